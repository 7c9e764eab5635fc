#include "fem_reference/verification/elastic_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "fem_reference/verification/verification.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::fem_reference;

namespace {

using meshes::Vector3;
using std::numbers::pi;

struct VolumeCase {
  const char* name;
  BodyMesh body;
  double volume;     ///< by formula
  double tolerance;  ///< relative, of quadratic elements
};

class BodyVolume : public testing::TestWithParam<VolumeCase> {};

TEST_P(BodyVolume, IsTheFormulas) {
  const auto problem =
      ElasticProblem::on(GetParam().body, {2, Volumetric::pointwise}, rubber_with(0.3));
  EXPECT_NEAR(problem->volume() / GetParam().volume, 1.0, GetParam().tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, BodyVolume,
    testing::Values(
        VolumeCase{"block",
                   {Shape::block, {1.0, 0.8, 1.2}, {0.1, 0.2, 0.3}, {3, 2, 2}, 0.25, 1},
                   0.96,
                   1e-13},
        // Its three shears keep the volume.
        VolumeCase{"curved",
                   {Shape::curved_block, {1.0, 0.8, 1.2}, Vector3::Zero(), {4, 4, 4}, 0.0, 0},
                   0.96,
                   1e-5},
        VolumeCase{"sphere",
                   {Shape::sphere_octant, {0.5, 1.0, 0.0}, Vector3::Zero(), {4, 1, 1}, 0.0, 0},
                   pi / 6 * (1.0 - 0.125),
                   1e-5},
        VolumeCase{"cylinder",
                   {Shape::cylinder_quarter, {0.5, 1.0, 0.7}, Vector3::Zero(), {2, 4, 1}, 0.0, 0},
                   pi / 4 * 0.75 * 0.7,
                   1e-4},
        VolumeCase{"disc",
                   {Shape::disc_octant, {1.0, 0.0, 0.25}, Vector3::Zero(), {4, 1, 1}, 0.0, 1},
                   pi / 4 * 0.25,
                   1e-5}),
    [](const auto& instance) { return instance.param.name; });

TEST(BodyMeshes, RefuseDivisionsThatAreNone) {
  BodyMesh block;
  block.divisions = {2, 0, 2};
  EXPECT_THROW(ElasticProblem::on(block, {}, rubber_with(0.3)), std::invalid_argument);
  BodyMesh octant;
  octant.shape = Shape::sphere_octant;
  octant.size = {0.5, 1.0, 0.0};
  octant.divisions[0] = 3;
  EXPECT_THROW(ElasticProblem::on(octant, {}, rubber_with(0.3)), std::invalid_argument);
}

TEST(ElasticProblem, WithoutSupportsIsRefused) {
  const auto problem = ElasticProblem::on({}, {1, Volumetric::pointwise}, rubber_with(0.3));
  Loading loading;
  loading.body_force = [](const Vector3& x) { return Vector3(x.y(), 0.0, 0.0); };
  EXPECT_THROW(problem->solve(loading), meshes::NotConverged);
}

/// A bar stretched along z between lubricated plates: sigma = E times strain, by hand.
TEST(ElasticProblem, StretchesABar) {
  BodyMesh bar;
  bar.size = {0.01, 0.02, 0.05};
  bar.divisions = {1, 2, 3};
  bar.distortion = 0.2;
  bar.local_refinements = 1;
  const meshes::Rubber rubber = rubber_with(0.35);
  const auto problem = ElasticProblem::on(bar, {2, Volumetric::mean_dilatation}, rubber);
  Loading loading;
  loading.prescribed = {
      {boundary::low_x, 0}, {boundary::low_y, 1}, {boundary::low_z, 2}, {boundary::high_z, 2}};
  loading.displacement = [](const Vector3& x) {
    return Vector3(0.0, 0.0, x.z() > 0.0 ? 1e-3 : 0.0);
  };
  problem->solve(loading);
  const double strain = 1e-3 / 0.05, force = rubber.youngs_modulus * strain * 0.01 * 0.02;
  EXPECT_NEAR(problem->reaction(boundary::high_z).z(), force, 1e-10 * force);
  EXPECT_NEAR(problem->reaction(boundary::low_z).z(), -force, 1e-10 * force);
  EXPECT_NEAR(problem->energy(), 0.5 * force * 1e-3, 1e-10 * force * 1e-3);
  EXPECT_NEAR(problem->mean_displacement(boundary::high_x).x(), -0.35 * strain * 0.01, 1e-14);
}

/// Under its own weight the root carries volume times density.
TEST(ElasticProblem, CarriesItsWeight) {
  BodyMesh body;
  body.shape = Shape::curved_block;
  body.divisions = {2, 2, 2};
  body.local_refinements = 1;
  const auto problem = ElasticProblem::on(body, {2, Volumetric::pointwise}, rubber_with(0.3));
  Loading loading;
  loading.prescribed = whole({boundary::low_z});
  loading.body_force = [](const Vector3&) { return Vector3(0.0, 3.0, -5.0); };
  problem->solve(loading);
  const Vector3 reaction = problem->reaction(boundary::low_z);
  EXPECT_NEAR(reaction.x(), 0.0, 1e-9);
  EXPECT_NEAR(reaction.y(), -3.0 * problem->volume(), 1e-9);
  EXPECT_NEAR(reaction.z(), 5.0 * problem->volume(), 1e-9);
}

/// Where elements of two sizes meet on a curved face, the larger one's polynomial and the smaller
/// ones' do not describe the same surface; the gap falls like h^(degree + 1), and what it does to
/// constant strain with it.
TEST(ElasticProblem, LinearFieldOnCurvedHangingNodesConverges) {
  const Loading::Field linear = [](const Vector3& x) {
    return Vector3(0.01 * x.x() + 0.004 * x.y(), 0.003 * x.z(), -0.006 * x.z() + 0.002 * x.x());
  };
  for (int degree = 1; degree <= 3; ++degree) {
    std::vector<double> errors;
    for (const int n : degree == 3 ? std::vector{2, 4} : std::vector{4, 8}) {
      BodyMesh body;
      body.shape = Shape::curved_block;
      body.divisions = {n, n, n};
      body.local_refinements = 1;
      const auto problem =
          ElasticProblem::on(body, {degree, Volumetric::pointwise}, rubber_with(0.3));
      Loading loading;
      loading.prescribed = whole({boundary::low_x, boundary::high_x, boundary::low_y,
                                  boundary::high_y, boundary::low_z, boundary::high_z});
      loading.displacement = linear;
      problem->solve(loading);
      errors.push_back(problem->nodal_error(linear));
    }
    EXPECT_GT(errors[0], 1e-9) << "degree " << degree;
    EXPECT_GT(std::log2(errors[0] / errors[1]), degree + 0.7)
        << "degree " << degree << ": " << errors[0] << ", " << errors[1];
  }
}

}  // namespace
