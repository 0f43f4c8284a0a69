// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_forces.h"

#include "other_fixes.h"

#include "pfv/error.hpp"

#include "atom.h"
#include "fix_contact_property_atom.h"
#include "fix_contact_property_atom_wall.h"
#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "force.h"
#include "modify.h"
#include "pair_gran.h"

#include <Eigen/Geometry>
#include <mpi.h>

namespace LAMMPS_NS {

namespace {

/// Contacts as they come, of the atoms that this rank owns.
class ContactList {
 public:
  void add(int atom, const Eigen::Vector3d& point, const Eigen::Vector3d& force) {
    atoms_.push_back(atom);
    points_.push_back(point);
    forces_.push_back(force);
  }

  pfv::ContactForces contacts() const {
    const auto count = static_cast<Eigen::Index>(atoms_.size());
    pfv::ContactForces all{decltype(all.spheres)(count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
    for (Eigen::Index c = 0; c < count; ++c) {
      all.spheres[c] = atoms_[c];
      all.points.col(c) = points_[c];
      all.forces.col(c) = forces_[c];
    }
    return all;
  }

 private:
  std::vector<int> atoms_;
  std::vector<Eigen::Vector3d> points_, forces_;
};

Eigen::Vector3d vector_at(const double* components) { return Eigen::Map<const Eigen::Vector3d>(components); }

PairGran* granular_pair(Force& force) {
  return force.pair ? dynamic_cast<PairGran*>(force.pair_match("gran", 0)) : nullptr;
}

template <class Kept>
Kept* kept_by(Modify& modify, const std::string& whose) {
  return dynamic_cast<Kept*>(modify.find_fix_id(("contactforces_stress_" + whose).c_str()));
}

/// Each rank has those of its own atoms. The arms are those of the torques: of each radius half of the overlap is cut.
void add_pair_contacts(FixContactPropertyAtom& kept, const Atom& atom, ContactList& list) {
  for (int i = 0; i < atom.nlocal; ++i)
    for (int c = 0; c < kept.n_partner(i); ++c) {
      const double* row = kept.contacthistory(i, c);  // force, then the index of the other
      const int other = static_cast<int>(row[3]);
      const Eigen::Vector3d here = vector_at(atom.x[i]), way = vector_at(atom.x[other]) - here;
      const double apart = way.norm(), arm = 0.5 * (apart + atom.radius[i] - atom.radius[other]);
      list.add(i, here + arm / apart * way, vector_at(row));
    }
}

void add_wall_contacts(FixContactPropertyAtomWall& kept, const Atom& atom, ContactList& list) {
  for (int i = 0; i < atom.nlocal; ++i)
    for (int c = 0; c < kept.n_partner(i); ++c) {
      const double* row = kept.contacthistory(i, c);  // force, then the way from the wall
      list.add(i, vector_at(atom.x[i]) - vector_at(row + 3), vector_at(row));
    }
}

/// Of a mesh wall those of its meshes.
std::vector<std::string> keepers_of(const FixWallGran& wall) {
  if (!wall.is_mesh_wall()) return {wall.id};
  std::vector<std::string> names;
  for (int mesh = 0; mesh < wall.n_meshes(); ++mesh) names.push_back(wall.mesh_list()[mesh]->id);
  return names;
}

}  // namespace

void PfvContactForces::ask() const {
  PairGran* pair = granular_pair(*force);
  if (!pair) throw pfv::InputError("contact_stress needs a pair style gran, defined before this fix");
  pair->do_store_contact_forces_stress();
}

std::string PfvContactForces::obstacle(const Fix& flow) const {
  if (force->newton_pair) return "contact_stress needs `newton off`";
  if (!kept_by<FixContactPropertyAtom>(*modify, ""))
    return "contact_stress: the pair style was defined after this fix; define this fix again";
  bool later = false;
  for (int i = 0; i < modify->nfix; ++i) {
    later = later || modify->fix[i] == &flow;
    auto* wall = dynamic_cast<FixWallGran*>(modify->fix[i]);
    if (!wall) continue;
    if (later) return "contact_stress: define " + name_of(*wall) + " before this fix, which asks it for forces";
    if (!wall->store_force_contact_stress())
      return "contact_stress: add `store_force_contact_stress yes` to " + name_of(*wall) + ", which keeps no forces";
  }
  return {};
}

pfv::ContactForces PfvContactForces::contacts() const {
  ContactList list;
  if (auto* pairs = kept_by<FixContactPropertyAtom>(*modify, "")) add_pair_contacts(*pairs, *atom, list);
  for (int i = 0; i < modify->nfix; ++i) {
    auto* wall = dynamic_cast<FixWallGran*>(modify->fix[i]);
    if (!wall) continue;
    for (const std::string& name : keepers_of(*wall))
      if (auto* kept = kept_by<FixContactPropertyAtomWall>(*modify, name)) add_wall_contacts(*kept, *atom, list);
  }
  return list.contacts();
}

namespace {

pfv::PackingArrays own_grains(const Atom& atom) {
  pfv::PackingArrays own;
  own.ids = pfv::Packing::Ids::LinSpaced(atom.nlocal, 0, atom.nlocal - 1);
  own.positions.resize(3, atom.nlocal);
  own.velocities.resize(3, atom.nlocal);
  own.radii.resize(atom.nlocal);
  for (int i = 0; i < atom.nlocal; ++i) {
    own.positions.col(i) = vector_at(atom.x[i]);
    own.velocities.col(i) = vector_at(atom.v[i]);
    own.radii[i] = atom.radius[i];
  }
  return own;
}

/// Of the group's centre of mass, m/s; collective.
Eigen::Vector3d mean_velocity_of(const Atom& atom, int groupbit, MPI_Comm world) {
  Eigen::Vector4d sums = Eigen::Vector4d::Zero();
  for (int i = 0; i < atom.nlocal; ++i)
    if (atom.mask[i] & groupbit) sums += atom.rmass[i] * vector_at(atom.v[i]).homogeneous();
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, world);
  if (!(sums[3] > 0.0)) return Eigen::Vector3d::Zero();
  return sums.hnormalized();
}

}  // namespace

std::vector<double> PfvContactForces::rows(int groupbit) const {
  const pfv::PackingArrays own = own_grains(*atom);
  const Eigen::Map<const Eigen::VectorXd> masses(atom->rmass, atom->nlocal);
  const pfv::SphereTensors of_contacts = pfv::contact_stresses(own.view(), contacts()),
                           of_motion = pfv::inertial_stresses(own.view(), masses,
                                                              mean_velocity_of(*atom, groupbit, world));
  std::vector<double> rows;
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit)) continue;
    rows.insert(rows.end(), of_contacts.col(i).begin(), of_contacts.col(i).end());
    rows.insert(rows.end(), of_motion.col(i).begin(), of_motion.col(i).end());
  }
  return rows;
}

}  // namespace LAMMPS_NS
