/// A stored run beside the live one: its force curve and, where it has them, its fields.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "studies/files/press_condition.h"
#include "studies/live/surface_fields.h"

namespace fingertip::studies::inline live {

/// A run's surface at one indentation.
struct Overlay {
  double indentation = 0.0;  ///< [m]
  SurfaceMesh surface;
};

struct Reference {
  meshes::PressResponse response;  ///< empty without a reference
  std::vector<Overlay> overlays;   ///< by increasing indentation
  std::string name;                ///< of its folder
  std::optional<PressCondition> condition;
  /// How it differs from what is pressed live.
  std::optional<ComparisonRemark> remark;
};

/// Of a run folder: DIR/response.csv, or that of DIR/reference (a validate run), and the fields
/// listed in fields/press.pvd beside it (a continuum's). `file` may also be a response.csv. Of a
/// symmetric half or quarter the rest is added. Throws InvalidInput when there is no curve or a
/// file is damaged. Leaves `remark` to who knows what is pressed.
Reference read_reference(const std::filesystem::path& file);

/// An overlay for the page: uint32 number of points and of edges, float32 rest places and
/// displacements (3 per point each) [m], uint32 pairs of points. Little-endian.
std::string encode_overlay(const Overlay& overlay);

}  // namespace fingertip::studies::inline live
