#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "calibration/material_tests/law_record.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/fit_screen.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/json_entry.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/fits/runs/law_job.h"
#include "studies/report/chapters/fit/law_chapter.h"
#include "studies/report/page/terminal.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

/// The laws, and of the recommended one how it meets the tests and what contradicts it, as far as
/// that is not why it was not accepted.
void print_laws(const calibration::LawsFile& file) {
  const report::LawResult result{file, {}};
  fmt::print(
      "{}", report::tables_text(report::law_chapter(result), {"ranking", "coefficients", "tests"}));
  for (const calibration::LawEntry& law : file.laws)
    if (!law.failure.empty()) fmt::print("{}: no fit: {}\n", law.law, law.failure);
  for (const std::string& sentence : result.taken().contradictions)
    if (std::ranges::find(file.failed, sentence) == file.failed.end())
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
    const auto file = struct_of<calibration::LawsFile>(read_entry(folder / "laws.json"));
    const std::filesystem::path card = folder / "material.toml",
                                taken = folder / "cards" / (file.recommended + ".toml");
    if (!file.failed.empty()) std::filesystem::remove(card);  // of an earlier attempt
    if (!file.failed.empty() && line.force && std::filesystem::exists(taken))
      std::filesystem::copy_file(taken, card);
    const bool written = std::filesystem::exists(card);
    if (!line.quiet) {
      fmt::print("{}\n\n", in_shown_units(file.statement, Spelling::terminal));
      print_laws(file);
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
