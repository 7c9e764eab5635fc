/// Contact fields of several runs at the depths that they share with the first one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/press/contact_map.h"
#include "meshes/press/press_response.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline results {

/// A run's contact_field.csv beside its response, both of which must outlive it.
struct RunContact {
  std::string label;
  Style style;
  const meshes::PressResponse* response;
  const std::vector<meshes::ContactPoint>* contact;
};

struct ContactsAtDepth {
  double depth = meshes::unknown;  ///< [m]
  /// Per run; empty where it has none there.
  std::vector<std::span<const meshes::ContactPoint>> fields;
  std::vector<meshes::ContactDifference> differences;  ///< per run, from the first

  /// One raster for all fields.
  meshes::Raster raster() const { return meshes::raster_around(fields, places); }
  static constexpr Eigen::Index places = 81;  ///< along each side, one in the middle
};

/// At samples of the first one's press, by increasing depth, runs without a field left out; all of
/// one's own where there is one alone.
std::vector<ContactsAtDepth> contacts_at_depths(const std::vector<RunContact>& runs);

}  // namespace fingertip::studies::report::inline results
