// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Core>

/// @file
/// Arrays of numbers in and out, by the buffer protocol alone: the module is neither built against
/// NumPy nor imports it before the first array is asked for.

namespace excavplan::python {

namespace py = pybind11;

/// Numbers handed out: a read-only array of NumPy where it is installed, else a memoryview. It owns
/// its numbers.
class Array : public py::object {
  PYBIND11_OBJECT_DEFAULT(Array, object, PyObject_CheckBuffer)
};
/// What numbers are taken from: a buffer (array of NumPy, memoryview, array.array) or nested
/// sequences.
class ArrayLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(ArrayLike, object, [](PyObject*) { return true; })
};

using Shape = std::vector<py::ssize_t>;

/// The numbers in the order of the last index. @throws std::logic_error if they do not fit the
/// shape
Array array(std::vector<double> numbers, Shape shape);
Array array(const Eigen::ArrayXXd& numbers);
Array array(const Eigen::ArrayXXi& numbers);
Array array(const Eigen::Matrix4d& numbers);
/// One row for each item, of what `row` gives for it.
template <typename Items, typename Row>
Array array_of_rows(const Items& items, const Row& row) {
  std::vector<double> numbers;
  Eigen::Index columns = 0;
  for (const auto& item : items) {
    const auto values = row(item);
    columns = values.size();
    numbers.insert(numbers.end(), values.data(), values.data() + columns);
  }
  const auto rows = static_cast<py::ssize_t>(items.size());
  if (rows == 0) columns = decltype(row(*items.begin()))::SizeAtCompileTime;
  return array(std::move(numbers), {rows, columns});
}
/// The number that `value` gives for each item.
template <typename Items, typename Value>
Array array_of(const Items& items, const Value& value) {
  std::vector<double> numbers;
  for (const auto& item : items) numbers.push_back(value(item));
  const auto size = static_cast<py::ssize_t>(numbers.size());
  return array(std::move(numbers), {size});
}

/// @param what  names the argument in messages
/// @throws Error (bad_input) unless it is a table of numbers
Eigen::ArrayXXd table_of(const std::string& what, const py::object& numbers);
/// @throws Error (bad_input) unless it is a row of numbers
std::vector<double> numbers_of(const std::string& what, const py::object& numbers);
/// @throws Error (bad_input) unless its shape is (N, 3)
std::vector<Eigen::Vector3d> points_of(const std::string& what, const py::object& numbers);
/// @throws Error (bad_input) unless its shape is (4, 4)
Eigen::Matrix4d transform_of(const std::string& what, const py::object& numbers);

/// Binds the class behind the memoryviews.
void bind_arrays(py::module_& module);

}  // namespace excavplan::python

namespace pybind11::detail {

template <>
struct handle_type_name<excavplan::python::Array> {
  static constexpr auto name = const_name("Array");
};
template <>
struct handle_type_name<excavplan::python::ArrayLike> {
  static constexpr auto name = const_name("ArrayLike");
};

/// A short vector: out as a tuple, in from any sequence of as many numbers.
template <int Size>
struct type_caster<Eigen::Matrix<double, Size, 1>> {
  using Vector = Eigen::Matrix<double, Size, 1>;
  PYBIND11_TYPE_CASTER(Vector, const_name("Vector") + const_name<static_cast<size_t>(Size)>());

  bool load(handle source, bool convert) {
    if (!source || PyUnicode_Check(source.ptr()) || !PySequence_Check(source.ptr())) return false;
    if (PySequence_Size(source.ptr()) != Size) {
      PyErr_Clear();
      return false;
    }
    for (Py_ssize_t i = 0; i < Size; ++i) {
      const auto item = reinterpret_steal<object>(PySequence_GetItem(source.ptr(), i));
      if (!item) PyErr_Clear();
      make_caster<double> number;
      if (!item || !number.load(item, convert)) return false;
      value(i) = cast_op<double>(number);
    }
    return true;
  }
  static handle cast(const Vector& vector, return_value_policy /*policy*/, handle /*parent*/) {
    tuple result(static_cast<size_t>(Size));
    for (int i = 0; i < Size; ++i) result[static_cast<size_t>(i)] = vector(i);
    return result.release();
  }
};

}  // namespace pybind11::detail
