/// The contact of a press for ParaView.
#pragma once

#include <filesystem>

namespace fingertip::studies::inline presses::inline pictures {

/// Writes contact/frame_0000.vtu, ... and contact/contact.pvd, one picture per sample of the
/// contact_field.csv in `folder`, in its axes: vertices with pressure, shear, force per area [Pa],
/// area [m²] and state (1 sticks, 2 slips); field data: indentation [m]. The time of a picture is
/// the sample's number. Nothing where no point touched.
void write_contact_frames(const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline presses::inline pictures
