// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"

#include <array>
#include <string>

namespace pfv {

template <class Enum>
struct Named {
  Enum value;
  const char* name;
};

/// The names of an enumeration as users write them. Each enumeration specialises it, where it stands, with
/// `what` (a noun for messages) and `all` (an array of Named, or of what has these two members and more).
template <class Enum>
struct Names;

/// Throws InputError for a number that the enumeration does not have.
template <class Enum, class = decltype(Names<Enum>::what)>
const char* name_of(Enum value) {
  for (const auto& one : Names<Enum>::all)
    if (one.value == value) return one.name;
  throw InputError(std::string("unknown ") + Names<Enum>::what + " number " +
                   std::to_string(static_cast<int>(value)) + ": use one of those that have a name");
}

/// "auto, metis, amd", or with another separator.
template <class Enum>
std::string names_of(const char* separator = ", ") {
  std::string text;
  for (const auto& one : Names<Enum>::all) text += (text.empty() ? "" : separator) + std::string(one.name);
  return text;
}

/// Inverse of name_of; throws InputError for any other name, with the list of those that exist.
template <class Enum>
Enum named(const std::string& name) {
  for (const auto& one : Names<Enum>::all)
    if (name == one.name) return one.value;
  throw InputError(std::string("unknown ") + Names<Enum>::what + " '" + name + "': use one of " +
                   names_of<Enum>());
}

}  // namespace pfv
