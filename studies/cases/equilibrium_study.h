/// What a lattice gives in equilibrium, with the tip's true surfaces: how its force converges to
/// the continuum's as the spacing falls.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/press_response.h"
#include "studies/run/session.h"

namespace fingertip::studies {

/// Static presses of `hookean` at the spacings R/6, R/8 and that of the case, and of `central` at
/// the last, small strain, with the case's contact and depths.
class EquilibriumStudy {
 public:
  EquilibriumStudy() = default;
  /// Presses of the two models as the case has them.
  EquilibriumStudy(const lattice::PressSetup& hookean, const lattice::PressSetup& central);

  /// In equilibrium/<name>, as exhibits: a criterion judges them.
  std::vector<PlannedJob> jobs() const;

  /// equilibrium_study.csv in `folder`: one row per press and verdict depth; empty cells where a
  /// press did not get that far.
  void write_table(const std::filesystem::path& folder,
                   const meshes::PressResponse& reference) const;

  /// Relative force errors of `hookean` at the case's spacing and the verdict depths; null where
  /// the press did not get that far.
  nlohmann::ordered_json hookean_errors(const std::filesystem::path& folder,
                                        const meshes::PressResponse& reference) const;

 private:
  struct Variant {
    std::string name;  ///< the job's folder
    lattice::PressSetup setup;
  };
  void add(const std::string& name, lattice::PressSetup setup);

  std::vector<Variant> variants_;  ///< the case's own `hookean` first
};

}  // namespace fingertip::studies
