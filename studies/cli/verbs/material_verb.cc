#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "calibration/material_tests/law_record.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/fit_screen.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/fits/runs/law_job.h"
#include "studies/jobs/json_file.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

using calibration::LawEntry;
using calibration::LawTestEntry;

std::string share_text(double share) {
  return std::isfinite(share) ? fmt::format("{:.3g}", 100.0 * share) : std::string("-");
}

/// "test 1.2 %, sheet* 14 %": errors of one law.
void print_ranking(const calibration::LawsFile& file) {
  const double least = file.laws.front().aicc;
  fmt::print("{:<23}{:>3}{:>10}  {:<11}", "law", "k", "AICc", "stable");
  for (const LawTestEntry& test : file.laws.front().tests)
    fmt::print("  {:>18.18}", test.name + (test.use == "fit" ? "" : "*"));
  fmt::print("\n");
  for (const LawEntry& law : file.laws) {
    if (!law.failure.empty()) {
      fmt::print("{:<23} no fit: {}\n", law.law, law.failure);
      continue;
    }
    const auto& unstable = law.unstable_in_tests ? law.unstable_in_tests
                           : law.unstable_in_use ? law.unstable_in_use
                                                 : law.unstable_in_press;
    fmt::print("{:<23}{:>3}{:>10.1f}  {:<11}", law.law, law.parameters.size(), law.aicc - least,
               unstable ? fmt::format("to {:.3g}", unstable->stretch) : "yes");
    for (const LawTestEntry& test : law.tests)
      fmt::print("  {:>18}",
                 share_text(test.rms_relative) + " / " + share_text(test.largest_relative));
    fmt::print("{}\n", law.law == file.recommended ? "  <" : "");
  }
  fmt::print(
      "errors in %: root mean square / largest, over those of the stress; *: not fitted; "
      "AICc less the least\n");
}

/// `told`: contradictions that stand elsewhere.
void print_coefficients(const LawEntry& law, const std::vector<std::string>& told) {
  fmt::print("\n{:<24}{:>14}{:>14}{:>14}  {}\n", law.law, "estimate", "95 % from", "to", "unit");
  for (const auto& parameter : law.parameters) {
    const ShownUnit* shown = shown_units().of(parameter.unit);
    const auto value = [&](double si) { return shown == nullptr ? si : (*shown)(si); };
    fmt::print("{:<24}{:>14.6g}{:>14.6g}{:>14.6g}  {}\n", parameter.name, value(parameter.estimate),
               value(parameter.lower), value(parameter.upper),
               shown == nullptr ? parameter.unit : std::string(shown->ascii));
  }
  for (const LawTestEntry& test : law.tests)
    if (std::isfinite(test.loop_measured))
      fmt::print("loops of {}: {:.4g} J/m^3 measured, {:.4g} by the law\n", test.name,
                 test.loop_measured, test.loop_computed);
  for (const std::string& sentence : law.contradictions)
    if (std::ranges::find(told, sentence) == told.end())
      fmt::print("- {}\n", in_shown_units(sentence, Spelling::terminal));
}

}  // namespace

int run_material(const CommandLine& line, const LoadedConfig& loaded) {
  const LawInput input = law_input(loaded);
  if (!line.quiet)
    for (const std::string& note : input.tests.notes)
      fmt::print(stderr, "fingertip: note: {}\n", note);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    for (const std::string& note : input.tests.notes) session.folder().log(note);
    const JobResult result = session.run({"", law_job(input), false});
    const std::filesystem::path& folder = session.folder().path();
    const auto file = struct_of<calibration::LawsFile>(
        JsonEntry(read_json(folder / "laws.json"), folder / "laws.json"));
    const std::filesystem::path card = folder / "material.toml",
                                taken = folder / "cards" / (file.recommended + ".toml");
    if (!file.failed.empty()) std::filesystem::remove(card);  // of an earlier attempt
    if (!file.failed.empty() && line.force && std::filesystem::exists(taken))
      std::filesystem::copy_file(taken, card);
    const bool written = std::filesystem::exists(card);
    if (!line.quiet) {
      fmt::print("{}\n\n", in_shown_units(file.statement, Spelling::terminal));
      print_ranking(file);
      for (const LawEntry& law : file.laws)
        if (law.law == file.recommended) print_coefficients(law, file.failed);
      if (result.reused) fmt::print("(result from an earlier run with the same input)\n");
      if (written)
        fmt::print("card: {} (use: --set rubber.card=PATH --set lattice.model=network)\n",
                   card.string());
      fmt::print("run folder: {}\n", folder.string());
    }
    return verdict(file.failed, true, written);
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
