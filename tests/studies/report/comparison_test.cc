#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "meshes/errors.h"
#include "page_check.h"
#include "studies/report/report.h"
#include "synthetic_run.h"

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

TEST(Comparison, GivesDifferencesRelativeToTheFirstRun) {
  TemporaryFolder folder;
  write_line(folder.path() / "soft", 1.0, 0.002);
  write_line(folder.path() / "stiff", 1.25, 0.002);
  studies::write_comparison({folder.path() / "soft", folder.path() / "stiff"},
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
  EXPECT_NE(report_testing::visible_text(html).find("stiff differs by 25.0 %"), std::string::npos);
}

TEST(Comparison, LeavesCellsEmptyBeyondTheDepthOfARun) {
  TemporaryFolder folder;
  write_line(folder.path() / "deep", 1.0, 0.002);
  write_line(folder.path() / "shallow", 1.0, 0.001);
  studies::write_comparison({folder.path() / "deep", folder.path() / "shallow/"},
                            folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  EXPECT_EQ(rows[0][2], "shallow normal_force [N]");
  EXPECT_NEAR(std::stod(rows[5][3]), 0.0, 1e-12);
  EXPECT_EQ(rows[6][2], "");
  EXPECT_EQ(rows[10][3], "");
}

TEST(Comparison, TakesAValidateRunApartWithTheContinuumFirst) {
  TemporaryFolder folder;
  report_testing::write_synthetic_run(folder.path() / "run");
  studies::write_comparison({folder.path() / "run"}, folder.path() / "out");
  const auto rows = cells(read_text(folder.path() / "out" / "comparison.csv"));
  EXPECT_EQ(rows[0][1], "run/reference normal_force [N]");
  EXPECT_EQ(rows[0].back(), "run/hookean relative_difference");
  EXPECT_NEAR(std::stod(rows.back().back()), 0.02, 1e-9);
}

TEST(Comparison, TellsRunsOfTheSameNameApartAndEscapesNames) {
  TemporaryFolder folder;
  const std::string odd = "it's <b>&, \"odd\"";
  write_line(folder.path() / "a" / odd, 1.0, 0.002);
  write_line(folder.path() / "b" / odd, 2.0, 0.002);
  studies::write_comparison({folder.path() / "a" / odd, folder.path() / "b" / odd},
                            folder.path() / "out");
  const std::string html = read_text(folder.path() / "out" / "comparison.html");
  EXPECT_TRUE(report_testing::structure_faults(html).empty())
      << report_testing::structure_faults(html).front();
  EXPECT_NE(report_testing::visible_text(html).find(odd + " (2)"), std::string::npos);
}

TEST(Comparison, RefusesLessThanTwoCurvesAndFoldersWithoutOne) {
  TemporaryFolder folder;
  write_line(folder.path() / "only", 1.0, 0.002);
  fs::create_directories(folder.path() / "empty");
  EXPECT_THROW(studies::write_comparison({folder.path() / "only"}, folder.path() / "out"),
               meshes::InvalidInput);
  EXPECT_THROW(studies::write_comparison({folder.path() / "only", folder.path() / "empty"},
                                         folder.path() / "out"),
               meshes::InvalidInput);
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
