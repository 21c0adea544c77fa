// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <expat.h>

#include <excavplan/base/error.hpp>
#include <excavplan/design/design_file.hpp>

#include "base/read_double.hpp"
#include "base/text.hpp"
#include "clouds/file_stream.hpp"
#include "design/land_units.hpp"
#include "design/raw_design.hpp"

namespace excavplan {
namespace {

constexpr std::size_t longest_content = 4096;  // of a P or F [byte]; ours
constexpr std::size_t most_levels = 64;        // of elements in one another; ours
constexpr std::size_t most_surfaces = 1000;    // ours
constexpr std::size_t faces_a_line = 64;       // of which the line is kept; ours
constexpr std::string_view blanks = " \t\r\n";

/// Where ids of points lead. Mostly they are small and dense.
class PointIds {
 public:
  /// False if the id is there already.
  bool add(std::uint64_t id, std::uint32_t point) {
    constexpr std::uint64_t most_dense = std::uint64_t{1} << 24U;  // 64 MiB; ours
    if (id >= most_dense) return sparse_.emplace(id, point).second;
    if (id >= dense_.size()) dense_.resize(std::max<std::size_t>(id + 1, 2 * dense_.size()), none);
    if (dense_[id] != none) return false;
    dense_[id] = point;
    return true;
  }
  std::optional<std::uint32_t> find(std::uint64_t id) const {
    if (id < dense_.size() && dense_[id] != none) return dense_[id];
    const auto found = sparse_.find(id);
    if (found == sparse_.end()) return std::nullopt;
    return found->second;
  }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  std::vector<std::uint32_t> dense_;
  std::unordered_map<std::uint64_t, std::uint32_t> sparse_;
};

/// A surface of the file. Of those that are not wanted only this is kept.
struct Outline {
  std::string name;
  std::string description;
  std::uint64_t line = 0;

  bool is_existing_ground() const {
    const std::string words = small_letters(name + " " + description);
    return words.find("existing") != words.npos;
  }
};

/// The triangles of the surface that is being read.
struct Surface {
  Outline outline;
  RawDesign mesh;
  PointIds ids;
  std::vector<std::pair<std::size_t, std::uint64_t>> lines;  ///< from a face on, of the file
  std::vector<std::array<std::uint64_t, 3>> faces;           ///< by the ids of their points
  std::size_t hidden = 0;                                    ///< faces
  bool has_other_data = false;                               ///< breaklines, boundaries, contours
};

struct Attributes {
  const XML_Char** list;
  const char* find(std::string_view key) const {
    for (const XML_Char** at = list; *at != nullptr; at += 2) {
      if (key == *at) return at[1];
    }
    return nullptr;
  }
};

/// Reads the file from front to back by expat, without a tree.
class LandXml {
 public:
  LandXml(const std::string& path, const DesignFileOptions& options)
      : file_(path), options_(options), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  RawDesign read() {
    while (file_.left() > 0) {
      const std::string_view part = file_.peek(std::min<std::uint64_t>(file_.left(), 1U << 16U));
      const bool is_last = part.size() == file_.left();
      const auto status =
          XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()), is_last ? 1 : 0);
      if (fault_) std::rethrow_exception(fault_);
      if (status != XML_STATUS_OK) {
        refuse(std::string("found XML that is not well formed, ") +
               XML_ErrorString(XML_GetErrorCode(parser_.get())));
      }
      file_.skip(part.size());
    }
    return chosen();
  }

 private:
  [[noreturn]] void refuse_at(std::uint64_t line, const std::string& why) const {
    file_.refuse("line " + std::to_string(line) + ": " + why);
  }
  [[noreturn]] void refuse(const std::string& why) const { refuse_at(line(), why); }
  std::uint64_t line() const { return XML_GetCurrentLineNumber(parser_.get()); }

  /// expat is C: no exception may pass through it.
  template <typename Work>
  static void guarded(void* self, Work work) {
    auto& reader = *static_cast<LandXml*>(self);
    if (reader.fault_) return;
    try {
      work(reader);
    } catch (...) {
      reader.fault_ = std::current_exception();
      XML_StopParser(reader.parser_.get(), XML_FALSE);
    }
  }
  static void XMLCALL on_start(void* self, const XML_Char* name, const XML_Char** attributes) {
    guarded(self, [&](LandXml& reader) { reader.start(name, {attributes}); });
  }
  static void XMLCALL on_end(void* self, const XML_Char* /*name*/) {
    guarded(self, [&](LandXml& reader) { reader.end(); });
  }
  static void XMLCALL on_text(void* self, const XML_Char* text, int length) {
    guarded(self, [&](LandXml& reader) {
      if (!reader.takes_text_) return;
      reader.content_.append(text, static_cast<std::size_t>(length));
      if (reader.content_.size() > longest_content) {
        reader.refuse("found a " + reader.path_.back() + " of more than " +
                      std::to_string(longest_content) + " bytes, expected less");
      }
    });
  }
  static void XMLCALL on_doctype(void* self, const XML_Char*, const XML_Char*, const XML_Char*,
                                 int) {
    guarded(self, [](LandXml& reader) {
      reader.refuse("found a document type, expected none: it may hold entities");
    });
  }

  bool is_inside(std::string_view parent) const {
    return path_.size() > 1 && path_[path_.size() - 2] == parent;
  }
  /// Below a Definition of a Surface or, as Trimble writes, below the Surface itself.
  bool is_of_surface() const {
    if (!surface_ || path_.size() < 3) return false;
    const std::string& above = path_[path_.size() - 3];
    return above == "Definition" || above == "Surface";
  }

  void start(std::string_view name, const Attributes& attributes) {
    name.remove_prefix(std::min(name.find(':') + 1, name.size()));  // npos + 1 is 0
    if (path_.empty() && name != "LandXML") {
      refuse("found the element " + in_quotes(name) + ", expected LandXML");
    }
    if (path_.size() == most_levels) {
      refuse("found elements in more than " + std::to_string(most_levels) + " levels");
    }
    path_.emplace_back(name);
    if (takes_text_) refuse("found " + in_quotes(name) + " in the coordinates of a point or face");
    if (is_inside("Units") && (name == "Metric" || name == "Imperial")) start_units(attributes);
    if (name == "Surface" && is_inside("Surfaces")) start_surface(attributes);
    if (surface_ && is_inside("SourceData")) surface_->has_other_data = true;
    if (name == "P" && is_inside("Pnts") && is_of_surface()) start_point(attributes);
    if (name == "F" && is_inside("Faces") && is_of_surface()) start_face(attributes);
  }

  void start_units(const Attributes& attributes) {
    if (units_) refuse("found a second list of units, expected either Metric or Imperial");
    const char* const linear = attributes.find("linearUnit");
    const char* const height = attributes.find("elevationUnit");
    units_ = land_units(path_.back(), linear ? linear : "", height ? height : "");
    if (!units_->fault.empty()) refuse(units_->fault);
  }

  void start_surface(const Attributes& attributes) {
    const char* const name = attributes.find("name");
    const char* const description = attributes.find("desc");
    surface_ = std::make_unique<Surface>();
    surface_->outline = {safe_text(name ? name : "", 200),
                         safe_text(description ? description : "", 200), line()};
    outlines_.push_back(surface_->outline);
    if (outlines_.size() > most_surfaces) {
      refuse("found more than " + std::to_string(most_surfaces) + " surfaces");
    }
    is_wanted_ = options_.surface.empty() ? !surface_->outline.is_existing_ground()
                                          : surface_->outline.name == options_.surface;
  }

  void start_point(const Attributes& attributes) {
    if (attributes.find("pntRef") != nullptr) {
      refuse("found a point that refers to another, expected its coordinates");
    }
    const char* const id = attributes.find("id");
    const auto number = parse_count(id ? id : "");
    if (!number || *number == 0) {
      refuse("found a point with the id " + in_quotes(id ? id : "") +
             ", expected a whole number above 0");
    }
    id_ = *number;
    take_text();
  }

  void start_face(const Attributes& attributes) {
    const char* const invisible = attributes.find("i");
    is_hidden_ = invisible != nullptr && std::string_view(invisible) == "1";
    take_text();
  }

  void take_text() {
    takes_text_ = true;
    content_.clear();
  }

  void end() {
    const std::string& name = path_.back();
    if (takes_text_ && name == "P") end_point();
    if (takes_text_ && name == "F") end_face();
    takes_text_ = false;
    if (name == "Surface" && surface_) end_surface();
    path_.pop_back();
  }

  std::string_view next_word(std::string_view& rest) const {
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
    rest.remove_prefix(word.size());
    return word;
  }

  void end_point() {
    std::string_view rest = content_;
    std::array<double, 3> numbers = {};
    for (double& number : numbers) {
      const std::string_view word = next_word(rest);
      const auto value = parse_number(word);
      if (!value || !std::isfinite(*value)) {
        refuse("found " + in_quotes(word.empty() ? "the end of a P" : word) +
               ", expected northing, easting and elevation of a point");
      }
      number = *value;
    }
    if (const auto word = next_word(rest); !word.empty()) {
      refuse("found " + in_quotes(word) + ", expected the end of a P after three numbers");
    }
    auto& points = surface_->mesh.points;
    if (points.size() == most_design_points) refuse("found too many points");
    if (is_wanted_ && !surface_->ids.add(id_, static_cast<std::uint32_t>(points.size()))) {
      refuse("found a second point with the id " + std::to_string(id_));
    }
    if (is_wanted_) points.emplace_back(numbers[1], numbers[0], numbers[2]);
  }

  void end_face() {
    std::string_view rest = content_;
    std::array<std::uint64_t, 4> ids = {};
    std::size_t count = 0;
    for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const auto id = parse_count(word);
      if (!id || *id == 0 || count == ids.size()) {
        refuse("found " + in_quotes(word) + ", expected three or four ids of points");
      }
      ids[count++] = *id;
    }
    if (count < 3) refuse("found " + std::to_string(count) + " ids, expected three or four");
    if (is_hidden_) {
      ++surface_->hidden;
      return;
    }
    auto& faces = surface_->faces;
    if (faces.size() >= most_design_triangles) refuse("found too many faces");
    if (!is_wanted_) return;
    auto& lines = surface_->lines;
    if (lines.empty() || faces.size() - lines.back().first >= faces_a_line) {
      lines.emplace_back(faces.size(), line());
    }
    faces.push_back({ids[0], ids[1], ids[2]});
    if (count == 4) faces.push_back({ids[0], ids[2], ids[3]});
  }

  void end_surface() {
    if (is_wanted_) {
      found_.push_back(std::move(surface_));
      if (found_.size() == 1) {
        resolve(*found_.front());
      } else {
        found_.back()->mesh = {};  // one too many: only its name is told
        found_.back()->faces.clear();
      }
    }
    surface_.reset();
  }

  void resolve(Surface& surface) const {
    const std::string name = "the surface " + in_quotes(surface.outline.name);
    if (surface.faces.empty()) {
      refuse_at(surface.outline.line,
                name + " has " + std::to_string(surface.mesh.points.size()) + " points and no " +
                    (surface.hidden > 0 ? "visible " : "") + "face, expected a TIN of triangles" +
                    (surface.has_other_data ? "; its source data (breaklines, boundaries) are no "
                                              "surface: export it with its triangles"
                                            : ""));
    }
    for (std::size_t i = 0; i < surface.faces.size(); ++i) {
      std::array<std::uint32_t, 3> triangle = {};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto point = surface.ids.find(surface.faces[i][corner]);
        if (!point) {
          refuse_at(line_of_face(surface, i), "or soon after: found a face with the point " +
                                                  std::to_string(surface.faces[i][corner]) +
                                                  ", which " + name + " does not have");
        }
        triangle[corner] = *point;
      }
      surface.mesh.triangles.push_back(triangle);
    }
    surface.faces = {};
    surface.ids = {};
    surface.mesh.name = surface.outline.name;
    if (surface.hidden > 0) {
      surface.mesh.notes.push_back(std::to_string(surface.hidden) +
                                   " invisible faces were left out");
    }
  }
  static std::uint64_t line_of_face(const Surface& surface, std::size_t face) {
    std::uint64_t line = surface.outline.line;
    for (const auto& [from, at] : surface.lines) {
      if (from <= face) line = at;
    }
    return line;
  }

  std::string names() const {
    std::string list;
    for (const Outline& outline : outlines_) {
      if (!list.empty()) list += ", ";
      list += in_quotes(outline.name);
    }
    return list;
  }

  RawDesign chosen() {
    if (outlines_.empty()) {
      refuse("found no surface, expected a TIN; alignments alone are none: export the surface");
    }
    if (found_.empty()) {
      refuse(options_.surface.empty()
                 ? "found only existing ground, expected a design: name the surface, of " + names()
                 : "found no surface " + in_quotes(options_.surface) + ", only " + names());
    }
    if (found_.size() > 1) {
      refuse("found " + std::to_string(found_.size()) +
             " surfaces that may be the design, expected one: name it, of " + names());
    }
    if (!units_) refuse("found no units, expected Metric or Imperial in Units");
    RawDesign mesh = std::move(found_.front()->mesh);
    mesh.unit = units_->linear;
    mesh.height_unit = units_->height;
    mesh.unit_told_by = units_->told_by;
    if (outlines_.size() > 1) mesh.notes.push_back("of the surfaces " + names() + " one was read");
    return mesh;
  }

  FileStream file_;
  const DesignFileOptions& options_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::exception_ptr fault_;
  std::vector<std::string> path_;  ///< of elements, from the outermost
  std::string content_;            ///< of the P or F that is being read
  bool takes_text_ = false;
  std::uint64_t id_ = 0;
  bool is_hidden_ = false;
  std::optional<LandUnits> units_;
  std::vector<Outline> outlines_;
  std::unique_ptr<Surface> surface_;
  bool is_wanted_ = false;
  std::vector<std::unique_ptr<Surface>> found_;
};

}  // namespace

RawDesign read_land_xml(const std::string& path, const DesignFileOptions& options) {
  return LandXml(path, options).read();
}

}  // namespace excavplan
