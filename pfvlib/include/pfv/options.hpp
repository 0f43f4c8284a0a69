// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/names.hpp"
#include "pfv/solvers.hpp"

#include <optional>

namespace pfv {

/// Conductance of a throat. `open_throat`: the hydraulic radius where spheres touch, the drag of the
/// spheres where they do not (doc/accuracy.md says why it is the default). `hydraulic_radius`: the
/// papers', Chareyre et al. 2012 eqs. 7-9 with alpha = 1/2. `effective_radius`: eq. 10.
enum class ConductanceLaw { hydraulic_radius, effective_radius, open_throat };
template <>
struct Names<ConductanceLaw> {
  static constexpr const char* what = "conductance law";
  static constexpr std::array<Named<ConductanceLaw>, 3> all{
      {{ConductanceLaw::hydraulic_radius, "hydraulic_radius"},
       {ConductanceLaw::effective_radius, "effective_radius"},
       {ConductanceLaw::open_throat, "open_throat"}}};
};

/// How supernodal keeps its factor. `full`: in double precision. `mixed`: in single precision, half of what a
/// solve has to read; residuals are taken in double precision and solved for again until they are below
/// 1e-9 of the right-hand side, from the last solution on, so that a step that changes little costs one solve.
enum class Precision { full, mixed };
template <>
struct Names<Precision> {
  static constexpr const char* what = "precision";
  static constexpr std::array<Named<Precision>, 2> all{
      {{Precision::full, "double"},
       {Precision::mixed, "mixed"}}};
};

/// How a throat's domain is parted among pores and spheres. `signed_angles`: signed volumes and solid
/// angles, whose sums are the pore volume and the solid surface. `yade`: the rules of YADE's FlowEngine,
/// to reproduce its results, with geometric volume rates; refused with the open-throat law, which counts on
/// signed volumes, and with reciprocal rates.
enum class Partition { signed_angles, yade };
template <>
struct Names<Partition> {
  static constexpr const char* what = "partition";
  static constexpr std::array<Named<Partition>, 2> all{
      {{Partition::signed_angles, "signed"},
       {Partition::yade, "yade"}}};
};

/// How the velocities of grains and faces change the pores' volumes. `reciprocal`: by S^T, the transpose of the
/// forces, as Stokes flow demands. `geometric`: by the papers' E = dV/dx; explicit steps only. It feeds some
/// motions of grains of unlike size (doc/method.md).
enum class VolumeRates { reciprocal, geometric };
template <>
struct Names<VolumeRates> {
  static constexpr const char* what = "volume rates";
  static constexpr std::array<Named<VolumeRates>, 2> all{
      {{VolumeRates::reciprocal, "reciprocal"},
       {VolumeRates::geometric, "geometric"}}};
};

/// How the pressures of a step are found. `explicit_step`: from the velocities given. `staged`: the drag is
/// integrated over the step in sub-stages. `implicit`: together with the velocities that follow. `automatic`:
/// what is cheapest and stable, chosen for each network.
enum class Coupling { explicit_step, staged, implicit, automatic };
template <>
struct Names<Coupling> {
  static constexpr const char* what = "coupling";
  static constexpr std::array<Named<Coupling>, 4> all{{{Coupling::explicit_step, "explicit"},
                                                       {Coupling::staged, "staged"},
                                                       {Coupling::implicit, "implicit"},
                                                       {Coupling::automatic, "auto"}}};
};

/// What to do with a grain whose centre is not inside the flow box.
enum class OutsideGrains { refuse, leave_out };
template <>
struct Names<OutsideGrains> {
  static constexpr const char* what = "rule for grains outside the box";
  static constexpr std::array<Named<OutsideGrains>, 2> all{
      {{OutsideGrains::refuse, "refuse"},
       {OutsideGrains::leave_out, "leave_out"}}};
};

/// The strain that leads to a new network. `largest`: the sum over the steps of the largest |dV/dt| dt / V
/// of all pores (thesis eqs. 5.13-5.14). `mean`: |V - V_0| / V_0, V_0 the pores' volumes when the network was built,
/// as the larger of its mean weighted with V_0 and that weighted with the power that the fluid loses in the throats
/// of each pore: one pore does not count for all unless the flow hangs on it, nor does what is undone.
enum class StrainMeasure { largest, mean };
template <>
struct Names<StrainMeasure> {
  static constexpr const char* what = "strain measure";
  static constexpr std::array<Named<StrainMeasure>, 2> all{
      {{StrainMeasure::largest, "largest"},
       {StrainMeasure::mean, "mean"}}};
};

/// Where a packing is solved once and left: from here on amg takes less than a factor (doc/solvers.md, auto).
inline constexpr std::int64_t amg_from_for_one_solution = 15000;

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
  /// Spheres from which `automatic` begins with amg. Below, the first network has a factor, whose pressures are exact; later
  /// ones of 2000 spheres and more have it where the one before has served enough solves.
  std::int64_t amg_from = 50000;
  OrderingKind ordering = OrderingKind::automatic;
  Precision precision = Precision::full;
  /// Where iterative solvers end, in (0, 1), 2-norms: cg and gauss_seidel at this residual over the right-hand side
  /// (absent: 1e-10), amg at this mass defect of the pores over the flow through them (absent: 1e-7). Direct solvers
  /// refuse one.
  std::optional<double> tolerance;
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
                               ///< 6.29-6.30)
  /// Spheres in open water, few in large pores, are braked at least as in unbounded fluid (doc/open_water.md). With
  /// reciprocal rates; nothing in a dense bed.
  bool open_water = true;
};

/// Which of a host's ranks hold the flow. `automatic`: all, where that is asked for by `solver amg` and nothing needs one.
enum class FlowRanks { automatic, one, all };
template <>
struct Names<FlowRanks> {
  static constexpr const char* what = "choice of ranks";
  static constexpr std::array<Named<FlowRanks>, 3> all{
      {{FlowRanks::automatic, "auto"}, {FlowRanks::one, "one"}, {FlowRanks::all, "all"}}};
};

/// When and how a host that moves the grains asks for forces.
struct StepSettings {
  Coupling coupling = Coupling::explicit_step;
  int couple_every = 1;  ///< steps between two solves of the flow, > 0
  /// In its place, by default: as the loads change, with this error, as a part of the load. Absent where each
  /// step or each N-th is solved. Explicit steps on a pore network without rebuild_lag.
  std::optional<double> couple_error = 1e-3;
  double safety = 1.0;  ///< part of the explicit limit that a step may reach, > 0
  bool time_step_check = true;
  FlowRanks ranks = FlowRanks::automatic;
};

/// Throws InputError for options that are unknown or contradict each other, or a step of this kind.
void check(const Options& options, Coupling step = Coupling::explicit_step);

}  // namespace pfv
