#include "studies/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "meshes/base/errors.h"
#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/report_parts.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using report_testing::write_file;

/// A complete run, with its report when asked.
struct SyntheticRun {
  TemporaryFolder folder;
  fs::path path = folder.path() / "run";
  SyntheticRun() { report_testing::write_synthetic_run(path); }
  std::string report() {
    studies::report::write_report(path);
    return read_text(path / "report.html");
  }
};

std::string first_or_none(const std::vector<std::string>& faults) {
  return faults.empty() ? "" : faults.front();
}

/// The cells of a CSV's row whose first cells are `panel` and `series`, closest to x.
double csv_value(const fs::path& file, const std::string& series, double x, std::size_t x_column,
                 std::size_t y_column) {
  std::istringstream stream(read_text(file));
  std::string line;
  double best = 1e300, value = std::nan("");
  while (std::getline(stream, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells.size() <= std::max(x_column, y_column) || cells[1] != series ||
        cells[x_column].empty())
      continue;
    const double distance = std::abs(std::stod(cells[x_column]) - x);
    if (distance < best) best = distance, value = std::stod(cells[y_column]);
  }
  return value;
}

TEST(Report, HasEveryChapterOfACompleteRun) {
  SyntheticRun run;
  const std::string html = run.report();
  for (const char* chapter :
       {"verdict", "force", "control", "elasticity", "pictures", "published", "equilibrium",
        "reasons", "continuum", "verification", "cost", "provenance"}) {
    EXPECT_TRUE(says(html, "<section id=\"" + std::string(chapter) + "\">")) << chapter;
  }
  EXPECT_TRUE(omits(html, "id=\"not-run\""))
      << report_testing::visible_text(html.substr(html.find("id=\"not-run\"")));
  for (const char* figure :
       {"force_indentation", "force_error", "tracking", "elastic_directions", "cubes", "shapes",
        "pressure", "published_study", "equilibrium_error", "mesh_convergence", "adaptive_mesh",
        "verification_orders", "locking"}) {
    EXPECT_TRUE(fs::exists(run.path / "figures" / (std::string(figure) + ".svg"))) << figure;
    EXPECT_TRUE(fs::exists(run.path / "figures" / (std::string(figure) + ".csv"))) << figure;
    // gnuplot names a curve by its command when the title goes astray.
    EXPECT_TRUE(
        omits(read_text(run.path / "figures" / (std::string(figure) + ".svg")), "using 1:2"))
        << figure;
    EXPECT_TRUE(says(html, "figures/" + std::string(figure) + ".csv")) << figure;
  }
}

TEST(Report, IsWellFormedAndSelfContained) {
  SyntheticRun run;
  const std::string html = run.report();
  EXPECT_EQ(first_or_none(report_testing::structure_faults(html)), "");
  EXPECT_EQ(first_or_none(report_testing::outside_references(html)), "");
}

TEST(Report, LeavesNothingButItsOwnFiles) {
  SyntheticRun run;
  run.report();
  run.report();
  for (const auto& entry : fs::directory_iterator(run.path)) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
  for (const auto& entry : fs::directory_iterator(run.path / "figures")) {
    EXPECT_TRUE(entry.path().extension() == ".svg" || entry.path().extension() == ".csv")
        << entry.path();
  }
}

// 3.18403 E and 1.47701 E are the paper's stiffnesses; 8.818, 12.21, 14.01 and 5.794 kPa follow.
TEST(Report, VerdictTableShowsTheModuliAndTheirDeviations) {
  SyntheticRun run;
  const std::string text = report_testing::visible_text(run.report());
  EXPECT_TRUE(says(text, {"8.818", "12.21", "14.01", "5.794"}));
  EXPECT_TRUE(says(text, "+125 %")) << "E_100 of the published model against 3.923 kPa";
  EXPECT_TRUE(says(text, "2.435")) << "K of the central model";
  EXPECT_TRUE(says(text, "−73.4 %")) << "its deviation from 9.153 kPa";
  EXPECT_TRUE(says(text, "+100 %")) << "force error of the published model";
  EXPECT_TRUE(says(text, {"−10.0 %", "+2.0 %"}));
}

TEST(Report, GradesErrorsWithoutRelyingOnColour) {
  SyntheticRun run;
  const std::string html = run.report();
  EXPECT_TRUE(says(html, {"class=\"wrong\">+100\u00a0%<span class=\"mark\">✕</span>",
                          "class=\"close\">+2.0\u00a0%<span class=\"mark\">●</span>"}));
}

TEST(Report, TitleOfProvenancesValuesStandsWhereTheyBegin) {
  SyntheticRun run;
  EXPECT_TRUE(says(run.report(), "<th scope=\"col\" class=\"words\">Value</th>"));
}

TEST(Report, ShowsHowWellTheControllerTracked) {
  SyntheticRun run;
  const std::string text = report_testing::visible_text(run.report());
  EXPECT_TRUE(says(text, {"1.5 %", "12.3 %", "0.0020 degrees"}));
  EXPECT_TRUE(says(text, "fingertip validate")) << "the command of the manifest";
}

TEST(Report, AnswersInWordsBestModelFirst) {
  SyntheticRun run;
  const std::string text = report_testing::visible_text(run.report());
  const std::size_t hookean = text.find("hookean is off by +2.0 %"),
                    published = text.find("published is off by +100 %");
  ASSERT_NE(hookean, std::string::npos);
  ASSERT_NE(published, std::string::npos);
  EXPECT_LT(hookean, published);
  EXPECT_TRUE(says(text, "All 2 criteria of the case are met."));
  // 1200 N/m^1.5 (3 mm)^1.5 = 0.19718 N
  EXPECT_TRUE(says(text, "pushes back with 197.2 mN"));
}

TEST(Report, FigureDataCarryUnitsAndTheMeasuredValues) {
  SyntheticRun run;
  run.report();
  const fs::path forces = run.path / "figures" / "force_indentation.csv";
  EXPECT_TRUE(says(read_text(forces), "panel,series,indentation [mm],normal force [mN]\n"));
  EXPECT_NEAR(csv_value(forces, "reference", 3.0, 2, 3),
              report_testing::continuum_force(0.003) * 1e3, 1e-9);
  EXPECT_NEAR(csv_value(run.path / "figures" / "force_error.csv", "central", 3.0, 2, 3), -10.0,
              1e-9);
}

// Along [110], the horizontal of the (1-10) plane, the polar plot must reach E_110: an independent
// number, since the plot is drawn from E_100, nu_100 and G alone.
TEST(Report, PolarPlotReachesTheModuliOfTheOtherDirections) {
  SyntheticRun run;
  run.report();
  const double c = 40.0 * 98.0665;
  const nlohmann::json published =
      report_testing::cubic_moduli(3.18403 * c, 1.47701 * c, 1.47701 * c);
  std::istringstream lines(read_text(run.path / "figures" / "elastic_directions.csv"));
  double along = 0.0;
  for (std::string line; std::getline(lines, line);) {
    const std::string start = "(1-10) plane,published,";
    if (line.compare(0, start.size(), start) != 0) continue;
    const std::size_t comma = line.find(',', start.size());
    if (std::abs(std::stod(line.substr(comma + 1))) < 1e-6)
      along = std::max(along, std::stod(line.substr(start.size())));
  }
  EXPECT_NEAR(along, double(published["E_110"]) / 1e3, 1e-6);
}

TEST(Report, MissingChaptersAreLeftOutAndNamed) {
  SyntheticRun run;
  for (const char* name : {"reference", "calibration_central", "cubes.csv", "published_study.csv",
                           "equilibrium_study.csv", "hookean"})
    fs::remove_all(run.path / name);
  for (const char* name : {"published", "central"}) fs::remove(run.path / name / "trace.csv");
  const std::string html = run.report(), text = report_testing::visible_text(html);
  EXPECT_TRUE(omits(html, {"<section id=\"control\">", "<section id=\"published\">"}));
  EXPECT_TRUE(says(html, "<section id=\"not-run\">"));
  EXPECT_TRUE(
      says(text, {"Continuum reference", "sequence of meshes", "Press of the hookean lattice",
                  "Controller trace of published", "Calibration of central",
                  "Cubes: the surface effect", "grid and ligaments"}));
  EXPECT_TRUE(omits(text, "Calibration of hookean (")) << "is there";
  EXPECT_EQ(first_or_none(report_testing::structure_faults(html)), "");
  EXPECT_TRUE(omits(text, " nan"));
}

TEST(Report, EscapesWhatComesFromFiles) {
  SyntheticRun run;
  nlohmann::json summary = nlohmann::json::parse(read_text(run.path / "summary.json"));
  const std::string hostile = "<script>alert('x')</script> & \"quoted\" {{page_title}}";
  summary["title"] = hostile;
  summary["criteria"][0]["name"] = hostile;
  summary["models"]["<b>odd 'model'"] = summary["models"]["hookean"];
  write_file(run.path / "summary.json", summary.dump());
  write_file(run.path / "parameters.toml", "# " + hostile);
  const std::string html = run.report();
  EXPECT_TRUE(omits(report_testing::without_own_scripts(html), "<script"));
  EXPECT_TRUE(omits(html, "<b>odd"));
  EXPECT_TRUE(says(html, "&lt;script&gt;"));
  EXPECT_TRUE(says(report_testing::visible_text(html), hostile));
  EXPECT_EQ(first_or_none(report_testing::structure_faults(html)), "");
}

TEST(Report, RefusesAFolderThatIsNoRun) {
  TemporaryFolder folder;
  EXPECT_THROW(studies::report::write_report(folder.path()), meshes::InvalidInput);
  EXPECT_THROW(studies::report::write_report(folder.path() / "absent"), meshes::InvalidInput);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// "places: rules" of everything that is wrong with the run.
std::string damage_of(const fs::path& run) {
  std::string text;
  for (const meshes::Violation& violation : studies::report::write_report(run))
    text += to_string(violation) + "\n";
  return text;
}

TEST(Report, NamesDamagedFilesAndReportsTheRest) {
  SyntheticRun run;
  const std::string whole = run.report();
  write_file(run.path / "cubes.csv", "model,cells_across\npublished\n");
  std::string damage = damage_of(run.path);
  EXPECT_TRUE(says(damage, "cubes.csv:2"));
  std::string html = read_text(run.path / "report.html");
  EXPECT_TRUE(says(report_testing::visible_text(html), "cubes.csv:2"));
  EXPECT_TRUE(says(html, "<section id=\"force\">"));
  EXPECT_EQ(first_or_none(report_testing::structure_faults(html)), "");
  // A chapter whose data are senseless is left out, the others stay.
  const std::string trace = read_text(run.path / "hookean/trace.csv");
  const std::size_t cell = trace.find(',', trace.find('\n'));
  write_file(run.path / "hookean/trace.csv",
             trace.substr(0, cell + 1) + "inf" + trace.substr(trace.find(',', cell + 1)));
  damage = damage_of(run.path);
  EXPECT_TRUE(says(damage, {"hookean/trace.csv:2, ", "= inf: must be a finite number"}));
  html = read_text(run.path / "report.html");
  EXPECT_TRUE(says(whole, "<section id=\"pictures\">"));
  EXPECT_TRUE(omits(html, "<section id=\"pictures\">"));
  EXPECT_TRUE(says(html, "<section id=\"force\">"));
  // What stands in the place of a file is not the file.
  fs::remove(run.path / "hookean/response.csv");
  fs::create_directory(run.path / "hookean/response.csv");
  EXPECT_TRUE(says(damage_of(run.path), "hookean/response.csv: is no file"));
}

TEST(Report, NamesEntriesOfAnotherType) {
  SyntheticRun run;
  auto summary = nlohmann::json::parse(read_text(run.path / "summary.json"));
  summary["criteria"] = "met";
  summary["depths"] = {0.001, "deep"};
  write_file(run.path / "summary.json", summary.dump());
  const std::string damage = damage_of(run.path);
  EXPECT_TRUE(says(damage, {"summary.json, criteria = \"met\": must be a list",
                            "summary.json, depths[1] = \"deep\": must be a number"}));
}

TEST(Report, SaysSoWhenGnuplotIsMissingAndKeepsTheOldReport) {
  SyntheticRun run;
  const std::string before = run.report(), path = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  std::string message;
  try {
    studies::report::write_report(run.path);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(says(message, "gnuplot"));
  EXPECT_EQ(read_text(run.path / "report.html"), before);
  EXPECT_TRUE(fs::exists(run.path / "figures" / "force_indentation.svg"));
}

TEST(VerdictText, IsPlainAsciiWithTheSameNumbers) {
  SyntheticRun run;
  const std::string text = studies::report::verdict_text(run.path);
  for (char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int(c);
  for (const char* part : {"published", "central", "hookean", "8.818", "14.01", "+100 %", "-10.0 %",
                           "197.2 mN", "met "}) {
    EXPECT_TRUE(says(text, part));
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 140U) << line;
}

TEST(Units, AreThoseOfTheTable) {
  using studies::UnitSystem, studies::units_of;
  // gf and cm by their definitions, one quantity from another.
  const auto& paper = units_of(UnitSystem::paper);
  EXPECT_NEAR(paper.stress(3922.66), 40.0, 1e-12);
  EXPECT_NEAR(paper.force(0.0980665), 10.0, 1e-12);
  for (const UnitSystem system : values(UnitSystem())) {
    const auto& units = units_of(system);
    EXPECT_EQ(studies::unit_system(name(system)), system);
    const double area = units.length.factor * units.length.factor;
    EXPECT_NEAR(units.stress.factor * area / units.force.factor, 1.0, 1e-12);
    EXPECT_NEAR(units.stiffness.factor * units.length.factor / units.force.factor, 1.0, 1e-12);
    EXPECT_NEAR(units.torque.factor / units.length.factor / units.force.factor, 1.0, 1e-12);
    EXPECT_NEAR(units.speed.factor / units.length.factor, 1.0, 1e-12);
    for (const studies::ShownUnit* unit : units.all()) EXPECT_EQ(units.of(unit->si), unit);
  }
  EXPECT_EQ(paper.of("Hz"), nullptr);
}

TEST(Units, OfTheRunAreThePagesUnlessOthersAreAskedFor) {
  SyntheticRun run;
  const auto text = [&](std::optional<studies::UnitSystem> units) {
    studies::report::write_report(run.path, units);
    return report_testing::visible_text(read_text(run.path / "report.html"));
  };
  const auto axes = [&] {
    return read_text(run.path / "figures/force_indentation.csv").substr(0, 60);
  };
  const std::string si = text({});
  EXPECT_TRUE(says(si, "pushes back with 197.2 mN"));
  // The paper's rubber stands there in its own units, too.
  EXPECT_TRUE(says(si, {"3.923 kPa", "40.00 gf/cm²"}));
  EXPECT_TRUE(says(axes(), "indentation [mm],normal force [mN]"));
  const std::string paper = text(studies::UnitSystem::paper);
  EXPECT_TRUE(says(paper, "20.11 gf (197.2 mN)"));
  EXPECT_TRUE(says(axes(), "indentation [cm],normal force [gf]"));
  EXPECT_EQ(studies::shown_units().system, studies::UnitSystem::si);
  auto manifest = nlohmann::json::parse(read_text(run.path / "manifest.json"));
  manifest["units"] = "paper";
  report_testing::write_file(run.path / "manifest.json", manifest.dump());
  EXPECT_EQ(text({}), paper);
  EXPECT_EQ(text(studies::UnitSystem::si), si);
}

TEST(Format, TellsSiBesideThePapersUnits) {
  using namespace studies::report;
  EXPECT_EQ(stress(3922.66), "3.923\u00a0kPa");
  EXPECT_EQ(length(0.003), "3\u00a0mm");
  EXPECT_EQ(si_note(0.1, "N"), "");
  {
    const studies::ShowIn paper(studies::UnitSystem::paper);
    EXPECT_EQ(stress(3922.66), "40.00\u00a0gf/cm² (3.923\u00a0kPa)");
    EXPECT_EQ(length(0.003), "0.3\u00a0cm (3\u00a0mm)");
    EXPECT_EQ(si_note(0.1, "N"), "100.0\u00a0mN");
  }
  EXPECT_EQ(number(-1234567.0, 3), "−1.23×10⁶");
  EXPECT_EQ(number(9.9996, 4), "10.00");
  EXPECT_EQ(number(3.2e-13, 2), "3.2×10⁻¹³");
  EXPECT_EQ(number(std::nan(""), 3), "–");
  EXPECT_EQ(percent(-0.0314), "−3.1\u00a0%");
  EXPECT_EQ(percent(1e-10), "0\u00a0%");
  EXPECT_EQ(count(1234567.0), "1\u202f234\u202f567");
  EXPECT_EQ(with_prefix(4.31e-5, "s"), "43.10\u00a0µs");
}

}  // namespace
