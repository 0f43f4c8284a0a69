// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "parallel/share.hpp"
#include "physics/conductances.hpp"
#include "physics/force_matrix.hpp"
#include "physics/resistance.hpp"
#include "physics/rigid_motion.hpp"
#include "physics/throats.hpp"
#include "pfv/container.hpp"
#include "pfv/network.hpp"

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace pfv {

/// What a sphere in open water is braked by beside the pressures of its pores, when it moves past what stands around
/// it: grains and faces. Their velocities are weighed by the part of its surface that looks at them.
struct OpenWaterDrag {
  struct Neighbour {
    int sphere;
    double weight;
  };

  int sphere;
  Eigen::Matrix3d resistance;         ///< symmetric, >= 0, kg/s
  std::vector<Neighbour> neighbours;  ///< neither its own images nor spheres of its body
  Eigen::Vector3d periods = Eigen::Vector3d::Zero();  ///< mean number by which images stand beside their spheres
  struct Face {
    int column;              ///< in a Motion
    Eigen::Matrix3d weight;  ///< what its velocity counts for: of a slip wall only that across it
    Eigen::Vector3d at;      ///< its point nearest to the sphere, from the network's origin, m
  };
  std::vector<Face> faces;
  bool is_own = true;  ///< a ghost's reactions on faces count at its owner
};

/// The drag that a network leaves out where water is open. A sphere that moves alone is braked at least as in
/// unbounded fluid: what stands still around it only adds to the dissipation (Hill & Power 1956, Quarterly Journal of
/// Mechanics and Applied Mathematics 9, 313-319). A network breaks that bound where few spheres stand in much water:
/// pores that share an imposed pressure have no difference of pressures however a sphere moves between them, no-slip
/// walls and neighbours far away take most of the shares of its throats. For such a sphere, of solid fraction below
/// 0.2 in its pores,
///
///     R = the part >= 0 of  6 pi mu r W - S_k G_k^-1 S_k^T - other resistances to it (`others`),
///
/// G_k of its own pores, those around held, W the correction for walls: of no-slip planes Faxen's along them and that
/// of Bevan & Prieve (2000, Journal of Chemical Physics 113, 1228) towards them, one after the other; of the nearest
/// slip or open one the image of a Stokeslet; nearer than 1.5 radii that of 1.5. In a round wall no less than
/// Haberman's on its axis. Spheres of a rigid body share the drag that they have together (physics/bead_mobility.hpp).
///
/// In a dense bed there is none. On several ranks of own spheres and the ghosts beside them; collective. Pure; cost: a pass over S, and some 20 µs a sphere in open water.
/// `imposed`: of each pore, whether its pressure is given; `matrix`: S. `body`: of each sphere, -1 for none; or no
/// entries. `still`: faces count among what stands around; not where water is driven through, which flows past them.
std::vector<OpenWaterDrag> open_water_drags(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices,
                                            const Throats& throats, const Conductances& conductances,
                                            const ForceMatrix& matrix, const std::vector<char>& imposed,
                                            const Container& container, double viscosity,
                                            const std::vector<ResistanceBlock>& others, const std::vector<int>& body,
                                            bool still, const Share& share = {});

/// Whether nothing drives water through the container: no macroscopic gradient and, of two openings and more, neither a
/// flux nor pressures that differ.
bool is_still(const Container& container);

/// Velocity of a sphere beside what stands around it, m/s. `of_periods`: how much faster an image moves than its
/// sphere, one column for a period along each axis, m/s.
Eigen::Vector3d velocity_past(const OpenWaterDrag& drag, const Motion& motion, const Eigen::Matrix3d& of_periods);

/// Adds the forces of this motion, N, to spheres and faces: each is an action and its reactions.
void add_open_water_forces(const std::vector<OpenWaterDrag>& drags, const Motion& motion,
                           const Eigen::Matrix3d& of_periods, Loads& loads);

/// Adds their R among spheres; faces are taken to move as they are told.
void add_blocks(const std::vector<OpenWaterDrag>& drags, std::vector<ResistanceBlock>& blocks);

/// 1 over the factor by which a wall slows a sphere of radius r at a distance h from its centre: along, towards.
struct WallMobility {
  double along = 1.0, towards = 1.0;
};
enum class PlaneKind { no_slip, slip, open };
WallMobility mobility_beside_plane(PlaneKind kind, double radius, double distance);

}  // namespace pfv
