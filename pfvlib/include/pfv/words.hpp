// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/names.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pfv {

/// What a number must be.
struct Demand {
  const char* text;  ///< "a finite number > 0"
  bool (*met)(double);
};

namespace demands {
extern const Demand finite, positive, not_negative, positive_or_infinite, part, percent, count, flow_steps,
    threads;
}

/// "; is viscosity meant?" where names are like `word`, the most like first; else nothing.
std::string meant_by(const std::string& word, const std::vector<std::string>& names);

/// The words of a command, read one after the other. Every method throws InputError; the message begins with
/// the subject (a keyword, an option).
class Words {
 public:
  Words(std::vector<std::string> words, std::string subject = {})
      : words_(std::move(words)), subject_(std::move(subject)) {}

  bool done() const { return next_ == words_.size(); }
  int taken() const { return static_cast<int>(next_); }

  /// The next word, which from now on is the subject.
  std::string keyword();
  /// Takes the next word if it is this one.
  bool take(const std::string& word);
  /// Whether the next word begins with this.
  bool begins(const std::string& beginning) const;
  /// Whether the next word is a number.
  bool number_comes() const;

  /// `what` is a noun: "the viscosity".
  std::string word(const std::string& what);
  double number(const std::string& what, const Demand& demand);
  int whole_number(const std::string& what, const Demand& demand);
  bool yes_or_no();
  int axis();
  template <class Enum>
  Enum choice() {
    const std::string name = word(std::string("the ") + Names<Enum>::what);
    try {
      return named<Enum>(name);
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::vector<std::string> words_;
  std::size_t next_ = 0;
  std::string subject_;
};

}  // namespace pfv
