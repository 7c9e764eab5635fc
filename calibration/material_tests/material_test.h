/// Tests of a rubber in which the whole specimen deforms alike.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/errors.h"
#include "meshes/strain_energy.h"

namespace fingertip::calibration {

/// What is done to the specimen, and what its `deformation` means.
enum class TestKind {
  uniaxial,      ///< one direction pulled (> 1) or compressed (< 1), the sides free: stretch
  equibiaxial,   ///< two directions alike, as a sheet that is inflated: stretch
  planar,        ///< a wide strip pulled, its width held ("pure shear"): stretch
  simple_shear,  ///< two plates displaced along each other: displacement over height, > 0
  volumetric,    ///< pressed from all sides: volume over volume at rest J
};
std::string_view name(TestKind kind);
constexpr auto values(TestKind) {
  using enum TestKind;
  return std::array{uniaxial, equibiaxial, planar, simple_shear, volumetric};
}

/// Force over the area at rest, or over the area now. In simple shear both are the same; the mean
/// stress of a volumetric test is the true one whatever is said.
enum class StressMeasure { nominal, cauchy };
std::string_view name(StressMeasure measure);
constexpr auto values(StressMeasure) {
  return std::array{StressMeasure::nominal, StressMeasure::cauchy};
}

/// SI.
struct MaterialTest {
  std::string name;  ///< for people
  TestKind kind = TestKind::uniaxial;
  StressMeasure measure = StressMeasure::nominal;
  std::vector<double> deformation;  ///< increasing, positive; meaning: TestKind
  std::vector<double> stress;       ///< positive in tension [Pa]
  std::vector<double> sigma = {};   ///< standard deviation of every stress [Pa]; empty: unknown
  /// Where the plates hold the ends of a cylinder: the force over that between plates that slip, at
  /// every deformation; empty: 1.
  std::vector<double> constraint = {};
  std::optional<double> rate = {};  ///< nominal strain rate [1/s], where known
  std::string source = {};          ///< file with its SHA-256, author; may be empty
  std::string licence = {};         ///< of the data; may be empty

  /// Every broken rule.
  std::vector<meshes::Violation> violations() const;
};

/// The principal stretches of an incompressible body in a test at `deformation` > 0; of volume 1
/// but in a volumetric test, J^(1/3) each.
std::array<double, 3> principal_stretches(TestKind kind, double deformation);

/// The smallest and largest principal stretch over all tests but volumetric ones; {1, 1} for none.
std::array<double, 2> stretch_range(const std::vector<MaterialTest>& tests);

}  // namespace fingertip::calibration
