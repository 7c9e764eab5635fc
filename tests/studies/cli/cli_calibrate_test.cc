/// `calibrate` from data to files, on lattices coarse enough for a test.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <regex>
#include <sstream>

#include "tests/studies/workplace.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

constexpr double rubber_modulus = 3922.66;  // 40 gf/cm^2

const Words experiment = {"calibration.problem=experiment", "calibration.bias=false",
                          "calibration.candidates=[]", "lattice.kinematics=small",
                          "lattice.spacing=tip_radius/5"};
const Words press_at_rest = {"press.mode=static", "lattice.spacing=tip_radius/5"};
const std::string one_modulus = R"(calibration.parameters=["modulus"])";

std::string of_files(const std::string& files) {
  return "calibration.data=[" + files + "]";
}

class Calibrate : public testing::Test {
 protected:
  /// The lattice's own press to `count` depths, `step` [cm] apart.
  PressResponse press(const std::string& contact, int count, double step) const {
    std::string samples;
    for (int i = 1; i <= count; ++i)
      samples += (i > 1 ? ",\"" : "\"") + std::to_string(step * i) + " cm\"";
    folder_.run(
        "press --out press_" + contact,
        press_at_rest + Words{"press.contact=" + contact, "press.samples=[" + samples + "]"});
    return folder_.response("press_" + contact);
  }

  /// Forces of the lattice itself, times `scale`, as a measured file with 1 % sigma and a fixed
  /// zigzag of half that.
  void write_measured(const std::string& contact, const std::string& name,
                      double scale = 1.0) const {
    std::ostringstream csv;
    csv << "# press.contact = \"" << contact << "\"\nindentation [mm],force [mN],sigma [mN]\n";
    double sign = 1.0;
    const PressResponse response = press(contact, 5, 0.02);
    for (const auto& sample : response.samples()) {
      const double force = 1e3 * scale * sample.normal_force;
      csv << 1e3 * sample.indentation << ',' << force * (1.0 + 0.005 * sign) << ',' << 0.01 * force
          << '\n';
      sign = -sign;
    }
    folder_.put(name, csv.str());
  }
  void write_both() const {
    write_measured("frictionless", "a.csv");
    write_measured("stick", "b.csv");
  }

  ProgramResult fit(const std::string& out, const Words& settings, int code = 0) const {
    return folder_.run("calibrate --out " + out, experiment + settings, code);
  }
  json found(const std::string& out) const { return folder_.json(out + "/calibration.json"); }

  /// One sample of a press with the constants of the fit.
  ProgramResult use(const std::string& fit) const {
    return folder_.run(
        "press --out use",
        press_at_rest + Words{"press.contact=frictionless", R"(press.samples=["0.06 cm"])",
                              "lattice.constants=" + fit + "/material.toml"});
  }

  const Workplace folder_;
};

void expect_holds(const json& parameter, double truth) {
  EXPECT_LT(parameter["lower"].get<double>(), truth);
  EXPECT_GT(parameter["upper"].get<double>(), truth);
}

}  // namespace

/// The lattice's own press as a machine tells it: the travel from 0.1 mm before touch, and a frame
/// that gives way by 2 mm/N.
TEST_F(Calibrate, FindsTheRubberBehindARig) {
  std::ostringstream csv;
  csv << "# press.contact = \"frictionless\"\nposition [mm];force [mN];sigma [mN]\n0;0;0.01\n";
  const PressResponse response = press("frictionless", 12, 0.01);
  for (const auto& sample : response.samples())
    csv << 0.1 + 1e3 * (sample.indentation + 2e-3 * sample.normal_force) << ';'
        << 1e3 * sample.normal_force << ';' << 10.0 * sample.normal_force << '\n';
  folder_.put("travel.csv", csv.str());
  const auto settings = [&](const std::string& rig) {
    return Words{of_files("\"travel.csv\""), one_modulus, "calibration.rig=" + rig};
  };
  fit("known", settings("{compliance = \"2 mm/N\"}"));
  const json known = found("known");
  expect_holds(known["parameters"][0], rubber_modulus);
  EXPECT_EQ(known["parameters"][1]["name"], "touch_offset");
  EXPECT_NEAR(known["rig"]["touch_offset"][0]["value"].get<double>(), 1e-4, 2e-5);
  EXPECT_EQ(known["rig"]["compliance"][0]["fitted"], false);
  EXPECT_EQ(known["rig"]["compliance"][0]["value"], 2e-3);
  EXPECT_EQ(known["rig"]["compliance"][0]["given"], true);
  EXPECT_EQ(known["rig"]["force_offset"][0]["given"], false);
  // A column tells how deep the finger was.
  EXPECT_TRUE(says(folder_.text("known/fit_data.csv"), "left_out,indentation"));
  // The same from a rigid blank on that machine; these data have no sigma.
  folder_.put("travel.csv",
              std::regex_replace(std::regex_replace(csv.str(), std::regex(";[^;\n]*\n"), "\n"),
                                 std::regex(";sigma \\[mN\\]"), ""));
  std::ostringstream blank;
  blank << "position [mm];force [mN]\n0;0\n";
  for (int i = 0; i <= 50; ++i)
    blank << 0.3 + 2e-3 * (5.0 * i + 0.02 * (i % 3 - 1)) << ';' << 5.0 * i << '\n';
  folder_.put("blank.csv", blank.str());
  EXPECT_TRUE(says(fit("blank", settings("{blank = \"blank.csv\"}")).err,
                   "blank blank.csv: the machine gives way by 2 +- "));
  const json by_blank = found("blank");
  const json& compliance = by_blank["rig"]["compliance"][0];
  EXPECT_EQ(compliance["fitted"], true);
  EXPECT_EQ(compliance["given"], true);
  EXPECT_NEAR(compliance["value"].get<double>(), 2e-3, 2e-5);
  expect_holds(compliance, 2e-3);
  expect_holds(by_blank["parameters"][0], rubber_modulus);
  EXPECT_TRUE(says(folder_.text("blank/material.toml"),
                   {"measured data: travel.csv (SHA-256 ", ", blank blank.csv (SHA-256 "}));
  // The blank among the presses: it is no curve of the fit.
  folder_.put("presses.toml",
              "[[press]]\npath = \"travel.csv\"\n[[press]]\npath = \"blank.csv\"\n"
              "finger = \"rigid\"\n");
  fit("among", {of_files("\"presses.toml\""), one_modulus});
  EXPECT_EQ(found("among")["curves"].size(), 1U);
  EXPECT_EQ(found("among")["parameters"], by_blank["parameters"]);
  for (const auto& [rig, words] :
       {std::pair("{blank = \"blank.csv\", compliance = \"2 mm/N\"}", "leave one of them out"),
        std::pair("{comliance = \"2 mm/N\"}", "did you mean compliance?"),
        std::pair("{compliance = \"0.1 +- 0.02 mm\"}", "compliance: ")})
    folder_.expect_refused("calibrate --out no", experiment + settings(rig), {words});
}

/// The lattice's own press, once behind a machine that gives way by 2 mm/N, once with forces that
/// grow faster, by 20 or 100 % at 1 mm: as a compliance that would be one below zero, which no
/// machine has.
TEST_F(Calibrate, WhatIsMissedHasAnAmountAndNoMachinePushesBack) {
  const PressResponse response = press("frictionless", 24, 0.005);
  const auto told = [&](double compliance, double stiffening, const std::string& out) {
    std::ostringstream csv;
    csv << "# press.contact = \"frictionless\"\nposition [mm];force [mN]\n0;0\n";
    for (const auto& sample : response.samples()) {
      const double depth = 1e3 * sample.indentation,
                   force = 1e3 * sample.normal_force * (1.0 + stiffening * std::pow(depth, 3));
      csv << 0.1 + depth + compliance * force << ';' << force << '\n';
    }
    folder_.put("travel.csv", csv.str());
    const std::string text = fit(out, {of_files("\"travel.csv\""), one_modulus}, judged).out;
    const json causes = found(out)["lack_of_fit"];
    for (const json& each : causes)
      EXPECT_TRUE(each["name"] != "compliance" || each["amount"].get<double>() >= 0.0) << each;
    return text;
  };
  EXPECT_TRUE(says(told(2e-3, 0.0, "soft"),
                   {"looks most like compliance, which alone would", " mm/N: frame, load cell"}));
  EXPECT_NEAR(found("soft")["lack_of_fit"][0]["amount"].get<double>(), 2e-3, 4e-4);

  const std::string stiff = told(0.0, 0.2, "stiff");
  EXPECT_TRUE(omits(stiff, "frame, load cell"));
  EXPECT_TRUE(says(stiff, "(150 % of what coarse lattices compute for it: "));
  const auto stiffening = [&](const char* out) {
    const json causes = found(out)["lack_of_fit"];
    double amount = 0.0;
    for (const json& each : causes)
      if (each["name"] == "stiffening") amount = each["amount"].get<double>();
    return amount;
  };
  EXPECT_GT(stiffening("stiff"), 0.05) << found("stiff")["lack_of_fit"];
  told(0.0, 1.0, "stiffer");
  EXPECT_GT(stiffening("stiffer"), 0.16);
}

/// One press, four times: its forces times 0.95, 1, 0.55 and 1.13, touched at 0.1 mm. Each keeps
/// its touch, E is that of their mean, 0.9075, and the interval that of the mean of four: Student's
/// t of three degrees, 3.18, times 0.249/2, or somewhat less, for repeats seldom differ by so much.
TEST_F(Calibrate, RepeatsThatScatterHaveAFactorEachAndTellTheirMean) {
  std::string files;
  const PressResponse response = press("frictionless", 24, 0.005);
  for (const double factor : {0.95, 1.0, 0.55, 1.13}) {
    std::ostringstream csv;
    csv << "# press.contact = \"frictionless\"\nposition [mm];force [mN]\n0;0\n0.05;0\n";
    for (const auto& sample : response.samples())
      csv << 0.1 + 1e3 * sample.indentation << ';' << 1e3 * factor * sample.normal_force << '\n';
    const std::string name = "repeat" + std::to_string(factor) + ".csv";
    folder_.put(name, csv.str());
    files += (files.empty() ? "\"" : ",\"") + name + "\"";
  }
  EXPECT_TRUE(says(fit("fit", {of_files(files), one_modulus}).out,
                   {"The 4 repeats of repeat0", "differ by 27 %"}));
  constexpr double truth = rubber_modulus * 0.9075, wide = 3.182 * 0.2489 / 2.0 * rubber_modulus;
  const json all = found("fit");
  const double estimate = all["parameters"][0]["estimate"], upper = all["parameters"][0]["upper"];
  EXPECT_NEAR(estimate, truth, 0.02 * truth);
  EXPECT_NEAR(upper - estimate, 0.9 * wide, 0.1 * wide);
  for (const json& touch : all["rig"]["touch_offset"])
    EXPECT_NEAR(touch["value"].get<double>(), 1e-4, 1e-5);
}

TEST_F(Calibrate, FindsTheRubberOfMeasuredPresses) {
  write_both();
  // The coarse lattice's own error leaves Poisson's ratio open.
  EXPECT_TRUE(says(fit("fit", {of_files("\"a.csv\",\"b.csv\""), "calibration.surrogate=true",
                               "calibration.prior=0.05"})
                       .out,
                   "youngs_modulus"));
  const json all = found("fit");
  EXPECT_EQ(all["problem"], "experiment");
  ASSERT_EQ(all["parameters"].size(), 2u);
  EXPECT_NEAR(all["parameters"][0]["estimate"].get<double>(), 3922.66, 0.05 * 3922.66);
  EXPECT_NEAR(all["parameters"][1]["estimate"].get<double>(), 1372.93, 0.05 * 1372.93);
  for (const json& parameter : all["parameters"])
    EXPECT_LT(parameter["lower"].get<double>(), parameter["upper"].get<double>());
  EXPECT_EQ(all["curves"][0]["condition"], "frictionless");
  EXPECT_EQ(all["curves"][1]["condition"], "stick");
  EXPECT_FALSE(all["chi_square"].is_null());
  EXPECT_FALSE(all["curves"][0]["left_out"].is_null());
  // Names of curves stand in quotes, whatever they say.
  EXPECT_TRUE(folder_.text("fit/fit_data.csv")
                  .starts_with("curve,x,measured,sigma,fitted,left_out,indentation,total_sigma,"
                               "whitened_residual\n\"" +
                               all["curves"][0]["name"].get<std::string>() + "\","));
  EXPECT_TRUE(folder_.has("fit/surrogate.json"));

  // The material goes into a press.
  use("fit");
  EXPECT_NEAR(folder_.response("use").normal_force_at(6e-4) /
                  folder_.response("press_frictionless").normal_force_at(6e-4),
              1.0, 0.01);
}

/// The scale of the search is the data's, whatever the configuration's rubber is.
TEST_F(Calibrate, FindsARubberAHundredTimesStiffer) {
  write_measured("frictionless", "a.csv", 100.0);
  EXPECT_TRUE(says(fit("fit", {of_files("\"a.csv\""), one_modulus}).out,
                   {"\nk1", "\nk2", "\nk3", "\nkappa", "kPa"}));
  EXPECT_NEAR(found("fit")["parameters"][0]["estimate"].get<double>(), 392266.0, 0.01 * 392266.0);
  const std::string material = folder_.text("fit/material.toml");
  EXPECT_TRUE(says(material, "[geometry]"));
  EXPECT_TRUE(omits(material, "density")) << "a default is not known";
}

/// Whoever frees E or G alone means it at the rubber's Poisson's ratio, here 0.4286: forces 1.3
/// times as large are those of a rubber 1.3 times as stiff.
TEST_F(Calibrate, OneModulusAloneIsFittedAtTheGivenPoissonsRatio) {
  write_measured("frictionless", "a.csv", 1.3);
  for (const std::string one : {"youngs_modulus", "shear_modulus"}) {
    EXPECT_TRUE(
        says(fit(one, {of_files("\"a.csv\""), "calibration.parameters=[\"" + one + "\"]"}).err,
             "Poisson's ratio is held at the rubber's, 0.4286"));
    const json rubber = found(one)["rubber"];
    const double e = rubber["youngs_modulus"], g = rubber["shear_modulus"];
    EXPECT_NEAR(e, 1.3 * rubber_modulus, 0.01 * rubber_modulus);
    EXPECT_NEAR(e / (2.0 * g) - 1.0, 40.0 / 28.0 - 1.0, 1e-9);
  }
  // E at a held ratio, and E with another one.
  fit("both", {of_files("\"a.csv\""), R"(calibration.parameters=["youngs_modulus", "modulus"])"},
      2);
}

/// Forces of nu = 0.43 cannot be met between 0.2 and 0.3, where the search then ends.
TEST_F(Calibrate, PoissonsRatioStaysInItsRangeAndTheFitIsNotAccepted) {
  write_both();
  const Words settings = {of_files("\"a.csv\",\"b.csv\""), "calibration.poisson_range=[0.2, 0.3]"};
  const ProgramResult run = fit("fit", settings, 4);
  EXPECT_TRUE(says(run.err, "Poisson's ratio ended at a bound, 0.3"));
  EXPECT_TRUE(says(run.out, "youngs_modulus")) << "estimates are shown";
  const json rubber = found("fit")["rubber"];
  const double e = rubber["youngs_modulus"], g = rubber["shear_modulus"];
  EXPECT_NEAR(e / (2.0 * g) - 1.0, 0.3, 1e-6);
  EXPECT_FALSE(folder_.has("fit/material.toml"));

  // On request there is a file, which says what it is, and a press says so again.
  fit("fit --force", settings, 4);
  EXPECT_TRUE(says(folder_.text("fit/material.toml"), "rejected = \"Poisson's ratio ended"));
  EXPECT_TRUE(says(use("fit").err, "failed its own tests"));
}

/// The best seen so far is told, and what to do.
TEST_F(Calibrate, ASearchThatEndsEarlyTellsWhatItHas) {
  write_both();
  const ProgramResult run =
      fit("fit", {of_files("\"a.csv\",\"b.csv\""), "calibration.evaluations=1"}, 3);
  EXPECT_TRUE(says(run.out, "youngs_modulus"));
  EXPECT_TRUE(says(run.err, {"did not end within", "calibration.evaluations"}));
  EXPECT_EQ(found("fit")["converged"], false);
  EXPECT_FALSE(folder_.has("fit/material.toml"));
}

/// At a fifth of the thickness the theories differ by 8 %: the finite law is taken, and that is
/// said before the fit; small strain on request keeps the difference in its intervals.
TEST_F(Calibrate, DataBeyondSmallStrainGetTheFiniteLaw) {
  write_measured("frictionless", "a.csv");
  const Words settings = {"calibration.problem=experiment", "lattice.spacing=tip_radius/5",
                          of_files("\"a.csv\""), one_modulus};
  const ProgramResult run = folder_.run("calibrate --out finite", settings);
  EXPECT_TRUE(says(run.err, "20 % of the rubber's thickness"));
  EXPECT_EQ(found("finite")["model"], "network");
  EXPECT_TRUE(says(run.out, "\nlambda"));

  folder_.run("calibrate --out small", settings + Words{"lattice.model=hookean"});
  EXPECT_EQ(found("small")["model"], "hookean");
  // The finite law, stiffer, needs a smaller modulus; small strain says that it may be off by that.
  const double other = found("finite")["parameters"][0]["estimate"];
  const json small = found("small")["parameters"][0];
  EXPECT_LT(other, small["estimate"].get<double>());
  EXPECT_GT(other, small["lower"].get<double>());
}

/// A column of millimetres called metres: place, cause and remedy on a few lines of a terminal.
TEST_F(Calibrate, AWrongUnitIsRefusedInAFewLines) {
  std::ostringstream text;
  text << "Weg [m];Kraft [N]\n";
  for (int i = 1; i <= 40; ++i) text << 0.05 * i << ';' << 0.1 * std::pow(0.05 * i, 1.5) << '\n';
  folder_.put("press.csv", text.str());
  const std::string told = fit("fit", {of_files("\"press.csv\"")}, 2).err;
  EXPECT_TRUE(says(told, {"press.csv:41: Weg [m]: the finger is pressed by 2", " thick",
                          "where the numbers are mm, say so in place of m"}));
  EXPECT_LT(told.size(), 400U) << told;
}

/// What is wrong with a measured file is said of it, with its line; what is wrong with the fit, of
/// its key.
TEST_F(Calibrate, RefusesWhatCannotBeFitted) {
  folder_.put("deep.csv", "indentation [mm],force [mN]\n1,2\n2,6\n70,11\n");
  folder_.put("tilt.csv",
              "# press.tilt = \"200 deg\"\nindentation [mm],force [mN]\n0.2,2\n0.4,6\n0.5,9\n");
  folder_.put("few.csv", "indentation [mm],force [mN]\n0.2,2\n");
  folder_.put("sure.csv",
              "indentation [mm],force [mN],sigma [mN]\n0.2,2,0.1\n0.4,6,0.1\n0.5,9,0.1\n");
  folder_.put("good.csv", "indentation [mm],force [mN]\n0.2,2\n0.4,6\n0.6,11\n");
  folder_.put("no_unit.csv", "indentation,force [mN]\n0.2,2\n");
  const std::string good = of_files("\"good.csv\"");
  for (const auto& [settings, told] : std::vector<std::pair<Words, std::string>>{
           {{of_files("\"deep.csv\"")}, "deep.csv:4"},
           {{of_files("\"tilt.csv\"")}, "tilt.csv:1"},
           {{of_files("\"few.csv\"")}, "few.csv"},
           {{of_files("\"few.csv\",\"sure.csv\"")}, "sure.csv"},
           {{}, "needs measured data"},
           {{of_files("\"absent.csv\"")}, "absent.csv"},
           {{of_files("\"no_unit.csv\"")}, "no_unit.csv:1"},
           {{good, R"(calibration.parameters=["young"])"}, "calibration.parameters"},
           {{good, R"(calibration.profile=["youngs_modulus"])"}, "calibration.profile"},
           {{good, "lattice.model=published"}, "published"},
           {{good, "calibration.robust_width=3.0"}, "sigma"},
           {{good, R"(calibration.conditions=["press.contact=stick", "press.tilt=5 deg"])"},
            "calibration.conditions"},
           {{good, R"(calibration.conditions=["lattice.spacing=tip_radius/4"])"},
            "press, obstacle, geometry and reference"},
           {{good, "calibration.forward=continuum", R"(calibration.parameters=["k1"])"},
            "moduli alone"},
           {{good, R"(calibration.parameters=["youngs_modulus", "k1"])"}, "described in one way"},
           {{good, "calibration.problem=moduli"}, "calibration.data"}})
    folder_.expect_refused("calibrate --out bad", experiment + settings, {told});
}

TEST_F(Calibrate, ResumesAndDoesNotDependOnThreads) {
  write_both();
  const Words settings = experiment + Words{of_files("\"a.csv\",\"b.csv\"")};
  Program killed = folder_.start("calibrate --threads 1 --out killed", settings);
  const std::string evaluations = "killed/fit/evaluations/curve_2.jsonl";
  folder_.comes(evaluations);
  killed.send(SIGTERM);
  const ProgramResult stopped = killed.wait();
  if (stopped.code == 0 || stopped.code == 4) GTEST_SKIP() << "too fast to be interrupted";
  ASSERT_EQ(stopped.code, 130) << stopped.err;
  const std::string before = folder_.text(evaluations);
  ASSERT_FALSE(before.empty());

  // Poisson's ratio stays open on so coarse a lattice, which is a verdict, not a failure.
  const ProgramResult resumed =
      folder_.run("calibrate --threads 1 --out killed --resume auto", settings, judged);
  EXPECT_TRUE(folder_.text(evaluations).starts_with(before)) << "evaluations were done again";
  folder_.forget_cache();
  folder_.run("calibrate --threads 2 --out whole", settings, resumed.code);
  const json first = found("killed"), second = found("whole");
  for (std::size_t p = 0; p < 2; ++p) {
    const double a = first["parameters"][p]["estimate"], b = second["parameters"][p]["estimate"];
    const double deviation = first["parameters"][p]["standard_error"];
    EXPECT_NEAR(a, b, 1e-6 * deviation);
  }
}
