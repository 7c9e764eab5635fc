/// The contact of a press for ParaView.
#pragma once

#include <filesystem>
#include <span>

#include "meshes/press/contact_field.h"

namespace fingertip::studies::inline presses::inline pictures {

/// Writes contact/frame_0000.vtu, ... and contact/contact.pvd, one picture per sample of a
/// field, in its axes: vertices with pressure, shear, force per area [Pa],
/// area [m²] and state (1 sticks, 2 slips); field data: indentation [m]. The time of a picture is
/// the sample's number. Takes older ones away; nothing of no points.
void write_contact_frames(std::span<const meshes::ContactPoint> field,
                          const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline presses::inline pictures
