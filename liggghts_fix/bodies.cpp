// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.h"

#include "pfv/union_parts.hpp"

#include "atom.h"
#include "comm.h"
#include "fix_multisphere.h"
#include "modify.h"
#include "multisphere.h"

#include <Eigen/Eigenvalues>
#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace LAMMPS_NS {

namespace {

constexpr int member_width = 3;  // tag, its body's tag, whether the fluid's force moves it
constexpr int body_width = 18;   // tag, spheres, mass, place of its centre, inertia, three axes

/// `nointegration` leaves the motion to something else, which no force of the fluid changes.
bool integrates(const FixMultisphere& bodies) {
  return std::string(bodies.style).find("nointegration") == std::string::npos;
}

/// How a force on the sphere at `arm` (m) from the centre of mass moves that sphere itself, 1/kg:
/// I/M + [r] J^-1 [r]^T, its largest eigenvalue.
double mobility(const Eigen::Vector3d& arm, double mass, const Eigen::Vector3d& inertia,
                const Eigen::Matrix3d& axes) {
  const Eigen::Vector3d r = axes.transpose() * arm;
  Eigen::Matrix3d cross;
  cross << 0.0, -r[2], r[1], r[2], 0.0, -r[0], -r[1], r[0], 0.0;
  const Eigen::Vector3d inverse =
      (inertia.array() > 0.0).select(inertia.array().inverse(), 0.0).matrix();
  const Eigen::Matrix3d turned = cross * inverse.asDiagonal() * cross.transpose();
  return 1.0 / mass +
         Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(turned, Eigen::EigenvaluesOnly)
             .eigenvalues()[2];
}

}  // namespace

FixMultisphere* find_multisphere(Modify* modify) {
  for (int i = 0; i < modify->nfix; ++i)
    if (auto* bodies = dynamic_cast<FixMultisphere*>(modify->fix[i])) return bodies;
  return nullptr;
}

std::vector<double> PfvBodies::on_root(const std::vector<double>& mine) const {
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(comm->nprocs), offsets(comm->nprocs);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, world);
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  std::vector<double> all(comm->me == 0 ? offsets.back() + counts.back() : 0);
  MPI_Gatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE,
              0, world);
  return all;
}

std::vector<double> PfvBodies::gather_members(const PfvGroups& groups,
                                              FixMultisphere& bodies) const {
  const bool moving = integrates(bodies);
  std::vector<double> mine;
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groups.flow) || bodies.belongs_to(i) < 0) continue;
    const bool free = moving && !(atom->mask[i] & groups.held);
    mine.insert(mine.end(), {static_cast<double>(atom->tag[i]),
                             static_cast<double>(bodies.belongs_to(i)), free ? 1.0 : 0.0});
  }
  return on_root(mine);
}

std::vector<double> PfvBodies::gather_bodies(FixMultisphere& bodies) const {
  Multisphere& data = bodies.data();
  std::vector<double> mine;
  double** const inertia = data.extract_double_vector("inertia");
  double** const axes[] = {data.extract_double_vector("ex_space"),
                           data.extract_double_vector("ey_space"),
                           data.extract_double_vector("ez_space")};
  for (int body = 0; body < data.n_body(); ++body) {
    double centre[3];
    data.xcm(centre, body);
    mine.insert(mine.end(), {static_cast<double>(data.tag(body)),
                             static_cast<double>(data.nrigid(body)), data.mass(body)});
    mine.insert(mine.end(), centre, centre + 3);
    mine.insert(mine.end(), inertia[body], inertia[body] + 3);
    for (double** const axis : axes) mine.insert(mine.end(), axis[body], axis[body] + 3);
  }
  return on_root(mine);
}

void PfvBodies::apply(const PfvGroups& groups, bool lift, PfvGrainExchange& grains) {
  FixMultisphere* const multisphere = find_multisphere(modify);
  if (!multisphere) return;
  const std::vector<double> members = gather_members(groups, *multisphere);
  const std::vector<double> rows = gather_bodies(*multisphere);
  if (comm->me != 0 || members.empty()) return;

  const pfv::Packing packing = grains.packing();
  std::map<int, Body> bodies;
  for (std::size_t row = 0; row < rows.size(); row += body_width)
    bodies[static_cast<int>(rows[row])].numbers.assign(&rows[row], &rows[row] + body_width);
  for (std::size_t row = 0; row < members.size(); row += member_width) {
    const auto* const place = std::lower_bound(packing.ids.data(), packing.ids.data() + packing.size(),
                                               static_cast<std::int64_t>(members[row]));
    Body& body = bodies[static_cast<int>(members[row + 1])];
    body.columns.push_back(static_cast<int>(place - packing.ids.data()));
    body.free |= members[row + 2] != 0.0;
  }

  std::map<int, Volumes> still;
  Eigen::VectorXd volumes;
  if (lift) {
    volumes.resize(packing.size());
    for (Eigen::Index k = 0; k < packing.size(); ++k)
      volumes[k] = 4.0 / 3.0 * M_PI * std::pow(packing.radii[k], 3);
  }
  Eigen::VectorXd masses = grains.masses();
  for (auto& [tag, body] : bodies) {
    if (body.columns.empty() || body.numbers.empty()) continue;
    std::sort(body.columns.begin(), body.columns.end());  // the same for any number of ranks
    masses(body.columns).setConstant(mass_of(body, packing));
    if (!lift) continue;
    volumes(body.columns) = volumes_of(tag, body, packing);
    still[tag] = known_[tag];
  }
  known_ = std::move(still);
  grains.stand_for_bodies(masses, volumes);
}

/// kg: where every sphere of the body had this mass, and were on its own, the fluid would shake them
/// sooner than it does the body. A force on sphere j moves sphere i of the body by K_ij, and
/// x.K x <= sum_j |K_jj| sum_i |x_i|^2 for the forces x on its spheres: so 1 / sum_j |K_jj|, which for
/// translation alone is the body's mass over the number of its spheres.
double PfvBodies::mass_of(const Body& body, const pfv::Packing& packing) const {
  if (!body.free) return std::numeric_limits<double>::infinity();
  const Eigen::Map<const Eigen::Vector3d> centre(&body.numbers[3]), inertia(&body.numbers[6]);
  const Eigen::Map<const Eigen::Matrix3d> axes(&body.numbers[9]);
  const PfvPeriodicCell cell(lmp);
  double sum = 0.0;
  for (const int k : body.columns)
    sum += mobility(cell.image_near(packing.positions.col(k), centre) - centre, body.numbers[2], inertia, axes);
  return 1.0 / sum;
}

/// A rigid body keeps them: found once, and when a sphere of it comes, goes or grows.
Eigen::VectorXd PfvBodies::volumes_of(int tag, const Body& body, const pfv::Packing& packing) {
  Volumes now;
  now.radii = packing.radii(body.columns);
  for (const int k : body.columns) now.tags.push_back(packing.ids[k]);
  const auto known = known_.find(tag);
  if (known != known_.end() && known->second.tags == now.tags && known->second.radii == now.radii)
    return known->second.volumes;
  Eigen::Matrix3Xd centres = packing.positions(Eigen::all, body.columns);
  const bool whole = static_cast<double>(body.columns.size()) == body.numbers[1];
  const Eigen::Map<const Eigen::Vector3d> centre(&body.numbers[3]);
  for (Eigen::Index i = 0; i < centres.cols(); ++i)
    centres.col(i) = PfvPeriodicCell(lmp).image_near(centres.col(i), centre);
  now.volumes = whole ? pfv::displaced_volumes(centres, now.radii, centre)
                      : pfv::union_parts(centres, now.radii);
  return (known_[tag] = now).volumes;
}

}  // namespace LAMMPS_NS
