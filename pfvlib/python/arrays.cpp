// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

#include "pfv/error.hpp"


namespace pfv::python {
namespace {

std::string shape_text(const py::array& array) { return py::str(array.attr("shape")); }

[[noreturn]] void refuse_shape(const char* name, const py::array& array, const std::string& wanted) {
  throw InputError(std::string(name) + " has the shape " + shape_text(array) + ": give " + wanted);
}

/// Complex numbers would lose a part, texts and objects are no numbers.
void require_kind(const py::array& array, const char* name, const char* kinds, const char* wanted) {
  if (std::string(kinds).find(array.dtype().kind()) == std::string::npos)
    throw py::type_error(std::string(name) + " has the dtype " + std::string(py::str(array.dtype())) + ": give " +
                         wanted);
}

/// NumPy keeps some value behind a mask, which nobody means.
void refuse_masked(py::handle given, const char* name) {
  if (!py::hasattr(given, "mask")) return;
  if (!py::isinstance(given, py::module_::import("numpy.ma").attr("MaskedArray"))) return;
  if (py::cast<bool>(given.attr("mask").attr("any")()))
    throw InputError(std::string(name) + " has masked values: give numbers in their place, or leave their rows out");
}

/// Nothing has to be made of it.
template <class Number>
bool is_as_wanted(py::handle given) {
  return Numbers<Number>::check_(given) &&
         py::detail::check_flags(given.ptr(), py::detail::npy_api::NPY_ARRAY_ALIGNED_);
}

template <class Number>
Numbers<Number> numbers_of(py::handle given, const char* name, const char* kinds, const char* wanted) {
  refuse_masked(given, name);
  if (is_as_wanted<Number>(given)) return py::reinterpret_borrow<Numbers<Number>>(given);
  const py::array array = py::array::ensure(given);
  if (!array) throw py::type_error(std::string(name) + " is no array: give " + wanted);
  require_kind(array, name, kinds, wanted);
  auto numbers = Numbers<Number>::ensure(array);
  if (!numbers) throw py::type_error(std::string(name) + " cannot be read: give " + wanted);
  return numbers;
}

std::string for_each_sphere(py::ssize_t spheres) {
  return "one for each of the " + std::to_string(spheres) + " spheres";
}

}  // namespace

Numbers<double> reals_of(py::handle given, const char* name) {
  return numbers_of<double>(given, name, "fiu", "real numbers (float64)");
}

Numbers<double> rows_of_three(py::handle given, const char* name) {
  auto rows = reals_of(given, name);
  if (rows.ndim() != 2 || rows.shape(1) != 3) refuse_shape(name, rows, "N x 3, a row for each sphere");
  return rows;
}

Numbers<double> rows_of_three(py::handle given, const char* name, py::ssize_t spheres) {
  auto rows = rows_of_three(given, name);
  if (rows.shape(0) != spheres) refuse_shape(name, rows, "a row of three, " + for_each_sphere(spheres));
  return rows;
}

Numbers<double> one_each(py::handle given, const char* name, py::ssize_t spheres) {
  auto numbers = reals_of(given, name);
  if (numbers.ndim() != 1 || numbers.shape(0) != spheres) refuse_shape(name, numbers, for_each_sphere(spheres));
  return numbers;
}

namespace {

Numbers<std::int64_t> whole_numbers_of(py::handle given, const char* name, py::ssize_t spheres) {
  auto numbers = numbers_of<std::int64_t>(given, name, "iu", "whole numbers (int64)");
  if (numbers.ndim() != 1 || numbers.shape(0) != spheres) refuse_shape(name, numbers, for_each_sphere(spheres));
  return numbers;
}

}  // namespace

Numbers<std::int64_t> ids_of(py::handle given, py::ssize_t spheres) { return whole_numbers_of(given, "ids", spheres); }

Eigen::VectorXi bodies_of(py::handle given, py::ssize_t spheres) {
  const auto numbers = whole_numbers_of(given, "bodies", spheres);
  for (py::ssize_t k = 0; k < spheres; ++k)
    if (numbers.at(k) < -1 || numbers.at(k) >= spheres)
      throw InputError("bodies: the sphere in row " + std::to_string(k) + " has the body " +
                       std::to_string(numbers.at(k)) + ": count bodies from 0 on, and give -1 for a sphere of none");
  return vector_of(numbers).cast<int>();
}

double number_of(py::handle given, const char* name) {
  const auto number = reals_of(given, name);
  if (number.ndim() != 0) refuse_shape(name, number, "one number");
  return *number.data();
}

Eigen::Vector3d vector_of(py::handle given, const char* name) {
  const auto numbers = reals_of(given, name);
  if (numbers.ndim() != 1 || numbers.size() != 3) refuse_shape(name, numbers, "three numbers, along x, y and z");
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

int axis_of(py::handle given) {
  const std::string name = py::str(given);
  for (int axis = 0; axis < 3; ++axis)
    if (name == std::string(1, "xyz"[axis]) || name == std::to_string(axis)) return axis;
  throw InputError("there is no axis '" + name + "': give x, y, z or 0, 1, 2");
}

py::array array_of(const Eigen::Vector3d& vector) { return py::array_t<double>(3, vector.data()); }

py::array array_of(const std::vector<Eigen::Matrix3d>& matrices) {
  py::array_t<double> array({static_cast<py::ssize_t>(matrices.size()), py::ssize_t{3}, py::ssize_t{3}});
  auto numbers = array.mutable_unchecked<3>();
  for (py::ssize_t n = 0; n < numbers.shape(0); ++n)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        numbers(n, row, column) = matrices[static_cast<std::size_t>(n)](row, column);
  return array;
}

std::string path_of(py::handle given) {
  return py::module_::import("os").attr("fspath")(given).cast<std::string>();
}

}  // namespace pfv::python
