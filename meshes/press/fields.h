/// The members of settings by name and unit, for whoever writes them, reads them or compares them.
#pragma once

#include <concepts>
#include <type_traits>

#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"
#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline press {

/// `T` is `Settings`, to be read or to be changed.
template <typename T, typename Settings>
concept Fields = std::same_as<std::remove_const_t<T>, Settings>;

/// Calls visit(name, member, SI unit) for every member; the unit is empty where there is none.
/// The bindings name every member, so that a new one that is not visited does not compile.
template <Fields<Geometry> T>
void visit_fields(T& geometry, auto&& visit) {
  auto& [tip_radius, rod_radius, sleeve_length, rod_length, profile, solid] = geometry;
  visit("tip_radius", tip_radius, "m");
  visit("rod_radius", rod_radius, "m");
  visit("sleeve_length", sleeve_length, "m");
  visit("rod_length", rod_length, "m");
  // Files of a dome need not name what it has not.
  if (!std::is_const_v<T> || !profile.empty()) visit("profile", profile, "");
  // Told by its digest, from which nobody can read it back.
  if constexpr (std::is_const_v<T>)
    if (solid) visit("solid", solid->content(), "");
}

template <Fields<ProfileCorner> T>
void visit_fields(T& corner, auto&& visit) {
  auto& [r, z, surface, curve, centre_r, centre_z] = corner;
  visit("r", r, "m");
  visit("z", z, "m");
  visit("surface", surface, "");
  visit("curve", curve, "");
  visit("centre_r", centre_r, "m");
  visit("centre_z", centre_z, "m");
}

template <Fields<Rubber> T>
void visit_fields(T& rubber, auto&& visit) {
  auto& [youngs_modulus, shear_modulus, density, retardation_time, energy, relaxation] = rubber;
  visit("youngs_modulus", youngs_modulus, "Pa");
  visit("shear_modulus", shear_modulus, "Pa");
  visit("density", density, "kg/m^3");
  visit("retardation_time", retardation_time, "s");
  // Files of the usual law need not name it.
  if (!std::is_const_v<T> || energy != StrainEnergy()) visit("energy", energy, "");
  if (!std::is_const_v<T> || !relaxation.empty()) visit("relaxation", relaxation, "");
}

template <Fields<Relaxation> T>
void visit_fields(T& relaxation, auto&& visit) {
  auto& [branches, bulk] = relaxation;
  visit("branches", branches, "");
  visit("bulk", bulk, "");
}

template <Fields<RelaxationBranch> T>
void visit_fields(T& branch, auto&& visit) {
  auto& [share, time] = branch;
  visit("share", share, "");
  visit("time", time, "s");
}

template <Fields<StrainEnergy> T>
void visit_fields(T& energy, auto&& visit) {
  auto& [law, volumetric, shape] = energy;
  visit("law", law, "");
  visit("volumetric", volumetric, "");
  visit("shape", shape, "");
}

template <Fields<PressProtocol> T>
void visit_fields(T& protocol, auto&& visit) {
  auto& [mode, contact, friction, tilt, lateral, lateral_path, lateral_samples, depth, speed,
         clearance, samples, obstacle, program] = protocol;
  visit("mode", mode, "");
  visit("contact", contact, "");
  visit("friction", friction, "");
  visit("tilt", tilt, "rad");
  visit("lateral", lateral, "m");
  visit("lateral_path", lateral_path, "");
  visit("lateral_samples", lateral_samples, "");
  visit("depth", depth, "m");
  visit("speed", speed, "m/s");
  visit("clearance", clearance, "m");
  visit("samples", samples, "m");
  // Files of a press on a plane need not name what it has not.
  if (!std::is_const_v<T> || !obstacle.is_plane()) visit("obstacle", obstacle, "");
  // Nor those of the usual press its stages.
  if (!std::is_const_v<T> || !program.empty()) visit("program", program, "");
}

template <Fields<PressStage> T>
void visit_fields(T& stage, auto&& visit) {
  auto& [indentation, speed, hold] = stage;
  visit("indentation", indentation, "m");
  visit("speed", speed, "m/s");
  visit("hold", hold, "s");
}

template <Fields<Obstacle> T>
void visit_fields(T& obstacle, auto&& visit) {
  auto& [shape, radius, along, offset] = obstacle;
  // What says nothing of a shape is not written, so that equal obstacles are written alike.
  const bool read = !std::is_const_v<T>, sphere = obstacle.shape == ObstacleShape::sphere;
  visit("shape", shape, "");
  visit("radius", radius, "m");
  if (read || !sphere) visit("along", along, "");
  if (read || !obstacle.along_x()) visit("offset", offset, "m");
}

}  // namespace fingertip::meshes::inline press
