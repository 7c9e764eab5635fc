/// A grasp in time: grasp.csv.
#pragma once

#include <array>

#include "lattice/grasp/grip.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::lattice::inline grasp {

/// One row of grasp.csv, once per period. World axes; forces are means over the last step.
struct GraspRow {
  double time = 0.0;  ///< [s]
  GripPhase phase = GripPhase::squeeze;
  double height = 0.0;         ///< of the box's centre above its start [m]
  double velocity = 0.0;       ///< upward [m/s]
  double tilt = 0.0;           ///< rotation of the block since the start [rad]
  double finger_height = 0.0;  ///< travel of the rods upward [m]
  double indentation = 0.0;    ///< travel of each rod toward the block since first touch [m]
  double support_force = 0.0;  ///< [N]
  /// Per finger: normal and tangential force on the block [N], points that touch and of these that
  /// slide.
  std::array<double, 2> normal{}, tangential{};
  std::array<int, 2> touching{}, sliding{};
  /// Per finger, at its points: sum of the magnitudes of their tangential forces, mu times `normal`
  /// where all slide, and of their parts on the tip toward the contact's centre [N].
  std::array<double, 2> point_friction{}, inward_friction{};
  double load = 0.0;  ///< upward force of both fingers on the block [N]
  double slip = 0.0;  ///< of the block down along the fingers since it left its support [m]
};

/// The member of one finger.
template <std::size_t finger>
constexpr auto of_finger(auto GraspRow::*member) {
  return [member](auto& row) -> auto& {
    return (row.*member)[finger];
  };
}

consteval auto fields_of(const GraspRow*) {
  using meshes::Fields, meshes::field;
  using Row = GraspRow;
  return Fields(field<Row>("time [s]", &Row::time), field<Row>("phase", &Row::phase),
                field<Row>("height [m]", &Row::height),
                field<Row>("velocity [m/s]", &Row::velocity), field<Row>("tilt [rad]", &Row::tilt),
                field<Row>("finger_height [m]", &Row::finger_height),
                field<Row>("indentation [m]", &Row::indentation),
                field<Row>("support_force [N]", &Row::support_force),
                field<Row>("load [N]", &Row::load), field<Row>("slip [m]", &Row::slip),
                field<Row>("normal_force_1 [N]", of_finger<0>(&Row::normal)),
                field<Row>("tangential_force_1 [N]", of_finger<0>(&Row::tangential)),
                field<Row>("touching_1", of_finger<0>(&Row::touching)),
                field<Row>("sliding_1", of_finger<0>(&Row::sliding)),
                field<Row>("normal_force_2 [N]", of_finger<1>(&Row::normal)),
                field<Row>("tangential_force_2 [N]", of_finger<1>(&Row::tangential)),
                field<Row>("touching_2", of_finger<1>(&Row::touching)),
                field<Row>("sliding_2", of_finger<1>(&Row::sliding)),
                field<Row>("point_friction_1 [N]", of_finger<0>(&Row::point_friction)),
                field<Row>("inward_friction_1 [N]", of_finger<0>(&Row::inward_friction)),
                field<Row>("point_friction_2 [N]", of_finger<1>(&Row::point_friction)),
                field<Row>("inward_friction_2 [N]", of_finger<1>(&Row::inward_friction)));
}

}  // namespace fingertip::lattice::inline grasp
