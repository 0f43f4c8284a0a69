// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/error.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>

namespace support {

/// The unit cube with pressures on two faces; all other faces sealed, of one wall type.
inline pfv::Box pressure_box(pfv::Face first, double p_first, pfv::Face second, double p_second,
                             pfv::Wall wall) {
  pfv::Box box;
  for (const pfv::Face face : pfv::all_faces) box[face].wall = wall;
  box[first].boundary = pfv::Boundary::pressure(p_first);
  box[second].boundary = pfv::Boundary::pressure(p_second);
  return box;
}

/// The unit cube with flow upwards: p = 1 on zlo, p = 0 on zhi.
inline pfv::Box upward_box(pfv::Wall wall) {
  return pressure_box(pfv::Face::zlo, 1.0, pfv::Face::zhi, 0.0, wall);
}

inline pfv::Fluid viscosity_one() {
  pfv::Fluid fluid;
  fluid.viscosity = 1.0;
  return fluid;
}

/// The law of the papers, whatever the default is.
inline pfv::Options hydraulic_radius() {
  pfv::Options options;
  options.conductance = pfv::ConductanceLaw::hydraulic_radius;
  return options;
}

/// The message of the InputError that `action` throws; fails the test where there is none.
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const pfv::InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

inline void expect_line(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace support
