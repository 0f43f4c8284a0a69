// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/ranks.hpp"

#include "pfv/error.hpp"
#include "pfv/ranks.hpp"

#include <exception>
#include <new>

namespace pfv {

namespace {

enum class Kind : char { none, input, solver, file, memory, other };

/// An error on its way to the other ranks.
Ranks::Bytes packed(Kind kind, const std::string& text, const Culprits& culprits) {
  Ranks::Bytes bytes{static_cast<char>(kind)};
  const std::size_t sizes[2] = {text.size(), culprits.spheres.size()};
  append(bytes, sizes, 2);
  append(bytes, text.data(), text.size());
  append(bytes, culprits.spheres.data(), culprits.spheres.size());
  append(bytes, culprits.places.data(), culprits.places.size());
  return bytes;
}

[[noreturn]] void throw_packed(const Ranks::Bytes& bytes) {
  std::size_t sizes[2];
  std::memcpy(sizes, bytes.data() + 1, sizeof sizes);
  const auto text_begin = bytes.begin() + 1 + sizeof sizes;
  const auto ids_begin = text_begin + static_cast<std::ptrdiff_t>(sizes[0]);
  const auto places_begin = ids_begin + static_cast<std::ptrdiff_t>(sizes[1] * sizeof(std::int64_t));
  const std::string text(text_begin, ids_begin);
  const Culprits culprits{values_in<std::int64_t>({ids_begin, places_begin}),
                          values_in<std::array<double, 3>>({places_begin, bytes.end()})};
  switch (static_cast<Kind>(bytes.front())) {
    case Kind::input: throw InputError(text, culprits);
    case Kind::solver: throw SolverError(text, culprits);
    case Kind::file: throw FileError(text, culprits);
    case Kind::memory: throw std::bad_alloc();
    default: throw std::runtime_error(text);
  }
}

/// What went wrong, as bytes; a lone `none` where nothing did.
Ranks::Bytes outcome_of(const std::function<void()>& part) {
  try {
    part();
    return {static_cast<char>(Kind::none)};
  } catch (const InputError& error) {
    return packed(Kind::input, error.what(), error.culprits());
  } catch (const SolverError& error) {
    return packed(Kind::solver, error.what(), error.culprits());
  } catch (const FileError& error) {
    return packed(Kind::file, error.what(), error.culprits());
  } catch (const std::bad_alloc&) {
    return packed(Kind::memory, "", {});
  } catch (const std::exception& error) {
    return packed(Kind::other, error.what(), {});
  }
}

}  // namespace

bool failed_together(const Ranks& ranks) { return ranks.failed_together(); }

void Ranks::together(const std::function<void()>& part) const {
  const Bytes outcome = outcome_of(part);
  const bool failed = outcome.size() > 1;
  failed_together_ = false;
  if (!any(failed)) return;
  for (const Bytes& other : gather(outcome))
    if (other.size() > 1) {
      failed_together_ = true;
      throw_packed(other);
    }
}

}  // namespace pfv
