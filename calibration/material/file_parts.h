/// What the kinds of calibration.json have in common.
#pragma once

#include "calibration/files/fit_file.h"
#include "lattice/model/constants.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline material {

inline RubberEntry rubber_entry(const meshes::Rubber& rubber) {
  RubberEntry entry{rubber.youngs_modulus, rubber.shear_modulus, rubber.poissons_ratio(),
                    rubber.bulk_modulus()};
  for (const meshes::RelaxationBranch& branch : rubber.relaxation.branches) {
    if (!entry.relaxation) entry.relaxation.emplace();
    entry.relaxation->push_back({branch.share, branch.time});
  }
  return entry;
}

inline FitConstants constants_entry(lattice::ModelKind model,
                                    const lattice::SpringConstants& constants,
                                    const meshes::Rubber& rubber) {
  FitConstants entry{constants.k1, constants.k2, constants.k3, constants.kappa};
  if (model == lattice::ModelKind::network) {
    entry.lambda = rubber.lame_lambda();
    entry.G = rubber.shear_modulus;
  }
  return entry;
}

}  // namespace fingertip::calibration::inline material
