/// The members of settings (meshes/tables/file_fields.h), for whoever writes them, reads them or
/// compares them. What a file need not tell of the usual press is left out, so that equal presses
/// are written alike.
#pragma once

#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"
#include "meshes/shape/solid.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline press {

/// A solid is told by its digest, from which nobody can read it back.
consteval auto fields_of(const Geometry*) {
  return FINGERTIP_ALL_MEMBERS(Geometry, tip_radius, rod_radius, sleeve_length, rod_length, profile,
                               solid)
      .if_known("profile solid");
}

FINGERTIP_FIELDS(ProfileCorner, r, z, surface, curve, centre_r, centre_z);

consteval auto fields_of(const Rubber*) {
  return FINGERTIP_ALL_MEMBERS(Rubber, youngs_modulus, shear_modulus, density, retardation_time,
                               energy, relaxation)
      .only(&Rubber::has_own_law, "energy")
      .if_known("relaxation");
}

FINGERTIP_FIELDS(Relaxation, branches, bulk);

FINGERTIP_FIELDS(RelaxationBranch, share, time);

FINGERTIP_FIELDS(StrainEnergy, law, volumetric, shape);

consteval auto fields_of(const PressProtocol*) {
  return FINGERTIP_ALL_MEMBERS(PressProtocol, mode, contact, friction, tilt, lateral, lateral_path,
                               twist, lateral_samples, depth, speed, clearance, samples, obstacle,
                               program, markers)
      .only(&PressProtocol::has_obstacle, "obstacle")
      .only(&PressProtocol::has_twist, "twist")
      .if_known("program markers");
}

consteval auto fields_of(const PressStage*) {
  return FINGERTIP_ALL_MEMBERS(PressStage, indentation, speed, hold, move, lateral, twist)
      .only(&PressStage::moves_along_plane, "move")
      .only(&PressStage::is_displaced, "lateral twist");
}

consteval auto fields_of(const Obstacle*) {
  return FINGERTIP_ALL_MEMBERS(Obstacle, shape, radius, along, offset)
      .only(&Obstacle::has_axis, "along")
      .only(&Obstacle::has_offset, "offset");
}

}  // namespace fingertip::meshes::inline press
