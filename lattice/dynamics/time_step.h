/// Choice of the time step.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lattice/dynamics/integrator.h"
#include "lattice/dynamics/spectrum.h"
#include "lattice/dynamics/spectrum_search.h"
#include "lattice/forces/cell_forces.h"
#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline dynamics {

/// How the time step was chosen; `explanation` says which integrator steps and which bound rules.
struct StepReport {
  double step = 0.0;                ///< at rest [s]
  double smallest = 0.0;            ///< used [s]; smaller where compression stiffened the cells
  double omega0 = meshes::unknown;  ///< published: the paper's estimate sqrt(2k/m) [rad/s]
  double paper_bound = meshes::unknown;  ///< 1/omega0 [s]
  /// Largest stable step by the computed stiffness and damping [s]; unknown with scaled masses.
  double spectral_bound = meshes::unknown;
  std::string explanation;
};

/// Largest step [s] for which every motion within the bounds stays bounded (README: stable
/// steps). Symplectic Euler: lambda dt² + 2 c dt <= 4. Explicit Euler: dt <= the shortest
/// retardation time mu/k, and c (2 dt - dt²/longest mu/k) <= 4; 0 without damping.
double largest_stable_step(const SpectralBounds& bounds, Integrator integrator);

/// The paper's omega0 = sqrt(2 k/m) with the largest spring constant and the mass of a
/// particle among whole cells.
double paper_frequency(const LatticeModel& model);

/// The bounds that the step is chosen from (README: stable steps). Published: the rigorous ones, or
/// where that is smaller the Lanczos estimate with a margin of 5 % plus the free rod's own block.
/// Others: that estimate, or three times the rod's own block if that is larger. `rod` null: its
/// motion is prescribed.
SpectralBounds tightest_bounds(const LatticeModel& model, const RodBody* rod);

/// Of mass_scaled where none is wanted [s]: a quarter of the usual control period.
inline constexpr double usual_scaled_step = 2.5e-4;

/// Chooses the steps of a press: the largest stable one times a safety factor (small kinematics
/// 0.95; finite 0.9 where the cells tell how they stiffen, 0.8 for springs alone, which do not), at
/// most `wanted` if given.
///
/// Compression stiffens cells. CellExtremes bound by how much, but far too generously where slivers
/// deform wildly. So they only say when it is time to look: once they have grown by `allowance`
/// since the spectrum was last computed, it is computed anew about the present state, at once
/// (update) or in portions, a force evaluation in every fourth step (follow). Until then the step
/// shrinks as the bound grows.
class StepController {
 public:
  /// Throws InvalidInput (key run.time_step) when `wanted` is not positive or exceeds the stable
  /// step at rest, or when no step is stable. `rod` null: its motion is prescribed. `team` looks at
  /// the spectrum.
  StepController(const LatticeModel& model, const RodBody* rod, Integrator integrator,
                 std::optional<double> wanted, const Team& team = Team(1));

  /// Whether the spectrum on which the limit rests has to be computed anew.
  bool outdated(const CellExtremes& now) const;
  /// Computes it.
  void update(const State& state, const CellExtremes& now);
  /// Takes note that whoever relies on the cells' extremes has looked at them now.
  void note(const CellExtremes& now);
  /// To be called in every step by those who do not wait: begins to compute it when it is outdated
  /// and goes on with that.
  void follow(const State& state, const CellExtremes& now);

  /// Largest step [s] that is safe, and changes no cell's volume by more than a tenth.
  double limit(const CellExtremes& now) const;
  /// The step that divides `span` [s] > 0 evenly and does not exceed the limit [s].
  double divide(double span, const CellExtremes& now) const;
  /// The same for a lattice at rest [s].
  double at_rest(double span) const;
  /// How `step` relates to the bounds at rest.
  StepReport report(double step) const;

  /// What it knows of the present state.
  struct Memory {
    double present = 0.0;    ///< [s]
    CellExtremes reference;  ///< when the spectrum was computed
    CellExtremes begun;      ///< when the present search was begun
    int steps = 0;           ///< since the search went on
    SpectrumSearch::Memory search;
  };
  const Memory& memory() const { return now_; }
  void recall(const Memory& memory) { now_ = memory; }

 private:
  double growth(const CellExtremes& now) const;
  void adopt(const SpectralBounds& estimate, const CellExtremes& at);

  const LatticeModel* model_;
  Integrator integrator_;
  double safety_;
  double rod_stiffness_ = 0.0;  ///< what the free rod adds to the bounds [1/s²]
  double largest_ = 0.0;        ///< at rest [s]
  Memory now_;
  std::unique_ptr<SpectrumSearch> search_;  ///< null where cells do not stiffen or nobody asks
  StepReport report_;
  std::string why_;
};

}  // namespace fingertip::lattice::inline dynamics
