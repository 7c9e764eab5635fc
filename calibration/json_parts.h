/// What the kinds of calibration.json have in common.
#pragma once

#include <nlohmann/json.hpp>

#include "calibration/moduli.h"
#include "lattice/press/setup_fields.h"
#include "meshes/fields_json.h"

namespace fingertip::calibration {

inline nlohmann::ordered_json rubber_json(const meshes::Rubber& rubber) {
  return {{"youngs_modulus", rubber.youngs_modulus},
          {"shear_modulus", rubber.shear_modulus},
          {"poissons_ratio", rubber.poissons_ratio()},
          {"bulk_modulus", rubber.bulk_modulus()}};
}

/// The network's lambda and G besides.
inline nlohmann::ordered_json constants_json(lattice::ModelKind model,
                                             const lattice::SpringConstants& constants,
                                             const meshes::Rubber& rubber) {
  nlohmann::ordered_json json = meshes::json_of(constants);
  if (model == lattice::ModelKind::network) {
    json["lambda"] = rubber.lame_lambda();
    json["G"] = rubber.shear_modulus;
  }
  return json;
}

inline nlohmann::ordered_json moduli_json(const ElasticModuli& moduli) {
  return {{"youngs_modulus_100", moduli.youngs_modulus_100},
          {"youngs_modulus_110", moduli.youngs_modulus_110},
          {"youngs_modulus_111", moduli.youngs_modulus_111},
          {"shear_modulus", moduli.shear_modulus},
          {"poissons_ratio_100", moduli.poissons_ratio_100},
          {"bulk_modulus", moduli.bulk_modulus},
          {"anisotropy", moduli.anisotropy}};
}

}  // namespace fingertip::calibration
