// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of NumPy and of Eigen: a row of the one is a column of the other, so that N x 3 numbers in C order are
// 3 x N numbers in Eigen's order, at the same place.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <pybind11/numpy.h>
#include <string>
#include <utility>
#include <vector>

namespace pfv::python {

namespace py = pybind11;

// ----------------------------------------------------------------------------------- from Python

/// In C order, where its numbers have to stand.
template <class Number>
using Numbers = py::array_t<Number, py::array::c_style | py::array::forcecast |
                                        py::detail::npy_api::NPY_ARRAY_ALIGNED_>;

/// The array itself where it has these numbers in C order, else a copy. Throws TypeError for what is no array of
/// real numbers, InputError for another shape; both name the argument.
Numbers<double> reals_of(py::handle given, const char* name);
Numbers<double> rows_of_three(py::handle given, const char* name);
/// With as many rows as there are spheres.
Numbers<double> rows_of_three(py::handle given, const char* name, py::ssize_t spheres);
Numbers<double> one_each(py::handle given, const char* name, py::ssize_t spheres);
Numbers<std::int64_t> ids_of(py::handle given, py::ssize_t spheres);
/// Numbers of the rigid bodies that hold the spheres, from 0 on, -1 for none.
Eigen::VectorXi bodies_of(py::handle given, py::ssize_t spheres);
/// One number.
double number_of(py::handle given, const char* name);
/// 0, 1, 2 or "x", "y", "z".
int axis_of(py::handle given);
/// Three numbers.
Eigen::Vector3d vector_of(py::handle given, const char* name);

inline Eigen::Map<const Eigen::Matrix3Xd> columns_of(const Numbers<double>& rows) {
  return {rows.data(), 3, rows.shape(0)};
}
template <class Number>
Eigen::Map<const Eigen::Matrix<Number, Eigen::Dynamic, 1>> vector_of(const Numbers<Number>& numbers) {
  return {numbers.data(), numbers.size()};
}

// ------------------------------------------------------------------------------------- to Python

/// Looks at numbers that `owner` keeps alive; not to be written to.
template <class Number>
py::array view_of(const Number* numbers, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array array(py::dtype::of<Number>(), std::move(shape), numbers, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
/// A row for each column.
template <class Number, int rows>
py::array view_of(const Eigen::Matrix<Number, rows, Eigen::Dynamic>& matrix, py::handle owner) {
  return view_of(matrix.data(), {matrix.cols(), matrix.rows()}, owner);
}
template <class Number>
py::array view_of(const Eigen::Matrix<Number, Eigen::Dynamic, 1>& vector, py::handle owner) {
  return view_of(vector.data(), {vector.size()}, owner);
}
template <class Number>
py::array view_of(const std::vector<Number>& numbers, py::handle owner) {
  return view_of(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, owner);
}
template <class Number, std::size_t columns>
py::array view_of(const std::vector<std::array<Number, columns>>& rows, py::handle owner) {
  return view_of(reinterpret_cast<const Number*>(rows.data()),
                 {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(columns)}, owner);
}

/// Keeps a value for the arrays that look at it.
template <class Value>
py::capsule keeper_of(Value* value) {
  return py::capsule(value, [](void* kept) { delete static_cast<Value*>(kept); });
}

/// An array of the numbers themselves, which are moved into it.
template <class Numbers>
py::array array_of(Numbers numbers) {
  auto* kept = new Numbers(std::move(numbers));
  const py::capsule keeper = keeper_of(kept);
  py::array array = view_of(*kept, keeper);
  py::detail::array_proxy(array.ptr())->flags |= py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
py::array array_of(const Eigen::Vector3d& vector);
/// n x 3 x 3
py::array array_of(const std::vector<Eigen::Matrix3d>& matrices);

/// The name of a file, from a text or a pathlib.Path.
std::string path_of(py::handle given);

}  // namespace pfv::python
