#include <gtest/gtest.h>
#include <iterator>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "meshes/base/errors.h"
#include "meshes/press/contact_field.h"
#include "meshes/tables/table_rows.h"
#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using nlohmann::json;
using report_testing::visible_text;
using report_testing::write_file;

class ContinuumReport : public testing::Test {
 protected:
  ContinuumReport() { report_testing::write_synthetic_run(run_); }

  std::string report() const {
    studies::report::write_report(run_);
    return read_text(run_ / "report.html");
  }
  /// What a reader sees of one chapter, "" when it is missing.
  std::string chapter(const std::string& id) const {
    const std::string html = report();
    const std::size_t begin = html.find("<section id=\"" + id + "\">");
    if (begin == std::string::npos) return "";
    return visible_text(html.substr(begin, html.find("</section>", begin) - begin));
  }
  void change(const fs::path& file, const std::function<void(json&)>& edit) const {
    json content = json::parse(read_text(run_ / file));
    edit(content);
    write_file(run_ / file, content.dump());
  }
  /// The points of a figure's series in the panel whose quantity is column `y`.
  std::map<double, double> points(const std::string& figure, const std::string& series,
                                  const std::string& x, const std::string& y) const {
    std::istringstream stream(read_text(run_ / "figures" / (figure + ".csv")));
    std::map<double, double> found;
    std::vector<std::string> names;
    for (std::string line; std::getline(stream, line);) {
      // A panel's title with a comma is quoted.
      if (line.starts_with('"')) line.replace(0, line.find('"', 1) + 1, "panel");
      std::vector<std::string> cells;
      std::istringstream row(line + ",");
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (names.empty()) names = cells;
      const auto column = [&](const std::string& name) {
        return cells.at(std::size_t(std::find(names.begin(), names.end(), name) - names.begin()));
      };
      if (cells.at(1) != series || column(x).empty() || column(y).empty()) continue;
      found[std::stod(column(x))] = std::stod(column(y));
    }
    return found;
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(ContinuumReport, NamesTheWorstErrorAndItsDepth) {
  const std::string text = chapter("continuum");
  EXPECT_TRUE(says(text, "known to within 0.45 % at every depth computed"));
  // 0.45 % of 1200 N/m^1.5 (1 mm)^1.5 = 0.17076 mN; 0.3 % of the force at 3 mm, 0.59 mN, is more.
  EXPECT_TRUE(says(text, {"170.8 µN, belongs to 1 mm", "591.5 µN, to 3 mm",
                          "Asked for was 0.50 %: reached.", "repeated on 3 meshes", "1.25 times"}));
}

TEST_F(ContinuumReport, DoesNotClaimAToleranceThatWasMissed) {
  change("reference/summary.json", [](json& summary) {
    summary["tolerance"] = 0.004;
    summary["status"] = "not converged";
    summary["message"] = "a finer mesh would exceed the limit";
  });
  const std::string text = chapter("continuum");
  EXPECT_TRUE(says(text, {"Asked for was 0.40 %: not reached.", "Status: not converged. ",
                          "a finer mesh would exceed the limit"}));
}

TEST_F(ContinuumReport, TabulatesEveryDepthAndEveryMesh) {
  const std::string text = chapter("continuum");
  // Hertz at 3 mm: F = 4/3 E* sqrt(R) d^1.5 = 0.105280 N against 0.197181 N.
  EXPECT_TRUE(says(text, {"197.18", "0.30 %", "monotone 2.3", "+87.3 %", "2\u202f700", "20 along a",
                          "contact 6", "3\u202f214", "90\u202f000", "21.00 s"}));
  EXPECT_TRUE(omits(text, "Smallest J")) << "of linear strain";
  EXPECT_TRUE(omits(text, "Newton")) << "of linear strain";
}

TEST_F(ContinuumReport, FiniteStrainShowsItsJacobianAndNewtonIterations) {
  change("reference/summary.json", [](json& summary) {
    summary["strain"] = "finite";
    summary["law"] = "neo-hookean, logarithmic";
  });
  const std::string text = chapter("continuum");
  EXPECT_TRUE(says(text, {"Smallest J", "0.731", "Newton 17, contact 6", "strain is finite"}));
  EXPECT_TRUE(says(chapter("cost"), "finite, neo-hookean, logarithmic"));
}

TEST_F(ContinuumReport, ConvergenceFigureHoldsTheChangesAndTheEstimate) {
  report();
  const auto change =
      points("mesh_convergence", "3 mm", "unknowns of the mesh", "F against the finest mesh [%]");
  ASSERT_EQ(change.size(), 3u);
  EXPECT_NEAR(change.at(10000), 2.0, 1e-9);
  EXPECT_NEAR(change.at(30000), -0.6, 1e-9);
  EXPECT_NEAR(change.at(90000), 0.0, 1e-12);
  const auto decay = points("mesh_convergence", "3 mm", "unknowns of the mesh", "magnitude [%]");
  ASSERT_EQ(decay.size(), 2u) << "zero has no place on a logarithmic axis";
  EXPECT_NEAR(decay.at(30000), 0.6, 1e-9);
  EXPECT_NEAR(points("mesh_convergence", "1 mm estimate", "unknowns of the mesh", "magnitude [%]")
                  .at(90000),
              0.45, 1e-9);
}

TEST_F(ContinuumReport, LogarithmicAxesCountInDecades) {
  report();
  const std::string svg = read_text(run_ / "figures" / "mesh_convergence.svg");
  EXPECT_TRUE(says(svg, {"10⁴", "5×10⁴", "0.5<"}));
}

TEST_F(ContinuumReport, OneMeshIsNoEstimate) {
  std::string response = read_text(run_ / "reference" / "response.csv"), stripped;
  std::istringstream lines(response);
  for (std::string line; std::getline(lines, line);) {
    if (!stripped.empty()) {
      const std::string empty = ",,,";  // time, area, mean pressure
      line.resize(line.size() - empty.size());
      line.erase(line.rfind(',') + 1);
      line += empty;
    }
    stripped += line + "\n";
  }
  write_file(run_ / "reference" / "response.csv", stripped);
  std::istringstream rows(read_text(run_ / "reference" / "convergence.csv"));
  std::string single;
  for (std::string line; std::getline(rows, line);)
    if (line[0] == 'm' || line[0] == '1') single += line + "\n";
  write_file(run_ / "reference" / "convergence.csv", single);
  const std::string text = chapter("continuum");
  EXPECT_TRUE(says(text, "How far the force is off is not known"));
  EXPECT_TRUE(omits(text, {"How it is estimated", "nan"}));
  EXPECT_FALSE(fs::exists(run_ / "figures" / "mesh_convergence.svg"));
}

// Johnson, Contact Mechanics (1985), eq. 4.24: p0 = (6 F E*²/(pi³ R²))^(1/3), with F from
// delta³ = 9 F²/(16 R E*²): not the way the report takes.
TEST_F(ContinuumReport, PressureStandsBesideHertz) {
  report();
  const double R = 0.01, delta = 0.003, nu = 3.0 / 7.0, E = 3922.66 / (1.0 - nu * nu);
  const double F = std::sqrt(16.0 * R * E * E * std::pow(delta, 3) / 9.0);
  const double p0 = std::cbrt(6.0 * F * E * E / (std::pow(std::acos(-1.0), 3) * R * R));
  const auto hertz = points("pressure", "3 mm Hertz", "radius [mm]", "contact pressure [kPa]");
  ASSERT_FALSE(hertz.empty());
  EXPECT_NEAR(hertz.begin()->second, p0 / 1e3, 1e-9 * p0);
  EXPECT_NEAR(hertz.rbegin()->first, 1e3 * std::cbrt(3.0 * F * R / (4.0 * E)), 1e-9);
  EXPECT_NEAR(hertz.rbegin()->second, 0.0, 1e-12);
}

// Two spheres: a² = R delta, 1/R = 1/R_tip + 1/R_ball (Johnson, eq. 4.17).
TEST_F(ContinuumReport, BallsStandBesideHertzOfBothRadiiAndAreDrawn) {
  const auto press_on = [&](const json& obstacle) {
    change("reference/job.json", [&](json& job) { job["protocol"]["obstacle"] = obstacle; });
    return chapter("continuum");
  };
  const auto line = [&](const std::string& series) {
    return points("adaptive_mesh", series, "x [mm]", "z [mm]");
  };
  chapter("continuum");
  ASSERT_FALSE(line("plane").empty());
  const double top = line("plane").begin()->second;  // at first touch; later rows are the pressed
  EXPECT_TRUE(says(press_on({{"shape", "sphere"}, {"radius", 0.006}}), "on the same ball"));
  const auto hertz = points("pressure", "3 mm Hertz", "radius [mm]", "contact pressure [kPa]");
  ASSERT_FALSE(hertz.empty());
  EXPECT_NEAR(hertz.rbegin()->first, std::sqrt(10.0 * 6.0 / 16.0 * 3.0), 1e-9);
  EXPECT_TRUE(line("plane").empty());
  const auto ball = line("sphere");
  ASSERT_GT(ball.size(), 50U);
  for (const auto& [x, z] : ball) {
    const double rise = 6.0 - std::sqrt(36.0 - x * x);
    EXPECT_LT(std::min(std::abs(top + rise - z), std::abs(top - 3.0 + rise - z)), 1e-6) << x;
  }
  // Beside the axis two spheres are pressed aslant; an edge is no sphere.
  for (const json& obstacle : {json{{"shape", "sphere"}, {"radius", 0.006}, {"offset", 0.002}},
                               json{{"shape", "edge"}, {"radius", 0.003}, {"along", "x"}}})
    EXPECT_TRUE(omits(press_on(obstacle), "Against Hertz")) << obstacle;
}

TEST_F(ContinuumReport, WithoutTheJobThereIsNoHertz) {
  fs::remove(run_ / "reference" / "job.json");
  const std::string html = report(), text = visible_text(html);
  EXPECT_TRUE(says(text, "Hertz's contact beside the continuum's"));
  EXPECT_TRUE(omits(text, "Against Hertz"));
  EXPECT_TRUE(points("pressure", "3 mm Hertz", "radius [mm]", "contact pressure [kPa]").empty());
}

TEST_F(ContinuumReport, ManyNodesAreThinnedButKeepTheirPeaks) {
  std::vector<meshes::ContactPoint> field;
  for (int i = 0; i < 20000; ++i) {
    meshes::ContactPoint ring{.sample = 1, .indentation = 0.003};
    ring.place.x() = 3e-7 * i;
    ring.area = 1e-9;
    ring.normal_traction = i == 12345 ? 9000.0 : 1000.0;
    std::ranges::copy(meshes::turned_around(ring, 2), std::back_inserter(field));
  }
  meshes::write_rows(field, run_ / "reference" / "contact_field.csv");
  report();
  const auto dots = points("pressure", "3 mm continuum", "radius [mm]", "contact pressure [kPa]");
  EXPECT_LT(dots.size(), 200u);
  EXPECT_GT(dots.size(), 80u);
  const auto peak = std::max_element(
      dots.begin(), dots.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_NEAR(peak->first, 3e-4 * 12345, 1e-3);
  EXPECT_NEAR(peak->second, 9000 / 1e3, 1e-9);
}

TEST_F(ContinuumReport, VerificationSumsUpWhatPassedAndNamesWhatDidNot) {
  const std::string text = chapter("verification");
  EXPECT_TRUE(says(text, "1 of 2 checks against known solutions passed"));
  EXPECT_TRUE(
      says(text,
           {"In 11 of 12 convergence studies", "Slower in “nearly solenoidal”: Q1 pointwise.",
            "Failed: balance of forces.",
            "computed with Q2 projected, which keeps its order in 2 of 2 studies.", "425.81 N/m"}));
  // 0.02/(1 - 2 0.4999) = 100
  EXPECT_TRUE(says(text, "+10000 %"));
}

TEST_F(ContinuumReport, ChecksOfOneKindShareARowWithTheWorst) {
  change("verification/verification.json", [](json& verification) {
    json& checks = verification["checks"];
    for (int i = 0; i < 20; ++i) {
      checks.push_back({{"name", "patch test, mesh " + std::to_string(i)},
                        {"quantity", "nodal error"},
                        {"source", "linear"},
                        {"value", i == 13 ? 6.5e-11 : 1e-15},
                        {"expected", 0.0},
                        {"relative_error", i == 13 ? 6.5e-11 : 1e-15},
                        {"tolerance", 1e-10},
                        {"passed", true}});
    }
    checks.push_back(checks.back());
    checks.back()["name"] = "patch test, broken mesh";
    checks.back()["passed"] = false;
  });
  const std::string text = chapter("verification");
  EXPECT_TRUE(says(text, {"patch test, mesh 13", "all 20", "6.5×10⁻¹¹"}));
  EXPECT_TRUE(omits(text, "patch test, mesh 12"));
  EXPECT_TRUE(says(text, "Failed: balance of forces and patch test, broken mesh."));
  EXPECT_TRUE(says(text.substr(text.find("failed ones first")), "patch test, broken mesh"));
}

TEST_F(ContinuumReport, VerificationMarksOrders) {
  const std::string html = report();
  EXPECT_TRUE(says(html, {"class=\"close\">2.98<span class=\"mark\">●</span>",
                          "class=\"wrong\">1.10<span class=\"mark\">✕</span>",
                          "class=\"wrong\">3.0×10⁻⁷<span class=\"mark\">✕</span>"}));
}

// Errors of the order p fall by 2^p when h is halved, and so must the slope beside them.
TEST_F(ContinuumReport, OrderFigureHasTheoryBesideTheErrors) {
  report();
  const auto guide =
      points("verification_orders", "h^3", "element size h [mm]", "relative error of u");
  ASSERT_EQ(guide.size(), 2u);
  EXPECT_NEAR(guide.at(500.0) / guide.at(125.0), 64.0, 1e-9);
  const auto errors =
      points("verification_orders", "Q2 projected", "element size h [mm]", "relative error of u");
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_LT(guide.at(125.0), errors.at(125.0));
}

TEST_F(ContinuumReport, LockingFigureCountsTowardsIncompressible) {
  report();
  const auto curve = points("locking", "Q1 pointwise", "0.5 − ν   (incompressible to the right)",
                            "cantilever: off by [%]");
  ASSERT_EQ(curve.size(), 4u);
  EXPECT_NEAR(curve.begin()->first, 1e-4, 1e-12);
  EXPECT_NEAR(curve.begin()->second, 1e4, 1e-6);
}

TEST_F(ContinuumReport, VerificationIsNamedWhenNotRunAndShownWhenPartial) {
  fs::remove_all(run_ / "verification");
  EXPECT_EQ(chapter("verification"), "");
  EXPECT_TRUE(says(visible_text(report()), "Verification of the continuum's code"));
  write_file(run_ / "verification" / "verification.json",
             R"({"studies":[],"checks":[{"name":"<b>one</b>","passed":true}],"locking":[]})");
  const std::string html = report();
  EXPECT_TRUE(says(chapter("verification"), "1 of 1 checks"));
  EXPECT_TRUE(omits(html, "<b>one"));
  EXPECT_TRUE(report_testing::structure_faults(html).empty());
  write_file(run_ / "verification" / "verification.json", "{\"studies\": [");
  const studies::report::Damages damage = studies::report::write_report(run_);
  ASSERT_EQ(damage.size(), 1U);
  EXPECT_TRUE(says(damage.front().key, "verification.json:1:14"));
  EXPECT_TRUE(says(visible_text(read_text(run_ / "report.html")), "verification.json:1:14"));
}

TEST_F(ContinuumReport, SurvivesStrangeEntries) {
  write_file(run_ / "verification" / "verification.json",
             R"({"studies":[{"problem":"p"},{"meshes":[{"h":0,"error_l2":null}]},3],
                 "checks":[null,{"quantity":"[m]"}],"locking":[{"element":""},{"poissons_ratio":0.5}]})");
  change("reference/summary.json", [](json& summary) {
    summary["samples"] = {{{"indentation", nullptr}}, 7};
    summary["meshes"] = "none";
  });
  const std::string html = report();
  EXPECT_TRUE(report_testing::structure_faults(html).empty());
  EXPECT_TRUE(omits(visible_text(html), " nan"));
}

}  // namespace
