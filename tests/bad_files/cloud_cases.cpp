// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include "bad_files/bad_file.hpp"
#include "fuzz/file_readers.hpp"

// Where a file is only unusual, or breaks a rule that others do not have, `either`.

namespace excavplan::test {
namespace {

using std::string;

const std::vector<Eigen::Vector3d>& four_points() {
  static const std::vector<Eigen::Vector3d> points = {
      {4.5, -0.25, -0.5}, {5.0, 0.75, -1.25}, {0.125, 0.0, 2.0}, {-3.0, 8.5, 0.0625}};
  return points;
}

string as_text(const string& separator = " ") {
  string text;
  for (const auto& p : four_points()) {
    text +=
        number_text(p.x()) + separator + number_text(p.y()) + separator + number_text(p.z()) + "\n";
  }
  return text;
}

template <typename T>
string raw(T value, bool big_endian = false) {
  std::array<char, sizeof value> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  return big_endian ? string(bytes.rbegin(), bytes.rend()) : string(bytes.begin(), bytes.end());
}

template <typename T>
string as_rows(bool big_endian = false) {
  string bytes;
  for (const auto& p : four_points()) {
    for (const double v : {p.x(), p.y(), p.z()}) bytes += raw(static_cast<T>(v), big_endian);
  }
  return bytes;
}

// ---- PCD ----------------------------------------------------------------------------------------

/// As columns, packed by LZF as literals, after both sizes.
string compressed(const string& columns) {
  string packed;
  for (std::size_t at = 0; at < columns.size(); at += 32) {
    const string run = columns.substr(at, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  return raw(static_cast<std::uint32_t>(packed.size())) +
         raw(static_cast<std::uint32_t>(columns.size())) + packed;
}

string as_columns() {
  string bytes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const auto& p : four_points()) bytes += raw(static_cast<float>(p[axis]));
  }
  return bytes;
}

struct Pcd {
  string version = "VERSION 0.7\n";
  string fields = "FIELDS x y z\n";
  string size = "SIZE 4 4 4\n";
  string type = "TYPE F F F\n";
  string count = "COUNT 1 1 1\n";
  string width = "WIDTH 4\n";
  string height = "HEIGHT 1\n";
  string viewpoint = "VIEWPOINT 0 0 0 1 0 0 0\n";
  string points = "POINTS 4\n";
  string data = "DATA ascii\n";
  string body = as_text();
  string text() const {
    return "# .PCD v0.7 - Point Cloud Data file format\n" + version + fields + size + type + count +
           width + height + viewpoint + points + data + body;
  }
};

std::array<Pcd, 3> pcd_kinds() {
  Pcd ascii, binary, packed;
  binary.data = "DATA binary\n";
  binary.body = as_rows<float>();
  packed.data = "DATA binary_compressed\n";
  packed.body = compressed(as_columns());
  return {ascii, binary, packed};
}

/// A line of the header replaced.
struct PcdChange {
  const char* name;
  string Pcd::*line;
  string text;
  Expected expected = refused;
};

std::vector<PcdChange> pcd_header_changes() {
  return {{"no VERSION", &Pcd::version, "", either},
          {"VERSION 9.9", &Pcd::version, "VERSION 9.9\n", either},
          {"VERSION x", &Pcd::version, "VERSION x\n", either},
          {"VERSION .7", &Pcd::version, "VERSION .7\n", same},
          {"no FIELDS", &Pcd::fields, ""},
          {"FIELDS empty", &Pcd::fields, "FIELDS\n"},
          {"no z", &Pcd::fields, "FIELDS x y intensity\n"},
          {"x twice", &Pcd::fields, "FIELDS x x z\n"},
          {"a field too many", &Pcd::fields, "FIELDS x y z w\n"},
          {"65 fields", &Pcd::fields, "FIELDS x y z" + times(62, " f") + "\n"},
          {"100,000 fields", &Pcd::fields, "FIELDS x y z" + times(100000, " f") + "\n"},
          {"no SIZE", &Pcd::size, ""},
          {"SIZE 3", &Pcd::size, "SIZE 3 4 4\n"},
          {"SIZE 0", &Pcd::size, "SIZE 0 4 4\n"},
          {"SIZE -4", &Pcd::size, "SIZE -4 4 4\n"},
          {"SIZE 2^32 + 4", &Pcd::size, "SIZE 4294967300 4 4\n"},
          {"two SIZEs", &Pcd::size, "SIZE 4 4\n"},
          {"no TYPE", &Pcd::type, ""},
          {"TYPE Q", &Pcd::type, "TYPE Q F F\n"},
          {"two TYPEs", &Pcd::type, "TYPE F F\n"},
          {"no COUNT", &Pcd::count, "", same},
          {"COUNT 0", &Pcd::count, "COUNT 0 1 1\n"},
          {"COUNT -1", &Pcd::count, "COUNT -1 1 1\n"},
          {"COUNT 2 of x", &Pcd::count, "COUNT 2 1 1\n"},
          {"COUNT 2^31", &Pcd::count, "COUNT 2147483648 1 1\n"},
          {"COUNT 1e9", &Pcd::count, "COUNT 1000000000 1 1\n"},
          {"no WIDTH", &Pcd::width, "", either},
          {"WIDTH 0", &Pcd::width, "WIDTH 0\n"},
          {"WIDTH 3", &Pcd::width, "WIDTH 3\n"},
          {"WIDTH 5", &Pcd::width, "WIDTH 5\n"},
          {"WIDTH -4", &Pcd::width, "WIDTH -4\n"},
          {"WIDTH four", &Pcd::width, "WIDTH four\n"},
          {"WIDTH 4.5", &Pcd::width, "WIDTH 4.5\n"},
          {"WIDTH 0x4", &Pcd::width, "WIDTH 0x4\n"},
          {"WIDTH 2^32 + 4", &Pcd::width, "WIDTH 4294967300\n"},
          {"WIDTH 1e30", &Pcd::width, "WIDTH 1000000000000000000000000000000\n"},
          {"HEIGHT 2", &Pcd::height, "HEIGHT 2\n"},
          {"HEIGHT 0", &Pcd::height, "HEIGHT 0\n"},
          {"WIDTH x HEIGHT overflows to 4", &Pcd::height, "HEIGHT 4611686018427387905\n"},
          {"WIDTH x HEIGHT overflows 32 bits", &Pcd::height, "HEIGHT 1073741825\n"},
          {"VIEWPOINT of 6", &Pcd::viewpoint, "VIEWPOINT 0 0 0 1 0 0\n", either},
          {"VIEWPOINT of words", &Pcd::viewpoint, "VIEWPOINT a b c d e f g\n", either},
          {"no VIEWPOINT", &Pcd::viewpoint, "", same},
          {"POINTS 3", &Pcd::points, "POINTS 3\n"},
          {"POINTS 5", &Pcd::points, "POINTS 5\n"},
          {"POINTS 0", &Pcd::points, "POINTS 0\n"},
          {"POINTS -1", &Pcd::points, "POINTS -1\n"},
          {"POINTS 4e9", &Pcd::points, "POINTS 4000000000\n"},
          {"no POINTS", &Pcd::points, "", either},
          {"POINTS twice", &Pcd::points, "POINTS 4\nPOINTS 8\n"},
          {"no DATA", &Pcd::data, ""},
          {"DATA unknown", &Pcd::data, "DATA brotli\n"},
          {"DATA alone", &Pcd::data, "DATA\n"},
          {"a line of 1 MB", &Pcd::points, "POINTS 4" + times(1000000, " ") + "\n", either},
          {"200 kB of comments", &Pcd::points, "POINTS 4\n" + times(20000, "# comment\n"), either},
          {"NUL in the header", &Pcd::points, string("POINTS 4\0\n", 10), either},
          {"CRLF", &Pcd::points, "POINTS 4\r\n", same}};
}

void add_pcd_headers(BadFiles& files) {
  const std::array<string, 3> names = {"ascii", "binary", "compressed"};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    for (const PcdChange& change : pcd_header_changes()) {
      Pcd pcd = pcd_kinds()[kind];
      pcd.*change.line = change.text;
      files.push_back({names[kind] + ": " + change.name, change.expected, pcd.text()});
    }
    // counts that lie, all alike
    for (const char* count : {"5", "1000", "100000000", "1000000000000", "18446744073709551615"}) {
      Pcd pcd = pcd_kinds()[kind];
      pcd.width = "WIDTH " + string(count) + "\n";
      pcd.points = "POINTS " + string(count) + "\n";
      files.push_back({names[kind] + ": says " + count + " points", refused, pcd.text()});
    }
  }
}

void add_ascii_bodies(BadFiles& files, const string& head, bool has_count) {
  const Expected counted = has_count ? refused : either;
  const string rows = as_text();
  const string first = rows.substr(0, rows.find('\n'));
  const string rest = rows.substr(first.size());
  const auto add = [&](const char* name, Expected expected, const string& body) {
    files.push_back({"text: " + string(name), expected, head + body});
  };
  add("no rows", refused, "");
  add("a row missing", counted, rest.substr(1));
  add("a row too many", counted, rows + "1 2 3\n");
  add("two values in a row", refused, "4.5 -0.25" + rest);
  add("a word", refused, "4.5 -0.25 deep" + rest);
  add("a number with a tail", refused, "4.5 -0.25 -0.5m" + rest);
  add("hexadecimal", refused, "0x4 -0.25 -0.5" + rest);
  add("decimal commas", refused, "4,5 -0,25 -0,5" + rest);
  add("two points", refused, "4.5.1 -0.25 -0.5" + rest);
  add("two signs", refused, "--4.5 -0.25 -0.5" + rest);
  add("1e", refused, "1e -0.25 -0.5" + rest);
  add("a Fortran exponent", refused, "4.5d0 -0.25 -0.5" + rest);
  add("Arabic digits", refused, "\xD9\xA4 -0.25 -0.5" + rest);
  add("a long minus", refused, "4.5 \xE2\x88\x92\x30.25 -0.5" + rest);
  add("thousands", refused, "4'000 -0.25 -0.5" + rest);
  add("1e400", either, "1e400 -0.25 -0.5" + rest);
  add("4000 digits", either, "4.5" + times(4000, "0") + " -0.25 -0.5" + rest);
  add("a line of 200 kB", either, first + times(200000, " ") + rest);
  add("NUL in a number", refused, string("4\0.5 -0.25 -0.5", 15) + rest);
  add("blanks and tabs", same, "  4.5\t -0.25   -0.5  " + rest);
  add("zeros at the end", either, rows + string(64, '\0'));
  add("binary at the end", counted, rows + "\x01\x02\xFF\xFE");
  add("lines end in CR", refused, "4.5 -0.25 -0.5\r5 0.75 -1.25\r0.125 0 2\r-3 8.5 0.0625\r");
}

void add_pcd_bodies(BadFiles& files) {
  Pcd ascii, binary = pcd_kinds()[1], packed = pcd_kinds()[2];
  ascii.body = "";
  add_ascii_bodies(files, ascii.text(), true);
  const auto add = [&](const char* name, Expected expected, Pcd pcd, const string& body) {
    pcd.body = body;
    files.push_back({name, expected, pcd.text()});
  };
  const string rows = as_rows<float>();
  add("binary: no data", refused, binary, "");
  add("binary: a byte missing", refused, binary, rows.substr(1));
  add("binary: a point too many", refused, binary, rows + rows.substr(0, 12));
  add("binary: zeros behind", same, binary, rows + string(100, '\0'));
  add("binary: text behind", refused, binary, rows + "and so on");
  add("binary: 1 MB behind", refused, binary, rows + string(1000000, 'x'));
  const string columns = as_columns();
  const auto sizes = [&](std::uint32_t in, std::uint32_t out) {
    return raw(in) + raw(out) + compressed(columns).substr(8);
  };
  add("compressed: no data", refused, packed, "");
  add("compressed: only sizes", refused, packed, compressed(columns).substr(0, 8));
  add("compressed: packed size 0", refused, packed, sizes(0, 48));
  add("compressed: packed size 4 GB", refused, packed, sizes(0xFFFFFFFF, 48));
  add("compressed: size 4 GB", refused, packed, sizes(50, 0xFFFFFFFF));
  add("compressed: size 0", refused, packed, sizes(50, 0));
  add("compressed: a byte too few", refused, packed, sizes(49, 48));
  add("compressed: reference before the start", refused, packed,
      raw(std::uint32_t{2}) + raw(std::uint32_t{48}) + "\x20\xFF");
  add("compressed: run beyond the end", refused, packed,
      raw(std::uint32_t{2}) + raw(std::uint32_t{48}) + string("\x1F\x00", 2));
  add("compressed: makes too much", refused, packed, compressed(columns + "1234"));
  add("compressed: makes too little", refused, packed, compressed(columns.substr(4)));
}

// ---- PLY ----------------------------------------------------------------------------------------

struct Ply {
  string magic = "ply\n";
  string format = "format ascii 1.0\n";
  string element = "element vertex 4\n";
  string properties = "property float x\nproperty float y\nproperty float z\n";
  string more = "";
  string end = "end_header\n";
  string body = as_text();
  string text() const { return magic + format + element + properties + more + end + body; }
};

std::array<Ply, 3> ply_kinds() {
  Ply ascii, little, big;
  little.format = "format binary_little_endian 1.0\n";
  little.body = as_rows<float>();
  big.format = "format binary_big_endian 1.0\n";
  big.body = as_rows<float>(true);
  return {ascii, little, big};
}

struct PlyChange {
  const char* name;
  string Ply::*part;
  string text;
  Expected expected = refused;
};

std::vector<PlyChange> ply_header_changes() {
  const string xyz = Ply().properties;
  return {{"magic PLY", &Ply::magic, "PLY\n", either},
          {"no magic", &Ply::magic, ""},
          {"no format", &Ply::format, ""},
          {"format 2.0", &Ply::format, "format ascii 2.0\n", either},
          {"format of two words", &Ply::format, "format ascii\n", either},
          {"unknown format", &Ply::format, "format binary_middle_endian 1.0\n"},
          {"no element", &Ply::element, ""},
          {"element -4", &Ply::element, "element vertex -4\n"},
          {"element four", &Ply::element, "element vertex four\n"},
          {"element 3", &Ply::element, "element vertex 3\n"},
          {"element 5", &Ply::element, "element vertex 5\n"},
          {"element 4.5", &Ply::element, "element vertex 4.5\n"},
          {"element 4000000000", &Ply::element, "element vertex 4000000000\n"},
          {"element 2^32 + 4", &Ply::element, "element vertex 4294967300\n"},
          {"element 2^64 - 1", &Ply::element, "element vertex 18446744073709551615\n"},
          {"element 1e30", &Ply::element, "element vertex 1000000000000000000000000000000\n"},
          {"element without a count", &Ply::element, "element vertex\n"},
          {"vertex twice", &Ply::element, "element vertex 4\nproperty float x\nelement vertex 4\n"},
          {"element points", &Ply::element, "element points 4\n"},
          {"no property", &Ply::properties, ""},
          {"no z", &Ply::properties, "property float x\nproperty float y\nproperty float w\n"},
          {"x twice", &Ply::properties, "property float x\nproperty float x\nproperty float z\n"},
          {"type quad", &Ply::properties, "property quad x\nproperty float y\nproperty float z\n"},
          {"x is a list", &Ply::properties,
           "property list uchar float x\nproperty float y\nproperty float z\n"},
          {"list of float length", &Ply::more, "property list float int n\n"},
          {"a property too many", &Ply::more, "property float w\n"},
          {"70 properties", &Ply::more, times(70, "property float w\n")},
          {"20,000 properties", &Ply::more, times(20000, "property float w\n")},
          {"faces that are missing", &Ply::more,
           "element face 3\nproperty list uchar int vertex_indices\n"},
          {"2^62 faces", &Ply::more,
           "element face 4611686018427387904\nproperty list uchar int vertex_indices\n"},
          {"an element without properties", &Ply::more, "element empty 4\n", either},
          {"no end_header", &Ply::end, ""},
          {"END_HEADER", &Ply::end, "END_HEADER\n"},
          {"unknown word", &Ply::more, "dimension 3\n", either},
          {"comments", &Ply::more, "comment a\nobj_info b\n", same},
          {"200 kB of comments", &Ply::more, times(20000, "comment x\n"), either},
          {"a comment of 1 MB", &Ply::more, "comment " + times(1000000, "x") + "\n", either},
          {"NUL in the header", &Ply::more, string("comment \0\n", 10), either}};
}

void add_ply_headers(BadFiles& files) {
  const std::array<string, 3> names = {"ascii", "little", "big"};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    for (const PlyChange& change : ply_header_changes()) {
      Ply ply = ply_kinds()[kind];
      ply.*change.part = change.text;
      files.push_back({names[kind] + ": " + change.name, change.expected, ply.text()});
    }
  }
}

void add_ply_bodies(BadFiles& files) {
  Ply ascii = ply_kinds()[0];
  ascii.body = "";
  add_ascii_bodies(files, ascii.text(), true);
  for (const bool big : {false, true}) {
    const string rows = as_rows<float>(big);
    const auto add = [&](const char* name, Expected expected, const string& body,
                         const string& more = "") {
      Ply ply = ply_kinds()[big ? 2 : 1];
      ply.more = more;
      ply.body = body;
      files.push_back({string(big ? "big: " : "little: ") + name, expected, ply.text()});
    };
    add("no data", refused, "");
    add("a byte missing", refused, rows.substr(1));
    add("a point too many", refused, rows + rows.substr(0, 12));
    add("text behind", refused, rows + "and so on");
    add("zeros behind", same, rows + string(100, '\0'));
    const string faces = "element face 1\nproperty list uchar int n\n";
    add("a face", same, rows + string("\1\0\0\0\0", 5), faces);
    add("a face cut", refused, rows + string("\3\0\0\0\0", 5), faces);
    add("a list of 4e9", refused, rows + "\xFF\xFF\xFF\xFF",
        "element face 1\nproperty list uint int n\n");
    add("a list of -1", refused, rows + "\xFF\xFF\xFF\xFF",
        "element face 1\nproperty list int int n\n");
  }
}

/// The whole file spoiled, as of text or bytes alike.
void add_spoiled(BadFiles& files, const std::vector<string>& valid) {
  for (const string& file : valid) {
    const bool is_text = file.find('\0') == file.npos;
    files.push_back({"empty", refused, ""});
    files.push_back({"half of it", refused, file.substr(0, file.size() / 2)});
    files.push_back({"its second half", refused, file.substr(file.size() / 2)});
    files.push_back({"twice", refused, file + file});
    files.push_back({"UTF-8 byte order mark", either, "\xEF\xBB\xBF" + file});
    files.push_back({"UTF-16 byte order mark", refused, "\xFF\xFE" + file});
    files.push_back({"gzip", refused, "\x1F\x8B\x08" + file});
    files.push_back({"a newline in front", either, "\n" + file});
    files.push_back({"a NUL in front", refused, string(1, '\0') + file});
    files.push_back({"300 kB behind", refused, file + times(300000, "z")});
    if (!is_text) continue;
    string wide;
    for (const char c : file) wide += string({c, '\0'});
    files.push_back({"UTF-16", refused, "\xFF\xFE" + wide});
    string crlf;
    for (const char c : file) crlf += c == '\n' ? "\r\n" : string(1, c);
    files.push_back({"CRLF throughout", same, crlf});
  }
}

}  // namespace

std::vector<string> valid_pcd_files() {
  std::vector<string> files;
  for (const Pcd& pcd : pcd_kinds()) files.push_back(pcd.text());
  return files;
}

std::vector<string> valid_ply_files() {
  std::vector<string> files;
  for (const Ply& ply : ply_kinds()) files.push_back(ply.text());
  return files;
}

BadFiles bad_pcd_files() {
  BadFiles files;
  add_pcd_headers(files);
  add_pcd_bodies(files);
  add_spoiled(files, valid_pcd_files());
  return files;
}

BadFiles bad_ply_files() {
  BadFiles files;
  add_ply_headers(files);
  add_ply_bodies(files);
  add_spoiled(files, valid_ply_files());
  return files;
}

BadFiles bad_xyz_files() {
  BadFiles files;
  add_ascii_bodies(files, "# x y z [m]\n", false);
  for (BadFile& file : files) {
    if (file.expected == same) file.said = points_text(four_points());
  }
  const auto add = [&](const char* name, Expected expected, const string& text) {
    files.push_back({name, expected, text, expected == same ? points_text(four_points()) : ""});
  };
  for (const char* separator : {",", ";", ", ", "\t", " ; "}) {
    add("another separator", same, as_text(separator));
  }
  add("names", same, "X;Y;Z\n" + as_text(";"));
  add("names in another order", either, "z y x\n" + as_text());
  add("names without z", refused, "x y w\n" + as_text());
  add("names twice", refused, "x x y z\n" + as_text());
  add("two separators", refused, "4.5,-0.25,-0.5\n5;0.75;-1.25\n");
  add("an empty field", refused, "4.5,,-0.5\n");
  add("comments of two kinds", same, "// a\n# b\n" + as_text());
  add("blank lines", same, "\n\n" + as_text() + "\n\n");
  add("only comments", refused, "# a\n# b\n");
  add("only blanks", refused, times(1000, " \n"));
  add("a number alone", refused, "5\n");
  add("HTML", refused, "<html><body>404</body></html>\n");
  add("JSON", refused, "{\"x\": 1}\n");
  add("UTF-8 byte order mark", same, "\xEF\xBB\xBF" + as_text());
  add("CRLF", same, "4.5 -0.25 -0.5\r\n5 0.75 -1.25\r\n0.125 0 2\r\n-3 8.5 0.0625\r\n");
  add("no newline at the end", same, as_text().substr(0, as_text().size() - 1));
  add("100,000 rows", either, times(100000, "1 2 3\n"));
  add("100,000 blank lines", either, times(100000, "\n") + as_text());
  add("2000 columns", either, "1 2 3" + times(2000, " 4") + "\n");
  add("E57", refused, "ASTM-E57 and more");
  add("PNG", refused, "\x89PNG\r\n\x1a\n0000");
  add("UTF-16", refused,
      string("\xFF\xFE"
             "1\0 \0002\0",
             8));
  return files;
}

}  // namespace excavplan::test
