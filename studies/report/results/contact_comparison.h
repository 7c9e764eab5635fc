/// Contact fields of several runs at the depths that they share with the first one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/press/contact_map.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "meshes/press/taxels.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline results {

/// A run's contact_field.csv, taxels.csv and markers.csv beside its response, all of which must
/// outlive it.
struct RunContact {
  std::string label;
  Style style;
  const meshes::PressResponse* response;
  const std::vector<meshes::ContactPoint>* contact;
  const std::vector<meshes::TaxelRow>* taxels = nullptr;  ///< null: it has no skin
  const std::vector<meshes::MarkerRow>* markers = nullptr;  ///< null: it has none
};

struct ContactsAtDepth {
  double depth = meshes::unknown;  ///< [m]
  /// Per run; empty where it has none there.
  std::vector<std::span<const meshes::ContactPoint>> fields;
  std::vector<meshes::ContactMap> maps;  ///< of these, on one raster

  /// Of a run from the first one; unknown where it has no field here.
  meshes::ContactDifference difference(std::size_t run) const;
};

struct ContactComparison {
  std::vector<RunContact> runs;         ///< those with a field
  std::vector<ContactsAtDepth> depths;  ///< increasing
};

/// At samples of the first run's press, of those that have a field at all, where another has one,
/// too; of a run alone at its deepest.
ContactComparison compared_contacts(std::vector<RunContact> runs);

}  // namespace fingertip::studies::report::inline results
