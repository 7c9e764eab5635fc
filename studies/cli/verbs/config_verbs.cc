#include <fmt/format.h>

#include "meshes/base/files.h"
#include "studies/cases/case_file.h"
#include "studies/cli/command_line/shell_texts.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/documents.h"
#include "studies/files/places.h"
#include "studies/fits/runs/calibration_stages.h"
#include "studies/fits/runs/law_job.h"
#include "studies/jobs/interrupt.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/force_error.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

/// What `calibrate` would note on the data that a configuration names; refuses what it would
/// refuse.
std::vector<std::string> notes_on_data(const LoadedConfig& loaded) {
  const CalibrationSettings& calibration = loaded.config.calibration;
  if (calibration.problem == CalibrationProblem::material && !calibration.tests.empty())
    return law_input(loaded).tests.notes;
  if (calibration.data.empty()) return {};
  return CalibrationStages(loaded, "", CalibrationStages::Failed::kept).notes();
}

/// What a solid's continuum will take. Bodies of revolution take seconds.
std::string note_on_continuum(const LoadedConfig& loaded) {
  try {
    const bool beside = loaded.config.force_error == ForceErrorBy::continuum;
    const std::optional<fem_reference::ReferenceJob> reference =
        beside ? error_source(loaded).continuum : continuum_setup(loaded);
    if (!reference || reference->axisymmetric() ||
        reference->analysis != fem_reference::Analysis::static_press ||
        !std::filesystem::exists(reference_program()))
      return "";
    const ReferenceCost cost = expected_cost(*reference, interrupted);
    return fmt::format(
        "the continuum takes at least some {} and {:.2g} GB, from {:.0f} unknowns on",
        rough_duration(cost.time), 1e-9 * cost.memory, cost.unknowns);
  } catch (const meshes::Interrupted&) {
    throw;
  } catch (const std::exception& failure) {
    return std::string("what the continuum takes is not known: ") + failure.what();
  }
}

}  // namespace

int run_check(const CommandLine& line) {
  watch_for_interrupts();
  std::vector<std::string> files = line.arguments;
  if (!line.config.file.empty()) files.push_back(line.config.file.string());
  const bool by_sets = files.empty() && !line.config.sets.empty();
  if (by_sets) files.emplace_back("--set");
  if (files.empty())
    refuse("check", "no file is given", "give a configuration file, or --set section.key=value");
  for (const std::string& file : files) {
    const LoadedConfig loaded =
        by_sets ? load_config(line.config) : load_case(file, line.config).loaded;
    check_all(loaded);
    const std::vector<std::string> on_data = notes_on_data(loaded);
    if (line.quiet) continue;
    for (const std::string& note : on_data) fmt::print("{}: note: {}\n", file, note);
    const LoadedConfig complete = with_material(loaded, LatticeUse::press);
    for (const std::string& note : complete.notes) fmt::print("{}: note: {}\n", file, note);
    // No error: the continuum can do it.
    const ConfigError located = complete.locate(beyond_the_lattice(complete));
    for (const meshes::Violation& limit : located.violations()) {
      fmt::print("{}: note: for press and validate: {}\n", file, to_string(limit));
    }
    const double memory = equilibrium_memory(complete.config.press);
    if (memory > shown_memory)
      fmt::print("{}: note: a press at rest takes some {:.2g} GB\n", file, 1e-9 * memory);
    if (const std::string note = note_on_continuum(complete); !note.empty())
      fmt::print("{}: note: {}\n", file, note);
    fmt::print("{}: OK\n", file);
  }
  return 0;
}

int run_explain(const CommandLine& line) {
  if (line.schema) fmt::print("{}", json_schema());
  if (line.markdown) fmt::print("{}", markdown_reference());
  if (line.man) fmt::print("{}", man_page());
  if (line.completion) fmt::print("{}", bash_completion());
  if (line.schema || line.markdown || line.man || line.completion) return 0;
  if (line.arguments.empty()) {
    fmt::print("{}\nfingertip explain section.key tells more about one.\n", key_overview());
    return 0;
  }
  for (const std::string& name : line.arguments) {
    bool found = false;
    for (const Key& key : key_table()) {
      if (key.full_name() != name && key.name != name && key.section != name) continue;
      fmt::print("{}{}", found ? "\n" : "", explanation(key));
      found = true;
    }
    if (!found) {
      throw ConfigError({"", "", "there is no such key",
                         "the nearest valid key is " + nearest_key(name), "explain " + name});
    }
  }
  return 0;
}

}  // namespace fingertip::studies::inline cli::inline verbs
