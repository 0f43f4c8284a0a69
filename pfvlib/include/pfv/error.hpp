// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pfv {

/// All spheres and places that an error is about, to be drawn (write_culprits).
struct Culprits {
  std::vector<std::int64_t> spheres;          ///< ids
  std::vector<std::array<double, 3>> places;  ///< m
};

/// Base of everything the library throws. `what()` is one line: what is wrong, where (sphere ids,
/// place), and what to do about it.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, Culprits culprits = {})
      : std::runtime_error(what), culprits_(std::move(culprits)) {}
  /// Empty where the error is about no sphere and no place.
  const Culprits& culprits() const { return culprits_; }

 private:
  Culprits culprits_;
};

/// The input cannot be used: a value, a file's content, a packing or a set of boundaries that leaves
/// the pressure undetermined. The caller can mend it. Exit status 2 of `pfv`.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A linear solver failed. Exit status 1 of `pfv`.
class SolverError : public Error {
 public:
  using Error::Error;
};

/// A file could not be written. Exit status 1 of `pfv`.
class FileError : public Error {
 public:
  using Error::Error;
};

}  // namespace pfv
