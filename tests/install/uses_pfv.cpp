// SPDX-License-Identifier: GPL-3.0-or-later
// One sphere in a symmetry cube is the simple cubic array: the force on it is dp S.
#include <pfv/pfv.hpp>

#include <cmath>
#include <cstdio>

int main() {
  pfv::PackingArrays sphere;
  sphere.ids = pfv::Packing::Ids::Constant(1, 1);
  sphere.positions = Eigen::Vector3d(0.5, 0.5, 0.5);
  sphere.radii = Eigen::VectorXd::Constant(1, 0.5);
  pfv::Box box;
  for (pfv::FaceCondition& face : box.faces) face.wall = pfv::Wall::symmetry;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  pfv::Flow flow(box, pfv::Fluid{});
  const double force = flow.evaluate(sphere.view()).total(2, 0);
  std::printf("pfv %s: force %.17g N\n", pfv::version, force);
  return std::abs(force - 1.0) < 1e-12 ? 0 : 1;
}
