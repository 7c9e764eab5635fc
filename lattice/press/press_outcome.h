/// What a press yields: its response, trace, pictures, and what it took.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lattice/dynamics/integrators/stepper.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/press/press_pictures.h"
#include "lattice/press/press_setup.h"
#include "lattice/press/trace.h"
#include "meshes/press/contact_field.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline press {

/// What the lattice consists of, for reports and pictures.
struct LatticeCensus {
  std::size_t particles = 0, cells = 0, boundary_particles = 0;
  std::size_t springs = 0;          ///< and fibres
  std::size_t ligaments = 0;        ///< or points of the bond
  double expected_particles = 0.0;  ///< V/a³
  double mass = 0.0;                ///< sum of the particles' masses [kg]
  double exact_mass = 0.0;          ///< rho V [kg]
  double added_mass = 0.0;          ///< what light particles at cut cells were given [kg]
};

/// What a press had taken when a row of its trace was written [s]. Another run takes another time:
/// no part of trace.csv.
struct ElapsedTime {
  double wall = 0.0;
  double processor = 0.0;  ///< of the thread that presses; with one thread all there is
};

struct PressOutcome : PressShapes {
  meshes::PressResponse response;  ///< at the sample depths and evenly in between; of a program
                                   ///< then at the times of PressMotion::samples
  std::vector<meshes::ContactPoint> contact;  ///< at the samples asked for; none of a published
                                              ///< finger
  std::vector<meshes::MarkerRow> markers;     ///< at the same samples; errors are left to others
  std::vector<TraceRow> trace;
  std::vector<ElapsedTime> elapsed;  ///< one per row of `trace`
  StepReport step;
  StepCount steps;
  long force_evaluations = 0;  ///< of springs and cells
  LatticeCensus census;
  int sectors = 1;                            ///< moving_sectors(): 1, 2 or 4; one was computed
  double simulated_time = 0.0;                ///< [s]
  double wall_time = 0.0;                     ///< of the step loop alone [s]
  double first_touch_time = meshes::unknown;  ///< [s]
  double work = 0.0;  ///< of the rod on the rubber, ∫ F dδ along its way, given back or not [J]
  double work_in = 0.0;  ///< the part of the way on which it is positive [J]
  /// Largest defect of the momentum balance of rod, tip and plane over a step, relative to the
  /// largest impulse exchanged.
  double momentum_defect = 0.0;

  /// Simulated over wall time.
  double real_time_factor() const { return wall_time > 0.0 ? simulated_time / wall_time : 0.0; }
};

/// Pictures of a press, evenly spaced in time from the start to the end.
struct PressFilm {
  /// How many, 2 or more, when the press takes as long as planned; 0: none.
  int pictures = 0;
  std::function<void(const BoundaryView& view, const FingerPicture& picture)> show;
};

}  // namespace fingertip::lattice::inline press
