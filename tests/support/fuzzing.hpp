// SPDX-License-Identifier: GPL-3.0-or-later
// What the fuzz programs share: PROGRAM --count N --seed S [--first K]. A case either flows, finite and balanced, or
// is refused with one line. Prints what happened to each kind and the number of every case that failed; status 1 if
// any did. Case K of a seed is always the same: --first K --count 1 repeats it.
#pragma once

#include "pfv/error.hpp"
#include "pfv/report.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <unistd.h>
#include <vector>

namespace support::fuzzing {

struct Outcome {
  bool refused = false;
  std::string message, failure;
  double mass = 0.0, balance = 0.0, volume = 0.0;  ///< largest errors

  void fail(const std::string& what) {
    if (failure.empty()) failure = what;
  }
};

inline bool all_finite(const pfv::Report& r) {
  double sum = r.porosity + r.pore_volume + r.solid_area + r.inflow + r.outflow + r.volume_rate_sum + r.storage_rate +
               r.mass_error + r.force_balance_error + r.residual + r.permeability.value_or(0.0) + r.force_sum.sum();
  for (const pfv::FaceResult& face : r.faces) sum += face.flux + face.force_pressure.sum() + face.force_viscous.sum();
  return std::isfinite(sum);
}

/// What `run` does; an error is a refusal, which has to say something.
template <class Run>
Outcome examine(Run&& run) {
  Outcome outcome;
  try {
    run(outcome);
  } catch (const pfv::Error& error) {
    outcome.refused = true;
    outcome.message = error.what();
    if (outcome.message.size() < 20 || outcome.message.find('\n') != std::string::npos)
      outcome.fail("an error that helps nobody: " + outcome.message);
  } catch (const std::exception& other) {
    outcome.fail(std::string("an error that is not the library's own: ") + other.what());
  }
  return outcome;
}

inline volatile std::uint64_t running = 0;

extern "C" inline void say_which(int signal) {
  char text[80];
  const int length = std::snprintf(text, sizeof text, "signal %d in case %llu\n", signal,
                                   static_cast<unsigned long long>(running));
  if (write(2, text, static_cast<std::size_t>(length)) < 0) _exit(3);
  _exit(2);
}

/// What comes before the first number of a message: enough to count messages of one sort.
inline std::string sort_of(const std::string& message) {
  return message.substr(0, std::min<std::size_t>(message.find_first_of("0123456789("), 60));
}

class Tally {
 public:
  explicit Tally(const std::vector<std::string>& kinds) : kinds_(kinds), counts_(kinds.size()) {}

  void add(std::uint64_t number, std::size_t kind, const std::string& description, const Outcome& o) {
    if (!o.failure.empty()) {
      std::printf("case %llu: %s (%s)\n", static_cast<unsigned long long>(number), o.failure.c_str(), description.c_str());
      ++counts_[kind].failed;
      ++failed_;
    }
    ++(o.refused ? counts_[kind].refused : counts_[kind].flows);
    if (o.refused) ++messages_[sort_of(o.message)];
    mass_.take(o.mass, number);
    balance_.take(o.balance, number);
    volume_.take(o.volume, number);
  }

  bool failed() const { return failed_ > 0; }

  void print() const {
    std::printf("%-18s %7s %8s %7s\n", "kind", "flows", "refused", "failed");
    for (std::size_t k = 0; k < kinds_.size(); ++k)
      std::printf("%-18s %7d %8d %7d\n", kinds_[k].c_str(), counts_[k].flows, counts_[k].refused, counts_[k].failed);
    for (const auto& [message, count] : messages_) std::printf("%6d  %s...\n", count, message.c_str());
    mass_.print("mass error");
    balance_.print("force balance error");
    if (volume_.value > 0.0) volume_.print("volume error");
  }

 private:
  struct Counts {
    int flows = 0, refused = 0, failed = 0;
  };
  struct Largest {
    double value = 0.0;
    std::uint64_t number = 0;
    void take(double other, std::uint64_t of) {
      if (other > value) value = other, number = of;
    }
    void print(const char* what) const {
      std::printf("largest %s %.2g (case %llu)\n", what, value, static_cast<unsigned long long>(number));
    }
  };

  std::vector<std::string> kinds_;
  std::vector<Counts> counts_;
  std::map<std::string, int> messages_;
  Largest mass_, balance_, volume_;
  int failed_ = 0;
};

/// `make(seed, number)` gives a case with its `kind`, `examine` its outcome, `describe` a line.
template <class Make, class Examine, class Describe>
int run(int argc, char** argv, const std::vector<std::string>& kinds, Make&& make, Examine&& examine, Describe&& describe) {
  constexpr unsigned hang = 120;  // s; guards against a case that never ends
  std::map<std::string, std::uint64_t> given{{"--count", 400}, {"--seed", 1}, {"--first", 0}};
  for (int i = 1; i < argc; i += 2) {
    char* end = nullptr;
    if (given.count(argv[i]) == 0 || i + 1 == argc ||
        (given[argv[i]] = std::strtoull(argv[i + 1], &end, 10), *end != '\0')) {
      std::fprintf(stderr, "usage: %s [--count N] [--seed S] [--first K]\n", argv[0]);
      return 2;
    }
  }
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGALRM, SIGBUS}) std::signal(signal, say_which);
  Tally tally(kinds);
  for (std::uint64_t i = 0; i < given["--count"]; ++i) {
    running = given["--first"] + i;
    alarm(hang);
    const auto one = make(given["--seed"], running);
    const Outcome outcome = examine(one);
    const std::string line = describe(one);
    tally.add(running, one.kind, line, outcome);
    if (given["--count"] == 1) std::printf("%s\n%s\n", line.c_str(), outcome.message.c_str());
  }
  tally.print();
  return tally.failed() ? 1 : 0;
}

}  // namespace support::fuzzing
