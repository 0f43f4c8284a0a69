// SPDX-License-Identifier: GPL-3.0-or-later
#include "body_sources.h"

#include "private_member.h"

#include "atom.h"
#include "comm.h"
#include "custom_value_tracker.h"
#include "fix_multisphere.h"
#include "fix_rigid.h"
#include "modify.h"
#include "multisphere.h"
#include "update.h"

#include <algorithm>
#include <string>

namespace LAMMPS_NS {

PFV_PRIVATE_MEMBER(PfvRigidCount, int, FixRigid, nbody)
PFV_PRIVATE_MEMBER(PfvRigidSpheres, int*, FixRigid, nrigid)
PFV_PRIVATE_MEMBER(PfvRigidBodyOf, int*, FixRigid, body)
PFV_PRIVATE_MEMBER(PfvRigidMass, double*, FixRigid, masstotal)
PFV_PRIVATE_MEMBER(PfvRigidCentre, double**, FixRigid, xcm)
PFV_PRIVATE_MEMBER(PfvRigidInertia, double**, FixRigid, inertia)
PFV_PRIVATE_MEMBER(PfvRigidX, double**, FixRigid, ex_space)
PFV_PRIVATE_MEMBER(PfvRigidY, double**, FixRigid, ey_space)
PFV_PRIVATE_MEMBER(PfvRigidZ, double**, FixRigid, ez_space)
PFV_PRIVATE_MEMBER(PfvRigidMoves, double**, FixRigid, fflag)
PFV_PRIVATE_MEMBER(PfvRigidTurns, double**, FixRigid, tflag)

namespace {

constexpr int body_width = 26;    // fix, number, spheres, mass, centre, inertia, three axes, moves, turns, weighed
constexpr int member_width = 16;  // tag, fix, body, in flow, free, home, radius, place, force, torque

/// `nointegration` leaves the motion to something else, which no force of the fluid changes.
bool integrates(const Fix& bodies) {
  return std::string(bodies.style).find("nointegration") == std::string::npos;
}

void add_three(std::vector<double>& rows, const double* three) { rows.insert(rows.end(), three, three + 3); }

template <class Type, int Size>
auto* property_of(Multisphere& data, const char* name) {
  return data.prop().getElementProperty<VectorContainer<Type, Size>>(name);
}

/// Until its first step of integration a body that is inserted goes on as it came.
bool has_begun(Multisphere& data, int body, long long now) {
  const auto* start = data.prop().getElementProperty<ScalarContainer<int>>("start_step");
  return !start || now >= (*start)(body);
}

void pack_multisphere(int number, FixMultisphere& fix, long long now, std::vector<double>& rows) {
  Multisphere& data = fix.data();
  double** const inertia = data.extract_double_vector("inertia");
  double** const axes[] = {data.extract_double_vector("ex_space"), data.extract_double_vector("ey_space"),
                           data.extract_double_vector("ez_space")};
  auto* const moves = property_of<bool, 3>(data, "fflag");
  auto* const turns = property_of<bool, 3>(data, "tflag");
  for (int b = 0; b < data.n_body(); ++b) {
    double centre[3];
    data.xcm(centre, b);
    const bool free = integrates(fix) && has_begun(data, b, now);
    rows.insert(rows.end(), {static_cast<double>(number), static_cast<double>(data.tag(b)),
                             static_cast<double>(data.nrigid(b)), data.mass(b)});
    add_three(rows, centre);
    add_three(rows, inertia[b]);
    for (double** const axis : axes) add_three(rows, axis[b]);
    for (auto* const flags : {moves, turns})
      for (int axis = 0; axis < 3; ++axis) rows.push_back(free && (!flags || (*flags)(b)[axis]) ? 1.0 : 0.0);
    rows.push_back(1.0);
  }
}

void pack_rigid(int number, FixRigid& fix, std::vector<double>& rows) {
  for (int b = 0; b < fix.*member(PfvRigidCount()); ++b) {
    rows.insert(rows.end(), {static_cast<double>(number), static_cast<double>(b),
                             static_cast<double>((fix.*member(PfvRigidSpheres()))[b]),
                             (fix.*member(PfvRigidMass()))[b]});
    add_three(rows, (fix.*member(PfvRigidCentre()))[b]);
    add_three(rows, (fix.*member(PfvRigidInertia()))[b]);
    add_three(rows, (fix.*member(PfvRigidX()))[b]);
    add_three(rows, (fix.*member(PfvRigidY()))[b]);
    add_three(rows, (fix.*member(PfvRigidZ()))[b]);
    add_three(rows, (fix.*member(PfvRigidMoves()))[b]);
    add_three(rows, (fix.*member(PfvRigidTurns()))[b]);
    rows.push_back(0.0);
  }
}

PfvBody body_of(const double* row) {
  using Three = Eigen::Map<const Eigen::Vector3d>;
  PfvBody body;
  body.spheres = row[2];
  body.mass = row[3];
  body.centre = Three(row + 4);
  body.inertia = Three(row + 7);
  body.axes = Eigen::Map<const Eigen::Matrix3d>(row + 10);
  body.moves = Three(row + 19);
  body.turns = Three(row + 22);
  body.weighed = row[25] != 0.0;
  return body;
}

PfvMember member_of(const double* row) {
  using Three = Eigen::Map<const Eigen::Vector3d>;
  return {static_cast<std::int64_t>(row[0]),
          {static_cast<int>(row[1]), static_cast<int>(row[2])},
          row[3] != 0.0,
          row[4] != 0.0,
          static_cast<int>(row[5]),
          row[6],
          Three(row + 7),
          Three(row + 10),
          Three(row + 13)};
}

}  // namespace

std::vector<Fix*> PfvBodySources::fixes() const {
  std::vector<Fix*> found;
  for (int i = 0; i < modify->nfix; ++i)
    if (dynamic_cast<FixMultisphere*>(modify->fix[i]) || dynamic_cast<FixRigid*>(modify->fix[i]))
      found.push_back(modify->fix[i]);
  return found;
}

/// Rows whose columns `key` and `key` + 1 name a body, on the rank that looks at it.
std::vector<double> PfvBodySources::where_looked_at(const std::vector<double>& mine, int width, int key, bool by_all) const {
  std::vector<int> lookers;
  for (std::size_t row = 0; row < mine.size(); row += width)
    lookers.push_back(by_all ? static_cast<int>(mine[row + key] + mine[row + key + 1]) % comm->nprocs : 0);
  PfvRankRows rows(lmp);
  rows.set_homes(std::move(lookers));
  return rows.to_homes(mine, width);
}

/// Those of this rank. A fix rigid has all its bodies on each.
void PfvBodySources::pack_bodies(int number, Fix& fix, std::vector<double>& rows) const {
  if (auto* const multisphere = dynamic_cast<FixMultisphere*>(&fix))
    pack_multisphere(number, *multisphere, update->ntimestep, rows);
  else if (comm->me == 0)
    pack_rigid(number, dynamic_cast<FixRigid&>(fix), rows);
}

void PfvBodySources::pack_members(int number, Fix& fix, const PfvGroups& groups, const PfvHomes& homes,
                                  std::vector<double>& rows) const {
  const auto* const multisphere = dynamic_cast<FixMultisphere*>(&fix);
  const int* const of_rigid = multisphere ? nullptr : dynamic_cast<FixRigid&>(fix).*member(PfvRigidBodyOf());
  for (int i = 0; i < atom->nlocal; ++i) {
    const int body = multisphere ? multisphere->belongs_to(i) : of_rigid[i];
    if (body < 0) continue;
    const int mask = atom->mask[i];
    rows.insert(rows.end(), {static_cast<double>(atom->tag[i]), static_cast<double>(number), static_cast<double>(body),
                             mask & groups.flow ? 1.0 : 0.0, mask & groups.held ? 0.0 : 1.0,
                             static_cast<double>(homes.is_known(i) ? homes.of(i) : comm->me), atom->radius[i]});
    add_three(rows, atom->x[i]);
    add_three(rows, atom->f[i]);
    add_three(rows, atom->torque[i]);
  }
}

PfvBodyList PfvBodySources::gather(const PfvGroups& groups, const PfvHomes& homes) const {
  std::vector<double> of_bodies, of_members;
  const std::vector<Fix*> all = fixes();
  for (int number = 0; number < static_cast<int>(all.size()); ++number) {
    pack_bodies(number, *all[number], of_bodies);
    pack_members(number, *all[number], groups, homes, of_members);
  }
  const bool by_all = homes.per_atom != nullptr;
  of_bodies = where_looked_at(of_bodies, body_width, 0, by_all);
  of_members = where_looked_at(of_members, member_width, 1, by_all);
  PfvBodyList list;
  std::map<PfvBodyKey, PfvBody> known;
  for (std::size_t row = 0; row < of_bodies.size(); row += body_width) {
    const double* const own = &of_bodies[row];
    known[{static_cast<int>(own[0]), static_cast<int>(own[1])}] = body_of(own);
  }
  for (std::size_t row = 0; row < of_members.size(); row += member_width) {
    list.members.push_back(member_of(&of_members[row]));
    const PfvMember& last = list.members.back();
    const auto body = known.find(last.body);
    if (body == known.end()) list.members.pop_back();  // about to be removed
    else if (last.in_flow) list.bodies.insert(*body);
  }
  list.members.erase(std::remove_if(list.members.begin(), list.members.end(),
                                    [&](const PfvMember& one) { return list.bodies.count(one.body) == 0; }),
                     list.members.end());
  std::sort(list.members.begin(), list.members.end(),
            [](const PfvMember& a, const PfvMember& b) { return a.tag < b.tag; });
  return list;
}

}  // namespace LAMMPS_NS
