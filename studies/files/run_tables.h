/// The rows of tables that runs leave, beside those of trace.csv (lattice/press/trace.h), grasp.csv
/// (lattice/grasp/grasp_table.h), the continuum (fem_reference/job/run_tables.h), fits
/// (calibration/files/fit_tables.h) and response.csv (meshes/press/press_response.h). SI.
#pragma once

#include <string>

#include "meshes/press/press_response.h"
#include "meshes/shape/geometry.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// boundary.csv: a boundary mass, at rest in the rod's frame and at the end in the plane's.
struct BoundaryRow {
  meshes::Vector3 rest = meshes::Vector3::Zero();
  meshes::Vector3 deformed = meshes::Vector3::Zero();
  bool anchored = false;
};
consteval auto fields_of(const BoundaryRow*) {
  return FINGERTIP_ALL_MEMBERS(BoundaryRow, rest, deformed, anchored)
      .in("m", "rest deformed")
      .called("rest", "x,y,z");
}

/// boundary_springs.csv: two rows of boundary.csv, counted from 0.
struct BoundarySpringRow {
  std::size_t i = 0;
  std::size_t j = 0;
};
FINGERTIP_FIELDS(BoundarySpringRow, i, j);

/// snapshots.csv: rod and plane at a moment of a press.
struct SnapshotRow {
  std::string moment;
  double time = meshes::unknown;
  double indentation = meshes::unknown;
  meshes::Vector3 endpoint = meshes::Vector3::Zero();
  meshes::Vector3 turn = meshes::Vector3::Zero();
  meshes::Vector3 force = meshes::Vector3::Zero();
  meshes::Vector3 torque = meshes::Vector3::Zero();
  meshes::Vector3 plane = meshes::Vector3::Zero();
  meshes::Vector3 normal = meshes::Vector3::Zero();
};
consteval auto fields_of(const SnapshotRow*) {
  return FINGERTIP_ALL_MEMBERS(SnapshotRow, moment, time, indentation, endpoint, turn, force,
                               torque, plane, normal)
      .in("s", "time")
      .in("m", "indentation endpoint plane")
      .in("rad", "turn")
      .in("N", "force")
      .in("N m", "torque");
}

/// snapshot_points.csv: a boundary mass in a row of snapshots.csv, counted from 0.
struct SnapshotPointRow {
  std::size_t snapshot = 0;
  meshes::Vector3 place = meshes::Vector3::Zero();
  bool held = false;
};
consteval auto fields_of(const SnapshotPointRow*) {
  return FINGERTIP_ALL_MEMBERS(SnapshotPointRow, snapshot, place, held)
      .in("m", "place")
      .called("place", "x,y,z");
}

/// modes.csv of a lattice: shares of mass and inertia that answer when the rod moves.
struct LatticeModeRow {
  int mode = 0;
  double frequency = meshes::unknown;
  std::string motion;
  meshes::Vector3 mass = meshes::Vector3::Zero();
  double inertia = meshes::unknown;
  int waves = 0;
};
consteval auto fields_of(const LatticeModeRow*) {
  return FINGERTIP_ALL_MEMBERS(LatticeModeRow, mode, frequency, motion, mass, inertia, waves)
      .in("Hz", "frequency")
      .called("inertia", "inertia_z");
}

/// cubes.csv: what a testing machine tells of a cube of whole cells.
struct CubeRow {
  std::string model;
  int cells_across = 0;
  double youngs_modulus_100 = meshes::unknown;
  double youngs_modulus_110 = meshes::unknown;
  double youngs_modulus_111 = meshes::unknown;
  double shear_modulus = meshes::unknown;
  double poissons_ratio_100 = meshes::unknown;
  double bulk_modulus = meshes::unknown;
};
consteval auto fields_of(const CubeRow*) {
  return FINGERTIP_ALL_MEMBERS(CubeRow, model, cells_across, youngs_modulus_100, youngs_modulus_110,
                               youngs_modulus_111, shear_modulus, poissons_ratio_100, bulk_modulus)
      .in("Pa",
          "youngs_modulus_100 youngs_modulus_110 youngs_modulus_111 shear_modulus bulk_modulus");
}

/// published_study.csv: a force of the published lattice on another grid.
struct PublishedStudyRow {
  std::string varied;
  double spacing = meshes::unknown;
  meshes::Vector3 offset = meshes::Vector3::Zero();
  double ligament_stiffness = meshes::unknown;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double relative_error = meshes::unknown;
};
consteval auto fields_of(const PublishedStudyRow*) {
  return FINGERTIP_ALL_MEMBERS(PublishedStudyRow, varied, spacing, offset, ligament_stiffness,
                               indentation, normal_force, relative_error)
      .in("m", "spacing indentation")
      .in("N", "normal_force");
}

/// equilibrium_study.csv: a force of a lattice at rest.
struct EquilibriumStudyRow {
  std::string model;
  double spacing = meshes::unknown;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double relative_error = meshes::unknown;
};
consteval auto fields_of(const EquilibriumStudyRow*) {
  return FINGERTIP_ALL_MEMBERS(EquilibriumStudyRow, model, spacing, indentation, normal_force,
                               relative_error)
      .in("m", "spacing indentation")
      .in("N", "normal_force");
}

/// variants.csv: a force of a study's press beside its continuum's.
struct VariantRow {
  std::string series;
  std::string name;
  double x = meshes::unknown;
  std::string model;
  std::string kinematics;
  std::string contact;
  double poissons_ratio = meshes::unknown;
  double spacing = meshes::unknown;
  std::string continuum;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double reference_force = meshes::unknown;
  double reference_error = meshes::unknown;
  double relative_error = meshes::unknown;
  double volume_defect = meshes::unknown;
  double wall_time = meshes::unknown;
  std::string status;
};
consteval auto fields_of(const VariantRow*) {
  return FINGERTIP_ALL_MEMBERS(VariantRow, series, name, x, model, kinematics, contact,
                               poissons_ratio, spacing, continuum, indentation, normal_force,
                               reference_force, reference_error, relative_error, volume_defect,
                               wall_time, status)
      .in("m", "spacing indentation")
      .in("N", "normal_force reference_force")
      .in("s", "wall_time");
}

/// later.csv: a force of a study's press after its first loading, beside its continuum's.
struct LaterRow {
  std::string series;
  std::string name;
  std::string continuum;
  double stage = meshes::unknown;
  double time = meshes::unknown;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double reference_force = meshes::unknown;
  double error = meshes::unknown;  ///< of the force, over the continuum's largest
};
consteval auto fields_of(const LaterRow*) {
  return FINGERTIP_ALL_MEMBERS(LaterRow, series, name, continuum, stage, time, indentation,
                               normal_force, reference_force, error)
      .called("error", "error_over_largest_force")
      .in("s", "time")
      .in("m", "indentation")
      .in("N", "normal_force reference_force");
}

/// transfer.csv: a force that a fit predicts beside the continuum's.
struct TransferRow {
  std::string fit;
  std::string prediction;
  std::string model;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double reference_force = meshes::unknown;
  double reference_error = meshes::unknown;
  double relative_error = meshes::unknown;
  std::string status;
};
consteval auto fields_of(const TransferRow*) {
  return FINGERTIP_ALL_MEMBERS(TransferRow, fit, prediction, model, indentation, normal_force,
                               reference_force, reference_error, relative_error, status)
      .in("m", "indentation")
      .in("N", "normal_force reference_force");
}

}  // namespace fingertip::studies::inline files
