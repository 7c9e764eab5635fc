/// Natural vibrations, of a lattice or of the continuum.
#pragma once

#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/shape/geometry.h"
#include "meshes/tables/csv_table.h"

namespace fingertip::studies::inline files {

/// A row of modes.csv, of whichever model.
struct VibrationMode {
  int number = 0;
  double frequency = meshes::unknown;  ///< [Hz]
  double error = meshes::unknown;      ///< of the continuum's frequency [Hz]
  /// The kind of motion in words, of the lattice's own or from the continuum's symmetry and
  /// multiplicity: shapes that are alike around the axis (multiplicity 1) twist when antisymmetric
  /// about both planes; pairs have an odd number of waves around the axis when the two planes
  /// differ, sideways being one wave, and an even number otherwise.
  std::string motion;
  bool of_lattice = false;
  /// Shares of mass and of inertia about the axis that answer when the rod moves; of a lattice.
  meshes::Vector3 mass = meshes::Vector3::Constant(meshes::unknown);
  double inertia = meshes::unknown;
};

/// Throws InvalidInput naming the file and what is missing or damaged.
std::vector<VibrationMode> vibration_modes(const meshes::CsvTable& table);

}  // namespace fingertip::studies::inline files
