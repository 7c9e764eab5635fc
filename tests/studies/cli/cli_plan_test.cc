/// `calibrate --plan`, and what a fit says of further measurements: against the fits that follow.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

using Words = std::vector<std::string>;

json read(const fs::path& file) {
  return json::parse(read_text(file));
}

/// A lattice coarse enough for a test, behind a rig whose compliance is known to a few per cent.
const Words experiment = with_settings(
    {"calibrate"},
    {"calibration.problem=experiment", "calibration.bias=false", "lattice.kinematics=small",
     "lattice.spacing=tip_radius/5", "press.contact=frictionless", "press.depth=0.1 cm",
     "calibration.points=12", "calibration.noise=0.02", "calibration.noise_force=0.2 mN",
     "calibration.parameters=[\"modulus\"]",
     "calibration.candidates=[\"repeat\", \"shallow\", \"blank\"]",
     "calibration.rig={touch_offset = \"0 mm\", compliance = \"2 +- 1 mm/N\"}"});

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const json& parameter(const json& file, const std::string& name) {
  for (const json& each : file["parameters"])
    if (each["name"] == name) return each;
  throw std::runtime_error("no parameter " + name);
}

const json& next(const json& file, const std::string& name) {
  for (const json& each : file["next"])
    if (each["name"] == name) return each;
  throw std::runtime_error("no candidate " + name);
}

double width(const json& each) {
  return each["upper"].get<double>() - each["lower"].get<double>();
}

/// planned_presses.csv as files that a machine would have written.
void write_measured(const fs::path& folder, const fs::path& plan) {
  std::stringstream rows(read_text(plan));
  std::map<std::string, std::string> files;
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line, "press,x,force,sigma");
  while (std::getline(rows, line)) {
    const std::size_t comma = line.find(',');
    files[line.substr(0, comma)] += line.substr(comma + 1) + "\n";
  }
  for (const auto& [name, text] : files)
    write_text(folder / (name + ".csv"), "position [m],force [N],sigma [N]\n" + text);
}

}  // namespace

/// The plan is what the fit to data as planned says: linear intervals, correlation, and how much
/// every further measurement narrows. The fit knows the press at other depths than the plan does,
/// between which the curve of so coarse a lattice is known to some per cent.
TEST(Plan, SaysWhatTheFitWillSay) {
  const TemporaryFolder folder;
  const ProgramResult planned =
      run_program(folder.path(), with_settings(experiment, {"calibration.data=[\"a.csv\"]"}) +
                                     Words{"--plan", "--out", "plan"});
  ASSERT_EQ(planned.code, 0) << planned.err;
  const json plan = read(folder / "plan/plan.json");
  EXPECT_EQ(plan["presses"][0]["name"], "a");
  EXPECT_EQ(plan["presses"][0]["points"], 12);
  EXPECT_EQ(plan["noise"], 0.02);
  ASSERT_EQ(plan["parameters"].size(), 2u) << "the touch is known";
  EXPECT_NE(planned.out.find("modulus"), std::string::npos);
  write_measured(folder.path(), folder / "plan/planned_presses.csv");
  const ProgramResult fitted = run_program(
      folder.path(),
      with_settings(experiment, {"calibration.data=[\"a.csv\"]", "calibration.intervals=linear"}) +
          Words{"--out", "fit"});
  ASSERT_TRUE(fitted.code == 0 || fitted.code == 4) << fitted.err;
  const json fit = read(folder / "fit/calibration.json");
  for (const json& each : plan["parameters"]) {
    const json& own = parameter(fit, each["name"]);
    EXPECT_NEAR(width(own) / width(each), 1.0, 0.05) << each["name"];
    EXPECT_NEAR(own["estimate"].get<double>(), each["value"].get<double>(), 0.1 * width(each));
  }
  EXPECT_NEAR(fit["correlation"][0][1].get<double>(), plan["correlation"][0][1].get<double>(),
              0.05);
  EXPECT_EQ(fit["next"].size(), plan["next"].size());
  for (const char* name : {"repeat", "shallow", "blank"})
    EXPECT_NEAR(next(fit, name)["parameters"][0]["times"].get<double>(),
                next(plan, name)["parameters"][0]["times"].get<double>(), 0.05)
        << name;
  EXPECT_NE(fit["statement"].get<std::string>().find("would tell most"), std::string::npos);
  EXPECT_NE(fitted.out.find("A further measurement would make the intervals"), std::string::npos);
}

/// What is told of a further press is what the plan with both presses comes to.
TEST(Plan, ACandidateNarrowsAsThePlanOfBothDoes) {
  const TemporaryFolder folder;
  const std::string ball = "obstacle.shape=sphere; obstacle.radius=0.4 cm; press.depth=0.1 cm";
  const ProgramResult one = run_program(
      folder.path(), with_settings(experiment, {"calibration.candidates=[\"" + ball + "\"]"}) +
                         Words{"--plan", "--out", "one"});
  ASSERT_EQ(one.code, 0) << one.err;
  const ProgramResult both = run_program(
      folder.path(),
      with_settings(experiment,
                    {"calibration.candidates=[]",
                     "calibration.conditions=[\"press.contact=frictionless\", \"" + ball + "\"]"}) +
          Words{"--plan", "--out", "both"});
  ASSERT_EQ(both.code, 0) << both.err;
  const json first = read(folder / "one/plan.json"), second = read(folder / "both/plan.json");
  ASSERT_EQ(second["parameters"].size(), 2u);
  ASSERT_EQ(first["next"].size(), 1u);
  for (const char* name : {"modulus", "compliance"}) {
    const double found = width(parameter(first, name)) / width(parameter(second, name));
    for (const json& each : first["next"][0]["parameters"]) {
      if (each["name"] != name) continue;
      EXPECT_NEAR(each["times"].get<double>(), found, 1e-3 * found);
    }
  }
  EXPECT_TRUE(second["next"].empty());
}

TEST(Plan, RefusesWhatIsNoPlan) {
  const TemporaryFolder folder;
  const auto refused = [&](const Words& sets, const char* what) {
    const ProgramResult run = run_program(
        folder.path(), with_settings(experiment, sets) + Words{"--plan", "--out", "no"});
    EXPECT_EQ(run.code, 2) << what;
    EXPECT_NE(run.err.find(what), std::string::npos) << run.err;
  };
  refused({"calibration.problem=moduli"}, "a plan is one of measured presses");
  refused({"calibration.candidates=[\"bal\"]"}, "did you mean ball?");
  refused({"calibration.noise=0.0", "calibration.noise_force=0 N"}, "the noise of the forces");
  refused({"calibration.data=[\"a.csv\", \"b.csv\"]",
           "calibration.conditions=[\"press.contact=stick\"]"},
          "one per file");
}

/// A contact that nobody told: both are fitted, and the intervals cover both.
TEST(Plan, FitsBothContactsWhereNoneIsTold) {
  const TemporaryFolder folder;
  const auto press = [&](const char* contact) {
    return with_settings({"press"},
                         {"press.mode=static", "lattice.spacing=tip_radius/5",
                          "lattice.kinematics=small", std::string("press.contact=") + contact,
                          "press.samples=[\"0.04 cm\", \"0.06 cm\", \"0.08 cm\", \"0.1 cm\"]"}) +
           Words{"--out", contact};
  };
  ASSERT_EQ(run_program(folder.path(), press("frictionless")).code, 0);
  std::stringstream rows(read_text(folder / "frictionless/response.csv"));
  std::string line, csv = "indentation [m],force [N],sigma [N]\n";
  std::getline(rows, line);
  while (std::getline(rows, line)) {
    const std::size_t a = line.find(','), b = line.find(',', a + 1);
    const double force = std::stod(line.substr(a + 1, b - a - 1));
    csv += line.substr(0, b) + "," + std::to_string(0.01 * force) + "\n";
  }
  write_text(folder / "a.csv", csv);
  const Words fit = with_settings(
      {"calibrate"},
      {"calibration.problem=experiment", "calibration.bias=false", "lattice.kinematics=small",
       "lattice.spacing=tip_radius/5", "calibration.candidates=[]",
       "calibration.parameters=[\"modulus\"]", "calibration.data=[\"a.csv\"]"});
  const auto result = [&](const Words& sets, const char* out) {
    const ProgramResult run =
        run_program(folder.path(), with_settings(fit, sets) + Words{"--out", out});
    EXPECT_TRUE(run.code == 0 || run.code == 4) << run.err;
    return read(folder / out / "calibration.json");
  };
  const json stick = result({"press.contact=stick"}, "s"),
             slip = result({"press.contact=frictionless"}, "f"), both = result({}, "both"),
             given = result({"calibration.contact=given"}, "given");
  EXPECT_TRUE(stick["contact"].is_null());
  EXPECT_TRUE(given["contact"].is_null());
  EXPECT_EQ(both["contact"]["taken"], "stick");
  EXPECT_EQ(both["contact"]["other"], "frictionless");
  EXPECT_EQ(both["contact"]["parameters"][0]["estimate"], slip["parameters"][0]["estimate"]);
  EXPECT_EQ(both["parameters"][0]["estimate"], stick["parameters"][0]["estimate"]);
  EXPECT_EQ(both["parameters"][0]["upper"], std::max(stick["parameters"][0]["upper"].get<double>(),
                                                     slip["parameters"][0]["upper"].get<double>()));
  EXPECT_EQ(both["parameters"][0]["lower"], std::min(stick["parameters"][0]["lower"].get<double>(),
                                                     slip["parameters"][0]["lower"].get<double>()));
  EXPECT_EQ(stick["parameters"][0]["interval"], "profile");
  EXPECT_EQ(both["parameters"][0]["interval"], "profile, both contacts");
  EXPECT_NE(both["statement"].get<std::string>().find("is not told (press.contact)"),
            std::string::npos);
}
