// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>

#include "bad_files/bad_file.hpp"
#include "base/random.hpp"
#include "support/las_file.hpp"
#include "support/png_bytes.hpp"

namespace excavplan::test {
namespace {

using std::string;

/// Numbers of 1 to 8 bytes over bytes anywhere: nothing, all, the ends of ranges.
void add_overwritten(BadFiles& files, const string& valid, int count) {
  constexpr std::array<std::uint64_t, 8> values = {0,
                                                   1,
                                                   0x7FFFFFFF,
                                                   0x80000000,
                                                   0xFFFFFFFF,
                                                   std::uint64_t{1} << 62,
                                                   0x7FFFFFFFFFFFFFFF,
                                                   0xFFFFFFFFFFFFFFFF};
  Random random(15);
  for (int i = 0; i < count; ++i) {
    const std::size_t width = std::size_t{1} << random.index(4);
    if (valid.size() <= width) return;
    const std::size_t at = random.index(valid.size() - width);
    const std::uint64_t value = values[random.index(values.size())];
    string bytes = valid;
    for (std::size_t k = 0; k < width; ++k) bytes[at + k] = static_cast<char>(value >> 8 * k);
    files.push_back({"byte " + std::to_string(at) + ": " + std::to_string(width) + " bytes of " +
                         std::to_string(value),
                     either, bytes});
  }
}

void add_spoiled(BadFiles& files, const string& valid) {
  const string half = valid.substr(0, valid.size() / 2);
  files.push_back({"empty", refused, ""});
  files.push_back({"one byte", refused, valid.substr(0, 1)});
  files.push_back({"its second half", refused, valid.substr(valid.size() / 2)});
  files.push_back({"half of it", either, half});
  files.push_back({"half of it, then zeros", either, half + string(valid.size() - half.size(), 0)});
  files.push_back({"zeros", refused, string(valid.size(), '\0')});
  files.push_back({"ones", refused, string(valid.size(), '\xFF')});
  files.push_back(
      {"its start and 1 MB of zeros", either, valid.substr(0, 16) + string(1000000, 0)});
  files.push_back({"twice", either, valid + valid});
  files.push_back({"300 kB behind", either, valid + string(300000, 'z')});
  files.push_back({"text", refused, "some words\n"});
  files.push_back({"UTF-8 byte order mark", refused, "\xEF\xBB\xBF" + valid});
  files.push_back({"reversed", refused, string(valid.rbegin(), valid.rend())});
}

// ---- LAS ----------------------------------------------------------------------------------------

void add_las_fields(BadFiles& files) {
  struct Field {
    const char* name;
    std::size_t at;
    std::size_t size;
    std::uint64_t value;
    Expected expected = refused;
  };
  const std::uint64_t not_a_number = 0x7FF8000000000000;
  const std::array<Field, 26> fields = {{{"signature", 0, 1, 'X'},
                                         {"version 2.0", 24, 1, 2},
                                         {"version 1.9", 25, 1, 9},
                                         {"version 1.4, header of 1.2", 25, 1, 4},
                                         {"header size 0", 94, 2, 0},
                                         {"header size 226", 94, 2, 226},
                                         {"header size 65535", 94, 2, 65535},
                                         {"points at 0", 96, 4, 0},
                                         {"points at 226", 96, 4, 226},
                                         {"points at 4 GB", 96, 4, 0xFFFFFFFF},
                                         {"records 1", 100, 4, 1},
                                         {"records 4e9", 100, 4, 0xFFFFFFFF},
                                         {"format 11", 104, 1, 11},
                                         {"format 255", 104, 1, 255},
                                         {"format of LAZ", 104, 1, 128},
                                         {"point size 0", 105, 2, 0},
                                         {"point size 19", 105, 2, 19},
                                         {"point size 65535", 105, 2, 65535},
                                         {"points 0", 107, 4, 0},
                                         {"points 1", 107, 4, 1},
                                         {"points 3", 107, 4, 3},
                                         {"points 4e9", 107, 4, 0xFFFFFFFF},
                                         {"scale 0", 131, 8, 0},
                                         {"scale NaN", 139, 8, not_a_number},
                                         {"scale negative", 147, 8, 0xBFF0000000000000},
                                         {"offset infinite", 155, 8, 0x7FF0000000000000}}};
  for (int minor = 0; minor < 4; ++minor) {
    for (const Field& field : fields) {
      LasFile file;
      file.minor = minor;
      string bytes = file.bytes();
      for (std::size_t k = 0; k < field.size; ++k) {
        bytes[field.at + k] = static_cast<char>(field.value >> 8 * k);
      }
      files.push_back({"1." + std::to_string(minor) + ": " + field.name, field.expected, bytes});
    }
  }
}

// ---- PNG ----------------------------------------------------------------------------------------

string png_head(std::uint32_t width, std::uint32_t height, const string& kind) {
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR" + big_endian(width) + big_endian(height) + kind);
}

void add_pngs(BadFiles& files) {
  const string grey16 = {16, 0, 0, 0, 0};
  const string image = png_of(4, {1, 2, 3, 4, 5, 6, 7, 8});
  const string data = image.substr(33);
  const auto add = [&](const string& name, const string& bytes, Expected expected = refused) {
    files.push_back({name, expected, bytes});
  };
  for (const auto& [width, height] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 2},
                                                            {4, 0},
                                                            {0, 0},
                                                            {5, 2},
                                                            {4, 3},
                                                            {1, 1},
                                                            {8, 1},
                                                            {0xFFFFFFFF, 1},
                                                            {1, 0xFFFFFFFF},
                                                            {0x7FFFFFFF, 0x7FFFFFFF},
                                                            {65536, 65536},
                                                            {10000, 10000}}) {
    const string size = std::to_string(width) + " x " + std::to_string(height);
    add(size, png_head(width, height, grey16) + data,
        width == 8 || width * height == 1 ? either : refused);
  }
  for (const int bits : {0, 1, 2, 3, 4, 8, 17, 32, 255}) {
    add(std::to_string(bits) + " bits",
        png_head(4, 2, {static_cast<char>(bits), 0, 0, 0, 0}) + data);
  }
  for (const int colour : {1, 2, 3, 4, 6, 7, 255}) {
    add("colour type " + std::to_string(colour),
        png_head(4, 2, {16, static_cast<char>(colour), 0, 0, 0}) + data);
  }
  add("compression 1", png_head(4, 2, {16, 0, 1, 0, 0}) + data);
  add("filter 1", png_head(4, 2, {16, 0, 0, 1, 0}) + data);
  add("interlace 2", png_head(4, 2, {16, 0, 0, 0, 2}) + data);
  add("interlaced, data not", png_head(4, 2, {16, 0, 0, 0, 1}) + data, either);
  add("no IEND", image.substr(0, image.size() - 12));
  add("no IDAT", image.substr(0, 33) + png_chunk("IEND"));
  add("no IHDR", image.substr(0, 8) + data);
  add("two IHDR", image.substr(0, 33) + image.substr(8), either);
  add("IDAT empty", image.substr(0, 33) + png_chunk("IDAT") + png_chunk("IEND"));
  add("IDAT of rubbish", image.substr(0, 33) + png_chunk("IDATrubbish") + png_chunk("IEND"));
  add("unknown critical chunk", image.substr(0, 33) + png_chunk("ABCDx") + data, either);
  add(
      "20,000 chunks of text",
      [&] {
        string chunks;
        for (int i = 0; i < 20000; ++i) chunks += png_chunk("tEXta");
        return image.substr(0, 33) + chunks + data;
      }(),
      either);
  add("a chunk of 4 GB", image.substr(0, 33) + "\xFF\xFF\xFF\xFFIDAT" + data);
  add("JPEG", "\xFF\xD8\xFF\xE0 and more");
}

/// What is at the path is made by this.
BadFile no_file(const string& name, std::function<string(const string&)> make,
                Expected expected = refused) {
  return {name, expected, "", "", std::move(make)};
}

}  // namespace

BadFiles bad_las_files() {
  BadFiles files;
  add_las_fields(files);
  for (const string& valid : valid_files("las")) add_spoiled(files, valid);
  LasFile lies;
  lies.minor = 4;
  lies.format = 6;
  string bytes = lies.bytes();
  LasFile::put(bytes, 247, std::uint64_t{1} << 62);
  files.push_back({"1.4: 2^62 points", refused, bytes});
  bytes = lies.bytes();
  LasFile::put(bytes, 243, std::uint32_t{1} << 31);
  files.push_back({"1.4: 2^31 extended records", refused, bytes});
  lies.scale = {1e308, 1e308, 1e308};
  files.push_back({"1.4: scale of 1e308", either, lies.bytes()});
  add_overwritten(files, valid_files("las").front(), 40);
  return files;
}

BadFiles bad_binary_files(const string& format) {
  BadFiles files;
  for (const string& valid : valid_files(format)) {
    add_spoiled(files, valid);
    add_overwritten(files, valid, 60);
  }
  for (BadFile& file : files) {  // a message without entries, or of other numbers
    const bool is_container = format == "mcap" || format == "bag" || format == "db3";
    const bool may_be = file.name == "zeros" || file.name == "reversed";
    if (may_be && !is_container && format != "depth_png") file.expected = either;
    if (format == "urdf" && file.name == "UTF-8 byte order mark")
      file.expected = Expected::same;  // XML 1.0
  }
  if (format == "depth_png") add_pngs(files);
  return files;
}

BadFiles things_that_are_no_files() {
  namespace fs = std::filesystem;
  return {
      no_file("a folder", [](const string& folder) { return folder; }),
      no_file("nothing", [](const string& folder) { return folder + "/nothing"; }),
      no_file("a pipe",
              [](const string& folder) {
                const string path = folder + "/pipe";
                ::mkfifo(path.c_str(), 0600);
                return path;
              }),
      no_file("links in a loop",
              [](const string& folder) {
                fs::create_symlink("loop", folder + "/loop");
                return folder + "/loop";
              }),
      no_file("a link to nothing",
              [](const string& folder) {
                fs::create_symlink("nowhere", folder + "/link");
                return folder + "/link";
              }),
      no_file("/dev/null", [](const string&) { return "/dev/null"; }),
      no_file("/dev/zero", [](const string&) { return "/dev/zero"; }),
      no_file("a name of 300 letters",
              [](const string& folder) { return folder + "/" + string(300, 'n'); }),
      no_file("a path through a file", [](const string&) { return string("/proc/self/stat/x"); }),
      no_file("no name", [](const string&) { return string(); })};
}

}  // namespace excavplan::test
