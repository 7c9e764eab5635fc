/// The columns of response.csv.
#pragma once

#include "meshes/file_fields.h"
#include "meshes/press_response.h"

namespace fingertip::meshes {

constexpr auto fields_of(const PressSample*) {
  using Row = PressSample;
  return std::tuple{
      field("indentation [m]", &Row::indentation),
      field("normal_force [N]", &Row::normal_force),
      field("lateral_force_x [N]", &Row::lateral_force_x),
      field("lateral_force_y [N]", &Row::lateral_force_y),
      field("torque_x [N m]", &Row::torque_x),
      field("torque_y [N m]", &Row::torque_y),
      field("torque_z [N m]", &Row::torque_z),
      field("contact_radius [m]", &Row::contact_radius),
      field("max_pressure [Pa]", &Row::max_pressure),
      field("force_error [N]", &Row::force_error),
      field("time [s]", &Row::time),
      field("lateral_displacement [m]", &Row::lateral_displacement, Presence::if_known),
      field("stage", &Row::stage, Presence::if_known)};
}

}  // namespace fingertip::meshes
