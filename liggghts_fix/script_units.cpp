// SPDX-License-Identifier: GPL-3.0-or-later
#include "script_units.h"

#include <regex>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

namespace {

constexpr PfvUnits known[]{
    {"si", 1.0, 1.0, "m", "kg", "s", "N", "Pa", "Pa s"},
    {"cgs", 1e2, 1e3, "cm", "g", "s", "dyne", "dyne/cm2", "P"},
    {"micro", 1e6, 1e15, "um", "pg", "us", "pg um/us2", "pg/(um us2)", "pg/(um us)"},
    {"nano", 1e9, 1e21, "nm", "ag", "ns", "ag nm/ns2", "ag/(nm ns2)", "ag/(nm ns)"}};

/// Each name in SI and in these units.
std::vector<std::pair<std::string, std::string>> names_in(const PfvUnits& units) {
  const std::string length = units.length, time = units.time, force = units.force, mass = units.mass;
  return {{"m3/s", length + "3/" + time}, {"m/s", length + "/" + time},
          {"m3", length + "3"},           {"m2", length + "2"},
          {"m", length},                  {"Pa s", units.viscosity},
          {"Pa", units.pressure},         {"N s/m", force + " " + time + "/" + length},
          {"N m", force + " " + length},  {"N", force},
          {"kg/m3", mass + "/" + length + "3"}, {"kg", mass},
          {"s", time}};
}

}  // namespace

std::string PfvUnits::relabelled(const std::string& text) const {
  if (this == &si_units()) return text;
  static const std::regex unit("([0-9.)]|per|`,) (m3/s|m/s|m3|m2|m|Pa s|Pa|N s/m|N m|N|kg/m3|kg|s)(?![A-Za-z0-9_/'-])");
  const auto names = names_in(*this);
  std::string result;
  auto rest = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), unit), none; match != none; ++match) {
    result.append(rest, (*match)[2].first);
    for (const auto& [si, here] : names)
      if ((*match)[2] == si) result += here;
    rest = (*match)[2].second;
  }
  return result.append(rest, text.cend());
}

const PfvUnits& si_units() { return known[0]; }

const PfvUnits* units_of(const std::string& style) {
  for (const PfvUnits& units : known)
    if (style == units.style) return &units;
  return nullptr;
}

std::string why_refused(const std::string& style) {
  std::string styles;
  for (const PfvUnits& units : known) styles += (styles.empty() ? "" : ", ") + std::string(units.style);
  return "cannot work in `units " + style + "`: " +
         (style == "lj" ? "they are no physical units, and a fluid's viscosity has one"
                        : "there a force is not a mass times a length over a time squared, so that forces of the fluid "
                          "and motions of the grains would not agree") +
         "; use one of " + styles;
}

}  // namespace LAMMPS_NS
