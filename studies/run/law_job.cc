#include "studies/run/law_job.h"

#include <fmt/format.h>

#include "calibration/material_tests/law_card.h"
#include "calibration/material_tests/law_record.h"
#include "meshes/fields_json.h"
#include "meshes/table_rows.h"
#include "source_hash.h"
#include "studies/run/json_file.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

using calibration::LawFit;
using calibration::MaterialTest;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

ordered_json test_inputs(const MaterialTest& test) {
  return {{"name", test.name},
          {"kind", name(test.kind)},
          {"measure", name(test.measure)},
          {"deformation", test.deformation},
          {"stress", test.stress},
          {"sigma", test.sigma},
          {"rate", test.rate.value_or(0.0)},
          {"source", test.source}};
}

ordered_json law_inputs(const LawInput& input) {
  ordered_json inputs = {
      {"weights", name(input.options.weights)},
      {"seed", input.options.seed},
      {"range_of_use", *input.options.range_of_use},
      {"about", {input.tests.material, input.tests.source, input.tests.licence}}};
  for (const char* list : {"fitted", "held_back", "laws"}) inputs[list] = ordered_json::array();
  for (const MaterialTest& test : input.tests.fitted) inputs["fitted"].push_back(test_inputs(test));
  for (const MaterialTest& test : input.tests.held_back)
    inputs["held_back"].push_back(test_inputs(test));
  for (const auto& law : input.laws) inputs["laws"].push_back(name(law));
  return inputs;
}

calibration::LawCard card_of_fit(const LawFit& fit, const LawInput& input) {
  calibration::LawCard card = card_of(fit, input.tests.fitted, input.tests.held_back);
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
    if (&fit == best) write_law_card(card, folder / "material.toml");
  }
}

void run_laws(const LawInput& input, const fs::path& folder, const JobContext& context) {
  const std::vector<MaterialTest>&fitted = input.tests.fitted, &held_back = input.tests.held_back;
  std::vector<LawFit> ranking;
  for (std::size_t i = 0; i < input.laws.size(); ++i) {
    if (!context.report(double(i) / double(input.laws.size()), name(input.laws[i])))
      throw meshes::Interrupted("the fit of laws was stopped");
    auto one = rank_laws(fitted, held_back, {input.laws[i]}, input.options);
    ranking.push_back(std::move(one.front()));
  }
  calibration::sort_ranking(ranking);
  const calibration::LawsFile file = laws_file(ranking, fitted, held_back, input.options.weights);
  meshes::write_json_file(file, folder / "laws.json");
  meshes::write_rows(law_data(ranking, fitted, held_back), folder / "law_data.csv");
  write_cards(ranking, input, folder);
  write_json({{"problem", "material"},
              {"status", "finished"},
              {"recommended", file.recommended},
              {"laws", input.laws.size()},
              {"tests", fitted.size()},
              {"predicted", held_back.size()},
              {"statement", file.statement}},
             folder / "summary.json");
  context.log(file.statement);
}

}  // namespace

LawInput law_input(const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  LawInput input;
  std::vector<meshes::Violation> found;
  if (settings.tests.empty())
    found.push_back({"calibration.tests", "none", "material tests are described by a file",
                     "write calibration.tests = \"tests.toml\""});
  for (const std::string& law : settings.laws) {
    const auto known = calibration::law_named(law);
    std::string names;
    for (const auto& each : calibration::known_laws())
      names += (names.empty() ? "" : ", ") + name(each);
    if (known)
      input.laws.push_back(*known);
    else
      found.push_back({"calibration.laws", law, "must be among " + names, "take some of them"});
  }
  if (input.laws.empty()) input.laws = calibration::known_laws();
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
    for (const meshes::Violation& broken : error.violations())
      found.push_back(
          {"calibration.tests", broken.value,
           broken.key + (broken.value.empty() ? "" : " = " + broken.value) + ": " + broken.rule,
           broken.remedy});
    throw loaded.locate(found);
  }
  return input;
}

Job law_job(const LawInput& input) {
  Job job;
  job.kind = "laws";
  job.inputs = law_inputs(input);
  job.source_hash = source_hash::calibration;
  job.weight = fit_weight;
  job.run = [input](const fs::path& folder, const JobContext& context) {
    run_laws(input, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies
