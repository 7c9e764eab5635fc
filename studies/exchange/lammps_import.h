/// A run of LAMMPS, taken back: checked against our own march, as a table and as pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "studies/exchange/lammps_output.h"
#include "studies/exchange/undamped_body.h"

namespace fingertip::studies {

/// One row of trajectory.csv: a stored frame.
struct TrajectoryRow {
  double time = 0.0;                                    ///< [s]
  meshes::Vector3 centre = meshes::Vector3::Zero();     ///< of mass [m]
  meshes::Vector3 momentum = meshes::Vector3::Zero();   ///< [N s]
  double kinetic_energy = 0.0;                          ///< [J]
  double elastic_energy = 0.0;                          ///< of springs, ligaments and wall [J]
  meshes::Vector3 rod_force = meshes::Vector3::Zero();  ///< of the ligaments on the rod [N]
  double wall_force = 0.0;                              ///< of the masses along its normal [N]
  /// Largest distance of a mass from where our own march has it, over the spacing; NaN: not
  /// marched.
  double deviation = std::numeric_limits<double>::quiet_NaN();
  /// Largest difference of a velocity, over the spacing times the frequency of an axis spring.
  double velocity_deviation = std::numeric_limits<double>::quiet_NaN();
};

struct ImportOptions {
  bool compare = false;   ///< march the body ourselves and measure deviations
  bool pictures = false;  ///< write frames/ for ParaView
  int threads = 1;        ///< of the march
};

struct LammpsImport {
  std::vector<TrajectoryRow> rows;
  bool broke_off = false;              ///< the dump ends inside a frame
  std::optional<LammpsTiming> timing;  ///< nothing without a complete log
  std::size_t springs = 0;

  double worst_deviation() const;           ///< over all frames; NaN: not compared
  double worst_velocity_deviation() const;  ///< likewise
};

/// The frame as a state of the body's model, velocities at the time of the positions. Throws
/// InvalidInput unless it has as many masses.
lattice::State state_of(const LammpsFrame& frame, const lattice::LatticeModel& model);

/// Reads lattice.dump and log.lammps in `folder`, which write_lammps made from this body, and
/// writes trajectory.csv, and frames/ when asked. `go_on` is called now and then with the present
/// step; false: Interrupted. Throws InvalidInput for a dump of something else.
LammpsImport import_lammps(const UndampedBody& body, const std::filesystem::path& folder,
                           const ImportOptions& options,
                           const std::function<bool(long step)>& go_on = {});

}  // namespace fingertip::studies
