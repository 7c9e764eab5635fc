#include "studies/fits/runs/law_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/material_tests/law_card.h"
#include "calibration/material_tests/law_record.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/fits/runs/plate_factor.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::LawFit;
using calibration::MaterialTest;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// Everything of a test: a member more does not compile.
ordered_json test_inputs(const MaterialTest& test) {
  const auto& [name, kind, measure, deformation, stress, sigma, constraint, specimens,
               stress_zero_sought, strain_zero_sought, stress_zero_known, stress_zero_error, doubts,
               rate, course, time, path, source, licence, published] = test;
  return {{"name", name},
          {"kind", int(kind)},
          {"measure", int(measure)},
          {"deformation", deformation},
          {"stress", stress},
          {"sigma", sigma},
          {"constraint", constraint},
          {"specimens", specimens},
          {"zeros", {stress_zero_sought, strain_zero_sought, stress_zero_known}},
          {"stress_zero_error", stress_zero_error},
          {"doubts", doubts},
          {"rate", rate.value_or(0.0)},
          {"course", int(course)},
          {"time", time},
          {"path", {path.time, path.deformation}},
          {"source", source},
          {"licence", licence},
          {"published", published}};
}

ordered_json law_inputs(const LawInput& input) {
  ordered_json inputs = {
      {"weights", name(input.options.weights)},
      {"seed", input.options.seed},
      {"range_of_use", *input.options.range_of_use},
      {"about", {input.tests.material, input.tests.source, input.tests.licence}}};
  for (const char* list : {"fitted", "validation", "laws"}) inputs[list] = ordered_json::array();
  for (const MaterialTest& test : input.tests.fitted) inputs["fitted"].push_back(test_inputs(test));
  for (const MaterialTest& test : input.tests.validation)
    inputs["validation"].push_back(test_inputs(test));
  for (const auto& law : input.laws) inputs["laws"].push_back(name(law));
  inputs["stuck"] = ordered_json::array();
  for (const auto& plates : input.tests.stuck)
    inputs["stuck"].push_back(plates ? ordered_json{plates->diameter, plates->height}
                                     : ordered_json());
  return inputs;
}

calibration::LawCard card_of_fit(const LawFit& fit, const LawInput& input) {
  calibration::LawCard card = card_of(fit, input.tests.fitted, input.tests.validation);
  card.material = input.tests.material;
  card.source = input.tests.source;
  card.licence = input.tests.licence;
  card.program = "fingertip " + program_version();
  card.date = utc_now();
  return card;
}

void write_cards(const std::vector<LawFit>& ranking, const LawInput& input,
                 const fs::path& folder) {
  fs::create_directories(folder / "cards");
  const LawFit* best = recommended(ranking);
  for (const LawFit& fit : ranking) {
    if (!fit.failure.empty()) continue;
    const calibration::LawCard card = card_of_fit(fit, input);
    if (!card.violations().empty()) continue;
    write_law_card(card, folder / "cards" / (name(fit.choice) + ".toml"));
    if (&fit == best && card.rejected.empty()) write_law_card(card, folder / "material.toml");
  }
}

std::vector<LawFit> ranked(const LawInput& input, const JobContext& context) {
  return rank_laws(input.tests.fitted, input.tests.validation, input.laws, input.options,
                   [&](double done, const calibration::LawChoice& law) {
                     if (!context.report(done, name(law)))
                       throw meshes::Interrupted("the fit of laws was stopped");
                   });
}

/// The test `i` of those fitted and, after them, those held back.
MaterialTest& test_at(LawInput& input, std::size_t i) {
  const std::size_t fitted = input.tests.fitted.size();
  return i < fitted ? input.tests.fitted[i] : input.tests.validation[i - fitted];
}

/// Puts the factors of stuck plates by this law into the tests. The largest change of a factor.
double hold_ends(const calibration::SizedLaw& law, const std::string& place, LawInput& input,
                 const JobContext& context) {
  double change = 0.0;
  for (std::size_t i = 0; i < input.tests.stuck.size(); ++i) {
    if (!input.tests.stuck[i]) continue;
    MaterialTest& test = test_at(input, i);
    const PlateFactor factor =
        plate_factor(*input.tests.stuck[i], law, fmt::format("{}_{}", place, i + 1), context);
    test.constraint.resize(test.deformation.size(), 1.0);
    for (std::size_t p = 0; p < test.deformation.size(); ++p) {
      const double now = factor.at(test.deformation[p]);
      change = std::max(change, std::abs(now - test.constraint[p]));
      test.constraint[p] = now;
    }
  }
  return change;
}

/// The factor of stuck plates hangs on the law that is sought, and hardly: a fixed point from
/// neo-Hooke, then from the law that was found.
std::vector<LawFit> ranked_between_plates(LawInput& input, const JobContext& context) {
  const bool stuck = std::ranges::any_of(input.tests.stuck, [](const auto& p) { return !!p; });
  if (!stuck) return ranked(input, context);
  hold_ends({1e4, {}}, "plates_neo-hookean", input, context);
  std::vector<LawFit> ranking = ranked(input, context);
  const LawFit* best = recommended(ranking);
  if (best == nullptr || best->unstable_in_press) return ranking;
  const double change = hold_ends(best->law, "plates_" + name(best->choice), input, context);
  context.log(fmt::format("factors of stuck plates by {} differ from neo-Hooke's by {:.2g}",
                          name(best->choice), change));
  return ranked(input, context);
}

void run_laws(LawInput input, const fs::path& folder, const JobContext& context) {
  const std::vector<LawFit> ranking = ranked_between_plates(input, context);
  const std::vector<MaterialTest>&fitted = input.tests.fitted, &validation = input.tests.validation;
  const calibration::LawsFile file = laws_file(ranking, fitted, validation, input.options.weights);
  meshes::write_json_file(file, folder / "laws.json");
  meshes::write_rows(law_data(ranking, fitted, validation), folder / "law_data.csv");
  write_cards(ranking, input, folder);
  meshes::write_json_file({{"problem", "material"},
                           {"status", "finished"},
                           {"failed", file.failed},
                           {"recommended", file.recommended},
                           {"laws", input.laws.size()},
                           {"tests", fitted.size()},
                           {"predicted", validation.size()},
                           {"statement", file.statement}},
                          folder / "summary.json");
  context.log(file.statement);
}

/// Where a fitted test goes in time, every law that names no branches with none up to so many.
std::vector<calibration::LawChoice> with_branches(const std::vector<calibration::LawChoice>& asked,
                                                  const MaterialTestFile& tests, int most) {
  const bool in_time = std::ranges::any_of(tests.fitted, [](const MaterialTest& test) {
    return test.course != calibration::TestCourse::slow;
  });
  std::vector<calibration::LawChoice> laws;
  for (calibration::LawChoice law : asked) {
    laws.push_back(law);
    if (!in_time || law.branches > 0) continue;
    for (law.branches = 1; law.branches <= most; ++law.branches) laws.push_back(law);
  }
  return laws;
}

}  // namespace

LawInput law_input(const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  LawInput input;
  std::vector<meshes::Violation> found;
  std::vector<calibration::LawChoice> asked;
  if (settings.tests.empty())
    found.push_back({"calibration.tests", "none", "material tests are described by a file",
                     "write calibration.tests = \"tests.toml\""});
  for (const std::string& law : settings.laws) {
    const auto known = calibration::law_named(law);
    std::string names;
    for (const auto& each : calibration::known_laws())
      names += (names.empty() ? "" : ", ") + name(each);
    if (known)
      asked.push_back(*known);
    else
      found.push_back({"calibration.laws", law,
                       "must be among " + names + ", of a relaxation with +prony-1 to +prony-" +
                           std::to_string(calibration::max_branches) + " behind",
                       "take some of them"});
  }
  if (asked.empty()) asked = calibration::known_laws();
  input.options.weights = settings.weights;
  input.options.seed = settings.seed;
  input.options.range_of_use = {settings.stretch_range[0], settings.stretch_range[1]};
  if (!(settings.stretch_range[0] < 1.0 && settings.stretch_range[1] > 1.0))
    found.push_back({"calibration.stretch_range", "", "must hold 1, the rubber at rest",
                     "write e.g. [0.5, 2.0]"});
  if (!found.empty()) throw loaded.locate(found);
  try {
    input.tests = read_material_tests(settings.tests);
  } catch (const meshes::InvalidInput& error) {
    throw refused_file(loaded, "calibration.tests", error);
  }
  input.laws = with_branches(asked, input.tests, settings.branches);
  return input;
}

Job law_job(const LawInput& input) {
  return {.kind = "laws",
          .inputs = law_inputs(input),
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_laws, input),
          .weight = fit_weight};
}

}  // namespace fingertip::studies::inline fits::inline runs
