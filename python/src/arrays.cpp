// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

namespace excavplan::python {
namespace {

/// Numbers that the buffer protocol shows, for as long as any array of them lives.
template <typename Number>
struct Buffer {
  std::vector<Number> numbers;
  Shape shape;
};

py::object import_numpy() {
  try {
    return py::module_::import("numpy");
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
    return py::none();
  }
}

/// NumPy, or None where it is not installed. The import lends the lock of the interpreter to other
/// threads, which may come here meanwhile: nothing of ours is locked, and the first to end counts.
py::object numpy() {
  static PyObject* module = nullptr;  // only touched with the lock
  if (module == nullptr) {
    py::object imported = import_numpy();
    if (module == nullptr) module = imported.release().ptr();
  }
  return py::reinterpret_borrow<py::object>(module);
}

template <typename Number>
Array shown(std::vector<Number> numbers, Shape shape) {
  auto view = py::reinterpret_steal<py::object>(PyMemoryView_FromObject(
      py::cast(Buffer<Number>{std::move(numbers), std::move(shape)}).ptr()));
  if (!view) throw py::error_already_set();
  const py::object library = numpy();
  if (library.is_none()) return py::reinterpret_borrow<Array>(view);
  return py::reinterpret_borrow<Array>(library.attr("asarray")(view));
}

template <typename Number, typename Numbers>
Array by_rows(const Numbers& numbers) {
  std::vector<Number> flat;
  flat.reserve(static_cast<std::size_t>(numbers.size()));
  for (Eigen::Index row = 0; row < numbers.rows(); ++row) {
    for (Eigen::Index col = 0; col < numbers.cols(); ++col) flat.push_back(numbers(row, col));
  }
  return shown(std::move(flat), {numbers.rows(), numbers.cols()});
}

// ---- in -----------------------------------------------------------------------------------------

/// Numbers in the order of the last index, and how many there are along each index.
struct Numbers {
  std::vector<double> values;
  Shape shape;
};

[[noreturn]] void refuse(const std::string& what, const std::string& found,
                         const std::string& expected) {
  throw Error(ErrorKind::bad_input, what + ": found " + found + ", expected " + expected);
}

std::string shape_text(const Shape& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

/// @tparam swapped  in the other order of bytes than this machine's
template <typename Number, bool swapped>
double number_at(const char* place) {
  std::array<char, sizeof(Number)> bytes;
  std::copy_n(place, bytes.size(), bytes.begin());
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  Number number;
  std::memcpy(&number, bytes.data(), sizeof number);
  return static_cast<double>(number);
}

using Reader = double (*)(const char* place);

template <bool swapped>
Reader reader_of(const std::string& format, py::ssize_t size) {
  if (format == "d" && size == 8) return number_at<double, swapped>;
  if (format == "f" && size == 4) return number_at<float, swapped>;
  const bool is_signed =
      format == "b" || format == "h" || format == "i" || format == "l" || format == "q";
  const bool is_unsigned =
      format == "B" || format == "H" || format == "I" || format == "L" || format == "Q";
  if (!is_signed && !is_unsigned) return nullptr;
  switch (size) {
    case 1:
      return is_signed ? number_at<std::int8_t, swapped> : number_at<std::uint8_t, swapped>;
    case 2:
      return is_signed ? number_at<std::int16_t, swapped> : number_at<std::uint16_t, swapped>;
    case 4:
      return is_signed ? number_at<std::int32_t, swapped> : number_at<std::uint32_t, swapped>;
    case 8:
      return is_signed ? number_at<std::int64_t, swapped> : number_at<std::uint64_t, swapped>;
    default:
      return nullptr;
  }
}

/// Reads a number of a format of the module struct; null: it is none of numbers.
Reader reader_of(const py::buffer_info& buffer) {
  std::string format = buffer.format;
  const bool has_order = format.size() == 2 && std::strchr("@=<>!", format[0]) != nullptr;
  const bool is_big = has_order && (format[0] == '>' || format[0] == '!');
  if (has_order) format.erase(0, 1);
  // This machine is little-endian.
  return is_big ? reader_of<true>(format, buffer.itemsize)
                : reader_of<false>(format, buffer.itemsize);
}

/// Numbers that share their places in memory, as those of a row that is broadcast, may be more than
/// any memory holds: they are no more than the cells of a height map.
void require_room(const std::string& what, const py::buffer_info& buffer) {
  double places = 1.0;  // from the first number to the last
  for (std::size_t i = 0; i < buffer.shape.size(); ++i) {
    places +=
        std::abs(static_cast<double>(buffer.strides[i]) / static_cast<double>(buffer.itemsize)) *
        static_cast<double>(buffer.shape[i] - 1);
  }
  const auto size = static_cast<double>(buffer.size);
  if (size <= most_cells || size <= places) return;
  refuse(what, "the shape " + shape_text(buffer.shape) + ", broadcast",
         "at most " + std::to_string(static_cast<std::int64_t>(most_cells)) +
             " numbers that share memory");
}

void append(const py::buffer_info& buffer, Reader read, std::size_t dimension, const char* place,
            std::vector<double>& values) {
  if (dimension == buffer.shape.size()) {
    values.push_back(read(place));
    return;
  }
  for (py::ssize_t i = 0; i < buffer.shape[dimension]; ++i) {
    append(buffer, read, dimension + 1, place + i * buffer.strides[dimension], values);
  }
}

Numbers of_buffer(const std::string& what, const py::object& object) {
  const py::buffer_info buffer = py::reinterpret_borrow<py::buffer>(object).request();
  const Reader read = reader_of(buffer);
  if (read == nullptr) refuse(what, "items of the format '" + buffer.format + "'", "numbers");
  require_room(what, buffer);
  Numbers numbers{{}, buffer.shape};
  numbers.values.reserve(static_cast<std::size_t>(buffer.size));
  append(buffer, read, 0, static_cast<const char*>(buffer.ptr), numbers.values);
  return numbers;
}

double number_of(const std::string& what, const py::handle& item) {
  const double number = PyFloat_AsDouble(item.ptr());
  if (number != -1.0 || PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  refuse(what, "an item of the type " + std::string(Py_TYPE(item.ptr())->tp_name), "numbers");
}

bool is_list(const py::handle& object) {
  return PySequence_Check(object.ptr()) != 0 && PyUnicode_Check(object.ptr()) == 0 &&
         PyBytes_Check(object.ptr()) == 0;
}

/// One item of a sequence, which Python code may give.
py::object item_of(const py::handle& list, py::ssize_t i) {
  auto item = py::reinterpret_steal<py::object>(PySequence_GetItem(list.ptr(), i));
  if (!item) throw py::error_already_set();
  return item;
}

py::ssize_t size_of(const py::handle& list) {
  const py::ssize_t size = PySequence_Size(list.ptr());
  if (size < 0) throw py::error_already_set();
  return size;
}

/// A list of numbers, or of lists of as many numbers each.
Numbers of_lists(const std::string& what, const py::object& object) {
  if (!is_list(object)) {
    throw py::type_error(what + ": found an object of the type " + Py_TYPE(object.ptr())->tp_name +
                         ", expected an array or a sequence of numbers");
  }
  const py::ssize_t rows = size_of(object);
  Numbers numbers{{}, {rows}};
  for (py::ssize_t row = 0; row < rows; ++row) {
    const py::object item = item_of(object, row);
    const bool nested = is_list(item);
    const py::ssize_t columns = nested ? size_of(item) : 0;
    if (row == 0 && nested) numbers.shape.push_back(columns);
    if (nested != (numbers.shape.size() == 2) || (nested && columns != numbers.shape[1])) {
      refuse(what, "rows of different lengths", "as many numbers in each row");
    }
    if (!nested) numbers.values.push_back(number_of(what, item));
    for (py::ssize_t col = 0; col < columns; ++col) {
      numbers.values.push_back(number_of(what, item_of(item, col)));
    }
  }
  return numbers;
}

Numbers read(const std::string& what, const py::object& object) {
  if (PyObject_CheckBuffer(object.ptr()) != 0) return of_buffer(what, object);
  return of_lists(what, object);
}

/// A table; `columns` of 0 is any number of them.
Numbers read_table(const std::string& what, const py::object& object, py::ssize_t columns,
                   const std::string& expected) {
  Numbers numbers = read(what, object);
  if (numbers.shape == Shape{0} && columns > 0) numbers.shape = {0, columns};
  if (numbers.shape.size() != 2 || (columns > 0 && numbers.shape[1] != columns)) {
    refuse(what, "the shape " + shape_text(numbers.shape), expected);
  }
  return numbers;
}

template <typename Number>
void bind_buffer(py::module_& module, const char* name) {
  py::class_<Buffer<Number>>(module, name, py::buffer_protocol())
      .def_buffer([](Buffer<Number>& buffer) {
        Shape strides(buffer.shape.size());
        py::ssize_t stride = sizeof(Number);
        for (std::size_t i = strides.size(); i-- > 0;) {
          strides[i] = stride;
          stride *= buffer.shape[i];
        }
        return py::buffer_info(
            buffer.numbers.data(), sizeof(Number), py::format_descriptor<Number>::format(),
            static_cast<py::ssize_t>(buffer.shape.size()), buffer.shape, strides, true);
      });
}

}  // namespace

Array array(std::vector<double> numbers, Shape shape) {
  std::size_t size = 1;
  for (const py::ssize_t length : shape) size *= static_cast<std::size_t>(length);
  if (size != numbers.size()) throw std::logic_error("an array does not fit its shape");
  return shown(std::move(numbers), std::move(shape));
}

Array array(const Eigen::ArrayXXd& numbers) { return by_rows<double>(numbers); }
Array array(const Eigen::ArrayXXi& numbers) { return by_rows<std::int32_t>(numbers); }
Array array(const Eigen::Matrix4d& numbers) { return by_rows<double>(numbers); }

Eigen::ArrayXXd table_of(const std::string& what, const py::object& object) {
  const Numbers numbers = read_table(what, object, 0, "two dimensions");
  using Rows = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(numbers.values.data(), numbers.shape[0], numbers.shape[1]);
}

std::vector<double> numbers_of(const std::string& what, const py::object& object) {
  Numbers numbers = read(what, object);
  if (numbers.shape.size() != 1)
    refuse(what, "the shape " + shape_text(numbers.shape), "one dimension");
  return std::move(numbers.values);
}

std::vector<Eigen::Vector3d> points_of(const std::string& what, const py::object& object) {
  const Numbers numbers = read_table(what, object, 3, "(N, 3)");
  std::vector<Eigen::Vector3d> points(static_cast<std::size_t>(numbers.shape[0]));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Eigen::Vector3d>(numbers.values.data() + 3 * i);
  }
  return points;
}

Eigen::Matrix4d transform_of(const std::string& what, const py::object& object) {
  const Numbers numbers = read_table(what, object, 4, "(4, 4)");
  if (numbers.shape[0] != 4) refuse(what, "the shape " + shape_text(numbers.shape), "(4, 4)");
  using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(numbers.values.data());
}

void bind_arrays(py::module_& module) {
  bind_buffer<double>(module, "_Numbers");
  bind_buffer<std::int32_t>(module, "_Counts");
}

}  // namespace excavplan::python
