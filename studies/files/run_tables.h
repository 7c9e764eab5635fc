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
constexpr auto fields_of(const BoundaryRow*) {
  using meshes::field;
  using Row = BoundaryRow;
  return std::tuple{field("x [m],y [m],z [m]", &Row::rest),
                    field("deformed_x [m],deformed_y [m],deformed_z [m]", &Row::deformed),
                    field("anchored", &Row::anchored)};
}

/// boundary_springs.csv: two rows of boundary.csv, counted from 0.
struct BoundarySpringRow {
  std::size_t i = 0;
  std::size_t j = 0;
};
constexpr auto fields_of(const BoundarySpringRow*) {
  using meshes::field;
  using Row = BoundarySpringRow;
  return std::tuple{field("i", &Row::i), field("j", &Row::j)};
}

/// contact.csv: a point of the true surface that the obstacle holds.
struct ContactRow {
  meshes::Vector3 rest = meshes::Vector3::Zero();
  meshes::Vector3 deformed = meshes::Vector3::Zero();
  double pressure = meshes::unknown;
};
constexpr auto fields_of(const ContactRow*) {
  using meshes::field;
  using Row = ContactRow;
  return std::tuple{field("x [m],y [m],z [m]", &Row::rest),
                    field("deformed_x [m],deformed_y [m],deformed_z [m]", &Row::deformed),
                    field("pressure [Pa]", &Row::pressure)};
}

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
constexpr auto fields_of(const SnapshotRow*) {
  using meshes::field;
  using Row = SnapshotRow;
  return std::tuple{field("moment", &Row::moment),
                    field("time [s]", &Row::time),
                    field("indentation [m]", &Row::indentation),
                    field("endpoint_x [m],endpoint_y [m],endpoint_z [m]", &Row::endpoint),
                    field("turn_x [rad],turn_y [rad],turn_z [rad]", &Row::turn),
                    field("force_x [N],force_y [N],force_z [N]", &Row::force),
                    field("torque_x [N m],torque_y [N m],torque_z [N m]", &Row::torque),
                    field("plane_x [m],plane_y [m],plane_z [m]", &Row::plane),
                    field("normal_x,normal_y,normal_z", &Row::normal)};
}

/// snapshot_points.csv: a boundary mass in a row of snapshots.csv, counted from 0.
struct SnapshotPointRow {
  std::size_t snapshot = 0;
  meshes::Vector3 place = meshes::Vector3::Zero();
  bool held = false;
};
constexpr auto fields_of(const SnapshotPointRow*) {
  using meshes::field;
  using Row = SnapshotPointRow;
  return std::tuple{field("snapshot", &Row::snapshot), field("x [m],y [m],z [m]", &Row::place),
                    field("held", &Row::held)};
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
constexpr auto fields_of(const LatticeModeRow*) {
  using meshes::field;
  using Row = LatticeModeRow;
  return std::tuple{field("mode", &Row::mode),         field("frequency [Hz]", &Row::frequency),
                    field("motion", &Row::motion),     field("mass_x,mass_y,mass_z", &Row::mass),
                    field("inertia_z", &Row::inertia), field("waves", &Row::waves)};
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
constexpr auto fields_of(const CubeRow*) {
  using meshes::field;
  using Row = CubeRow;
  return std::tuple{field("model", &Row::model),
                    field("cells_across", &Row::cells_across),
                    field("youngs_modulus_100 [Pa]", &Row::youngs_modulus_100),
                    field("youngs_modulus_110 [Pa]", &Row::youngs_modulus_110),
                    field("youngs_modulus_111 [Pa]", &Row::youngs_modulus_111),
                    field("shear_modulus [Pa]", &Row::shear_modulus),
                    field("poissons_ratio_100", &Row::poissons_ratio_100),
                    field("bulk_modulus [Pa]", &Row::bulk_modulus)};
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
constexpr auto fields_of(const PublishedStudyRow*) {
  using meshes::field;
  using Row = PublishedStudyRow;
  return std::tuple{field("varied", &Row::varied),
                    field("spacing [m]", &Row::spacing),
                    field("offset_x,offset_y,offset_z", &Row::offset),
                    field("ligament_stiffness", &Row::ligament_stiffness),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("relative_error", &Row::relative_error)};
}

/// equilibrium_study.csv: a force of a lattice at rest.
struct EquilibriumStudyRow {
  std::string model;
  double spacing = meshes::unknown;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double relative_error = meshes::unknown;
};
constexpr auto fields_of(const EquilibriumStudyRow*) {
  using meshes::field;
  using Row = EquilibriumStudyRow;
  return std::tuple{field("model", &Row::model), field("spacing [m]", &Row::spacing),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("relative_error", &Row::relative_error)};
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
constexpr auto fields_of(const VariantRow*) {
  using meshes::field;
  using Row = VariantRow;
  return std::tuple{field("series", &Row::series),
                    field("name", &Row::name),
                    field("x", &Row::x),
                    field("model", &Row::model),
                    field("kinematics", &Row::kinematics),
                    field("contact", &Row::contact),
                    field("poissons_ratio", &Row::poissons_ratio),
                    field("spacing [m]", &Row::spacing),
                    field("continuum", &Row::continuum),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("reference_force [N]", &Row::reference_force),
                    field("reference_error", &Row::reference_error),
                    field("relative_error", &Row::relative_error),
                    field("volume_defect", &Row::volume_defect),
                    field("wall_time [s]", &Row::wall_time),
                    field("status", &Row::status)};
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
constexpr auto fields_of(const LaterRow*) {
  using meshes::field;
  using Row = LaterRow;
  return std::tuple{field("series", &Row::series),
                    field("name", &Row::name),
                    field("continuum", &Row::continuum),
                    field("stage", &Row::stage),
                    field("time [s]", &Row::time),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("reference_force [N]", &Row::reference_force),
                    field("error_over_largest_force", &Row::error)};
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
constexpr auto fields_of(const TransferRow*) {
  using meshes::field;
  using Row = TransferRow;
  return std::tuple{field("fit", &Row::fit),
                    field("prediction", &Row::prediction),
                    field("model", &Row::model),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("reference_force [N]", &Row::reference_force),
                    field("reference_error", &Row::reference_error),
                    field("relative_error", &Row::relative_error),
                    field("status", &Row::status)};
}

}  // namespace fingertip::studies::inline files
