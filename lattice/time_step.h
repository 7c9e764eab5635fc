/// Choice of the time step.
#pragma once

#include <optional>

#include "lattice/model.h"
#include "lattice/press.h"
#include "lattice/rod.h"
#include "lattice/settings.h"
#include "lattice/spectrum.h"

namespace fingertip::lattice {

/// Largest step [s] for which every motion within the bounds stays bounded (README: stable
/// steps). Symplectic Euler: lambda dt² + 2 c dt <= 4. Explicit Euler: dt <= the shortest
/// retardation time mu/k, and c (2 dt - dt²/longest mu/k) <= 4; 0 without damping.
double largest_stable_step(const SpectralBounds& bounds, Integrator integrator);

/// The paper's omega0 = sqrt(2 k/m) with the largest spring constant and the smallest mass.
double paper_frequency(const LatticeModel& model);

/// The bounds that the step is chosen from: the rigorous ones, or where that is smaller the Lanczos
/// estimate with a margin of 5 % plus the free rod's own block (README: stable steps). `rod` null:
/// its motion is prescribed.
SpectralBounds tightest_bounds(const LatticeModel& model, const RodBody* rod);

/// The step to use. Absent `wanted`: the stable step times a safety factor (small kinematics 0.95,
/// finite 0.8, for springs turn and cells grow stiffer as the tip deforms), rounded down so that
/// a whole number of steps makes `period`. Throws InvalidInput (key run.time_step) when `wanted`
/// is not positive or exceeds the stable step, or when no step is stable. `rod` null: its motion is
/// prescribed.
StepReport choose_step(const LatticeModel& model, const RodBody* rod, Integrator integrator,
                       std::optional<double> wanted, double period);

}  // namespace fingertip::lattice
