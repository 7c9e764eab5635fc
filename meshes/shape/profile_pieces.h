/// From the corners of a profile to the pieces of its meridian, and what is wrong with them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "meshes/shape/meridian_piece.h"

namespace fingertip::meshes::inline shape {

/// A corner of a profile's closed meridian [m], and the piece from it to the next corner.
struct ProfileCorner {
  double r = 0.0, z = 0.0;
  ProfileSurface surface = ProfileSurface::free;
  ProfileCurve curve = ProfileCurve::straight;
  double centre_r = 0.0, centre_z = 0.0;  ///< of an arc
};

/// Counter-clockwise. Throws InvalidInput with the corner where they are no closed curve in r >= 0
/// that neither crosses nor touches itself.
std::vector<MeridianPiece> profile_pieces(std::vector<ProfileCorner> corners);

/// Chords in place of one of `count` pieces: fewer where the meridian has many.
int chord_count(const MeridianPiece& piece, std::size_t count);

/// Throws InvalidInput about geometry.profile.
[[noreturn]] void refuse_profile(const std::string& value, const std::string& rule,
                                 const std::string& remedy);

/// "(r, z) = (1, 2) mm"
std::string profile_place(const Vector2& corner);

}  // namespace fingertip::meshes::inline shape
