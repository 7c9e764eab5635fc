/// Tests of a rubber in which the whole specimen deforms alike.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/names.h"
#include "meshes/rubber/strain_energy.h"

namespace fingertip::calibration::inline material_tests {

/// What is done to the specimen, and what its `deformation` means.
enum class TestKind {
  uniaxial,      ///< one direction pulled (> 1) or compressed (< 1), the sides free: stretch
  equibiaxial,   ///< two directions alike, as a sheet that is inflated: stretch
  planar,        ///< a wide strip pulled, its width held ("pure shear"): stretch
  simple_shear,  ///< two plates displaced along each other: displacement over height, > 0
  volumetric,    ///< pressed from all sides: volume over volume at rest J
};
using meshes::name, meshes::values;
constexpr auto names_of(TestKind) {
  using enum TestKind;
  return meshes::names<TestKind>({{uniaxial, "uniaxial"},
                                  {equibiaxial, "equibiaxial"},
                                  {planar, "planar"},
                                  {simple_shear, "simple-shear"},
                                  {volumetric, "volumetric"}});
}

/// How an incompressible body deforms, whatever the test. A column in compression and a sheet that
/// is pulled both ways are one: two stretches are alike and longer than the third.
enum class DeformationMode {
  tension,      ///< (l, l^(-1/2), l^(-1/2)), l > 1
  compression,  ///< (l, l, l^-2)
  shear,        ///< (l, 1, 1/l), turned in simple shear
};
constexpr auto names_of(DeformationMode) {
  using enum DeformationMode;
  return meshes::names<DeformationMode>(
      {{tension, "tension"}, {compression, "compression"}, {shear, "shear"}});
}
/// Of a test of shape at a deformation.
DeformationMode mode_of(TestKind kind, double deformation);

/// Force over the area at rest, or over the area now. In simple shear both are the same; the mean
/// stress of a volumetric test is the true one whatever is said.
enum class StressMeasure { nominal, cauchy };
constexpr auto names_of(StressMeasure) {
  using enum StressMeasure;
  return meshes::names<StressMeasure>({{nominal, "nominal"}, {cauchy, "true"}});
}

/// How a specimen's deformation goes in time.
enum class TestCourse {
  slow,        ///< at its `rate`, or so slowly that the rubber is in equilibrium
  relaxation,  ///< brought to a deformation, which is held
  cycles,      ///< any other course
};
constexpr auto names_of(TestCourse) {
  using enum TestCourse;
  return meshes::names<TestCourse>(
      {{slow, "slow"}, {relaxation, "relaxation"}, {cycles, "cycles"}});
}

/// A deformation in time, linear from corner to corner. Two corners of one time are a sudden
/// change; where the first is not rest, so is what comes before it.
struct StrainPath {
  std::vector<double> time;         ///< never decreasing [s]
  std::vector<double> deformation;  ///< as that of a test, in shear of any sign

  bool empty() const { return time.empty(); }
  /// Between the corners, after a sudden change [time within the path, not empty].
  double at(double when) const;
  /// When the last deformation is reached within 2 % of its distance from `rest`.
  double held_from(double rest) const;
};

/// SI.
struct MaterialTest {
  std::string name;  ///< for people
  TestKind kind = TestKind::uniaxial;
  StressMeasure measure = StressMeasure::nominal;
  /// Positive; meaning: TestKind. Increasing where the course is slow.
  std::vector<double> deformation;
  std::vector<double> stress;      ///< positive in tension [Pa]
  std::vector<double> sigma = {};  ///< standard deviation of every stress [Pa]; empty: unknown
  /// Where the plates hold the ends of a cylinder: the force over that between plates that slip, at
  /// every deformation; empty: 1.
  std::vector<double> constraint = {};
  /// Of a mean of specimens every specimen's stress over it; else empty.
  std::vector<double> specimens = {};
  /// Whether a stress that the load cell tells at rest, and a strain that the specimen has then,
  /// are sought with the law; of slow tests, the second one of a nominal strain or a shear.
  bool stress_zero_sought = false, strain_zero_sought = false;
  bool stress_zero_known = false;        ///< rows at rest, or the file's description, tell it
  double stress_zero_error = 0.0;        ///< standard error of what was taken off [Pa]
  std::vector<std::string> doubts = {};  ///< why no law fitted to it is accepted, sentences
  std::optional<double> rate = {};       ///< nominal strain rate [1/s], where known
  TestCourse course = TestCourse::slow;
  /// Of a course that is not slow: when every stress was measured, increasing [s], and how the
  /// specimen was deformed from before the first of them until the last. Before it was at rest.
  std::vector<double> time = {};
  StrainPath path = {};
  std::string source = {};   ///< file with its SHA-256, author; may be empty
  std::string licence = {};  ///< of the data; may be empty
  /// Sums of squared residuals [Pa²] that fits of others left in this test, by names of laws.
  std::map<std::string, double> published = {};

  /// Every broken rule.
  std::vector<meshes::Violation> violations() const;
  /// Of every point and every corner of the path.
  std::vector<double> all_deformations() const;

 private:
  std::vector<meshes::Violation> time_violations() const;
};

/// The deformation of a specimen at rest: 0 in shear, else 1.
double rest_of(TestKind kind);

/// From the first time that a test tells of how its stress fades to the last [s]: of cycles, and of
/// a ramp with three stresses or more, from their mean step in time; of a relaxation
/// whose ramp was not measured, which hides what is faster, from its duration or the first stress
/// after it, whichever is later. Not for a slow course.
std::array<double, 2> observed_times(const MaterialTest& test);

/// What was done to a specimen of volume 1 m³, less what it gave back: the area within the curve of
/// nominal stress over deformation, its ends joined by a straight line [J/m³]. `stress`: at the
/// test's points, by its measure.
double loop_area(const MaterialTest& test, const std::vector<double>& stress);

/// The principal stretches of an incompressible body in a test at `deformation`, > 0 but in shear;
/// of volume 1 but in a volumetric test, J^(1/3) each.
std::array<double, 3> principal_stretches(TestKind kind, double deformation);

/// Largest logarithmic strain [1].
double strain_size(TestKind kind, double deformation);

/// Points of a test that deform the rubber in one way. What it does on one side of rest is a part
/// of its own where that goes to a tenth of all its strain.
struct TestPart {
  std::string name, way;  ///< of the test, and its side where it has both; "biaxial tension"
  DeformationMode mode = DeformationMode::shear;
  std::vector<std::size_t> points = {};
  double strain = 0.0;  ///< the largest
};
/// The further strained one first.
std::vector<TestPart> parts_of(const MaterialTest& test);

/// The smallest and largest principal stretch over all tests but volumetric ones; {1, 1} for none.
std::array<double, 2> stretch_range(const std::vector<MaterialTest>& tests);

}  // namespace fingertip::calibration::inline material_tests
