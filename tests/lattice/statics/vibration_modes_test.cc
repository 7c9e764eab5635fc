#include "lattice/statics/vibration_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "body_sums.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/mode_motion.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"

using namespace fingertip;
using namespace body_sums;
using Eigen::MatrixXd;
using lattice::Kinematics;
using lattice::LatticeSettings;
using lattice::ModelKind;
using lattice::vibration_modes;
using lattice::VibrationMode;

namespace {

using Modes = std::vector<VibrationMode>;

constexpr double pi = std::numbers::pi;

LatticeSettings settings_for(double spacing, ModelKind model = ModelKind::hookean,
                             Kinematics kinematics = Kinematics::small) {
  LatticeSettings settings;
  settings.model = model;
  settings.kinematics = kinematics;
  settings.spacing = spacing;
  settings.constants = lattice::hookean_constants({}, spacing);
  return settings;
}

LatticeBody block(double spacing, const std::array<int, 3>& cells) {
  return build_free_block({}, settings_for(spacing), cells);
}

VectorXd masses(const LatticeBody& body) {
  return VectorXd::NullaryExpr(body.unknowns(),
                               [&](Eigen::Index i) { return body.mass[std::size_t(i / 3)]; });
}

double square(const VibrationMode& mode) {
  return std::pow(2.0 * pi * mode.frequency, 2);
}

/// Whole default tip at R/8: 4646 particles, about a second.
struct WholeTip {
  LatticeBody body = build_cut_tip({}, {}, settings_for(0.01 / 8.0), 1);
  Modes modes = vibration_modes(body, 10);
};

const WholeTip& whole_tip() {
  static const WholeTip tip;
  return tip;
}

/// From the nearest mode: there are others, in which the column's edges slide past one another.
double distance(const Modes& modes, double frequency) {
  double least = frequency;
  for (const VibrationMode& mode : modes)
    least = std::min(least, std::abs(mode.frequency - frequency));
  return least;
}

/// A column of `cells` cells, `height` tall, whose lowest layer is held and which moves along
/// `component` only.
LatticeBody column(double height, int cells, int component) {
  LatticeBody body = block(height / cells, {1, 1, cells});
  for (std::size_t p = 0; p < body.rest.size(); ++p)
    for (int i = 0; i < 3; ++i)
      body.fixed[3 * p + std::size_t(i)] = i != component || body.rest[p].z() < 1e-9;
  return body;
}

}  // namespace

/// By dense matrices, on bodies small enough, bond ties and mirror planes among them.
TEST(VibrationModes, AreThoseOfADenseSolver) {
  LatticeBody held = block(1e-3, {2, 2, 3});
  for (std::size_t p = 0; p < 9; ++p)
    for (std::size_t i = 0; i < 3; ++i) held.fixed[3 * p + i] = 1;
  LatticeBody tip = build_cut_tip({}, {}, settings_for(0.01 / 4.0), 4);
  for (const LatticeBody& body : {held, tip}) {
    MatrixXd K = stiffness(body);
    for (const EmbeddedPoint& point : body.bond)
      for (std::size_t c = 0; c < 8; ++c)
        for (std::size_t d = 0; d < 8; ++d)
          K.block<3, 3>(3 * point.corners[c], 3 * point.corners[d]) +=
              point.stiffness * point.weights[c] * point.weights[d] * Matrix3d::Identity();
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < K.rows(); ++i)
      if (!body.fixed[std::size_t(i)]) free.push_back(i);
    const VectorXd scale = masses(body).cwiseSqrt().cwiseInverse();
    const MatrixXd A = (scale.asDiagonal() * K * scale.asDiagonal())(free, free);
    const VectorXd expected = Eigen::SelfAdjointEigenSolver<MatrixXd>(A).eigenvalues();
    const Modes modes = vibration_modes(body, 30);
    ASSERT_EQ(modes.size(), 30u);
    // The dense solver's own error is round-off of the largest eigenvalue, that of slivers.
    const double error = 1e-14 * expected[expected.size() - 1];
    for (int i = 0; i < 30; ++i)
      EXPECT_NEAR(square(modes[std::size_t(i)]), expected[i], 1e-8 * expected[i] + error) << i;
  }
}

TEST(VibrationModes, AFreeBlockHasSixRigidMotions) {
  const LatticeBody body = block(1e-3, {3, 4, 5});
  const Modes modes = vibration_modes(body, 8);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT(modes[i].frequency, 1e-5 * modes[6].frequency) << i;
    EXPECT_LT(elastic_energy(body, modes[i].shape), 1e-10 * elastic_energy(body, modes[6].shape));
  }
  // A free block of this size cannot be slower than half a bar's wave, by orders of magnitude.
  EXPECT_GT(modes[6].frequency, 0.1 * meshes::Rubber{}.shear_wave_speed() / (2 * 5e-3));
}

/// One unknown per layer: a chain of masses m, half of one at the free end, and springs k obeys
/// omega_j = 2 sqrt(k/m) sin((2j - 1) pi a / (4h)), sqrt(k/m) = c/a (von Kármán & Biot,
/// Mathematical Methods in Engineering, ch. XI), which tends to the bar's (2j - 1) c / (4h).
TEST(VibrationModes, AHeldColumnFollowsTheChainAndTendsToTheBar) {
  const double height = 0.01;
  const meshes::Rubber rubber;
  // c_p along the column; across it, layers that shear.
  for (const int component : {2, 0}) {
    SCOPED_TRACE(component);
    const double speed =
        component == 2 ? rubber.longitudinal_wave_speed() : rubber.shear_wave_speed();
    std::vector<double> errors;
    for (const int cells : {4, 8, 16}) {
      const Modes modes = vibration_modes(column(height, cells, component), 15);
      for (int j = 1; j <= 2; ++j) {
        const double angle = (2 * j - 1) * pi / (4.0 * cells);
        const double chain = 2.0 * speed * cells / height * std::sin(angle) / (2.0 * pi);
        EXPECT_LT(distance(modes, chain), 1e-9 * chain);
      }
      errors.push_back(modes[0].frequency * 4.0 * height / speed - 1.0);
    }
    EXPECT_LT(std::abs(errors[2]), 5e-4);
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.1);
    EXPECT_NEAR(errors[1] / errors[2], 4.0, 0.1);
  }
}

/// The continuum by fem_reference (analysis "modes", two meshes, estimated error below 0.3 %). None
/// is missing, none in between, although some corners of slivers weigh 1e-7 of a cell.
TEST(VibrationModes, TheTipVibratesLikeTheContinuum) {
  const std::array<double, 10> continuum{49.175, 54.139, 54.139, 62.565, 67.206,
                                         69.256, 69.256, 75.590, 75.590, 81.041};
  const Modes& modes = whole_tip().modes;
  ASSERT_GE(modes.size(), continuum.size());
  for (std::size_t i = 0; i < continuum.size(); ++i)
    EXPECT_NEAR(modes[i].frequency, continuum[i], 0.01 * continuum[i]) << i;
}

/// x and y are alike, so modes odd around the axis come in pairs: the solver must find both.
TEST(VibrationModes, PairsOfTheTipAreEqual) {
  const Modes& modes = whole_tip().modes;
  for (const std::size_t i : {1u, 5u, 7u})
    EXPECT_NEAR(modes[i].frequency, modes[i + 1].frequency, 1e-8 * modes[i].frequency) << i;
}

TEST(VibrationModes, ShapesAreOrthonormalAndCarryTheirEnergy) {
  const auto& [body, modes] = whole_tip();
  ASSERT_GE(modes.size(), 10U);
  const VectorXd mass = masses(body);
  for (const VibrationMode& x : modes) {
    for (const VibrationMode& y : modes)
      EXPECT_NEAR(x.shape.dot(mass.cwiseProduct(y.shape)), &x == &y ? 1.0 : 0.0, 1e-8);
    const double energy = elastic_energy(body, x.shape) + bond_energy(body, x.shape);
    EXPECT_NEAR(2.0 * energy, square(x), 1e-8 * square(x));
  }
}

/// Mirror planes keep what is symmetric about both.
/// The field u(X) as a shape: normalised, x' M x = 1.
template <typename Field>
VectorXd shape_of(const LatticeBody& body, const Field& field) {
  VectorXd shape(body.unknowns());
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    shape.segment<3>(3 * Eigen::Index(i)) = field(body.rest[i]);
  return shape / std::sqrt(shape.dot(masses(body).cwiseProduct(shape)));
}

TEST(ModeMotion, NamesFieldsOfKnownMotion) {
  const LatticeBody& body = whole_tip().body;
  using meshes::Vector3;
  const auto motion = [&](const auto& field) {
    return lattice::motion_of(body, shape_of(body, field), 0.01 / 8.0);
  };
  const auto shift = motion([](const Vector3&) { return Vector3(0.6, 0.8, 0.0); });
  EXPECT_NEAR(shift.effective_mass.x(), 0.36, 1e-9);
  EXPECT_NEAR(shift.effective_mass.y(), 0.64, 1e-9);
  EXPECT_EQ(lattice::description(shift), "sideways");
  const auto lift = motion([](const Vector3&) { return Vector3(0.0, 0.0, 2.0); });
  EXPECT_NEAR(lift.effective_mass.z(), 1.0, 1e-9);
  EXPECT_EQ(lattice::description(lift), "along the axis");
  const auto turn = motion([](const Vector3& x) { return Vector3(-x.y(), x.x(), 0.0); });
  EXPECT_NEAR(turn.effective_inertia, 1.0, 1e-9);
  EXPECT_NEAR(turn.circumferential, 1.0, 1e-9);
  EXPECT_EQ(lattice::description(turn), "torsion");
  const auto swell = motion([](const Vector3& x) { return Vector3(x.x(), x.y(), 0.0); });
  EXPECT_NEAR(swell.radial, 1.0, 1e-9);
  EXPECT_EQ(lattice::description(swell), "breathing");
  // cos 2 phi, about axes of any direction, and cos 3 phi
  for (const double angle : {0.0, 0.3, pi / 4.0}) {
    const auto oval = motion([angle](const Vector3& x) {
      const double c = std::cos(angle), s = std::sin(angle);
      return Vector3(c * x.x() + s * x.y(), s * x.x() - c * x.y(), 0.0);
    });
    EXPECT_EQ(lattice::description(oval), "2 waves around the axis") << angle;
    EXPECT_LT(oval.effective_mass.sum() + oval.effective_inertia, 1e-9);
  }
  const auto three = motion([](const Vector3& x) {
    const double phi = std::atan2(x.y(), x.x());
    return Vector3(0.0, 0.0, std::hypot(x.x(), x.y()) * std::cos(3.0 * phi));
  });
  EXPECT_EQ(lattice::description(three), "3 waves around the axis");
}

TEST(ModeMotion, OfTheTipIsTorsionAndAPairSidewaysFirst) {
  const auto& [body, modes] = whole_tip();
  Eigen::Vector3d mass = Eigen::Vector3d::Zero();
  std::vector<std::string> words;
  double inertia = 0.0;
  for (const VibrationMode& mode : modes) {
    const auto motion = lattice::motion_of(body, mode.shape, 0.01 / 8.0);
    EXPECT_NEAR(motion.radial + motion.circumferential + motion.axial, 1.0, 1e-9);
    words.push_back(lattice::description(motion));
    mass += motion.effective_mass;
    inertia += motion.effective_inertia;
  }
  // Shares of one whole; x and y are alike, and the lowest modes carry most of it.
  EXPECT_LE(mass.maxCoeff(), 1.0);
  EXPECT_LE(inertia, 1.0);
  EXPECT_NEAR(mass.x(), mass.y(), 1e-6);
  EXPECT_GT(mass.minCoeff(), 0.4);
  EXPECT_GT(inertia, 0.5);
  EXPECT_EQ(std::ranges::count(words.begin(), words.begin() + 4, "torsion"), 2);
  EXPECT_EQ(std::ranges::count(words.begin(), words.begin() + 4, "sideways"), 2);
  EXPECT_GE(std::ranges::count(words, "along the axis"), 1);
}

TEST(VibrationModes, OfAQuarterAreAmongThoseOfTheWhole) {
  const LatticeBody quarter = build_cut_tip({}, {}, settings_for(0.01 / 8.0), 4);
  const Modes symmetric = vibration_modes(quarter, 2);
  const Modes& all = whole_tip().modes;
  EXPECT_NEAR(symmetric[0].frequency, all[4].frequency, 1e-8 * all[4].frequency);
  EXPECT_GE(symmetric[1].frequency, all[9].frequency * (1.0 - 1e-8));
  for (Eigen::Index i = 0; i < quarter.unknowns(); ++i) {
    if (quarter.fixed[std::size_t(i)]) {
      EXPECT_EQ(symmetric[0].shape[i], 0.0);
    }
  }
}

/// The network's tangent at rest is Hooke's law.
TEST(VibrationModes, OfTheNetworkAtRestAreThoseOfHooke) {
  const double spacing = 0.01 / 5.0;
  const LatticeBody network =
      build_cut_tip({}, {}, settings_for(spacing, ModelKind::network, Kinematics::finite), 4);
  const LatticeBody hooke = build_cut_tip({}, {}, settings_for(spacing), 4);
  const Modes expected = vibration_modes(hooke, 5), modes = vibration_modes(network, 5);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(modes[i].frequency, expected[i].frequency, 1e-8 * expected[i].frequency);
}

TEST(VibrationModes, StopWhenAsked) {
  const LatticeBody body = block(0.001, {3, 3, 3});
  int asked = 0;
  EXPECT_THROW(vibration_modes(body, 8, [&] { return ++asked == 5; }), meshes::Interrupted);
  EXPECT_EQ(asked, 5);
}

TEST(VibrationModes, RefuseWhatCannotVibrate) {
  LatticeBody body = block(1e-3, {1, 1, 1});
  EXPECT_EQ(vibration_modes(body, 23).size(), 23u);
  EXPECT_THROW_SAYING(vibration_modes(body, 0), meshes::InvalidInput, "modes");
  EXPECT_THROW_SAYING(vibration_modes(body, 24), meshes::InvalidInput, "modes");
  body.mass[3] = 0.0;
  EXPECT_THROW_SAYING(vibration_modes(body, 6), meshes::InvalidInput, "rubber.density");
  LatticeBody compressed = block(1e-3, {2, 2, 2});
  for (auto& fibre : compressed.fibres) fibre.stiffness *= -10.0;
  EXPECT_THROW(vibration_modes(compressed, 6), meshes::NotConverged);
}
