/// `calibrate --plan`, and what a fit says of further measurements: against the fits that follow.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

/// A lattice coarse enough for a test, behind a rig whose compliance is known to a few per cent.
const Words experiment = {
    "calibration.problem=experiment",
    "calibration.bias=false",
    "lattice.kinematics=small",
    "lattice.spacing=tip_radius/5",
    "press.contact=frictionless",
    "press.depth=0.1 cm",
    "calibration.points=12",
    "calibration.noise=0.02",
    "calibration.noise_force=0.2 mN",
    "calibration.parameters=[\"modulus\"]",
    "calibration.candidates=[\"repeat\", \"shallow\", \"blank\"]",
    "calibration.rig={touch_offset = \"0 mm\", compliance = \"2 +- 1 mm/N\"}"};

/// That of the list with this name.
const json& named(const json& list, const std::string& name) {
  for (const json& each : list)
    if (each["name"] == name) return each;
  throw std::runtime_error("no " + name);
}

double width(const json& each) {
  return each["upper"].get<double>() - each["lower"].get<double>();
}

/// planned_presses.csv as files that a machine would have written.
void write_measured(const Workplace& folder, const std::string& plan) {
  std::stringstream rows(folder.text(plan));
  std::map<std::string, std::string> files;
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line, "press,x,force,sigma");
  while (std::getline(rows, line)) {
    const std::size_t comma = line.find(',');
    files[line.substr(0, comma)] += line.substr(comma + 1) + "\n";
  }
  for (const auto& [name, text] : files)
    folder.put(name + ".csv", "position [m],force [N],sigma [N]\n" + text);
}

}  // namespace

/// The plan is what the fit to data as planned says: linear intervals, correlation, and how much
/// every further measurement narrows. The fit knows the press at other depths than the plan does,
/// between which the curve of so coarse a lattice is known to some per cent.
TEST(Plan, SaysWhatTheFitWillSay) {
  const Workplace folder;
  const Words settings = experiment + Words{"calibration.data=[\"a.csv\"]"};
  EXPECT_TRUE(says(folder.run("calibrate --plan --out plan", settings).out, "modulus"));
  const json plan = folder.json("plan/plan.json");
  EXPECT_EQ(plan["presses"][0]["name"], "a");
  EXPECT_EQ(plan["presses"][0]["points"], 12);
  EXPECT_EQ(plan["noise"], 0.02);
  ASSERT_EQ(plan["parameters"].size(), 2u) << "the touch is known";
  write_measured(folder, "plan/planned_presses.csv");
  const ProgramResult fitted =
      folder.run("calibrate --out fit", settings + Words{"calibration.intervals=linear"}, judged);
  const json fit = folder.json("fit/calibration.json");
  for (const json& each : plan["parameters"]) {
    const json& own = named(fit["parameters"], each["name"]);
    EXPECT_NEAR(width(own) / width(each), 1.0, 0.05) << each["name"];
    EXPECT_NEAR(own["estimate"].get<double>(), each["value"].get<double>(), 0.1 * width(each));
  }
  EXPECT_NEAR(fit["correlation"][0][1].get<double>(), plan["correlation"][0][1].get<double>(),
              0.05);
  EXPECT_EQ(fit["next"].size(), plan["next"].size());
  for (const char* name : {"repeat", "shallow", "blank"})
    EXPECT_NEAR(named(fit["next"], name)["parameters"][0]["times"].get<double>(),
                named(plan["next"], name)["parameters"][0]["times"].get<double>(), 0.05)
        << name;
  EXPECT_TRUE(says(fit["statement"], "would tell most"));
  EXPECT_TRUE(says(fitted.out, "What to measure next."));
}

/// What is told of a further press is what the plan with both presses comes to.
TEST(Plan, ACandidateNarrowsAsThePlanOfBothDoes) {
  const Workplace folder;
  const std::string ball = "obstacle.shape=sphere; obstacle.radius=0.4 cm; press.depth=0.1 cm";
  const auto plan = [&](const std::string& out, const Words& settings) {
    folder.run("calibrate --plan --out " + out, experiment + settings);
    return folder.json(out + "/plan.json");
  };
  const json first = plan("one", {"calibration.candidates=[\"" + ball + "\"]"}),
             second = plan("both", {"calibration.candidates=[]",
                                    "calibration.conditions=[\"press.contact=frictionless\", \"" +
                                        ball + "\"]"});
  ASSERT_EQ(second["parameters"].size(), 2u);
  ASSERT_EQ(first["next"].size(), 1u);
  for (const char* name : {"modulus", "compliance"}) {
    const double found =
        width(named(first["parameters"], name)) / width(named(second["parameters"], name));
    EXPECT_NEAR(named(first["next"][0]["parameters"], name)["times"].get<double>(), found,
                1e-3 * found);
  }
  EXPECT_TRUE(second["next"].empty());
}

TEST(Plan, RefusesWhatIsNoPlan) {
  const Workplace folder;
  for (const auto& [settings, told] : std::vector<std::pair<Words, std::string>>{
           {{"calibration.problem=moduli"}, "a plan is one of measured presses"},
           {{"calibration.candidates=[\"bal\"]"}, "did you mean ball?"},
           {{"calibration.noise=0.0", "calibration.noise_force=0 N"}, "the noise of the forces"},
           {{"calibration.data=[\"a.csv\", \"b.csv\"]",
             "calibration.conditions=[\"press.contact=stick\"]"},
            "one per file"}})
    folder.expect_refused("calibrate --plan --out no", experiment + settings, {told});
}

/// A contact that nobody told: both are fitted, and the intervals cover both.
TEST(Plan, FitsBothContactsWhereNoneIsTold) {
  const Workplace folder;
  const Words lattice = {"lattice.spacing=tip_radius/5", "lattice.kinematics=small"};
  folder.run("press --out frictionless",
             lattice + Words{"press.mode=static", "press.contact=frictionless",
                             R"(press.samples=["0.04 cm", "0.06 cm", "0.08 cm", "0.1 cm"])"});
  std::ostringstream csv;
  csv << "indentation [m],force [N],sigma [N]\n";
  csv.precision(17);
  for (const auto& sample : folder.samples("frictionless"))
    csv << sample.indentation << ',' << sample.normal_force << ',' << 0.01 * sample.normal_force
        << '\n';
  folder.put("a.csv", csv.str());
  const auto result = [&](const std::string& out, const Words& settings) {
    folder.run("calibrate --out " + out,
               lattice + settings +
                   Words{"calibration.problem=experiment", "calibration.bias=false",
                         "calibration.candidates=[]", "calibration.parameters=[\"modulus\"]",
                         "calibration.data=[\"a.csv\"]"},
               judged);
    return folder.json(out + "/calibration.json");
  };
  const json stick = result("s", {"press.contact=stick"}),
             slip = result("f", {"press.contact=frictionless"}), both = result("both", {}),
             given = result("given", {"calibration.contact=given"});
  EXPECT_TRUE(stick["contact"].is_null());
  EXPECT_TRUE(given["contact"].is_null());
  EXPECT_EQ(both["contact"]["taken"], "stick");
  EXPECT_EQ(both["contact"]["other"], "frictionless");
  const json &of_stick = stick["parameters"][0], &of_slip = slip["parameters"][0],
             &of_both = both["parameters"][0];
  EXPECT_EQ(both["contact"]["parameters"][0]["estimate"], of_slip["estimate"]);
  EXPECT_EQ(of_both["estimate"], of_stick["estimate"]);
  EXPECT_EQ(of_both["upper"],
            std::max(of_stick["upper"].get<double>(), of_slip["upper"].get<double>()));
  EXPECT_EQ(of_both["lower"],
            std::min(of_stick["lower"].get<double>(), of_slip["lower"].get<double>()));
  EXPECT_EQ(of_stick["interval"], "profile");
  EXPECT_EQ(of_both["interval"], "profile, both contacts");
  EXPECT_TRUE(says(both["statement"], "is not told (press.contact)"));
}
