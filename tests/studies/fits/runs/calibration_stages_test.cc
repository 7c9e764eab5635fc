/// A fit whose contact nobody told, from its data to its files: stage by stage, as a session runs
/// them.
#include "studies/fits/runs/calibration_stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "calibration/files/fit_tables.h"
#include "calibration/press_fit/lattice_forward_model.h"
#include "meshes/base/errors.h"
#include "meshes/tables/csv_table.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/json_entry.h"
#include "studies/files/read_fields.h"
#include "studies/fits/runs/fit_corrections.h"
#include "studies/fits/runs/fit_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/jobs/cache.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

class OfTwoContacts : public testing::Test {
 protected:
  OfTwoContacts() {
    std::ofstream csv(folder_ / "press.csv");
    csv << "indentation [mm];force [mN];sigma [mN]\n";
    for (const double depth : {0.2, 0.4, 0.6, 0.8})
      csv << depth << ';' << 30.0 * std::pow(depth, 1.5) << ";0.5\n";
  }

  /// Carries out the stages; what `answerless` names ends as a press does that finds no
  /// equilibrium.
  void run(const std::vector<std::string>& answerless) {
    CalibrationStages stages(
        load_config({{},
                     {"calibration.problem=experiment",
                      "calibration.data=[\"" + (folder_ / "press.csv").string() + "\"]",
                      "calibration.parameters=[\"modulus\"]", "calibration.candidates=[]",
                      "calibration.bias=false", "lattice.spacing=tip_radius/4"},
                     {}}),
        "", CalibrationStages::Failed::kept);
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    for (auto jobs = stages.next(run_); !jobs.empty(); jobs = stages.next(run_)) {
      for (const PlannedJob& planned : jobs) {
        const fs::path place = run_ / planned.name;
        fs::create_directories(place);
        const bool ends = std::ranges::find(answerless, planned.name) == answerless.end();
        if (ends) planned.job.run(place, context);
        mark(planned.job, place, ends ? finished : "not converged: beyond 3 mm", 0.0);
      }
    }
  }

  nlohmann::ordered_json result() const { return parse_json(run_ / "calibration.json"); }

  const TemporaryFolder folder_;
  const fs::path run_ = folder_ / "run";
};

}  // namespace

TEST_F(OfTwoContacts, TheOtherOneIsTakenWhereTheFirstHasNoAnswer) {
  run({"fit"});
  EXPECT_EQ(result()["parameters"],
            parse_json(run_ / "fit_other_contact" / "calibration.json")["parameters"]);
  EXPECT_TRUE(says(result()["statement"],
                   "frictionless is taken, since stick contact has no answer (beyond 3 mm)"));
  EXPECT_TRUE(fs::exists(run_ / "material.toml"));
}

TEST_F(OfTwoContacts, TheFirstOneIsTakenWhereTheOtherHasNoAnswer) {
  run({"fit_other_contact"});
  EXPECT_EQ(result()["parameters"], parse_json(run_ / "fit" / "calibration.json")["parameters"]);
  EXPECT_TRUE(fs::exists(run_ / "material.toml"));
}

TEST_F(OfTwoContacts, BothAreNamedWhereNeitherHasAnAnswer) {
  try {
    run({"fit", "fit_other_contact"});
    FAIL() << "an answer out of nothing";
  } catch (const meshes::NotConverged& error) {
    const std::string words = error.what();
    EXPECT_TRUE(says(words, {"stick: not converged: beyond 3 mm", "frictionless: not converged"}));
  }
}

/// Both fits run at a time: one folder for both would give one contact the other's forces.
TEST_F(OfTwoContacts, TheirContinuaHaveFoldersOfTheirOwn) {
  const FitSetup fit =
      fit_setup(load_config({{},
                             {"calibration.problem=experiment",
                              "calibration.data=[\"" + (folder_ / "press.csv").string() + "\"]",
                              "calibration.parameters=[\"modulus\"]", "calibration.candidates=[]",
                              "calibration.forward=continuum"},
                             {}}));
  const auto other = with_other_contact(fit);
  ASSERT_TRUE(other);
  EXPECT_NE(other->input.place, fit.input.place);
}

/// Forces of the frictionless lattice itself, which a sticking one meets within 0.2 %: what so
/// coarse a lattice is known to miss is more, and both contacts stay possible.
TEST_F(OfTwoContacts, BothStayWhereTheLatticesOwnErrorHidesWhichItIs) {
  run({});
  EXPECT_EQ(result()["contact"]["taken"], "stick");
  const meshes::CsvTable data = meshes::read_csv(run_ / "fit_other_contact" / "fit_data.csv");
  std::ofstream csv(folder_ / "press.csv");
  csv.precision(15);
  csv << "indentation [m];force [N]\n";
  for (const auto& row : meshes::known_rows<calibration::FitDataRow>(data))
    csv << row.x << ';' << row.fitted << '\n';
  csv.close();
  fs::remove_all(run_);
  run({});
  const auto own = result()["parameters"][0],
             other = parse_json(run_ / "fit_other_contact" / "calibration.json")["parameters"][0];
  EXPECT_EQ(result()["contact"]["other"], "frictionless");
  EXPECT_LE(own["lower"], other["lower"]);
  EXPECT_GE(own["upper"], other["upper"]);
  EXPECT_TRUE(says(own["interval"].get<std::string>(), "both contacts"));
}

/// E and G of two contacts, a lattice each: what presses at the truth tell comes back by six or
/// seven presses, whose answers are kept, and no press is nearly incompressible.
TEST_F(OfTwoContacts, FewPressesTellEAndG) {
  FitSetup fit = fit_setup(load_config(
      {{},
       {"calibration.problem=experiment",
        "calibration.data=[\"" + (folder_ / "press.csv").string() + "\", \"" +
            (folder_ / "press.csv").string() + "\"]",
        "calibration.conditions=[\"press.contact=frictionless\", \"press.contact=stick\"]",
        "calibration.candidates=[]", "lattice.spacing=tip_radius/4", "lattice.model=hookean"},
       {}}));
  const Eigen::Vector2d truth(59.2e3, 20e3);
  for (FitCurve& curve : fit.input.curves) {
    const Eigen::VectorXd forces =
        calibration::LatticeForwardModel(curve.press, parameters_of(fit.input))
            .evaluate(truth)
            .value;
    curve.y.assign(forces.begin(), forces.end());
  }
  JobContext context;
  context.report = [](double, const std::string&) { return true; };
  context.log = [](const std::string&) {};
  fs::create_directories(run_);
  fit_job(fit.input).run(run_, context);
  for (Eigen::Index i = 0; i < 2; ++i)
    EXPECT_NEAR(result()["parameters"][std::size_t(i)]["estimate"].get<double>() / truth(i), 1.0,
                2e-3);
  for (const char* name : {"curve_1.jsonl", "curve_2.jsonl"}) {
    std::ifstream answers(run_ / "evaluations" / name);
    std::string line;
    int lines = -1;  // the first says what they belong to
    while (std::getline(answers, line)) ++lines;
    EXPECT_GE(lines, 4);
    EXPECT_LE(lines, 7);
  }
}

/// A continuum would press to each of forty depths at its tolerance: between eighteen ln F is a
/// cubic. A lattice passes them on its way.
TEST_F(OfTwoContacts, OfAContinuumManyRowsAreNoSamples) {
  std::ofstream csv(folder_ / "press.csv");
  csv << "indentation [mm];force [mN]\n";
  for (int i = 1; i <= 40; ++i) csv << 0.02 * i << ';' << 1.0 * i << '\n';
  csv.close();
  for (const bool continuum : {true, false}) {
    const FitSetup fit = fit_setup(
        load_config({{},
                     {"calibration.problem=experiment",
                      "calibration.data=[\"" + (folder_ / "press.csv").string() + "\"]",
                      "calibration.parameters=[\"modulus\"]", "calibration.candidates=[]",
                      "lattice.kinematics=small",
                      std::string("calibration.forward=") + (continuum ? "continuum" : "lattice")},
                     {}}));
    const FitCurve& curve = fit.input.curves.front();
    EXPECT_EQ(curve.continuum.protocol.samples.size(), continuum ? 18u : 40u);
    EXPECT_DOUBLE_EQ(curve.continuum.protocol.samples.back(), 8e-4);
    EXPECT_EQ(curve.x.size(), 40u);
    EXPECT_EQ(fit.input.options.free.size(), 1u) << "nothing of a machine is sought";
  }
}

namespace {

/// One finger, pressed on the plane and on a ball; the lattice's own forces at 60 kPa, times a
/// factor, behind touches that no file tells.
class HeldBackFiles : public testing::Test {
 protected:
  std::vector<std::string> sets() const {
    return {"calibration.problem=experiment",
            "calibration.data=[\"" + (folder_ / "press.toml").string() + "\"]",
            "calibration.parameters=[\"modulus\"]",
            "calibration.candidates=[]",
            "press.contact=stick",
            "lattice.kinematics=small",
            "lattice.spacing=tip_radius/4",
            "calibration.rig={compliance=\"0 mm/N\"}"};
  }
  FitSetup setup() const { return fit_setup(load_config({{}, sets(), {}})); }
  void describe(const std::string& presses) const {
    std::ofstream(folder_ / "press.toml") << "[data]\nposition = {column = 1, unit = \"mm\"}\n"
                                          << "force = {column = 2, unit = \"mN\"}\n"
                                          << presses;
  }
  /// 30 mN/mm^1.5, as of Hertz, which so coarse a lattice meets about as well as any rubber does.
  void measure(const char* name, double touch, double factor) const {
    std::ofstream csv(folder_ / name);
    csv << "x [mm];F [mN]\n";
    for (int i = 1; i <= 30; ++i)
      csv << touch + 0.05 * i << ';' << factor * 30.0 * std::pow(0.05 * i, 1.5) << '\n';
  }
  calibration::FitFile fitted() const {
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    const fs::path run = folder_ / "run";
    fs::remove_all(run);
    fs::create_directories(run);
    fit_job(setup().input).run(run, context);
    return struct_of<calibration::FitFile>(read_entry(run / "calibration.json"));
  }

  const TemporaryFolder folder_;
};

}  // namespace

/// What is held back stands behind what is fitted, wherever the file names it.
TEST_F(HeldBackFiles, IsNoPartOfTheFit) {
  measure("press.csv", 0.3, 1.0);
  measure("other.csv", 0.1, 1.0);
  describe("[[press]]\npath = \"other.csv\"\nuse = \"predict\"\n[[press]]\npath = \"press.csv\"\n");
  const FitInput input = setup().input;
  ASSERT_EQ(input.curves.size(), 1u);
  EXPECT_EQ(input.curves[0].name, "press");
  ASSERT_TRUE(input.with_held_back);
  ASSERT_EQ(input.with_held_back->curves.size(), 2u);
  EXPECT_EQ(input.with_held_back->curves[1].name, "other");
  EXPECT_FALSE(input.with_held_back->curves[1].continues);
  EXPECT_EQ(input.options.free.size(), 3u);                  // E, touch, zero
  EXPECT_EQ(input.with_held_back->options.free.size(), 5u);  // and another touch and zero
  describe("[[press]]\npath = \"press.csv\"\nuse = \"predict\"\n");
  EXPECT_TRUE(refuses<std::exception>([&] { setup(); }, {"every press is held back"}));
}

TEST_F(HeldBackFiles, IsForetoldWithTheTouchOfItsOwnFile) {
  measure("press.csv", 0.3, 1.0);
  measure("repeat.csv", 0.1, 1.0);
  measure("stiffer.csv", 0.2, 1.5);
  describe(
      "[[press]]\npath = \"press.csv\"\n[[press]]\npath = [\"repeat.csv\", "
      "\"stiffer.csv\"]\nuse = \"predict\"\n");
  const calibration::FitFile fit = fitted();
  ASSERT_EQ(fit.predicted.size(), 2u);
  const calibration::PredictedEntry &repeat = fit.predicted[0], &stiffer = fit.predicted[1];
  EXPECT_EQ(repeat.failure + stiffer.failure, "");
  EXPECT_TRUE(repeat.is_within());
  EXPECT_FALSE(stiffer.is_within());
  ASSERT_EQ(repeat.own.size(), 2u);
  EXPECT_EQ(repeat.own[0].name, "touch_offset (repeat)");
  // The same forces 0.2 mm earlier.
  EXPECT_NEAR(fit.rig->touch_offset[0].value - repeat.own[0].estimate, 0.2e-3, 5e-6);
  EXPECT_TRUE(says(fit.statement, {"repeat, held back, is foretold within", "inside its 95 %",
                                   "stiffer, held back", "outside its 95 %"}));
}

/// Further rows of a file that is fitted have its touch and its press.
TEST_F(HeldBackFiles, FurtherRowsArePartOfThePress) {
  measure("press.csv", 0.3, 1.0);
  describe(
      "[[press]]\npath = \"press.csv\"\nrows = [1, 20]\n[[press]]\npath = \"press.csv\"\n"
      "rows = [21, 30]\nname = \"deeper\"\nuse = \"predict\"\n");
  const FitInput input = setup().input;
  EXPECT_EQ(input.with_held_back->curves[1].continues, 0u);
  EXPECT_EQ(input.with_held_back->options.free.size(), input.options.free.size());
  EXPECT_EQ(input.curves[0].travel->depths, input.with_held_back->curves[1].travel->depths);
  const calibration::FitFile fit = fitted();
  ASSERT_EQ(fit.predicted.size(), 1u);
  EXPECT_EQ(fit.predicted[0].failure, "");
  EXPECT_TRUE(fit.predicted[0].own.empty());
  EXPECT_LT(fit.predicted[0].rms_relative, 0.1);
}

/// A travel is interpolated between the depths of its press, whatever stands beside it.
TEST_F(HeldBackFiles, FewRowsBesideATravelAreNotItsDepths) {
  std::ofstream(folder_ / "deeper.csv") << "indentation [mm];force [mN]\n1;30\n1.5;55\n2;85\n";
  std::ofstream(folder_ / "travel.csv") << "position [mm];force [mN]\n0.5;10\n0.8;22\n1.1;35\n";
  std::vector<std::string> both = sets();
  both[1] = "calibration.data=[\"" + (folder_ / "deeper.csv").string() + "\", \"" +
            (folder_ / "travel.csv").string() + "\"]";
  for (const FitCurve& curve : fit_setup(load_config({{}, both, {}})).input.curves)
    EXPECT_EQ(curve.travel->depths, calibration::depths_for_rig(2e-3)) << curve.name;
}

/// Of few rows over an indentation one press of all of them answers, at these depths.
TEST_F(HeldBackFiles, FewRowsAreTheDepthsOfOnePress) {
  measure("press.csv", 0.0, 1.0);
  std::ofstream(folder_ / "press.toml")
      << "[data]\nindentation = {column = 1, unit = \"mm\"}\n"
         "force = {column = 2, unit = \"mN\"}\n"
         "[[press]]\npath = \"press.csv\"\nrows = [8, 10]\n"
         "[[press]]\npath = \"press.csv\"\nrows = [11, 13]\nname = \"deeper\"\n"
         "use = \"predict\"\n";
  std::vector<std::string> indented = sets();
  std::erase_if(indented, [](const auto& set) { return set.starts_with("calibration.rig"); });
  const FitInput input = fit_setup(load_config({{}, indented, {}})).input;
  std::vector<double> rows = input.curves[0].x;
  const FitCurve& deeper = input.with_held_back->curves[1];
  rows.insert(rows.end(), deeper.x.begin(), deeper.x.end());
  ASSERT_EQ(rows.size(), 6u);
  for (const FitCurve* curve : {&input.curves[0], &deeper}) {
    EXPECT_EQ(curve->press.protocol.samples, rows);
    EXPECT_EQ(curve->continuum.protocol.samples, rows);
  }
  EXPECT_EQ(input.options.free.size(), 1u);  // neither touch nor zero
}
