/// Stresses of a rubber that relaxes in homogeneous tests: against closed forms at small strain, an
/// integration of the branches in tensors, and the lattice that a press runs.
#include "calibration/material_tests/relaxing_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "calibration/material_tests/law_model.h"
#include "lattice/forces/forces.h"
#include "meshes/base/errors.h"
#include "meshes/rubber/hyperelastic_law.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Matrix3d;
using Eigen::VectorXd;
using meshes::RubberLaw;

namespace {

const Matrix3d one = Matrix3d::Identity();

VectorXd numbers_of(std::initializer_list<double> values) {
  return VectorXd::Map(values.begin(), Eigen::Index(values.size()));
}

/// A law with two branches, of 30 % at 0.05 s and 20 % at 2 s.
struct RelaxingLaw {
  LawChoice choice;
  VectorXd coefficients;
};
const RelaxingLaw relaxing_neo = {{RubberLaw::neo_hookean, 1, 2},
                                  numbers_of({20e3, 0.3, 0.05, 0.2, 2.0})},
                  relaxing_yeoh = {{RubberLaw::yeoh, 3, 2},
                                   numbers_of({10e3, 500.0, 50.0, 0.3, 0.05, 0.2, 2.0})},
                  relaxing_ogden = {{RubberLaw::ogden, 2, 2},
                                    numbers_of({16e3, 1.3, 4e3, 5.0, 0.3, 0.05, 0.2, 2.0})};
const std::array shape_tests = {TestKind::uniaxial, TestKind::equibiaxial, TestKind::planar,
                                TestKind::simple_shear};

/// Stresses at `times` while the deformation follows the path.
MaterialTest in_time(TestKind kind, StrainPath path, std::vector<double> times,
                     TestCourse course = TestCourse::cycles) {
  MaterialTest test;
  test.name = "made";
  test.kind = kind;
  test.course = course;
  for (const double time : times) test.deformation.push_back(path.at(time));
  test.stress.assign(times.size(), 1.0);
  test.time = std::move(times);
  test.path = std::move(path);
  return test;
}

VectorXd stresses(const RelaxingLaw& law, const MaterialTest& test) {
  return LawModel(test, std::vector<double>(test.stress.size(), 1.0), law.choice,
                  coefficients(law.choice))
      .evaluate(law.coefficients)
      .value;
}

std::vector<double> equal_steps(double to, int count) {
  std::vector<double> times;
  for (int i = 1; i <= count; ++i) times.push_back(to * i / count);
  return times;
}

/// Modulus of small strain over G.
double small_modulus(TestKind kind) {
  switch (kind) {
    case TestKind::uniaxial: return 3.0;
    case TestKind::equibiaxial: return 6.0;
    case TestKind::planar: return 4.0;
    default: return 1.0;
  }
}

TEST(RelaxingTest, RampAndHoldAtSmallStrainIsTheConvolution) {
  constexpr double amount = 1e-7, ramp = 0.3;
  const meshes::Relaxation relaxation =
      relaxation_of(relaxing_neo.choice, relaxing_neo.coefficients);
  for (const TestKind kind : shape_tests) {
    const double rest = rest_of(kind);
    const auto test = in_time(kind, {{1.0, 1.0 + ramp, 9.0}, {rest, rest + amount, rest + amount}},
                              {1.01, 1.1, 1.3, 1.31, 1.5, 3.0, 9.0});
    const VectorXd found = stresses(relaxing_neo, test);
    for (Eigen::Index p = 0; p < found.size(); ++p) {
      const double t = test.time[std::size_t(p)] - 1.0, on = std::min(t, ramp);
      double exact = on / ramp;
      for (std::size_t i = 0; i < 2; ++i) {
        const double tau = relaxation.branches[i].time;
        exact += relaxation.relative_modulus(i) * tau / ramp * -std::expm1(-on / tau) *
                 std::exp(-(t - on) / tau);
      }
      exact *= small_modulus(kind) * 20e3 * amount;
      EXPECT_NEAR(found(p), exact, 1e-6 * exact) << name(kind) << " " << t;
    }
  }
}

TEST(RelaxingTest, CyclesAtSmallStrainHaveStorageLossAndLoop) {
  constexpr double amount = 1e-6;
  const meshes::Relaxation relaxation =
      relaxation_of(relaxing_neo.choice, relaxing_neo.coefficients);
  for (const double frequency : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    const double period = 2.0 * std::numbers::pi / frequency;
    // In steady state after the slowest branch has forgotten the start.
    const int settling = int(std::ceil(40.0 / period)) + 1, per_cycle = 1000;
    StrainPath path;
    for (int i = 0; i <= per_cycle * (settling + 1); ++i) {
      path.time.push_back(period * i / per_cycle);
      path.deformation.push_back(1.0 + amount * std::sin(frequency * path.time.back()));
    }
    const std::vector<double> last(path.time.end() - per_cycle - 1, path.time.end());
    const MaterialTest test = in_time(TestKind::uniaxial, path, last);
    const VectorXd found = stresses(relaxing_neo, test);
    double storage = 0.0, loss = 0.0;
    for (Eigen::Index p = 0; p < per_cycle; ++p) {
      storage += 2.0 / per_cycle * found(p) * std::sin(frequency * last[std::size_t(p)]);
      loss += 2.0 / per_cycle * found(p) * std::cos(frequency * last[std::size_t(p)]);
    }
    const double scale = 60e3 * amount;
    EXPECT_NEAR(storage / scale, relaxation.storage(frequency),
                1e-5 * relaxation.storage(frequency));
    EXPECT_NEAR(loss / scale, relaxation.loss(frequency), 1e-5 * relaxation.storage(frequency));
    // pi E'' eps² of work per cycle.
    const double area = loop_area(test, {found.begin(), found.end()});
    EXPECT_NEAR(area / (std::numbers::pi * relaxation.loss(frequency) * scale * amount), 1.0, 1e-4);
    if (frequency > 10.0) break;  // as many cycles as that say nothing new
  }
}

/// The deformation of a body whose stretch (or shear) is `at`; `across` is its third stretch.
Matrix3d gradient(TestKind kind, double at, double across) {
  Matrix3d F = one;
  F(2, 2) = across;
  if (kind == TestKind::simple_shear) {
    F(0, 1) = at;
    return F;
  }
  F(0, 0) = at;
  F(1, 1) = kind == TestKind::uniaxial ? across : kind == TestKind::equibiaxial ? at : 1.0;
  return F;
}

meshes::Rubber nearly_incompressible(const RelaxingLaw& law) {
  const SizedLaw sized = sized_law(law.choice, law.coefficients);
  meshes::Rubber rubber;
  rubber.shear_modulus = sized.shear_modulus;
  rubber.youngs_modulus = 2.0 * sized.shear_modulus * (1.0 + 0.49999995);
  rubber.energy = sized.energy;
  rubber.relaxation = relaxation_of(law.choice, law.coefficients);
  rubber.retardation_time = 0.0;
  return rubber;
}

/// The third stretch at which free faces bear nothing after long times.
double free_stretch(const meshes::HyperelasticLaw& law, TestKind kind, double at) {
  double across = principal_stretches(kind, at)[kind == TestKind::simple_shear ? 1 : 2];
  for (int i = 0; i < 6; ++i) {
    constexpr double h = 1e-7;
    const auto bears = [&](double value) {
      return law.complete(gradient(kind, at, value)).stress(2, 2);
    };
    across -= bears(across) * 2.0 * h / (bears(across + h) - bears(across - h));
  }
  return across;
}

/// Back and forth through large strain, one sudden step among the ramps.
StrainPath rough_path(TestKind kind) {
  const double rest = rest_of(kind);
  return {{0.0, 0.4, 0.4, 1.0, 1.6, 2.4},
          {rest, rest + 0.6, rest + 0.7, rest + 0.7, rest - 0.3, rest + 0.4}};
}

/// Stress along the test and across its free faces, at the points of `test`.
struct LatticeStresses {
  VectorXd along, across;
};

/// The cells of a press go through the deformations of `test` in so many steps.
LatticeStresses lattice_stresses(const RelaxingLaw& law, const MaterialTest& test, int steps) {
  const meshes::Rubber rubber = nearly_incompressible(law);
  const lattice::LatticeModel model = fixtures::cell_block(
      fixtures::settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, 10),
      {2, 2, 2}, rubber);
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  lattice::RelaxingMemory memory(model);
  lattice::VectorField force(model.points());
  const double volume = std::pow(2 * model.spacing(), 3);
  const meshes::HyperelasticLaw point(rubber);
  const auto go = [&](double at, double time) {
    const Matrix3d H = gradient(test.kind, at, free_stretch(point, test.kind, at)) - one;
    lattice::State state(model);
    for (const std::size_t i : model.particles)
      state.displacement.set(i, H * model.rest_position(i));
    forces.note(state, time, memory, force);
  };
  const auto stress = [&](int i, int j) {
    double sum = 0.0;
    for (const std::size_t p : model.particles) sum -= force.at(p)(i) * model.rest_position(p)(j);
    return sum / volume;
  };
  const Eigen::Index count = Eigen::Index(test.time.size());
  LatticeStresses result{VectorXd(count), VectorXd(count)};
  Eigen::Index next = 0;
  for (int n = 1; n <= steps; ++n) {
    const double time = test.path.time.back() * n / steps;
    go(test.path.at(time), time);
    if (next == count || std::abs(time - test.time[std::size_t(next)]) > 1e-9) continue;
    result.along(next) = stress(0, test.kind == TestKind::simple_shear ? 1 : 0);
    result.across(next++) = stress(2, 2);
  }
  EXPECT_EQ(next, count);
  return result;
}

/// Free faces bear nothing at any time, and the others what the course says. The lattice takes the
/// rate of the stress for constant in a step, an error of second order, which is extrapolated away;
/// steps are long enough for it to note every one.
TEST(RelaxingTest, IsTheLatticeOfAPressAtLargeStrain) {
  for (const RelaxingLaw& law : {relaxing_neo, relaxing_yeoh, relaxing_ogden})
    for (const TestKind kind : shape_tests) {
      const double rest = rest_of(kind);
      const MaterialTest test = in_time(
          kind, {{0.0, 0.4, 1.0, 1.6, 2.4}, {rest, rest + 0.7, rest + 0.7, rest - 0.3, rest + 0.4}},
          {0.2, 0.4, 0.7, 1.0, 1.3, 1.6, 2.0, 2.4});
      const VectorXd expected = stresses(law, test);
      const double scale = expected.cwiseAbs().maxCoeff();
      const LatticeStresses coarse = lattice_stresses(law, test, 600),
                            fine = lattice_stresses(law, test, 1200);
      const VectorXd found = fine.along + (fine.along - coarse.along) / 3.0;
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * scale)
          << name(law.choice) << " " << name(kind);
      EXPECT_LT((fine.along - expected).cwiseAbs().maxCoeff(), 3e-5 * scale);
      EXPECT_LT(fine.across.cwiseAbs().maxCoeff(), 1e-7 * scale) << name(kind);
    }
}

/// h' + h/tau = S' of an incompressible Mooney-Rivlin body in tensors, by the trapezoidal rule in
/// so many steps; p follows from the free face at every time.
double integrated(TestKind kind, const StrainPath& path, double until, int steps) {
  constexpr double c10 = 8e3, c01 = 2e3;
  const std::array<std::array<double, 2>, 2> branches = {{{0.6, 0.05}, {0.4, 2.0}}};  // b, tau
  const auto lasting = [&](double at) {
    Matrix3d F = gradient(kind, at, 1.0);
    F(2, 2) = 1.0;
    const double across = 1.0 / F.determinant();
    F = gradient(kind, at, kind == TestKind::uniaxial ? std::sqrt(1.0 / at) : across);
    const Matrix3d C = F.transpose() * F, inverse = C.inverse();
    const Matrix3d S = 2.0 * (c10 + c01 * C.trace()) * one - 2.0 * c01 * C;
    return Matrix3d(S - S(2, 2) / inverse(2, 2) * inverse);
  };
  std::array<Matrix3d, 2> h = {Matrix3d::Zero(), Matrix3d::Zero()};
  Matrix3d S = Matrix3d::Zero();
  for (int n = 1; n <= steps; ++n) {
    const double time = until * n / steps, dt = until / steps;
    const Matrix3d now = lasting(path.at(time));
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = 0.5 * dt / branches[i][1];
      h[i] = (h[i] * (1.0 - x) + (now - S)) / (1.0 + x);
    }
    S = now;
  }
  const double across = kind == TestKind::uniaxial ? std::sqrt(1.0 / path.at(until)) : 1.0;
  const Matrix3d P =
      gradient(kind, path.at(until), across) * (S + branches[0][0] * h[0] + branches[1][0] * h[1]);
  return P(0, kind == TestKind::simple_shear ? 1 : 0);
}

TEST(RelaxingTest, IsTheEquationOfTheBranchesWrittenOut) {
  const RelaxingLaw law = {{RubberLaw::mooney_rivlin, 1, 2},
                           numbers_of({8e3, 2e3, 0.3, 0.05, 0.2, 2.0})};
  for (const TestKind kind : shape_tests) {
    const double rest = rest_of(kind);
    const StrainPath path = {{0.0, 0.5, 0.9, 1.0}, {rest, rest + 1.2, rest - 0.2, rest + 0.1}};
    const auto test = in_time(kind, path, {0.3, 0.5, 0.8, 1.0});
    const VectorXd found = stresses(law, test);
    for (Eigen::Index p = 0; p < found.size(); ++p) {
      const double until = test.time[std::size_t(p)];
      // The trapezoidal rule's own error, extrapolated away.
      const double coarse = integrated(kind, path, until, 4000),
                   fine = integrated(kind, path, until, 8000);
      EXPECT_NEAR(found(p), fine + (fine - coarse) / 3.0, 2e-7 * found.cwiseAbs().maxCoeff())
          << name(kind) << " " << until;
    }
  }
}

TEST(RelaxingTest, DerivativesAreThoseOfDifferences) {
  for (const RelaxingLaw& law : {relaxing_neo, relaxing_yeoh, relaxing_ogden})
    for (const TestKind kind : {TestKind::uniaxial, TestKind::simple_shear}) {
      MaterialTest test = in_time(kind, rough_path(kind), equal_steps(2.4, 12));
      test.measure = StressMeasure::cauchy;
      LawModel model(test, std::vector<double>(12, 2.0), law.choice, coefficients(law.choice));
      const CurveSlopes at = model.evaluate(law.coefficients);
      for (Eigen::Index i = 0; i < law.coefficients.size(); ++i) {
        const double h = 1e-5 * law.coefficients(i);
        const VectorXd step = h * VectorXd::Unit(law.coefficients.size(), i);
        const VectorXd slope = (model.evaluate(law.coefficients + step).value -
                                model.evaluate(law.coefficients - step).value) /
                               (2.0 * h);
        EXPECT_LT((slope - at.jacobian.col(i)).norm(),
                  1e-7 * slope.norm() + 1e-9 * at.value.norm() / law.coefficients(i))
            << name(law.choice) << " " << i;
      }
    }
}

/// A slow test with a rate is the same test in time; without one it is that after long times.
TEST(RelaxingTest, ASlowTestCountsAtItsRate) {
  MaterialTest slow;
  slow.name = "slow";
  slow.deformation = {0.7, 0.9, 1.0, 1.2, 1.8};
  slow.stress.assign(5, 1.0);
  const VectorXd lasting = stresses(relaxing_yeoh, slow);
  slow.rate = 0.5;
  const VectorXd found = stresses(relaxing_yeoh, slow);
  const auto pulled = in_time(TestKind::uniaxial, {{0.0, 1.6}, {1.0, 1.8}}, {0.4, 1.6}),
             pressed = in_time(TestKind::uniaxial, {{0.0, 0.6}, {1.0, 0.7}}, {0.2, 0.6});
  const VectorXd up = stresses(relaxing_yeoh, pulled), down = stresses(relaxing_yeoh, pressed);
  EXPECT_NEAR(found(3), up(0), 1e-9 * up(0));
  EXPECT_NEAR(found(4), up(1), 1e-9 * up(1));
  EXPECT_NEAR(found(1), down(0), -1e-9 * down(0));
  EXPECT_NEAR(found(0), down(1), -1e-9 * down(1));
  EXPECT_EQ(found(2), 0.0);
  EXPECT_GT(found(4), 1.05 * lasting(4));
  // So slowly that nothing is left of the branches, and so fast that nothing has faded.
  slow.rate = 1e-7;
  EXPECT_LT((stresses(relaxing_yeoh, slow) - lasting).norm(), 1e-5 * lasting.norm());
  slow.rate = 1e7;
  EXPECT_LT((stresses(relaxing_yeoh, slow) - 2.0 * lasting).norm(), 1e-5 * lasting.norm());
}

TEST(RelaxingTest, RefusesWhatIsNoTest) {
  const auto rule_of = [](const MaterialTest& test) {
    const auto found = test.violations();
    return found.empty() ? std::string() : found.front().rule;
  };
  const MaterialTest good = in_time(TestKind::uniaxial, {{0.0, 1.0}, {1.0, 1.5}}, {0.2, 0.5, 1.0});
  EXPECT_EQ(rule_of(good), "");
  MaterialTest bad = good;
  std::swap(bad.time[0], bad.time[1]);
  EXPECT_NE(rule_of(bad).find("times must be finite and increase"), std::string::npos);
  bad = good;
  bad.time.back() = 2.0;
  EXPECT_NE(rule_of(bad).find("must be known as long as"), std::string::npos);
  bad = good;
  bad.time.pop_back();
  EXPECT_NE(rule_of(bad).find("every stress has its time"), std::string::npos);
  bad = good;
  for (const double stretch : {-0.5, 1e-308, 21.0}) {
    bad.path.deformation.back() = stretch;
    EXPECT_NE(rule_of(bad).find("a stretch is positive"), std::string::npos);
  }
  bad = good;
  bad.kind = TestKind::volumetric;
  EXPECT_NE(rule_of(bad).find("in equilibrium alone"), std::string::npos);
  bad = good;
  bad.path.deformation = {1.0, 1.0};
  bad.deformation = {1.0, 1.0, 1.0};
  EXPECT_NE(rule_of(bad).find("never deformed"), std::string::npos);
  LawModel model(good, {1.0, 1.0, 1.0}, relaxing_neo.choice, coefficients(relaxing_neo.choice));
  EXPECT_THROW(model.evaluate(numbers_of({1e4, 0.6, 0.1, 0.4, 1.0})), meshes::NotConverged);
}

}  // namespace
