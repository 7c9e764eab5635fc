// Damaged configurations, --set texts, sweeps and cases.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "campaign.h"
#include "meshes/base/errors.h"
#include "studies/cases/case_file.h"
#include "studies/config/documents.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/text/units.h"
#include "studies/presses/press_setup.h"
#include "studies/sweep/sweep.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

/// Names of keys, their choices, units, and TOML's own words.
std::vector<std::string> words_of_configuration() {
  std::set<std::string> words = {"[",        "]",
                                 "{",        "}",
                                 "\"",       "'",
                                 "\"\"\"",   "=",
                                 ",",        ".",
                                 "#",        "\n[press]\n",
                                 "true",     "nan",
                                 "inf",      "[[a]]\n",
                                 "\\",       "\\u0000",
                                 " cm",      " gf/cm^2",
                                 " kPa",     " deg",
                                 " ms",      " s/s",
                                 " degC",    " cm^999",
                                 " lg(m)",   "tip_radius/12",
                                 "\"auto\"", "1979-05-27T07:32:00Z",
                                 "1 cm",     "[\"1 mm\", \"2 mm\"]"};
  for (const Key& key : key_table()) {
    words.insert(key.name);
    words.insert(key.full_name() + " = " + key.preset + "\n");
    for (const Choice& choice : key.choices) words.insert("\"" + choice.word + "\"");
  }
  return {words.begin(), words.end()};
}

const std::string fine_file = R"(# A finger of silicone
[geometry]
tip_radius = "1 cm"
rod_radius = "5 mm"
[rubber]
youngs_modulus = "340 kPa"
shear_modulus = "114 kPa"
density = "1.07 g/cm^3"
[lattice]
model = "network"
spacing = "tip_radius/8"
offset = [0.25, 0.5, 0]
[press]
mode = "static"
contact = "coulomb"
friction = 0.4
samples = ["0.5 mm", "1 mm", "2 mm"]
tilt = "5 deg"
[calibration]
seed = 7
starts = 3
poisson_range = [0.3, 0.49]
profile = ["0", "1"]
[run]
threads = 2
)";

const std::string second_file =
    "rubber.youngs_modulus = '''40 gf/cm^2'''\nrubber.shear_modulus=\"1.4e1 gf/cm^2\"\n"
    "press = { speed = \"10 mm/s\", depth = \"0.2 cm\" }\r\n"
    "[controller]\ntype = \"force\"\nperiod = \"1 ms\"\n[reference]\nstrain = \"finite\"\ndegree = "
    "0x2\n";

void expect_physical(const LoadedConfig& loaded) {
  const lattice::PressSetup& press = loaded.config.press;
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  EXPECT_TRUE(press.geometry.violations().empty());
  EXPECT_TRUE(press.rubber.violations().empty());
  EXPECT_TRUE(press.protocol.violations(press.geometry).empty());
  EXPECT_TRUE(positive(press.rubber.youngs_modulus) && positive(press.rubber.shear_modulus));
  EXPECT_TRUE(press.rubber.poissons_ratio() > -1.0 && press.rubber.poissons_ratio() < 0.5);
  EXPECT_TRUE(positive(press.geometry.tip_radius) && positive(press.geometry.thickness()));
  EXPECT_TRUE(positive(press.protocol.depth) && positive(press.rubber.density));
  EXPECT_GE(press.threads, 0);
  EXPECT_GE(loaded.config.calibration.starts, 1);
}

/// What a run writes down of itself is the same configuration again.
void expect_written_reads_back(const LoadedConfig& loaded, const std::filesystem::path& file) {
  const std::string text = parameters_toml(loaded, "once");
  write_text(file, text);
  const LoadedConfig again = load_config({file, {}, {}});
  for (const auto& [name, entry] : loaded.entries)
    EXPECT_EQ(again.entries.at(name).literal, entry.literal) << name;
}

/// Everything a verb checks before it computes.
void expect_usable_or_refused(const LoadedConfig& loaded) {
  if (loaded.config.press.lattice.model == lattice::ModelKind::central) return;  // fits: slow
  if (loaded.config.constants == ConstantsSource::calibrated) return;
  check_all(loaded);
  EXPECT_TRUE(std::isfinite(loaded.config.press.lattice.spacing));
  EXPECT_GT(loaded.config.press.lattice.spacing, 0.0);
}

/// Whether the configuration is one, and that all of the above holds for it.
fuzz::Reader configuration(const TemporaryFolder& folder,
                           std::function<LoadedConfig(const std::string&)> load) {
  return fuzz::refusing<ConfigError, meshes::NotConverged>(
      [&folder, load = std::move(load)](const std::string& input) {
        const LoadedConfig loaded = load(input);
        expect_physical(loaded);
        expect_written_reads_back(loaded, folder / "parameters.toml");
        expect_usable_or_refused(loaded);
      });
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  return lines;
}

}  // namespace

TEST(FuzzConfiguration, Files) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "fine.toml";
  fuzz::attack({{fine_file, second_file, config_template()}, words_of_configuration()},
               configuration(folder, [&](const std::string& input) {
                 write_text(file, input);
                 return load_config({file, {}, {}});
               }));
}

TEST(FuzzConfiguration, SetTexts) {
  const TemporaryFolder folder;
  const std::vector<std::string> seeds = {"press.depth=0.2 cm",
                                          "rubber.youngs_modulus=\"41 gf/cm^2\"",
                                          "press.samples=[\"0.1 cm\", \"0.25 cm\"]",
                                          "calibration.seed=17",
                                          "lattice.offset=[0.5, 0.25, 0]",
                                          "lattice.spacing=tip_radius/8",
                                          "controller.address=unix:here",
                                          "calibration.bias=false",
                                          "press.contact=frictionless",
                                          "press.tilt=3 deg\npress.lateral=0.1 mm"};
  fuzz::attack({seeds, words_of_configuration()},
               configuration(folder, [](const std::string& input) {
                 return load_config({{}, lines_of(input), {}});
               }));
}

TEST(FuzzConfiguration, Quantities) {
  const std::vector<std::string> seeds = {"40 gf/cm^2",  "3.92 kPa", "1.2e3 N m-2",
                                          "0.5 kgf/mm2", "12 N.m-2", "40 gf cm^-2"};
  const std::vector<std::string> words = {"^",  "-2", " since ", "lg(re 1 mW)", "(",  ")",  "µ",
                                          "°",  "²",  "%",       "e",           "nm", "@",  "/",
                                          ".",  "*",  "rad",     "hPa",         "1",  " ",  "per",
                                          "dB", "ln", "degree",  "100000",      "Pa", "sec"};
  fuzz::attack({seeds, words}, fuzz::refusing<UnitError>([](const std::string& input) {
                 EXPECT_TRUE(std::isfinite(parse_quantity(input, "Pa", "40 gf/cm^2")));
               }));
}

TEST(FuzzConfiguration, Sweeps) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "sweep.toml";
  const std::vector<std::string> seeds = {
      "[sweep]\nverb = \"press\"\npress.speed = [\"1 cm/s\", \"2 cm/s\"]\n"
      "lattice.spacing = [\"tip_radius/6\", \"0.2 cm\"]\n[press]\nmode = \"static\"\n",
      "[sweep]\nverb = \"modes\"\n[sweep.press]\nsamples = [[\"0.1 cm\"], [\"0.1 cm\", \"0.2 "
      "cm\"]]\n"};
  std::vector<std::string> words = words_of_configuration();
  words.insert(words.end(), {"[sweep]\n", "points = [{press.depth = \"1 mm\"}]\n", "sweep.",
                             "verb = \"grasp\"\n", "[[\"1 cm\"]]", "[]"});
  fuzz::attack({seeds, words}, fuzz::refusing<ConfigError>([&](const std::string& input) {
                 write_text(file, input);
                 const Sweep sweep = read_sweep({file, {}, {}}, "");
                 EXPECT_FALSE(sweep.points.empty());
                 std::size_t whole = 0;
                 for (int number = 1; number <= 3; ++number)
                   whole += points_of(sweep, {number, 3}).size();
                 EXPECT_EQ(whole, sweep.points.size());
                 std::set<std::string> names;
                 for (const SweepPoint& point : sweep.points) names.insert(point.id);
                 EXPECT_EQ(names.size(), sweep.points.size());
                 expect_physical(config_of(sweep, sweep.points.front()));
               }));
}

TEST(FuzzConfiguration, Cases) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "case.toml";
  std::vector<std::string> seeds;
  for (const char* name : {"01", "02", "08", "11", "12"})
    seeds.push_back(read_text(find_case(name)));
  std::vector<std::string> words = words_of_configuration();
  words.insert(words.end(), {"[[case.variant]]\n", "[[case.criteria]]\n", "[[case.budget]]\n",
                             "limit = 1e999\n", "x = 9223372036854775807\n", "set = {}\n",
                             "measure = \"hookean.tilt_deg\"\n", "name = \"\"\n", "[case]\n"});
  fuzz::attack({seeds, words}, fuzz::refusing<ConfigError>([&](const std::string& input) {
                 write_text(file, input);
                 const Case study_case = load_case(file, {});
                 expect_physical(study_case.loaded);
                 for (const CaseCriterion& criterion : study_case.criteria)
                   EXPECT_TRUE(std::isfinite(criterion.limit));
                 write_text(folder / "again.toml",
                            parameters_toml(study_case.loaded, "") + study_case.text);
                 EXPECT_EQ(load_case(folder / "again.toml", {}).text, study_case.text);
               }));
}
