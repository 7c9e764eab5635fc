#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes/base/errors.h"
#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;

/// A press of `factor` times a straight line of 100 N/m down to `depth`.
void write_line(const fs::path& folder, double factor, double depth) {
  std::ostringstream text;
  text << "indentation [m],normal_force [N]\n";
  for (int i = 1; i <= 10; ++i)
    text << depth * i / 10.0 << ',' << factor * 100.0 * depth * i / 10.0 << '\n';
  report_testing::write_file(folder / "response.csv", text.str());
}

std::vector<std::vector<std::string>> cells(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back(1);
    for (char c : line) {
      if (c == ',')
        rows.back().emplace_back();
      else
        rows.back().back() += c;
    }
  }
  return rows;
}

/// At samples their own; between them the larger share of both sides.
TEST(Comparison, TellsForcesWithTheirErrors) {
  TemporaryFolder folder;
  report_testing::write_file(folder.path() / "a/response.csv",
                             "indentation [m],normal_force [N],force_error [N]\n"
                             "0.001,2,0.02\n0.002,4,0.08\n0.003,6,0.06\n");
  report_testing::write_file(folder.path() / "b/response.csv",
                             "indentation [m],normal_force [N],force_error [N]\n"
                             "0.001,2.2,\n0.0015,3.3,0.33\n0.003,6.6,0.33\n");
  studies::report::write_comparison({folder.path() / "a", folder.path() / "b"},
                                    folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  ASSERT_EQ(rows[0].size(), 7U);
  EXPECT_EQ(rows[0][5], "a force_error [N]");
  EXPECT_EQ(rows[0][6], "b force_error [N]");
  ASSERT_GE(rows.size(), 3U);
  EXPECT_EQ(std::stod(rows[1][5]), 0.02);
  EXPECT_EQ(rows[1][6], "");
  EXPECT_EQ(std::stod(rows.back()[5]), 0.06);
  EXPECT_EQ(std::stod(rows.back()[6]), 0.33);
  EXPECT_TRUE(
      says(report_testing::visible_text(read_text(folder.path() / "out/comparison.html")), "± 330"))
      << report_testing::visible_text(read_text(folder.path() / "out/comparison.html"));
}

/// At depths that both have, of the press; a field by itself is nothing to compare.
TEST(Comparison, TellsHowContactsDiffer) {
  TemporaryFolder folder;
  write_line(folder.path() / "soft", 1.0, 0.002);
  write_line(folder.path() / "stiff", 1.25, 0.002);
  report_testing::write_contact_field(folder.path() / "soft", {2e-4, 4e-4, 6e-4});
  const std::vector<fs::path> runs{folder.path() / "soft", folder.path() / "stiff"};
  const fs::path out = folder.path() / "out";
  studies::report::write_comparison(runs, out);
  EXPECT_FALSE(fs::exists(out / "comparison_contact.csv"));
  report_testing::write_contact_field(folder.path() / "stiff", {2e-4, 4e-4}, 1.1);
  const std::string screen = studies::report::write_comparison(runs, out).text;
  const auto rows = cells(read_text(out / "comparison_contact.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0][1], "stiff pressure_l2");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_NEAR(std::stod(rows[i][0]), 2e-4 * double(i), 1e-12);
    EXPECT_NEAR(std::stod(rows[i][1]), 0.1 * std::sqrt(0.5), 1e-3);  // of Hertz's pressure
    EXPECT_EQ(std::stod(rows[i][2]), 0.0);
    EXPECT_NEAR(std::stod(rows[i][3]), 0.1, 1e-9);
    EXPECT_NEAR(std::stod(rows[i][4]), 0.0, 1e-9);
  }
  EXPECT_TRUE(says(screen, "7.0 % (largest +10.0 %, radius 0 %)")) << screen;
  EXPECT_TRUE(says(read_text(out / "comparison.html"), "<section id=\"contact\">"));

  // A run without a field is left out, in the file as on the page, and none leaves none.
  write_line(folder.path() / "bare", 1.1, 0.002);
  const std::string three =
      studies::report::write_comparison({folder.path() / "bare", runs[0], runs[1]}, out).text;
  EXPECT_TRUE(says(three, "beside that of soft")) << three;
  EXPECT_EQ(cells(read_text(out / "comparison_contact.csv")), rows);
  studies::report::write_comparison({folder.path() / "bare", runs[0]}, out);
  EXPECT_FALSE(fs::exists(out / "comparison_contact.csv"));
  EXPECT_TRUE(says(read_text(out / "comparison.html"), "The contact of soft at"));
}

/// Two samples at 1 and 2 mm of a row of markers that goes down by `factor` times half the way.
std::string markers(double factor, double error, double shift = 0.0) {
  std::ostringstream text;
  text << "sample,indentation [m],marker,x [m],y [m],z [m],displacement_x [m],displacement_y [m],"
          "displacement_z [m],error [m]\n";
  for (int sample = 1; sample <= 2; ++sample)
    for (int i = 0; i < 9; ++i)
      text << sample << ',' << 1e-3 * sample << ',' << i + 1 << ',' << 1e-3 * (i - 4) + shift
           << ",0,0.009,0,0," << -0.5e-3 * sample * factor << ',' << error << '\n';
  return text.str();
}

/// At samples that both have, of the same markers, on the screen, in the file and on the page.
TEST(Comparison, TellsHowMarkersDiffer) {
  TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const std::vector<fs::path> runs{folder.path() / "soft", folder.path() / "stiff"};
  const auto put = [](const fs::path& run, const std::string& text) {
    report_testing::write_file(run / "response.csv",
                               "indentation [m],normal_force [N]\n0.001,0.1\n0.002,0.2\n");
    report_testing::write_file(run / "markers.csv", text);
  };
  put(runs[0], markers(1.0, 1e-6));
  put(runs[1], markers(1.1, 3e-6));
  const std::string screen = studies::report::write_comparison(runs, out).text;
  const auto rows = cells(read_text(out / "comparison_markers.csv"));
  ASSERT_EQ(rows.size(), 3u);
  ASSERT_EQ(rows[0].size(), 14u);
  EXPECT_EQ(rows[0][2], "soft rms [m]");
  EXPECT_EQ(rows[0][8], "stiff difference [m]");
  EXPECT_EQ(rows[0][12], "stiff relative_difference");
  for (std::size_t i = 1; i < 3; ++i) {
    const double way = 0.5e-3 * double(i);
    EXPECT_NEAR(std::stod(rows[i][0]), 1e-3 * double(i), 1e-12);
    EXPECT_NEAR(std::stod(rows[i][2]), way, 1e-12);
    EXPECT_NEAR(std::stod(rows[i][8]), 0.1 * way, 1e-12);
    EXPECT_NEAR(std::stod(rows[i][9]), 0.1 * way, 1e-12);
    EXPECT_NEAR(std::stod(rows[i][11]), 4e-6, 1e-12);
    EXPECT_NEAR(std::stod(rows[i][12]), 0.1, 1e-9);
    EXPECT_NEAR(std::stod(rows[i][13]), 4e-6 / way, 1e-9);
  }
  EXPECT_TRUE(says(screen, {"stiff: relative difference", "10.0 %", "errors 0.40 %"})) << screen;
  const std::string html = read_text(out / "comparison.html");
  EXPECT_TRUE(says(html, {"<section id=\"markers\">", "How 9 markers have moved"}));
  EXPECT_TRUE(report_testing::structure_faults(html).empty());
  for (const char* figure : {"markers_along", "markers_side", "markers_difference"})
    EXPECT_TRUE(fs::exists(out / "figures" / (std::string(figure) + ".svg"))) << figure;

  // Other markers are not compared, and no file tells of them.
  put(runs[1], markers(1.1, 3e-6, 1e-4));
  studies::report::write_comparison(runs, out);
  EXPECT_FALSE(fs::exists(out / "comparison_markers.csv"));
  EXPECT_FALSE(says(read_text(out / "comparison.html"), "<section id=\"markers\">"));
}

TEST(Comparison, GivesDifferencesRelativeToTheFirstRun) {
  TemporaryFolder folder;
  write_line(folder.path() / "soft", 1.0, 0.002);
  write_line(folder.path() / "stiff", 1.25, 0.002);
  studies::report::write_comparison({folder.path() / "soft", folder.path() / "stiff"},
                                    folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  ASSERT_EQ(rows.size(), 11U);
  EXPECT_EQ(rows[0][1], "soft normal_force [N]");
  EXPECT_EQ(rows[0][3], "stiff relative_difference");
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_NEAR(std::stod(rows[i][3]), 0.25, 1e-12);
  EXPECT_TRUE(fs::exists(folder.path() / "out" / "figures" / "comparison_force.svg"));
  const std::string html = read_text(folder.path() / "out" / "comparison.html");
  EXPECT_TRUE(report_testing::structure_faults(html).empty())
      << report_testing::structure_faults(html).front();
  EXPECT_TRUE(report_testing::outside_references(html).empty());
  EXPECT_TRUE(says(report_testing::visible_text(html), "stiff differs by +25.0 %"));
}

/// A press of given samples [m, N] and, unless empty, inputs of its job.
void write_press(const fs::path& folder, const std::vector<std::pair<double, double>>& samples,
                 const std::string& inputs = {}) {
  std::ostringstream text;
  text << "indentation [m],normal_force [N]\n";
  for (const auto& [depth, force] : samples) text << depth << ',' << force << '\n';
  report_testing::write_file(folder / "response.csv", text.str());
  if (!inputs.empty())
    report_testing::write_file(folder / "finished.json", "{\"inputs\": " + inputs + "}");
}

/// Inputs of a lattice's press.
std::string lattice_inputs(const std::string& contact, const std::string& strain = "small",
                           double speed = 0.01) {
  std::ostringstream text;
  text
      << R"({"geometry":{"tip_radius":0.01},"rubber":{"youngs_modulus":4000},"protocol":{"contact":")"
      << contact << R"(","tilt":0,"lateral":0,"speed":)" << speed
      << R"(},"lattice":{"kinematics":")" << strain << "\"}}";
  return text.str();
}

/// Inputs of a press of a finger of this geometry.
std::string inputs_of(const std::string& geometry) {
  return R"({"geometry":)" + geometry + R"(,"protocol":{"contact":"stick"},"lattice":{}})";
}

/// A press with a fit that was not accepted is no measure of anything without that word.
TEST(Comparison, APressOfARejectedFitSaysSoFirst) {
  TemporaryFolder folder;
  write_line(folder.path() / "plain", 1.0, 0.002);
  write_line(folder.path() / "foam", 1.25, 0.002);
  report_testing::write_file(
      folder.path() / "foam" / "summary.json",
      R"({"warnings": ["deep", "material.toml: the fit failed its own tests: E = 0.5 Pa"]})");
  const auto result = studies::report::write_comparison(
      {folder.path() / "plain", folder.path() / "foam"}, folder.path() / "out");
  EXPECT_EQ(result.text.rfind("NOT ACCEPTED: foam: material.toml: the fit failed", 0), 0u)
      << result.text;
  const std::string html = read_text(folder.path() / "out" / "comparison.html");
  EXPECT_LT(html.find("<div class=\"rejected\""), html.find("<p class=\"answer\""));
  const std::string text = report_testing::visible_text(html);
  EXPECT_TRUE(says(text, "foam: material.toml: the fit failed its own tests"));
  EXPECT_TRUE(omits(text, "deep"));
}

TEST(Comparison, TellsOfShapesWhatHoldsForBoth) {
  const TemporaryFolder folder;
  const auto finger = [](const std::string& lengths, const std::string& shape) {
    return inputs_of("{" + lengths + (shape.empty() ? "" : "," + shape) + "}");
  };
  const std::string ten = R"("tip_radius":0.01,"rod_radius":0.005,"sleeve_length":0.015)";
  const std::string twelve = R"("tip_radius":0.012,"rod_radius":0.012,"sleeve_length":0)";
  const std::string corners = R"("profile":[{"r":0.012,"z":0}])";
  const std::vector<std::pair<double, double>> samples{{1e-3, 1.0}, {2e-3, 2.0}};
  write_press(folder / "dome", samples, finger(ten + R"(,"rod_length":0.03)", ""));
  write_press(folder / "profile", samples, finger(twelve + R"(,"rod_length":0)", corners));
  write_press(folder / "other", samples,
              finger(twelve + R"(,"rod_length":0)", R"("profile":[{"r":0.012,"z":0.001}])"));
  write_press(folder / "lower", samples, finger(twelve + R"(,"rod_length":0.001)", corners));
  write_press(folder / "solid", samples,
              finger(twelve + R"(,"rod_length":0)", R"("solid":"0123abcd")"));
  const auto remark = [&](const char* one, const char* other) {
    const std::string text =
        studies::report::write_comparison({folder / other, folder / one}, folder / "out").text;
    const auto from = text.find("problem ("), to = text.find("): the percentages");
    return to == text.npos ? text : text.substr(from + 9, to - from - 9);
  };
  EXPECT_EQ(remark("profile", "dome"),
            "shape: profile, not dome; largest radius: 12 mm, not 10 mm");
  EXPECT_EQ(remark("solid", "profile"), "shape: solid, not profile");
  EXPECT_EQ(remark("other", "profile"), "another profile");
  EXPECT_EQ(remark("lower", "profile"), "depth of the endpoint below z = 0: 1 mm, not 0 mm");
}

TEST(Comparison, TellsNothingOutsideTheSamplesOfARun) {
  const TemporaryFolder folder;
  std::vector<std::pair<double, double>> fine;
  for (int i = 1; i <= 30; ++i) fine.push_back({1e-4 * i, 0.02 * i * i});
  write_press(folder / "fine", fine);
  write_press(folder / "coarse", {{1e-3, 2.2}, {2e-3, 8.8}});
  const auto result =
      studies::report::write_comparison({folder / "fine", folder / "coarse"}, folder / "out");
  // Common samples alone, at both of which the forces differ by 10 %.
  const auto rows = cells(read_text(folder / "out/comparison.csv"));
  ASSERT_EQ(rows.size(), 3U);
  for (std::size_t i : {1, 2}) {
    EXPECT_NEAR(std::stod(rows[i][3]), 0.1, 1e-12);
    EXPECT_EQ(rows[i][4], "0");
  }
  EXPECT_TRUE(omits(result.text, "interpolated"));
}

/// What the screen shows in several lines.
std::string in_a_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

TEST(Comparison, InterpolatesInsideTheSamplesWhereNoneAreCommonAndSaysSo) {
  const TemporaryFolder folder;
  write_press(folder / "a", {{0.5e-3, 0.5}, {1e-3, 1.0}, {1.5e-3, 1.5}, {2e-3, 2.0}, {3e-3, 3.0}});
  write_press(folder / "b", {{0.9e-3, 0.99}, {1.2e-3, 1.32}, {2.1e-3, 2.31}});
  const auto result =
      studies::report::write_comparison({folder / "a", folder / "b"}, folder / "out");
  const auto rows = cells(read_text(folder / "out/comparison.csv"));
  ASSERT_EQ(rows.size(), 4U);  // 1, 1.5 and 2 mm
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_NEAR(std::stod(rows[i][3]), 0.1, 1e-6);
    EXPECT_EQ(rows[i][4], "1");
  }
  EXPECT_TRUE(says(in_a_line(result.text), "~: interpolated between samples of b"));
  EXPECT_TRUE(says(report_testing::visible_text(read_text(folder / "out/comparison.html")),
                   "interpolated between samples of b"));
}

/// F = d² by three samples: halfway between the last two a chord would lie 1/9 too high.
TEST(Comparison, FewSamplesAreDrawnAsTheCurveThatForcesAreComparedBy) {
  const TemporaryFolder folder;
  write_press(folder / "a", {{1e-3, 1.0}, {2e-3, 4.0}, {3e-3, 9.0}});
  write_press(folder / "b", {{1e-3, 1.1}, {2e-3, 4.4}, {3e-3, 9.9}});
  studies::report::write_comparison({folder / "a", folder / "b"}, folder / "out");
  // The numbers are the samples, the line has a point per 1/200 of the depth.
  EXPECT_EQ(cells(read_text(folder / "out/figures/comparison_force.csv")).size(), 7U);
  const std::string html = read_text(folder / "out/comparison.html");
  const auto line = html.find("id=\"comparison_force_plot_1\"");
  ASSERT_NE(line, std::string::npos);
  const std::string first = html.substr(line, html.find("comparison_force_plot_2") - line);
  EXPECT_TRUE(omits(first, "<use"));
  EXPECT_GT(std::ranges::count(first, ','), 190);
  // Its samples are the next item, which buttons switch with it.
  EXPECT_TRUE(says(html, "[\"comparison_force_plot_1\",\"comparison_force_plot_2\"]"));
}

TEST(Comparison, OneSampleOfEachAtOneDepthIsCompared) {
  const TemporaryFolder folder;
  write_press(folder / "a", {{1e-3, 1.0}});
  write_press(folder / "b", {{1e-3, 1.5}});
  const auto result =
      studies::report::write_comparison({folder / "a", folder / "b"}, folder / "out");
  const auto rows = cells(read_text(folder / "out/comparison.csv"));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(std::stod(rows[1][3]), 0.5, 1e-12);
}

/// At full depth the forces of a lateral motion are none of the press.
TEST(Comparison, ForcesAgainstIndentationEndWithThePress) {
  const TemporaryFolder folder;
  const std::string press =
      "indentation [m],normal_force [N],lateral_force_x [N],lateral_displacement [m]\n"
      "0.001,1,0,0\n0.002,3,0,0\n";
  report_testing::write_file(folder / "a/response.csv",
                             press + "0.002,7,0.5,0.0001\n0.002,9,1,0.0002\n");
  report_testing::write_file(folder / "b/response.csv", press + "0.002,8,0.7,0.0002\n");
  const auto result =
      studies::report::write_comparison({folder / "a", folder / "b"}, folder / "out");
  const auto rows = cells(read_text(folder / "out/comparison.csv"));
  ASSERT_EQ(rows.size(), 3U);
  for (const std::size_t i : {1, 2}) EXPECT_EQ(std::stod(rows[i][3]), 0.0);
  const auto lateral = result.text.find("lateral force at full depth [mN]");
  ASSERT_NE(lateral, std::string::npos) << result.text;
  // The one displacement that both have: 1 and 0.7 N.
  EXPECT_NE(result.text.find(" 1000 ", lateral), std::string::npos) << result.text;
  EXPECT_NE(result.text.find(" 700.0\n", lateral), std::string::npos) << result.text;
  EXPECT_EQ(result.text.find("0.1000 ", lateral), std::string::npos) << result.text;
  EXPECT_TRUE(says(read_text(folder / "out/comparison.html"), "comparison_lateral"));
}

TEST(Comparison, SaysThatRunsOfAnotherContactAreNotTheSameProblem) {
  const TemporaryFolder folder;
  const std::vector<std::pair<double, double>> samples = {{1e-3, 1.0}, {2e-3, 3.0}};
  write_press(folder / "stick", samples, lattice_inputs("stick"));
  write_press(folder / "free", samples, lattice_inputs("frictionless"));
  write_press(folder / "large", samples, lattice_inputs("stick", "finite", 0.05));
  write_press(folder / "same", samples, lattice_inputs("stick"));
  write_press(folder / "unknown", samples);
  const auto compare = [&](const char* name) {
    const auto result =
        studies::report::write_comparison({folder / "stick", folder / name}, folder / "out");
    return std::pair{result.text,
                     report_testing::visible_text(read_text(folder / "out/comparison.html"))};
  };
  const auto [free, free_page] = compare("free");
  EXPECT_TRUE(says(free,
                   "WARNING: free and stick are not the same problem (contact: frictionless, not "
                   "stick)"));
  EXPECT_TRUE(
      says(free_page, {"Not the same problem, see below.", "contact: frictionless, not stick"}));
  const auto [large, large_page] = compare("large");
  EXPECT_TRUE(omits(large, "WARNING"));
  EXPECT_TRUE(says(large, "finite strain, not small; pressed at 50 mm/s, not pressed at 10 mm/s"));
  EXPECT_TRUE(says(large_page, "finite strain, not small"));
  EXPECT_TRUE(omits(compare("same").first, "note:"));
  EXPECT_TRUE(says(compare("unknown").first, "not known"));
}

TEST(Comparison, LeavesCellsEmptyBeyondTheDepthOfARun) {
  TemporaryFolder folder;
  write_line(folder.path() / "deep", 1.0, 0.002);
  write_line(folder.path() / "shallow", 1.0, 0.001);
  studies::report::write_comparison({folder.path() / "deep", folder.path() / "shallow/"},
                                    folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  EXPECT_EQ(rows[0][2], "shallow normal_force [N]");
  EXPECT_NEAR(std::stod(rows[5][3]), 0.0, 1e-12);
  ASSERT_EQ(rows.size(), 6U);  // the deeper samples have nothing beside them
}

TEST(Comparison, TakesAValidateRunApartWithTheContinuumFirst) {
  TemporaryFolder folder;
  report_testing::write_synthetic_run(folder.path() / "run");
  studies::report::write_comparison({folder.path() / "run"}, folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  EXPECT_EQ(rows[0][1], "run/reference normal_force [N]");
  ASSERT_GE(rows[0].size(), 3U);
  const std::size_t last = rows[0].size() - 2 - 4;  // before the errors
  EXPECT_EQ(rows[0][last], "run/hookean relative_difference");
  EXPECT_NEAR(std::stod(rows.back()[last]), 0.02, 1e-9);
}

TEST(Comparison, TellsRunsOfTheSameNameApartAndEscapesNames) {
  TemporaryFolder folder;
  const std::string odd = "it's <b>&, \"odd\"";
  write_line(folder.path() / "a" / odd, 1.0, 0.002);
  write_line(folder.path() / "b" / odd, 2.0, 0.002);
  studies::report::write_comparison({folder.path() / "a" / odd, folder.path() / "b" / odd},
                                    folder.path() / "out");
  const std::string html = read_text(folder.path() / "out" / "comparison.html");
  EXPECT_TRUE(report_testing::structure_faults(html).empty())
      << report_testing::structure_faults(html).front();
  EXPECT_TRUE(says(report_testing::visible_text(html), odd + " (2)"));
}

TEST(Comparison, RefusesLessThanTwoCurvesAndFoldersWithoutOne) {
  TemporaryFolder folder;
  write_line(folder.path() / "only", 1.0, 0.002);
  fs::create_directories(folder.path() / "empty");
  EXPECT_THROW(studies::report::write_comparison({folder.path() / "only"}, folder.path() / "out"),
               meshes::InvalidInput);
  EXPECT_THROW(studies::report::write_comparison({folder.path() / "only", folder.path() / "empty"},
                                                 folder.path() / "out"),
               meshes::InvalidInput);
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
