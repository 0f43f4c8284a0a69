// SPDX-License-Identifier: GPL-3.0-or-later
// The units of a LIGGGHTS script. The flow's equations hold in any system in which 1 force = 1 mass x length / time²,
// and so does the library, which has no length, time or mass of its own: numbers pass as the script has them. What is
// given in SI (defaults, thresholds, the units' names in messages) is converted here and nowhere else.
#ifndef LMP_PFV_SCRIPT_UNITS_H
#define LMP_PFV_SCRIPT_UNITS_H

#include <string>

namespace LAMMPS_NS {

struct PfvUnits {
  const char* style;                    ///< of the command `units`
  double per_metre, per_kg;  ///< how many of the script's units
  const char *length, *mass, *time, *force, *pressure, *viscosity;

  double of_length(double metres) const { return metres * per_metre; }
  double of_density(double kg_per_m3) const { return kg_per_m3 * per_kg / (per_metre * per_metre * per_metre); }
  /// The text with the SI units behind its numbers ("2.5 m", "(0 0 1) m", "3 m/s per N") replaced by the script's.
  std::string relabelled(const std::string& text) const;
};

/// Of this `units` style, or null where its units do not fit together or are none.
const PfvUnits* units_of(const std::string& style);
const PfvUnits& si_units();
/// Why fix pfv cannot work in a style that units_of does not know.
std::string why_refused(const std::string& style);

}  // namespace LAMMPS_NS

#endif
