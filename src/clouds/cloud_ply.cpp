// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "clouds/cloud_formats.hpp"
#include "clouds/ply_mesh.hpp"

// PLY 1.0 as Greg Turk describes it (Stanford, 1994), with the type names int8 ... float64 that
// later programs write, and the names X Y Z of PDAL (io/PlyWriter.cpp, as of 2015).

namespace excavplan {
namespace {

enum class PlyEncoding { ascii, little_endian, big_endian };

struct Property {
  std::string name;
  ScalarType type = ScalarType::float32;
  std::optional<ScalarType> length_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  const char* axes = "XYZ";  ///< "xyz" once a property is called x

  bool has_lists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const Property& property) { return property.length_type.has_value(); });
  }
  /// Bytes of one row, all lists being empty.
  std::size_t row() const {
    std::size_t bytes = 0;
    for (const Property& property : properties) {
      bytes += size_of(property.length_type.value_or(property.type));
    }
    return bytes;
  }
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<Element> elements;
};

constexpr std::size_t no_axis = 3;

/// 0, 1, 2 for x, y, z of a vertex, or X, Y, Z where it has no x.
std::size_t axis_of(const Element& element, const Property& property) {
  if (element.name != "vertex" || property.length_type || property.name.size() != 1) return no_axis;
  return std::min(std::string(element.axes).find(property.name), no_axis);
}

/// Whether a list holds the corners of a face, by either of its names.
bool is_face(const Element& element, const Property& property) {
  return element.name == "face" && property.length_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

ScalarType scalar_type(std::string_view name, const LineReader& lines) {
  struct Name {
    std::string_view old_name;
    std::string_view new_name;
    ScalarType type;
  };
  constexpr std::array<Name, 8> names = {{{"char", "int8", ScalarType::int8},
                                          {"uchar", "uint8", ScalarType::uint8},
                                          {"short", "int16", ScalarType::int16},
                                          {"ushort", "uint16", ScalarType::uint16},
                                          {"int", "int32", ScalarType::int32},
                                          {"uint", "uint32", ScalarType::uint32},
                                          {"float", "float32", ScalarType::float32},
                                          {"double", "float64", ScalarType::float64}}};
  for (const Name& known : names) {
    if (name == known.old_name || name == known.new_name) return known.type;
  }
  lines.fail("type " + in_quotes(name), "char ... double or int8 ... float64");
}

using Words = std::vector<std::string_view>;

PlyEncoding read_encoding(const Words& words, const LineReader& lines) {
  if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyEncoding::ascii;
    if (words[1] == "binary_little_endian") return PlyEncoding::little_endian;
    if (words[1] == "binary_big_endian") return PlyEncoding::big_endian;
  }
  lines.fail(in_quotes(lines.line()),
             "format ascii, binary_little_endian or binary_big_endian 1.0");
}

Element read_element(const Words& words, const LineReader& lines) {
  if (words.size() != 3) lines.fail(in_quotes(lines.line()), "element NAME COUNT");
  Element element;
  element.name = words[1];
  element.count = count_of(words[2], lines);
  return element;
}

Property read_property(const Words& words, const LineReader& lines) {
  if (words.size() == 3 && words[1] != "list") {
    return {std::string(words[2]), scalar_type(words[1], lines), std::nullopt};
  }
  if (words.size() != 5 || words[1] != "list") {
    lines.fail(in_quotes(lines.line()), "property TYPE NAME or property list TYPE TYPE NAME");
  }
  const ScalarType length_type = scalar_type(words[2], lines);
  if (!is_integer(length_type)) {
    lines.fail("a list length of type " + in_quotes(words[2]), "an integer type");
  }
  return {std::string(words[4]), scalar_type(words[3], lines), length_type};
}

/// The header must describe one element vertex with x, y and z.
void require_vertices(const PlyHeader& header, const LineReader& lines) {
  std::size_t vertices = 0;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) {
      lines.fail("element " + in_quotes(element.name) + " without a property", "one or more");
    }
    if (element.name != "vertex") continue;
    ++vertices;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto times =
          std::count_if(element.properties.begin(), element.properties.end(),
                        [&](const auto& property) { return axis_of(element, property) == axis; });
      if (times == 1) continue;
      lines.fail(std::string("property ") + "xyz"[axis] + " " + std::to_string(times) + " times",
                 "x, y and z of a vertex once each");
    }
  }
  if (vertices != 1) {
    lines.fail(std::to_string(vertices) + " elements called vertex", "one");
  }
}

Words next_header_line(LineReader& lines) {
  while (true) {
    if (!lines.next_filled()) lines.fail("the end of the file", "end_header of a PLY header");
    if (lines.offset() > longest_header) {
      lines.fail("a header of more than " + std::to_string(longest_header) + " bytes", "less");
    }
    Words words = words_of(lines.line());
    if (words[0] != "comment" && words[0] != "obj_info") return words;
  }
}

PlyHeader read_ply_header(LineReader& lines) {
  PlyHeader header;
  lines.next();  // "ply", by which the format was detected
  header.encoding = read_encoding(next_header_line(lines), lines);
  std::size_t properties = 0;
  for (Words words = next_header_line(lines); words[0] != "end_header";
       words = next_header_line(lines)) {
    if (words[0] == "element") {
      header.elements.push_back(read_element(words, lines));
    } else if (words[0] == "property" && !header.elements.empty()) {
      Element& element = header.elements.back();
      element.properties.push_back(read_property(words, lines));
      if (element.properties.back().name == "x") element.axes = "xyz";
      ++properties;
    } else {
      lines.fail(in_quotes(words[0]), "element, property of an element or end_header");
    }
    if (properties > most_fields || header.elements.size() > most_fields) {
      lines.fail("more than " + std::to_string(most_fields) + " elements or properties", "fewer");
    }
  }
  require_vertices(header, lines);
  return header;
}

/// Reads one row of text, keeps x, y and z if it is a vertex and hands on the corners of a face.
Eigen::Vector3d read_text_row(const Element& element, const LineReader& lines,
                              const FaceVisitor& visit_face) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::string_view rest = lines.line();
  const auto next_word = [&] {
    const std::string_view word = take_word(rest);
    if (word.empty()) lines.fail("the end of the line", "a value for every property");
    return word;
  };
  for (const Property& property : element.properties) {
    if (property.length_type) {
      const bool is_wanted = visit_face && is_face(element, property);
      std::vector<double> corners;
      for (auto n = count_of(next_word(), lines); n > 0; --n) {
        const double value = number_of(next_word(), lines);
        if (is_wanted) corners.push_back(value);
      }
      if (is_wanted) visit_face(corners);
      continue;
    }
    const double value = number_of(next_word(), lines);
    const std::size_t axis = axis_of(element, property);
    if (axis != no_axis) point[static_cast<Eigen::Index>(axis)] = value;
  }
  if (const std::string_view word = take_word(rest); !word.empty()) {
    lines.fail(in_quotes(word), "the end of the row of element " + in_quotes(element.name));
  }
  return point;
}

void stream_text(FileStream& file, LineReader& lines, const PlyHeader& header, const MeshSink& to) {
  PointSink& sink = to.points;
  PointBatch batch(sink);
  for (const Element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    if (is_vertex) {
      const std::size_t shortest_row = 2 * element.properties.size();
      sink.require_memory(std::min(element.count, file.left() / shortest_row + 1), 0);
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (!lines.next_filled()) {
        lines.fail(
            "the end after " + std::to_string(i) + " rows of element " + in_quotes(element.name),
            std::to_string(element.count));
      }
      const Eigen::Vector3d point = read_text_row(element, lines, to.face);
      if (is_vertex) batch.add(point);
    }
  }
  if (lines.next_filled()) lines.fail(in_quotes(lines.line()), "the end after the last element");
  batch.hand_on();
}

/// Walks over the binary part.
class BinaryBody {
 public:
  BinaryBody(FileStream& file, bool swapped, const MeshSink& to)
      : file_(file), swapped_(swapped), sink_(to.points), visit_face_(to.face) {}

  void stream(const std::vector<Element>& elements) {
    for (const Element& element : elements) {
      require(element.count, element.row(), element);
      if (element.name == "vertex") sink_.require_memory(element.count, 0);
      if (element.has_lists()) {
        walk(element);
      } else if (element.name == "vertex") {
        stream_rows(file_, element.count, columns_of(element), swapped_, sink_);
      } else {
        file_.skip(element.count * element.row());
      }
    }
    file_.require_end();
  }

 private:
  void require(std::uint64_t count, std::size_t bytes, const Element& element) const {
    if (count <= file_.left() / bytes) return;
    file_.fail_here(std::to_string(file_.left()) + " bytes of data",
                    std::to_string(count) + " times " + std::to_string(bytes) +
                        " bytes of element " + in_quotes(element.name));
  }

  /// Of rows of fixed size.
  static Columns columns_of(const Element& element) {
    Columns columns;
    std::size_t offset = 0;
    for (const Property& property : element.properties) {
      if (const std::size_t axis = axis_of(element, property); axis != no_axis) {
        columns.type[axis] = property.type;
        columns.offset[axis] = offset;
        columns.stride[axis] = element.row();
      }
      offset += size_of(property.type);
    }
    return columns;
  }

  /// Rows with lists, each of its own size.
  void walk(const Element& element) {
    PointBatch batch(sink_);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      for (const Property& property : element.properties) {
        if (property.length_type) {
          take_list(element, property);
          continue;
        }
        const double value = take(property.type, element);
        const std::size_t axis = axis_of(element, property);
        if (axis != no_axis) point[static_cast<Eigen::Index>(axis)] = value;
      }
      if (element.name == "vertex") batch.add(point);
    }
    batch.hand_on();
  }

  void take_list(const Element& element, const Property& property) {
    const double length = take(*property.length_type, element);
    if (length < 0.0) file_.fail_here("a list of negative length", "0 or more");
    const auto entries = static_cast<std::uint64_t>(length);
    require(entries, size_of(property.type), element);
    if (!visit_face_ || !is_face(element, property)) {
      file_.skip(entries * size_of(property.type));
      return;
    }
    corners_.resize(entries);
    for (double& corner : corners_) corner = take(property.type, element);
    visit_face_(corners_);
  }

  double take(ScalarType type, const Element& element) {
    require(1, size_of(type), element);
    const double value = load_scalar(type, file_.peek(size_of(type)).data(), swapped_);
    file_.skip(size_of(type));
    return value;
  }

  FileStream& file_;
  bool swapped_;
  PointSink& sink_;
  const FaceVisitor& visit_face_;
  std::vector<double> corners_;
};

bool holds_ply(FileStream& file) {
  const std::string_view text = file.peek(5);
  return text.substr(0, 4) == "ply\n" || text == "ply\r\n";
}

CloudShape stream(FileStream& file, const MeshSink& to) {
  LineReader lines(file);
  const PlyHeader header = read_ply_header(lines);
  if (header.encoding == PlyEncoding::ascii) {
    stream_text(file, lines, header, to);
  } else {
    BinaryBody(file, header.encoding == PlyEncoding::big_endian, to).stream(header.elements);
  }
  const auto vertices = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const Element& e) { return e.name == "vertex"; });
  return {vertices->count, 1};
}

CloudShape stream_ply(FileStream& file, PointSink& sink) { return stream(file, {sink, nullptr}); }

std::string head_of_ply(const CloudShape& shape, Numbers numbers) {
  const std::string encoding = numbers == Numbers::text ? "ascii" : "binary_little_endian";
  const std::string type = numbers == Numbers::float32 ? "float" : "double";
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(shape.points()) +
         "\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
         " z\nend_header\n";
}

}  // namespace

bool is_ply(FileStream& file) { return holds_ply(file); }
void stream_ply_mesh(FileStream& file, const MeshSink& to) { stream(file, to); }

CloudFileFormat ply_format() {
  return {"ply", "PLY", {".ply"}, holds_ply, stream_ply, head_of_ply};
}

}  // namespace excavplan
