/// The smooth curve of a press: Hertz's law and its derivative, roughness, the band, files, and the
/// stiffness of a real lattice.
#include "calibration/surrogate/surrogate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "calibration/statistics/non_negative.h"
#include "lattice/press/static_press.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::calibration;

namespace {

using Samples = std::vector<SurrogateSample>;

constexpr double depth = 3e-3;  // [m]

/// Hertz: F = c d^(3/2).
double hertz(double d) {
  return 4.0 / 3.0 * 5000.0 * std::sqrt(0.01 * d) * d;
}
double hertz_slope(double d) {
  return 1.5 * hertz(d) / d;
}

Samples hertz_samples(int count, double noise = 0.0, double deviation = 0.0) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Samples samples;
  for (int i = 1; i <= count; ++i) {
    const double d = depth * i / count;
    samples.push_back({d, hertz(d) * (1.0 + noise * uniform(generator)), deviation * hertz(d)});
  }
  return samples;
}

/// Largest relative error of F' between `from` and the last sample.
double slope_error(const Surrogate& curve, double from) {
  double worst = 0.0;
  for (double d = from; d <= depth; d += 1e-5)
    worst = std::max(worst, std::abs(curve.stiffness(d) / hertz_slope(d) - 1.0));
  return worst;
}

TEST(NonNegative, MeetsTheConditionsOfALeastSquare) {
  // Kuhn and Tucker: the gradient vanishes where x > 0 and does not fall where x = 0.
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  int held = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd a =
        Eigen::MatrixXd::NullaryExpr(12, 7, [&] { return normal(generator); });
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(12, [&] { return normal(generator); });
    const Eigen::VectorXd x = non_negative_least_squares(a, b);
    const Eigen::VectorXd slope = a.transpose() * (a * x - b);
    for (int j = 0; j < 7; ++j) {
      EXPECT_GE(x(j), 0.0);
      EXPECT_GE(slope(j), -1e-11);
      EXPECT_NEAR(x(j) * slope(j), 0.0, 1e-11);
      held += x(j) == 0.0;
    }
  }
  EXPECT_GT(held, 100);
  // Where the free minimum is inside, it is the answer.
  const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3) * 2.0;
  EXPECT_NEAR((non_negative_least_squares(a, Eigen::Vector3d(2.0, 4.0, -6.0)) -
               Eigen::Vector3d(1.0, 2.0, 0.0))
                  .norm(),
              0.0, 1e-14);
}

TEST(Surrogate, RecoversHertzAndItsDerivative) {
  const Surrogate curve = fit_surrogate(hertz_samples(30), "frictionless");
  EXPECT_EQ(curve.force(0.0), 0.0);
  for (double d = 1e-4; d <= depth; d += 1e-5)
    EXPECT_NEAR(curve.force(d) / hertz(d), 1.0, d < 3e-4 ? 0.01 : 1e-3) << d;
  EXPECT_LT(slope_error(curve, 3e-4), 0.005);
  EXPECT_LT(slope_error(curve, 1e-3), 0.001);
  EXPECT_EQ(curve.depth(), depth);
}

TEST(Surrogate, IsUnitFree) {
  Samples samples = hertz_samples(20, 0.003);
  const Surrogate curve = fit_surrogate(samples);
  for (SurrogateSample& sample : samples) {
    sample.indentation *= 1e3;
    sample.force *= 1e-4;
  }
  const Surrogate other = fit_surrogate(samples);
  for (double d = 0.0; d <= depth; d += 1e-4)
    EXPECT_NEAR(other.stiffness(1e3 * d), 1e-7 * curve.stiffness(d), 1e-16 * hertz_slope(depth));
}

TEST(Surrogate, RoughnessHardlyReachesTheDerivative) {
  const Samples rough = hertz_samples(60, 0.003);
  // Differences between neighbouring samples amplify it.
  double worst = 0.0;
  for (std::size_t i = 20; i < rough.size(); ++i) {
    const double slope = (rough[i].force - rough[i - 1].force) / (depth / 60.0);
    worst = std::max(worst, std::abs(slope / hertz_slope(rough[i].indentation) - 1.0));
  }
  EXPECT_GT(worst, 0.08);
  EXPECT_LT(slope_error(fit_surrogate(rough), 1e-3), 0.01);
}

TEST(Surrogate, BandContainsTheSamplesAndTheirUncertainty) {
  const Samples samples = hertz_samples(40, 0.01, 0.05);
  const Surrogate curve = fit_surrogate(samples);
  double widest = 0.0;
  for (const SurrogateSample& sample : samples) {
    const double d = sample.indentation;
    EXPECT_GE(curve.band(d), std::abs(curve.force(d) - sample.force) + 1.95 * sample.deviation)
        << d;
    if (d > 1e-3) widest = std::max(widest, curve.band(d) / sample.force);
  }
  // 1.96 * 5 % of the force at the next knot, 1 % of roughness: not everything.
  EXPECT_LT(widest, 0.25);
  // An uncertain sample tells where.
  Samples uncertain = hertz_samples(40);
  uncertain[20].deviation = hertz(uncertain[20].indentation);
  const Surrogate local = fit_surrogate(uncertain);
  EXPECT_GT(local.band(uncertain[20].indentation), 1.95 * uncertain[20].deviation);
  EXPECT_LT(local.band(depth), 0.01 * hertz(depth));
}

TEST(Surrogate, GainsDoNotJump) {
  const Surrogate curve = fit_surrogate(hertz_samples(25, 0.003));
  const auto& knots = curve.table().knots;
  for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
    // Second derivatives from both sides, of quadratics: a one-sided difference is exact in h.
    const double h = 1e-3 * (knots[k] - knots[k - 1]);
    const auto slope = [&](double d) { return curve.stiffness(d); };
    const double at = slope(knots[k]);
    const double left =
        (3.0 * at - 4.0 * slope(knots[k] - h) + slope(knots[k] - 2.0 * h)) / (2.0 * h);
    const double right =
        (-3.0 * at + 4.0 * slope(knots[k] + h) - slope(knots[k] + 2.0 * h)) / (2.0 * h);
    EXPECT_NEAR(left, right, 1e-6 * (std::abs(left) + at / depth)) << k;
  }
}

TEST(Surrogate, GoesOnBeyondItsSamplesAsSaid) {
  const Surrogate curve = fit_surrogate(hertz_samples(20));
  EXPECT_EQ(curve.force(-1e-3), 0.0);
  EXPECT_EQ(curve.stiffness(-1e-3), 0.0);
  EXPECT_EQ(curve.band(-1e-3), 0.0);
  const double end = curve.force(depth), slope = curve.stiffness(depth);
  EXPECT_NEAR(curve.force(depth * (1.0 - 1e-9)), end, 1e-8 * end);
  EXPECT_NEAR(curve.force(2.0 * depth), end + slope * depth, 1e-12 * end);
  EXPECT_EQ(curve.stiffness(2.0 * depth), slope);
  EXPECT_GT(curve.band(2.0 * depth), curve.band(depth));
  EXPECT_TRUE(std::isnan(curve.force(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Surrogate, JsonRebuildsTheVeryCurve) {
  const TemporaryFolder folder;
  const Surrogate curve = fit_surrogate(hertz_samples(20, 0.003, 0.01), "stick, tilt 20 deg");
  write_surrogate_json(curve, folder / "surrogate.json");
  const Surrogate read = read_surrogate_json(folder / "surrogate.json");
  // A reader that knows nothing but the Hermite basis.
  const auto json = nlohmann::json::parse(read_text(folder / "surrogate.json"));
  const auto list = [&](const char* key) { return json.at(key).get<std::vector<double>>(); };
  const auto x = list("knots"), f = list("force"), s = list("stiffness");
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    for (const double t : {0.1, 0.5, 0.77}) {
      const double h = x[k + 1] - x[k], d = x[k] + t * h;
      const double value =
          f[k] * (2 * t * t * t - 3 * t * t + 1) + h * s[k] * (t * t * t - 2 * t * t + t) +
          f[k + 1] * (3 * t * t - 2 * t * t * t) + h * s[k + 1] * (t * t * t - t * t);
      EXPECT_NEAR(value, curve.force(d), 1e-12 * f.back());
      EXPECT_EQ(read.force(d), curve.force(d));
      EXPECT_EQ(read.stiffness(d), curve.stiffness(d));
      EXPECT_EQ(read.band(d), curve.band(d));
    }
  }
  EXPECT_EQ(json.at("condition"), "stick, tilt 20 deg");
  EXPECT_EQ(json.at("units").at("stiffness"), "N/m");
  EXPECT_TRUE(says(read.table().statement, "20 samples"));
}

TEST(Surrogate, CsvHoldsTheCurveAndItsBand) {
  const TemporaryFolder folder;
  const Surrogate curve = fit_surrogate(hertz_samples(20, 0.003, 0.01));
  write_surrogate_csv(curve, folder / "surrogate.csv");
  std::istringstream in(read_text(folder / "surrogate.csv"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "indentation [m],force [N],stiffness [N/m],force_lower [N],force_upper [N]");
  int rows = 0;
  for (double d, f, s, lower, upper; std::getline(in, line); ++rows) {
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &d, &f, &s, &lower, &upper), 5);
    EXPECT_EQ(f, curve.force(d));
    EXPECT_EQ(s, curve.stiffness(d));
    EXPECT_LE(lower, f);
    EXPECT_NEAR(upper - f, curve.band(d), 1e-12 * f);
  }
  EXPECT_EQ(rows, 65);
}

TEST(Surrogate, RefusesBadSamples) {
  const auto text = [](const std::function<void(Samples&)>& spoil) {
    Samples samples = hertz_samples(10);
    spoil(samples);
    return refusal([&] { fit_surrogate(samples); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(text([](Samples&) {}), "");
  EXPECT_TRUE(says(text([](Samples& s) { s.resize(4); }), "at least 5"));
  EXPECT_TRUE(says(text([](Samples& s) { s[3].indentation = s[2].indentation; }),
                   "samples[3].indentation"));
  EXPECT_TRUE(says(text([](Samples& s) { s[0].indentation = 0.0; }), "samples[0]"));
  EXPECT_TRUE(says(text([&](Samples& s) { s[5].force = nan; }), "samples[5].force"));
  EXPECT_TRUE(says(text([](Samples& s) { s[1].force = -1.0; }), "positive"));
  EXPECT_TRUE(says(text([](Samples& s) { s[1].deviation = -1.0; }), "deviation"));
}

TEST(Surrogate, RefusesBadFiles) {
  const TemporaryFolder folder;
  const auto file = folder / "surrogate.json";
  const Surrogate curve = fit_surrogate(hertz_samples(10));
  write_surrogate_json(curve, file);
  const nlohmann::json good = nlohmann::json::parse(read_text(file));
  const auto text = [&](const std::function<void(nlohmann::json&)>& spoil) {
    nlohmann::json json = good;
    spoil(json);
    write_text(file, json.dump());
    return refusal([&] { read_surrogate_json(file); });
  };
  EXPECT_EQ(text([](nlohmann::json&) {}), "");
  for (const auto& [key, value] : good.items())
    EXPECT_TRUE(says(text([name = key](nlohmann::json& j) { j.erase(name); }), file.string()))
        << key;
  using Json = nlohmann::json;
  EXPECT_TRUE(says(text([](Json& j) { j["force"].erase(3); }), "one length"));
  EXPECT_TRUE(says(text([](Json& j) { j["knots"][3] = j["knots"][2]; }), "knots[3]"));
  EXPECT_TRUE(
      says(text([](Json& j) { j["force"][3] = j["force"][2].get<double>() * 0.9; }), "fall"));
  EXPECT_TRUE(says(text([](Json& j) { j["stiffness"][5] = 1e3 * j["stiffness"][5].get<double>(); }),
                   "fall"))
      << "too steep at a knot, the cubic swings back";
  EXPECT_TRUE(says(text([](Json& j) { j["force"][0] = 1.0; }), "force[0]"));
  EXPECT_TRUE(says(text([](Json& j) { j["units"]["force"] = "gf"; }), "units"));
  EXPECT_TRUE(says(text([](Json& j) { j["band"][2] = "wide"; }), "no curve"));
  write_text(file, "{\"knots\": [");
  EXPECT_TRUE(says(refusal([&] { read_surrogate_json(file); }), "no curve"));
  EXPECT_TRUE(says(refusal([&] { read_surrogate_json(folder / "absent"); }), "cannot be read"));
}

TEST(Surrogate, IsTheStiffnessOfALattice) {
  // Of the same press at 30 depths the curve, at 60 the differences over 0.06 cm.
  lattice::PressSetup setup;
  setup.lattice.spacing = setup.geometry.tip_radius / 8.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = meshes::ContactMode::frictionless;
  for (int i = 1; i <= 60; ++i) setup.protocol.samples.push_back(depth * i / 60);
  const auto response = lattice::run_static_press(setup).response;
  const auto& dense = response.samples();
  ASSERT_EQ(dense.size(), 60U);
  Samples samples;
  for (std::size_t i = 1; i < dense.size(); i += 2)
    samples.push_back({dense[i].indentation, dense[i].normal_force, 0.0});
  const Surrogate curve = fit_surrogate(samples, "frictionless");
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 13; i + 6 < dense.size(); ++i) {
    const double from = dense[i - 6].indentation, to = dense[i + 6].indentation;
    const double slope = (dense[i + 6].normal_force - dense[i - 6].normal_force) / (to - from);
    // The curve's mean over the same step, by Simpson's rule on its stiffness.
    const double mean =
        (curve.stiffness(from) + 4.0 * curve.stiffness(0.5 * (from + to)) + curve.stiffness(to)) /
        6.0;
    EXPECT_NEAR(mean / slope, 1.0, 0.025) << dense[i].indentation;
    squares += std::pow(mean / slope - 1.0, 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.008);
}

}  // namespace
