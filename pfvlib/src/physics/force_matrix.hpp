// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "parallel/share.hpp"
#include "parallel/team.hpp"
#include "physics/rigid_motion.hpp"
#include "physics/throats.hpp"
#include "pfv/network.hpp"
#include "pfv/options.hpp"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace pfv {

/// S of F = S p (Chareyre et al. 2012 eqs. 14, 17, 18), in compressed rows: row k < N is sphere k,
/// row N + f the viscous force on face f. An entry is the force (m²) and the moment (m³) that the pressure
/// of one pore gives.
struct ForceMatrix {
  int spheres = 0;
  int bodies = 0;  ///< the last rows are theirs (physics/rigid_bodies.hpp)
  bool wall_moments = false;  ///< it has those on walls
  bool stretching = false;    ///< it has the rows of a periodic cell's faces (physics/cell_stretching.hpp)
  std::vector<int> row_begin{0};
  std::vector<int> pore;
  Matrix6Xd value;

  int rows() const { return static_cast<int>(row_begin.size()) - 1; }
};

/// `moments`: where forces act besides; without them those on spheres act at their centres, as in
/// the papers. `wall_moments`: those on walls act where they lie, so that a wall that turns takes
/// its share along.
struct ForceParts {
  bool pressure = true, viscous = true, moments = true, wall_moments = false;
};

/// Share of its throat's viscous force that each vertex of each facet takes; they add up to 1 over a
/// throat.
using ViscousShares = std::vector<std::array<double, 3>>;

/// gamma^k / gamma (Chareyre et al. 2012 eq. 18), no-slip walls included. With the open-throat law a
/// sphere's gamma^k counts max(1, r_max / (4 r_k)) times, r_max the largest radius of the facet: a sphere
/// much smaller than its pore stands in the fast flow. A throat with gamma <= 0 shares equally among its
/// spheres.
ViscousShares viscous_shares(ConductanceLaw law, const PoreNetwork& network,
                             const Throats& throats, const Spheres& spheres);

/// S of F = S p, facet by facet, with n from pore i to pore j: sphere k gets A^k (p_i - p_j) n (pressure; Chareyre et
/// al. 2012 eq. 14), and its share of A^f (p_i - p_j) n (viscous; eqs. 17, 18), as does a no-slip wall. Each throat
/// hands out S (p_i - p_j) n in full, so the forces on spheres and faces balance for any pressures and shares. The
/// moments are those of the parts where they lie on the facet, the viscous ones at the centroid of the fluid area: with
/// the pressures on the faces they balance, too, and a pressure has no moment about anything it surrounds. `vertices`:
/// what the network's vertices stand for; `spheres`: N. No byte depends on the team.
ForceMatrix force_matrix(const PoreNetwork& network, const Spheres& vertices,
                         const Throats& throats, const ViscousShares& shares, int spheres,
                         ForceParts parts, Team& team);
ForceMatrix force_matrix(const PoreNetwork& network, const Spheres& vertices,
                         const Throats& throats, const ViscousShares& shares, int spheres,
                         ForceParts parts);

/// F = S p: 6 x (N + 6), N and N m.
void multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures, Team& team, Loads& loads);
Loads multiply(const ForceMatrix& matrix, const Eigen::VectorXd& pressures);

/// What a macroscopic gradient (Pa/m) adds to S p where throats reach into images: 6 x (N + 6). On several ranks a throat
/// pushes on faces at one of them.
Loads gradient_forces(const PoreNetwork& network, const Spheres& vertices, const Throats& throats,
                      const ViscousShares& shares, int spheres, ForceParts parts,
                      const Eigen::Vector3d& gradient, const Share& share = {});

/// Mean pressure over each sphere's surface: pores weighted with the solid angle of their cells, Pa.
/// Around an image a macroscopic gradient has raised it by the gradient times the image's offset.
struct SurfacePressure {
  std::vector<int> row_begin{0};
  std::vector<int> pore;
  std::vector<double> weight;
  Eigen::Matrix3Xd offset;  ///< mean offset of the images whose cells surround each sphere, m
};
SurfacePressure surface_pressure(const PoreNetwork& network, const Spheres& vertices,
                                 const Spheres& spheres);
void multiply(const SurfacePressure& matrix, const Eigen::VectorXd& pressures, Team& team,
              Eigen::VectorXd& mean);

}  // namespace pfv
