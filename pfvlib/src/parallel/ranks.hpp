// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pfv {

/// Those that hold one packing together, each a part of it. Every method is called by all of them, in the same
/// order; what comes back of a sum or a maximum is the same on each, to the last bit.
class Ranks {
 public:
  using Bytes = std::vector<char>;

  virtual ~Ranks() = default;
  virtual int count() const = 0;
  virtual int own() const = 0;  ///< from 0 on

  /// Entry by entry over all ranks, in place.
  virtual void add(double* values, std::size_t size) const = 0;
  virtual void take_largest(double* values, std::size_t size) const = 0;
  /// Hands `to[r]` to rank r; returns what each has handed to this one. Any lengths, known to the sender alone.
  virtual std::vector<Bytes> hand_over(const std::vector<Bytes>& to) const = 0;
  /// The same with lengths that both sides know: those of `from`.
  virtual void exchange(const std::vector<std::vector<double>>& to, std::vector<std::vector<double>>& from) const = 0;

  /// The same ranks, whose messages are apart from these: for another thread of each.
  virtual std::shared_ptr<const Ranks> beside() const = 0;

  double sum(double value) const {
    add(&value, 1);
    return value;
  }
  double largest(double value) const {
    take_largest(&value, 1);
    return value;
  }
  bool any(bool value) const { return largest(value ? 1.0 : 0.0) > 0.0; }
  /// What each rank has to say.
  std::vector<Bytes> gather(const Bytes& own) const { return hand_over(std::vector<Bytes>(count(), own)); }

  /// Does what each rank does alone. Where it throws on one, all throw the error of the lowest rank that did, so that
  /// none waits for another that has gone.
  void together(const std::function<void()>& part) const;
  /// Whether the last error is known to all: no rank waits for this one.
  bool failed_together() const { return failed_together_; }

 private:
  mutable bool failed_together_ = false;
};

/// Plain values into bytes and back.
template <class Value>
void append(Ranks::Bytes& bytes, const Value* values, std::size_t count) {
  const auto* first = reinterpret_cast<const char*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(Value));
}
template <class Value>
std::vector<Value> values_in(const Ranks::Bytes& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(Value));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(Value));
  return values;
}

}  // namespace pfv
