// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/machine/machine_file.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "machine/data_sheet_keys.hpp"
#include "machine/machine_reading.hpp"
#include "machine/urdf_machine.hpp"

namespace excavplan {
namespace {

MachineFile file_of(const std::string& name, std::string text) {
  JsonObject file = JsonObject::of_text(name, text, "excavplan-machine");
  MachineFile read;
  read.machine = read_machine(file);
  if (file.has("data_sheet")) read.data_sheet = read_data_sheet(file.object("data_sheet"));
  read.text = std::move(text);
  return read;
}

bool is_xml(const std::string& content) {
  const std::size_t start = content.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return start != content.npos && content[start] == '<';
}

}  // namespace

MachineFile load_machine_file(const std::string& path) {
  std::string content = read_file(path);
  if (!is_xml(content)) return file_of(path, std::move(content));
  UrdfDraft draft = draft_of_urdf(path, content);
  const std::string name =
      draft.beside.empty() ? path : path + " with " + draft.beside + " beside it";
  MachineFile read = file_of(name, draft.json.dump(2) + "\n");
  read.warnings = std::move(draft.warnings);
  return read;
}

Machine load_machine(const std::string& path) { return load_machine_file(path).machine; }

}  // namespace excavplan
