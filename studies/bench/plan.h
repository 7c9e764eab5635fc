/// What `bench` measures, and how long.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"

namespace fingertip::studies::inline bench {

/// A lattice to press.
struct PressedLattice {
  lattice::ModelKind model = lattice::ModelKind::network;
  int per_radius = 12;  ///< R/a
  int threads = 1;
  lattice::Integrator integrator = lattice::Integrator::symplectic_euler;
  std::optional<double> time_step = {};  ///< [s]; the largest safe one when empty
  bool whole = false;  ///< also where the press is its own mirror image (run.symmetry)
};

/// A continuum on one mesh.
struct ContinuumMesh {
  int degree = 1;
  double refinement = 0.5;
};

struct BenchPlan {
  bool quick = false;
  // Kernels.
  int rounds = 5;              ///< of ratios: fingertip-kernels, then the peers
  int wide_rounds = 3;         ///< of these, with kernels of which no ratio is asked
  double seconds = 0.1;        ///< per kernel and round [s]
  std::vector<int> sizes;      ///< masses along the edges of LAMMPS's cubes, of 20 and 48
  int threads = 2;             ///< most of the kernels, and ranks of LAMMPS
  int widest = 0;              ///< doubles per register, 2, 4 or 8; 0: what the processor has
  std::string lammps = "lmp";  ///< program; empty: leave it out
  bool bullet = true;
  // Presses.
  std::vector<PressedLattice> presses;
  int static_finest = 12;     ///< R/a up to which equilibria are computed beside presses, and timed
  double depth = 0.003;       ///< [m]
  double error_from = 0.001;  ///< force errors are taken from this indentation on [m]
  double reference_tolerance = 0.003;
  int reference_degree = 2;
  double reference_refinement = 0.5;
  bool reference_error = true;  ///< refine the reference until it meets the tolerance
  bool small_strain = true;     ///< a second reference, of small strain
  std::vector<ContinuumMesh> continua;
  int continuum_solves = 30;  ///< equilibria per press of these
  bool times = true;          ///< of static press and calibration
};

/// Half an hour on two cores, most of it for R/24.
BenchPlan full_plan();
/// R/6 and R/8 only, fewer repeats: below three minutes.
BenchPlan quick_plan();
/// Seconds: to see that everything works, not to measure.
BenchPlan smallest_plan();

}  // namespace fingertip::studies::inline bench
