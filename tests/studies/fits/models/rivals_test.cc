/// A press that is not as it is told: forces of one lattice, fitted by another.
#include "studies/fits/models/rivals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "calibration/files/fit_file.h"
#include "lattice/press/static_press.h"
#include "studies/config/loader.h"
#include "studies/files/json_entry.h"
#include "studies/files/read_fields.h"
#include "studies/fits/runs/fit_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/presses/press_setup.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::FitFile;

namespace {

using Settings = std::vector<std::string>;

/// A layer of 5 mm, pressed to two fifths of it.
const Settings common = {"press.mode=static", "lattice.model=network",
                         "lattice.spacing=tip_radius/6", "rubber.poissons_ratio=0.45"};
const Settings as_told = {"press.contact=frictionless", "geometry.rod_radius=5 mm"};

Settings joined(const Settings& first, const Settings& second) {
  Settings all = first;
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

class Rivals : public testing::Test {
 protected:
  /// The fit of a press with these settings, told as `as_told` and `further` say: touch at 0.4 mm,
  /// rows before it, noise of 0.1 % of the largest force.
  FitFile fit(const Settings& truth, const Settings& further = {}) {
    constexpr int rows = 20;
    constexpr double touch = 0.4e-3, deepest = 2e-3;
    lattice::PressSetup press = press_setup(
        load_config({{}, joined(joined(common, truth), {"rubber.youngs_modulus=100 kPa"}), {}}));
    press.protocol.samples.clear();
    for (int i = 1; i <= rows; ++i) press.protocol.samples.push_back(deepest * i / rows);
    press.protocol.depth = deepest;
    const auto samples = lattice::run_static_press(press).response.samples();
    const double largest = samples.back().normal_force;
    std::mt19937 random{3};
    std::normal_distribution<double> noise(0.0, 0.001 * largest);
    const std::string file = (folder_ / "press.csv").string();
    std::ofstream csv(file);
    csv.precision(12);
    csv << "position [m];force [N]\n";
    for (int i = 0; i < 10; ++i) csv << touch * i / 10 << ';' << noise(random) << '\n';
    for (const auto& sample : samples)
      csv << touch + sample.indentation << ';' << sample.normal_force + noise(random) << '\n';
    csv.close();
    const Settings order = {"calibration.problem=experiment",
                            "calibration.data=[\"" + file + "\"]",
                            "calibration.parameters=[\"modulus\"]",
                            "calibration.candidates=[]",
                            "calibration.bias=false",
                            "calibration.forward=lattice"};
    const FitSetup setup =
        fit_setup(load_config({{}, joined(joined(common, as_told), joined(order, further)), {}}));
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    const std::filesystem::path run = folder_ / "run";
    std::filesystem::remove_all(run);
    std::filesystem::create_directories(run);
    fit_job(setup.input).run(run, context);
    return struct_of<FitFile>(read_entry(run / "calibration.json"));
  }

  static std::vector<std::string> names(const FitFile& fit) {
    std::vector<std::string> names;
    for (const calibration::RivalEntry& each : fit.rivals) names.push_back(each.name);
    return names;
  }

  const TemporaryFolder folder_;
};

}  // namespace

TEST_F(Rivals, APressAsToldHasNone) {
  const FitFile found = fit(as_told);
  EXPECT_TRUE(found.rivals.empty()) << testing::PrintToString(names(found));
  EXPECT_TRUE(found.failed.empty()) << testing::PrintToString(found.failed);
  EXPECT_LT(found.parameters[0].lower, 1e5);
  EXPECT_GT(found.parameters[0].upper, 1e5);
}

/// The layer is 3.5 mm thick, not 5: so thin a one stiffens far more, which touch and zero hide
/// but for a little. By the radius that is told E comes out twice as large as it is.
TEST_F(Rivals, AWrongRadiusIsInTheInterval) {
  const FitFile found = fit({"press.contact=frictionless", "geometry.rod_radius=6.5 mm"});
  const auto radius = std::ranges::find(found.rivals, "rod_radius", &calibration::RivalEntry::name);
  ASSERT_NE(radius, found.rivals.end()) << found.statement;
  EXPECT_EQ(radius->told, "0.005 m");
  EXPECT_EQ(radius->instead, "0.00625 m");
  EXPECT_GT(found.parameters[0].estimate, 1.5e5);
  EXPECT_LE(found.parameters[0].lower, radius->parameters[0].lower);
  EXPECT_LT(found.parameters[0].lower, 1e5);
  EXPECT_TRUE(says(found.statement,
                   {"They leave open rod_radius = 0.005 m: with 0.00625 m", "the intervals cover"}))
      << found.statement;
}

/// Where its owner tells how well a radius is known that is not in doubt.
TEST_F(Rivals, ANumberWithAToleranceIsNoRival) {
  const FitFile found = fit({"press.contact=frictionless", "geometry.rod_radius=6.5 mm"},
                            {"calibration.tolerances={rod_radius=\"0.1 mm\"}"});
  EXPECT_EQ(std::ranges::count(found.rivals, "rod_radius", &calibration::RivalEntry::name), 0);
}
