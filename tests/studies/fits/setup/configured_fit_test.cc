#include "studies/fits/setup/configured_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "lattice/press/press_deviation.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

class SpacingOfAFit : public testing::Test {
 protected:
  /// A file of seven rows down to `depth` [mm].
  std::string measured(const std::string& name, double depth) const {
    std::ofstream csv(folder_ / name);
    csv << "indentation [mm],force [mN]\n";
    for (int i = 1; i <= 7; ++i) {
      const double x = depth * i / 7.0;
      csv << x << ',' << 30.0 * std::pow(x, 1.5) << '\n';
    }
    return (folder_ / name).string();
  }

  static FitSetup setup(const std::vector<std::string>& files,
                        const std::vector<std::string>& further = {}) {
    std::string data;
    for (const std::string& file : files) data += (data.empty() ? "\"" : ", \"") + file + '"';
    std::vector<std::string> sets = {
        "calibration.problem=experiment",       "calibration.data=[" + data + "]",
        "calibration.parameters=[\"modulus\"]", "calibration.candidates=[]",
        "rubber.poissons_ratio=0.45",           "lattice.kinematics=small",
        "press.contact=frictionless",           "lattice.tolerance=0.05"};
    sets.insert(sets.end(), further.begin(), further.end());
    return fit_setup(load_config({{}, sets, {}}));
  }

  static std::vector<double> spacings(const FitSetup& fit) {
    std::vector<double> all;
    for (const auto& curve : fit.input.curves) all.push_back(curve.press.lattice.spacing);
    return all;
  }

  const TemporaryFolder folder_;
};

}  // namespace

/// As coarse as keeps the tolerance from a fifth of the depth on: a cell fewer on the radius does
/// not.
TEST_F(SpacingOfAFit, FollowsTheDepthOfItsData) {
  for (const double depth : {0.8e-3, 1.6e-3, 3.2e-3}) {
    const FitSetup fit = setup({measured("press.csv", 1e3 * depth)});
    lattice::PressSetup press = fit.input.curves.front().press;
    const double cells = press.geometry.tip_radius / press.lattice.spacing;
    EXPECT_NEAR(cells, std::round(cells), 1e-9);
    EXPECT_EQ(fit.input.base.lattice.spacing, press.lattice.spacing);
    const double fitting = lattice::ForceEstimator(press).spacing_for(0.2 * depth, 0.05);
    EXPECT_LE(press.lattice.spacing, fitting);
    EXPECT_GT(press.geometry.tip_radius / (cells - 1.0), fitting);
  }
}

TEST_F(SpacingOfAFit, IsOneForAllItsPresses) {
  const std::string deep = measured("deep.csv", 3.0), shallow = measured("shallow.csv", 1.0);
  const double needed = spacings(setup({shallow})).front();
  ASSERT_LT(needed, spacings(setup({deep})).front());
  EXPECT_EQ(spacings(setup({deep, shallow})), std::vector(2, needed));
}

TEST_F(SpacingOfAFit, IsAsGiven) {
  const FitSetup fit = setup({measured("press.csv", 3.0)}, {"lattice.spacing=tip_radius/7"});
  const lattice::PressSetup& press = fit.input.curves.front().press;
  EXPECT_NEAR(press.geometry.tip_radius / press.lattice.spacing, 7.0, 1e-12);
}
