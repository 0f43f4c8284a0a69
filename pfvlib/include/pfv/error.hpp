// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace pfv {

/// Base of everything the library throws. `what()` is one line: what is wrong, where (sphere ids,
/// place), and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
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
