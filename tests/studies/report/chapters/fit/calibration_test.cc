// The page of a fit to curves, from a folder of `calibrate` whose numbers are known.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <regex>
#include <sstream>
#include <vector>

#include "meshes/base/errors.h"
#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_fit.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using nlohmann::json;
using report_testing::visible_text;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class FitReport : public testing::Test {
 protected:
  /// Writes the folder with `edit` applied to calibration.json; the page.
  std::string report(const std::function<void(json&)>& edit = {}) {
    json result = report_testing::fit_result();
    if (edit) edit(result);
    report_testing::write_fit(run_, result);
    return written();
  }
  std::string written() const {
    studies::report::write_report(run_);
    const std::string html = read_text(run_ / "report.html");
    const auto faults = report_testing::structure_faults(html);
    EXPECT_TRUE(faults.empty()) << faults.front();
    EXPECT_TRUE(report_testing::outside_references(html).empty());
    EXPECT_TRUE(omits(visible_text(html), "nan "));
    return html;
  }
  std::string svg(const std::string& name) const {
    return read_text(run_ / "figures" / (name + ".svg"));
  }
  /// Rows of a figure's CSV whose series is `series`, without panel and series.
  std::vector<std::vector<double>> rows(const std::string& figure,
                                        const std::string& series) const {
    std::istringstream stream(read_text(run_ / "figures" / (figure + ".csv")));
    std::vector<std::vector<double>> found;
    for (std::string line; std::getline(stream, line);) {
      std::vector<std::string> cells;
      std::istringstream row(line + ",");
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (cells.at(1) != series) continue;
      found.emplace_back();
      for (std::size_t i = 2; i < cells.size(); ++i)
        found.back().push_back(cells[i].empty() || cells[i] == "nan" ? std::nan("")
                                                                     : std::stod(cells[i]));
    }
    return found;
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

/// How a curve was pressed, in the units that are asked for.
TEST_F(FitReport, ConditionsHaveTheUnitsAskedFor) {
  report([](json& result) {
    result["curves"][0]["condition"] = "frictionless, ball of 0.006 m, lateral 0.0005 m";
  });
  const auto text = [&](studies::UnitSystem units) {
    studies::report::write_report(run_, units);
    return visible_text(read_text(run_ / "report.html"));
  };
  EXPECT_TRUE(says(text(studies::UnitSystem::si), "frictionless, ball of 6 mm, lateral 0.5 mm"));
  EXPECT_TRUE(
      has(text(studies::UnitSystem::paper), "frictionless, ball of 0.6 cm, lateral 0.05 cm"));
}

TEST_F(FitReport, TellsTheResultWithItsDoubts) {
  const std::string text = visible_text(report());
  // 4000 Pa ± 1.96 × 80 Pa; the prior is 3922.66 Pa ± 98.07 Pa.
  EXPECT_TRUE(says(text, {"The model hookean, fitted to 2 curves, has E = 4.000 kPa",
                          "3.843 … 4.157", "3.923 ± 0.0981", "−3.0 %", "2.0 %", "0.600",
                          "Chi-square is 40.00 with 8 degrees of freedom", "3.2×10⁻⁶",
                          "The residuals are larger than sigma explains",
                          "One run: the model is too soft.", "E and G that rise together",
                          "stick, tilt 20 deg", "of a curve that was left out, 7.7 %", "2.500",
                          "333.0", "20.0 % of the thickness", "Two presses were fitted."}));
  EXPECT_TRUE(says(text, "reported")) << "which of the minima";
  EXPECT_TRUE(omits(text, "Truth"));
}

TEST_F(FitReport, WarnsOnlyWhereThereIsSomethingToWarnOf) {
  EXPECT_TRUE(says(report(), "class=\"warning\""));
  const std::string calm = report([](json& result) {
    result["unidentifiable"] = json::array();
    result["chi_square"] = 8.1;
    result["chi_square_probability"] = 0.42;
    result["minima"][0] = result["minima"][1];
  });
  EXPECT_TRUE(omits(calm, "class=\"warning\""));
  const std::string text = visible_text(calm);
  EXPECT_TRUE(says(text, {"The data determine every direction of the parameters.",
                          "The residuals are as large as sigma says.",
                          "All 2 starts ended at the same place."}));
  const std::string bound =
      report([](json& result) { result["parameters"][1]["at_bound"] = true; });
  EXPECT_TRUE(says(visible_text(bound), "G ended at the limit set for the search"));
  const std::string ratio = report([](json& result) {
    result["parameters"][0]["at_bound"] = true;
    result["parameters"][0]["bound_of"] = "poissons_ratio";
  });
  EXPECT_TRUE(says(visible_text(ratio), "ν ended at the limit set for the search"));
}

/// What must not be used does not look as if it might be: why stands first, in red, in shown units.
TEST_F(FitReport, ARejectedFitSaysSoFirst) {
  const std::string accepted = report();
  EXPECT_TRUE(omits(accepted, "class=\"rejected\""));
  EXPECT_TRUE(omits(visible_text(accepted), "ot accepted"));
  const std::string html = report([](json& result) {
    result["failed"] = {"E = 0.5 Pa is no rubber's", "G ended at a bound"};
  });
  const std::string text = visible_text(html);
  const auto box = html.find("<div class=\"rejected\""), answer = html.find("<p class=\"answer\"");
  ASSERT_NE(box, html.npos);
  EXPECT_LT(box, answer);
  EXPECT_TRUE(says(html, ".rejected + .answer { border-left-color: #c62828; }"));
  EXPECT_TRUE(says(text, {"E = 0.0005 kPa is no rubber", "G ended at a bound"}));
  EXPECT_LT(text.find("This fit is not accepted."), text.find("has E = 4.000 kPa"));
  EXPECT_TRUE(omits(text, "Status of the run"));
}

TEST_F(FitReport, CurvesAreInMillinewtonAndResidualsInSigma) {
  report();
  const auto measured = rows("fit_curves", "stick measured");
  ASSERT_EQ(measured.size(), 5u);
  EXPECT_NEAR(measured[4][0], 2.0, 1e-12);
  EXPECT_NEAR(measured[4][1], 1.1 * 1.02 * 1000.0 * std::pow(0.002, 1.5) * 1e3, 1e-9);
  for (const auto& row : rows("fit_curves", "stick")) EXPECT_NEAR(row[2], 2.0, 1e-9);
  EXPECT_TRUE(says(svg("fit_curves"), {"force [mN]", "residual / sigma"}));
}

// The synthetic profile is the quadratic form of the covariance: the line of 5.99 is the ellipse.
TEST_F(FitReport, ProfileLinesAreThoseOfTheCovariance) {
  report();
  std::size_t points = 0;
  double widest = 0.0;
  for (const auto& [series, level] : {std::pair{"68 %", 2.30}, {"95 %", 5.99}, {"ellipse", 5.99}}) {
    for (const auto& row : rows("fit_profile", series)) {
      if (std::isnan(row[0])) continue;
      const double u = (row[0] * 1e3 - 4000.0) / 80.0, v = (row[1] * 1e3 - 1400.0) / 42.0;
      EXPECT_NEAR((u * u - 1.2 * u * v + v * v) / 0.64, level, 0.02) << series;
      if (level > 5.0) widest = std::fmax(widest, u);
      ++points;
    }
  }
  EXPECT_GT(points, 200u);
  EXPECT_NEAR(widest, std::sqrt(5.99), 0.01);
  EXPECT_TRUE(says(svg("fit_profile"), "E [kPa]"));
}

TEST_F(FitReport, ProfileTooCoarseForItsValleyShowsPointsAlone) {
  report([](json& result) {
    // A bent valley, far narrower than the grid's steps.
    json& profile = result["profile"];
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t j = 0; j < 9; ++j) {
        const double u = double(i) - 4.0, v = double(j) - 4.0;
        profile["increase"][i][j] = 0.1 * u * u + 400.0 * std::pow(v - u - 0.3 * u * u * u, 2);
      }
  });
  EXPECT_TRUE(rows("fit_profile", "95 %").empty());
  EXPECT_FALSE(rows("fit_profile", "within 68 %").empty());
}

// Along a cube axis and the diagonals the surfaces must reach the homogenised constants: of the
// published rule k = E a²/l0 with l0 = a, √2 a, √3 a.
TEST_F(FitReport, SurfacesShowRuleAndFit) {
  report();
  const double E = 4000.0, c44 = (1.0 / std::sqrt(2.0) + 4.0 / 3.0 / std::sqrt(3.0)) * E;
  const double c11 = E + c44 + E / std::sqrt(2.0), c12 = c44;
  const json moduli = report_testing::cubic_moduli(c11, c12, c44);
  double least = 1e9, most = 0.0;
  for (const auto& row : rows("fit_moduli", "before: the published rule")) {
    least = std::fmin(least, row[3]), most = std::fmax(most, row[3]);
    EXPECT_NEAR(std::hypot(row[0], row[1], row[2]), row[3], 1e-9 * row[3]);
  }
  EXPECT_NEAR(least, moduli["E_100"].get<double>() / 1e3, 1e-6);
  EXPECT_NEAR(most, moduli["E_111"].get<double>() / 1e3, 0.01 * most);
  // k1 = k2 = aG, k3 = 0: isotropic with this G, and lambda = kappa + G.
  const double G = 1400.0, lambda = 9100.0;
  const double ball = G * (3.0 * lambda + 2.0 * G) / (lambda + G) / 1e3;
  for (const auto& row : rows("fit_moduli", "after: fitted")) EXPECT_NEAR(row[3], ball, 1e-6);
  EXPECT_LT(fs::file_size(run_ / "figures" / "fit_moduli.svg"), 300'000u);
}

// Measured presses replace no rule for springs; a lattice of theirs that is no ball is shown alone.
TEST_F(FitReport, TheSurfaceOfARubberThatWasMeasuredStandsAlone) {
  const auto measured = [](json& result) { result["problem"] = "experiment"; };
  EXPECT_TRUE(omits(report(measured), "fit_moduli"));
  const std::string central = report([&](json& result) {
    measured(result);
    result["constants"]["k3"] = 1.0;
  });
  EXPECT_TRUE(says(central, "fit_moduli"));
  EXPECT_TRUE(omits(central, "published"));
  EXPECT_TRUE(omits(visible_text(central), "both at the same scale"));
}

// What is drawn later lies above, and the CSV has the order of drawing.
TEST_F(FitReport, TheFittedLineLiesAboveItsDots) {
  report();
  const std::string table = read_text(run_ / "figures" / "fit_curves.csv");
  ASSERT_TRUE(says(table, ",stick measured,"));
  EXPECT_LT(table.rfind(",stick measured,"), table.find(",stick fitted,"));
  EXPECT_TRUE(omits(svg("fit_curves"), "opacity='0.30'")) << "five dots hide nothing";
  std::string rows = "curve,x,measured,sigma,fitted,left_out\n";
  for (int i = 1; i <= 60; ++i)
    rows += fmt::format("stick,{0},{0},,{0},\nfrictionless,{0},{0},,{0},\n", 1e-5 * i);
  report_testing::write_file(run_ / "fit_data.csv", rows);
  written();
  EXPECT_TRUE(says(svg("fit_curves"), "opacity='0.30'"));
}

// What readers turn starts as what gnuplot printed: every corner of every facet is where one of the
// page's points is seen from its angles.
TEST_F(FitReport, SurfacesThatTurnCoincideWithThePicture) {
  const std::string html = report();
  const std::string opening = "<script type=\"application/json\">";
  const auto from = html.find(opening, html.find("<figure id=\"fit_moduli\"")) + opening.size();
  const std::string text = html.substr(from, html.find("</script>", from) - from);
  EXPECT_LT(text.size(), 120'000u);
  const json panels = json::parse(text);
  ASSERT_EQ(panels.size(), 2u);
  using Place = std::array<double, 2>;
  std::vector<Place> seen;
  for (const json& panel : panels) {
    const double a = panel["view"][0].get<double>() / 57.29577951308232;
    const double e = panel["view"][1].get<double>() / 57.29577951308232;
    const auto& box = panel["box"];
    for (const json& point : panel["points"]) {
      const double x = point[0], y = point[1], z = point[2];
      const double ahead = std::cos(a) * y - std::sin(a) * x;
      seen.push_back(
          {(box[0].get<double>() + box[1].get<double>()) / 2.0 + std::cos(a) * x + std::sin(a) * y,
           (box[2].get<double>() + box[3].get<double>()) / 2.0 - std::sin(e) * ahead -
               std::cos(e) * z});
    }
    int facets = 0;
    for (const json& piece : panel["pieces"]) facets += piece.size() == 5;
    EXPECT_EQ(facets, 20 * 40);
  }
  const std::string picture = svg("fit_moduli");
  const std::regex corners("<polygon fill = '[^']*' points = '([^']*)'");
  int facets = 0;
  double farthest = 0.0;
  for (std::sregex_iterator it(picture.begin(), picture.end(), corners), end; it != end; ++it) {
    std::string places = (*it)[1];
    std::replace(places.begin(), places.end(), ',', ' ');
    if (std::stod(places) > panels[0]["colour_scale"].get<double>() - 1.0) continue;
    std::istringstream stream(places);
    ++facets;
    for (Place place; stream >> place[0] >> place[1];) {
      double nearest = 1e9;
      for (const Place& other : seen)
        nearest = std::fmin(nearest, std::hypot(place[0] - other[0], place[1] - other[1]));
      farthest = std::fmax(farthest, nearest);
    }
  }
  EXPECT_EQ(facets, 2 * 20 * 40);
  EXPECT_LT(farthest, 0.2);
}

TEST_F(FitReport, SurrogateHasForceAndStiffnessWithKnots) {
  report_testing::write_surrogate(run_);
  const std::string text = visible_text(report());
  EXPECT_TRUE(says(text, "Condition: frictionless. Three knots. The band is at most 4.0 %"));
  EXPECT_TRUE(omits(text, "(surrogate.csv, surrogate.json)"));
  EXPECT_NEAR(rows("fit_surrogate", "stiffness at knots").at(1)[2], 100.0, 1e-9);
  EXPECT_EQ(rows("fit_surrogate", "band").size(), 42u);
}

TEST_F(FitReport, MissingPartsAreNamed) {
  report_testing::write_fit(run_, report_testing::fit_result());
  fs::remove(run_ / "fit_data.csv");
  json result = report_testing::fit_result();
  result["profile"] = nullptr;
  for (json& curve : result["curves"]) curve["left_out"] = nullptr;
  report_testing::write_file(run_ / "calibration.json", result.dump());
  const std::string text = visible_text(written());
  EXPECT_TRUE(
      says(text, {"Measured and fitted curves", "(fit_data.csv)", "Profile likelihood",
                  "Curves left out one after the other", "(surrogate.csv, surrogate.json)"}));
  EXPECT_FALSE(fs::exists(run_ / "figures" / "fit_profile.svg"));
}

TEST_F(FitReport, WithoutSigmaSaysWhatCannotBeSaid) {
  report_testing::write_fit(run_, report_testing::fit_result());
  json result = report_testing::fit_result();
  result["chi_square"] = result["chi_square_probability"] = nullptr;
  result["residual_deviation"] = 0.0031;
  report_testing::write_file(run_ / "calibration.json", result.dump());
  report_testing::write_file(run_ / "fit_data.csv",
                             "curve,x,measured,sigma,fitted,left_out\n"
                             "frictionless,0.001,0.1,,0.11,\nfrictionless,0.002,0.2,,0.19,\n");
  const std::string text = visible_text(written());
  EXPECT_TRUE(says(text, {"No sigma was given", "Residual deviation: 3.100 mN."}));
  EXPECT_NEAR(rows("fit_curves", "frictionless").at(0)[2], -10.0, 1e-9) << "per cent of measured";
}

/// What chi-square squares is drawn, where a file tells it.
TEST_F(FitReport, ResidualsAreThoseThatChiSquareCounts) {
  json result = report_testing::fit_result();
  result["model_error"] = "the known error of the lattice";
  report_testing::write_fit(run_, result);
  const std::string old = visible_text(written());
  EXPECT_TRUE(says(old, "Chi-square counts the known error of the lattice besides."));
  report_testing::write_file(
      run_ / "fit_data.csv",
      "curve,x,measured,sigma,fitted,left_out,indentation,total_sigma,whitened_residual\n"
      "frictionless,0.001,0.1,0.001,0.11,,,0.02,-0.7\n"
      "frictionless,0.002,0.2,0.001,0.19,,,0.03,0.4\n");
  const std::string text = visible_text(written());
  const auto drawn = rows("fit_curves", "frictionless");
  ASSERT_EQ(drawn.size(), 2u);
  EXPECT_NEAR(drawn[0][2], -0.7, 1e-12);
  EXPECT_NEAR(drawn[1][2], 0.4, 1e-12);
  EXPECT_TRUE(says(svg("fit_curves"), "whitened residual"));
  EXPECT_TRUE(
      says(text,
           {"Bars are one standard deviation of sigma and the known error of the lattice together.",
            "whitened by the covariance of both",
            "Chi-square is the sum of the squares of these residuals and of the priors'.",
            "The residuals are larger than sigma and the known error of the lattice explain:"}));
  EXPECT_TRUE(omits(text, "besides."));
}

// The norm of the statement, which one value of a small force does not rule.
TEST_F(FitReport, RmsResidualsAreOverTheRmsOfTheData) {
  const std::string text = visible_text(report());
  EXPECT_TRUE(says(text, "the root mean square of the residuals over that of what was measured"));
  // Over their own values they would be 14.1 %.
  report_testing::write_file(run_ / "fit_data.csv",
                             "curve,x,measured,sigma,fitted,left_out\n"
                             "frictionless,0.001,3,1,2.4,\nfrictionless,0.002,4,1,4,\n");
  EXPECT_TRUE(says(visible_text(written()), "12.0 %")) << "0.6 over 5";
}

TEST_F(FitReport, AComplianceThatNobodyMeasuredIsAssumed) {
  const auto with_rig = [&](const json& given, bool fitted) {
    return visible_text(report([&](json& result) {
      const json entry = {{"of", "press"},    {"fitted", fitted}, {"value", 0.0},
                          {"lower", nullptr}, {"upper", nullptr}, {"given", given}};
      result["rig"] = {{"touch_offset", json::array()},
                       {"compliance", {entry}},
                       {"force_offset", json::array()},
                       {"drift", json::array()}};
    }));
  };
  EXPECT_TRUE(
      says(with_rig(false, false), {"default, not measured", "Its compliance was not measured"}));
  EXPECT_TRUE(says(with_rig(false, true), {"nobody has told it", "(95 %) is taken as possible"}));
  for (const std::string& text : {with_rig(true, false), with_rig(nullptr, false)})
    EXPECT_TRUE(omits(text, {"nobody has told it", "Its compliance was not measured"}));
}

/// 0.006 +- 0.013 mm is a touch that is known well; a modulus whose interval exceeds it is not.
TEST_F(FitReport, APressThatWasHeldBackStandsBesideWhatIsForetold) {
  const auto predicted = [](double probability) {
    return [probability](json& result) {
      result["predicted"] = {
          {{"name", "deeper"},
           {"condition", "stick"},
           {"own", {{{"name", "touch_offset (deeper)"}, {"unit", "m"}, {"estimate", 3.1e-4}}}},
           {"x", {0.001, 0.002}},
           {"measured", {0.011, 0.032}},
           {"foretold", {0.010, 0.030}},
           {"lower", {0.009, 0.027}},
           {"upper", {0.012, 0.034}},
           {"rms_relative", 0.066},
           {"within", 1.0},
           {"probability", probability},
           {"failure", ""}}};
    };
  };
  const std::string inside = visible_text(report(predicted(0.4)));
  EXPECT_TRUE(says(inside, {"Held back and foretold", "deeper", "6.6", "27", "34", "inside",
                            "touch_offset (deeper)"}));
  EXPECT_TRUE(omits(inside, "does not foretell"));
  const auto measured = rows("fit_predicted1", "measured");
  ASSERT_EQ(measured.size(), 2u);
  EXPECT_NEAR(measured[1][1], 32.0, 1e-9);  // mN
  EXPECT_TRUE(says(visible_text(report(predicted(0.001))),
                   {"does not foretell what it has not seen", "outside", "probability 0.001"}));
  EXPECT_TRUE(omits(visible_text(report()), "Held back"));
}

TEST_F(FitReport, ATouchNearZeroIsDeterminedAndAModulusLikeThatIsNot) {
  const auto page = [&](const char* name, const char* unit) {
    return visible_text(report([&](json& result) {
      json& parameter = result["parameters"][1];
      parameter["name"] = name, parameter["unit"] = unit;
      parameter["estimate"] = 6e-6, parameter["standard_error"] = 6.6e-6;
      parameter["lower"] = -7e-6, parameter["upper"] = 19e-6;
      result["profile"] = nullptr;
    }));
  };
  const std::string touch = page("touch_offset", "m");
  EXPECT_TRUE(omits(touch, "not determined by these data"));
  EXPECT_TRUE(says(touch, "−0.007000 … 0.01900"));
  EXPECT_TRUE(says(touch, "0.006600")) << "its standard error, which is no share of it";
  EXPECT_TRUE(says(page("shear_modulus", "Pa"), "not determined by these data"));
}

TEST_F(FitReport, OtherQuantitiesKeepTheirUnitsAndTheirOwnFigures) {
  json result = report_testing::fit_result();
  result["problem"] = "damping";
  result["x_quantity"] = "frequency [Hz]";
  result["y_quantity"] = "loss factor [1]";
  result["parameters"] = json::array({result["parameters"][0]});
  result["parameters"][0]["name"] = "retardation_time";
  result["parameters"][0]["unit"] = "s";
  result["parameters"][0]["estimate"] = 3.1e-4;
  result["profile"] = nullptr;
  result["curves"] = json::array(
      {{{"name", "loss"}},
       {{"name", "pull"}, {"x_quantity", "stretch [1]"}, {"y_quantity", "nominal stress [Pa]"}}});
  report_testing::write_file(run_ / "calibration.json", result.dump());
  report_testing::write_file(run_ / "fit_data.csv",
                             "curve,x,measured,sigma,fitted,left_out\nloss,1,0.1,0.01,0.1,\n"
                             "loss,100,0.2,0.01,0.2,\npull,1.5,900,10,910,\n");
  const std::string text = visible_text(written());
  EXPECT_TRUE(says(text, "τ = 0.3100 ms"));
  EXPECT_TRUE(says(svg("fit_curves1"), {"frequency [Hz]", ">loss factor<"}));
  EXPECT_TRUE(says(svg("fit_curves2"), "nominal stress [kPa]"));
  EXPECT_NEAR(rows("fit_curves2", "pull measured").at(0)[1], 0.9, 1e-12);
}

TEST_F(FitReport, OddEntriesAreNotFatal) {
  const std::vector<std::function<void(json&)>> oddities{
      [](json& r) { r["parameters"] = nullptr; },
      [](json& r) {
        r["parameters"] = {1, "two", nullptr};
      },
      [](json& r) { r["curves"] = json::array(); },
      [](json& r) {
        r["covariance"] = {{1.0}, {2.0, 3.0}};
      },
      [](json& r) {
        r["correlation"] = "none", r["singular_values"] = {nullptr, 0.0};
      },
      [](json& r) { r["profile"]["increase"][4] = nullptr; },
      [](json& r) { r["profile"]["first"] = "shear_modulus"; },
      [](json& r) { r["profile"]["increase"][4][4] = nullptr; },
      [](json& r) {
        r["minima"] = {nullptr, 3, {{"estimates", "x"}}};
      },
      [](json& r) {
        r["unidentifiable"] = {{{"direction", {{"youngs_modulus", 1.0}}}}, nullptr};
      },
      [](json& r) { r["constants"] = r["achieved"] = nullptr; },
      [](json& r) { r["x_quantity"] = nullptr, r["y_quantity"] = "]["; },
      [](json& r) {
        r = {{"problem", "curve"}};
      },
  };
  for (std::size_t i = 0; i < oddities.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_FALSE(report(oddities[i]).empty());
  }
  report_testing::write_file(run_ / "calibration.json", "{\"problem\": ");
  const studies::report::Damages damage = studies::report::write_report(run_);
  ASSERT_FALSE(damage.empty());
  EXPECT_TRUE(says(damage.front().key, "calibration.json:1:"));
}

TEST_F(FitReport, TextFromFilesIsEscaped) {
  const std::string odd = "it's <script>alert(1)</script> {{page_title}} \"%s";
  const std::string html = report([&](json& result) {
    result["statement"] = result["model"] = result["curves"][0]["name"] = odd;
    result["parameters"][0]["name"] = result["x_quantity"] = odd;
  });
  EXPECT_TRUE(omits(report_testing::without_own_scripts(html), "<script"));
  EXPECT_TRUE(says(visible_text(html), odd));
}

TEST_F(FitReport, AFolderWithoutAProblemIsRefused) {
  report_testing::write_file(run_ / "calibration.json", "{\"model\": \"hookean\"}");
  const auto damage = studies::report::write_report(run_);
  ASSERT_FALSE(damage.empty());
  EXPECT_TRUE(says(damage[0].key, "calibration.json"));
}

}  // namespace
