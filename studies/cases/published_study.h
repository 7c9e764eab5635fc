/// What the published model's force depends on although the rubber stays the same: spacing, grid
/// offset and the stiffness of the ligaments, none of which the paper prints.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/press_response.h"
#include "studies/run/session.h"

namespace fingertip::studies {

/// One parameter at a time is varied around `base`, a press of the published model.
class PublishedStudy {
 public:
  PublishedStudy() = default;
  explicit PublishedStudy(const lattice::PressSetup& base);

  /// The variants' presses, as exhibits in published_study/<name>; the base itself is the
  /// validation's job `published`.
  std::vector<PlannedJob> jobs() const;

  /// published_study.csv in `folder`: one row per variant and verdict depth, the base in each of
  /// the three groups; empty cells where a press did not get that far.
  void write_table(const std::filesystem::path& folder,
                   const meshes::PressResponse& reference) const;

 private:
  struct Variant {
    std::string varied;  ///< "spacing", "offset", "ligament_stiffness"
    std::string name;    ///< the job's folder
    lattice::PressSetup setup;
    bool is_base = false;
  };
  void add(const std::string& varied, const std::string& label, const lattice::PressSetup& setup,
           bool is_base);

  std::vector<Variant> variants_;
};

}  // namespace fingertip::studies
