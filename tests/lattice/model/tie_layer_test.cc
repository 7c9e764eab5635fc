#include "lattice/model/tie_layer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "lattice/model/cut_tip.h"

using namespace fingertip;
using lattice::TieLaw;
using meshes::RubberLaw;
using Push = lattice::kernel::TiePush<double>;

namespace {

constexpr double spacing = 1e-3;
const double thickness = 3.0 * spacing / lattice::tie_stiffness;
const double deepest = lattice::layer_depth * thickness;

/// Push over the stiffness at rest of a layer of an incompressible rubber, by its closed form
/// 2 (l - 1/l²) W'(I1) over 3 G = 6 W'(3).
double layer(double slope_over_rest, double depth) {
  const double stretch = 1.0 - depth / thickness;
  return thickness * slope_over_rest * (1.0 / (stretch * stretch) - stretch) / 3.0;
}
double push(const TieLaw& law, double depth) {
  return Push(law, depth).length;
}

}  // namespace

TEST(TieLaw, IsLinearUnlessToldOtherwise) {
  for (const double depth : {0.0, 1e-9, 0.1, 1e9}) {
    const Push tie(TieLaw{}, depth);
    EXPECT_EQ(tie.length, depth);
    EXPECT_EQ(tie.tangent, 1.0);
    EXPECT_EQ(tie.energy, 0.5 * depth * depth);
  }
}

TEST(TieLaw, PushAndTangentAreDerivativesOfAConvexEnergy) {
  const TieLaw law = lattice::layer_law({}, spacing);
  double before = 1.0;
  for (const double share : {0.01, 0.3, 0.9, 0.999, 1.001, 1.5, 20.0}) {
    const double depth = share * deepest, step = 1e-5 * deepest;
    const Push at(law, depth), more(law, depth + step), less(law, depth - step);
    EXPECT_NEAR(at.length, (more.energy - less.energy) / (2.0 * step), 1e-7 * at.length) << share;
    EXPECT_NEAR(at.tangent, (more.length - less.length) / (2.0 * step), 1e-7 * at.tangent) << share;
    EXPECT_GE(at.tangent, before);
    before = at.tangent;
  }
  EXPECT_NEAR(before, 5.0, 1e-12);
}

/// Closed forms of laws of I1; x = I1 - 3 = 5/4 at half the thickness.
TEST(LayerLaw, PushesLikeALayerOfTheRubber) {
  const TieLaw neo_hookean = lattice::layer_law({}, spacing);
  EXPECT_NEAR(push(neo_hookean, deepest), layer(1.0, deepest), 1e-12 * deepest);
  for (int i = 1; i < 100; ++i) {
    const double depth = 0.01 * i * deepest, exact = layer(1.0, depth);
    EXPECT_NEAR(push(neo_hookean, depth), exact, 0.06 * exact) << i;
  }
  const double x = 1.25;
  const TieLaw yeoh = lattice::layer_law({.law = RubberLaw::yeoh, .shape = {0.05, 0.005}}, spacing);
  EXPECT_NEAR(push(yeoh, deepest), layer(1.0 + 4.0 * 0.05 * x + 6.0 * 0.005 * x * x, deepest),
              1e-12 * deepest);
  const TieLaw gent = lattice::layer_law({.law = RubberLaw::gent, .shape = {10.0}}, spacing);
  EXPECT_NEAR(push(gent, deepest), layer(1.0 / (1.0 - x / 10.0), deepest), 1e-12 * deepest);
  // Ogden's mu, 2 is neo-Hooke's law.
  const TieLaw ogden = lattice::layer_law({.law = RubberLaw::ogden, .shape = {1.0, 2.0}}, spacing);
  EXPECT_NEAR(push(ogden, deepest), push(neo_hookean, deepest), 1e-12 * deepest);
  // Mooney-Rivlin: 2 (l - 1/l²) (C10 + C01/l), C10 + C01 = G/2.
  const TieLaw mooney =
      lattice::layer_law({.law = RubberLaw::mooney_rivlin, .shape = {0.3}}, spacing);
  EXPECT_NEAR(push(mooney, deepest), layer(0.7 + 0.3 / 0.5, deepest), 1e-12 * deepest);
}

/// Also where the rubber's limit is nearer than half the layer's thickness.
TEST(LayerLaw, IsNeverStifferThanTheLatticeBears) {
  for (const double limit : {0.1, 1.2, 1.26, 1.5}) {
    const TieLaw law = lattice::layer_law({.law = RubberLaw::gent, .shape = {limit}}, spacing);
    EXPECT_NEAR(Push(law, 10.0 * deepest).tangent, lattice::stiffest_tie, 1e-12) << limit;
  }
}

/// Ties of the network at large strain stiffen, those of all others are linear.
TEST(LayerLaw, IsThatOfTheNetworkAtLargeStrain) {
  using lattice::Kinematics, lattice::ModelKind;
  for (const ModelKind model : {ModelKind::central, ModelKind::hookean, ModelKind::network}) {
    for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
      const meshes::Rubber rubber;
      lattice::LatticeSettings settings;
      settings.model = model;
      settings.kinematics = kinematics;
      settings.spacing = meshes::Geometry{}.tip_radius / 6;
      settings.constants = lattice::hookean_constants(rubber, settings.spacing);
      const TieLaw law = lattice::cut_tip({}, rubber, settings, 4).contact;
      const bool stiffens = model == ModelKind::network && kinematics == Kinematics::finite;
      EXPECT_EQ(law.growth,
                stiffens ? lattice::layer_law(rubber.energy, settings.spacing).growth : 0.0);
      EXPECT_EQ(law.growth > 0.0, stiffens);
    }
  }
}
