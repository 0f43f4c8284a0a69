// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace pfv {

/// Conductance of a throat. `open_throat`: the hydraulic radius where spheres touch, the drag of the
/// spheres where they do not (doc/accuracy.md says why it is the default). `hydraulic_radius`: the
/// papers', Chareyre et al. 2012 eqs. 7-9 with alpha = 1/2. `effective_radius`: eq. 10.
enum class ConductanceLaw { hydraulic_radius, effective_radius, open_throat };

/// Direct solvers behind Amesos2: cholmod (`automatic`), klu2 (the plain reference), mumps (where the
/// build has it: CMake's PFV_WITH_MUMPS). Iterative ones: cg, conjugate gradients with incomplete
/// Cholesky; gauss_seidel with over-relaxation.
enum class SolverKind { automatic, cholmod, klu2, mumps, cg, gauss_seidel };

/// Fill-reducing ordering: nested dissection of the pore centres in space (`automatic`) or of the
/// graph by METIS, or minimum degree: cholmod's. The other solvers order themselves or not at all and
/// refuse a choice (klu2 takes amd, its own).
enum class OrderingKind { automatic, geometric, metis, amd };

/// How cholmod keeps its factor. `full`: in double precision. `mixed`: in single precision, half of what a
/// solve has to read; residuals are taken in double precision and solved for again until they are below
/// 1e-9 of the right-hand side, from the last solution on, so that a step that changes little costs one solve.
enum class Precision { full, mixed };

/// How a throat's domain is parted among pores and spheres. `signed_angles`: signed volumes and solid
/// angles, whose sums are the pore volume and the solid surface. `yade`: the rules of YADE's FlowEngine,
/// to reproduce its results, with geometric volume rates; refused with the open-throat law, which counts on
/// signed volumes, and with reciprocal rates.
enum class Partition { signed_angles, yade };

/// How the velocities of grains and faces change the pores' volumes. `reciprocal`: by S^T, the transpose of the
/// forces, as Stokes flow demands. `geometric`: by the papers' E = dV/dx; explicit steps only. It feeds some
/// motions of grains of unlike size (doc/method.md).
enum class VolumeRates { reciprocal, geometric };

/// What to do with a grain whose centre is not inside the flow box.
enum class OutsideGrains { refuse, leave_out };

/// The strain that leads to a new network. `largest`: the sum over the steps of the largest |dV/dt| dt / V
/// of all pores (thesis eqs. 5.13-5.14). `mean`: |V - V_0| / V_0, V_0 the pores' volumes when the network was built,
/// as the larger of its mean weighted with V_0 and that weighted with the power that the fluid loses in the throats
/// of each pore: one pore does not count for all unless the flow hangs on it, nor does what is undone.
enum class StrainMeasure { largest, mean };

constexpr double default_tolerance = 1e-10;

struct Options {
  ConductanceLaw conductance = ConductanceLaw::open_throat;
  Partition partition = Partition::signed_angles;
  VolumeRates volume_rates = VolumeRates::reciprocal;
  /// Forces act where they lie and turn the grains, whose spins move fluid: a rotation of all as one body then
  /// moves none, which without costs 0.13 of a pore's volume a radian. Nothing but contacts brakes spins: where
  /// grains have no friction, or no contacts, they give way in place of the velocities and the drag is lost
  /// (doc/stability.md, spins). With reciprocal rates.
  bool torques = false;
  SolverKind solver = SolverKind::automatic;
  OrderingKind ordering = OrderingKind::automatic;
  Precision precision = Precision::full;
  /// Where cg and gauss_seidel end: residual over right-hand side (2-norms), in (0, 1). Direct solvers
  /// have none and refuse another than this.
  double tolerance = default_tolerance;
  /// Threads that share a step, 1 ... 64. They change no byte of any result.
  int threads = 1;
  OutsideGrains outside = OutsideGrains::refuse;
  /// Accumulated pore strain at which `Flow::step` triangulates anew, > 0.
  double retriangulation_strain = 0.01;
  StrainMeasure strain_measure = StrainMeasure::mean;
  /// K > 0: when that strain is reached, another thread builds the next network from the grains as
  /// they are, while the steps go on with the old one; the K-th step after takes it up, and waits
  /// where it must. Same bytes in every run. 0: the step itself builds it. Explicit and staged
  /// steps.
  int rebuild_lag = 0;
  bool forces = true;         ///< false: no force matrix is built, `Forces` stays empty
  bool split_forces = false;  ///< also the pressure and the viscous part of each sphere's force
  bool buoyancy = true;       ///< add -density V gravity to each sphere where there is gravity
  bool sphere_pressure = false;  ///< also the mean pressure around each sphere
  bool shear_viscous = false;  ///< add the shear viscous forces of sliding neighbours (Catalano 2012 eqs.
                               ///< 6.29-6.30); explicit and staged steps, no periodic axes
};

/// Throws InputError for settings that are unknown or contradict each other.
void check(const Options& options);

/// The name that the command line and the fix use, and back (InputError for an unknown one, with the
/// list of those that exist).
const char* name_of(ConductanceLaw law);
const char* name_of(Partition partition);
const char* name_of(SolverKind solver);
const char* name_of(OrderingKind ordering);
const char* name_of(Precision precision);
const char* name_of(StrainMeasure measure);
const char* name_of(VolumeRates rates);
ConductanceLaw conductance_law_named(const std::string& name);
Partition partition_named(const std::string& name);
SolverKind solver_named(const std::string& name);
OrderingKind ordering_named(const std::string& name);
Precision precision_named(const std::string& name);
VolumeRates volume_rates_named(const std::string& name);

}  // namespace pfv
