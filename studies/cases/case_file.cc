#include "studies/cases/case_file.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <toml++/toml.h>
#include "studies/config/finger_defaults.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;

/// Whether the run has a setting of its own for the key.
bool sets_key(const CaseRun& run, const std::string& key) {
  return std::ranges::any_of(
      run.sets, [&](const std::string& setting) { return setting.starts_with(key + "="); });
}

}  // namespace

const std::vector<RunKind>& run_kinds() {
  static const std::vector<RunKind> kinds = {
      {"run",
       "",
       "",
       false,
       {"verb", "beside", "varied", "when", "times", "exhibit", "displacements"}},
      {"variant", "press", "variants", true, {"beside", "displacements", "snapshots"}},
      {"fit", "fit", "fits", true, {}},
      {"prediction", "press", "", true, {}},  // below each fit
      {"press", "press", "presses", false, {"beside", "continuum", "snapshots"}},
      {"grasp", "grasp", "grasps", false, {}},
      {"material", "laws", "materials", false, {"law", "test"}}};
  return kinds;
}

std::string full_name(const CaseRun& run) {
  return (run.series.empty() ? "" : run.series + ", ") + run.name;
}

bool is_asked(const CaseRun& prediction, const CaseRun& fit) {
  return prediction.is("prediction") && fit.is("fit") &&
         (prediction.series.empty() || prediction.series == fit.series);
}

fs::path cases_folder() {
  const char* const chosen = std::getenv("FINGERTIP_CASES");
  return chosen != nullptr && *chosen != '\0' ? fs::path(chosen)
                                              : data_folder("cases", FINGERTIP_CASES_FOLDER);
}

std::vector<fs::path> all_cases() {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& item : fs::directory_iterator(cases_folder(), failed)) {
    if (fs::exists(item.path() / "case.toml")) files.push_back(item.path() / "case.toml");
  }
  std::ranges::sort(files);
  return files;
}

fs::path find_case(const std::string& name) {
  if (fs::is_regular_file(name)) return name;
  if (fs::is_regular_file(fs::path(name) / "case.toml")) return fs::path(name) / "case.toml";
  std::string known;
  for (const fs::path& file : all_cases()) {
    const std::string folder = file.parent_path().filename();
    if (folder.starts_with(name)) return file;
    known += (known.empty() ? "" : ", ") + folder;
  }
  throw ConfigError({"", "", "there is no such case",
                     "use a folder with a case.toml, or one of " + known, "CASE " + name});
}

Case load_case(const fs::path& file, const ConfigSource& source) {
  Case study_case;
  study_case.name = file.filename() == "case.toml"
                        ? fs::absolute(file).parent_path().filename().string()
                        : file.stem().string();
  study_case.title = study_case.name;
  std::vector<meshes::Violation> problems;
  try {
    ConfigSource with_file = source;
    with_file.file = file;
    study_case.loaded = load_config(with_file);
  } catch (const ConfigError& error) {
    problems = error.violations();
  }
  append(problems, read_case_table(file, study_case));
  if (!problems.empty()) throw ConfigError(problems);
  study_case.text = case_toml(study_case);
  return study_case;
}

std::string missing_data(const Case& study_case) {
  const CaseData& data = study_case.data;
  if (data.variable.empty()) return {};
  const char* const folder = std::getenv(data.variable.c_str());
  if (folder != nullptr && fs::is_directory(folder)) return {};
  return fmt::format("its data are no part of the project: get {}, and name their folder in {}",
                     data.source, data.variable);
}

LoadedConfig run_config(const Case& study_case, const CaseRun& run) {
  std::vector<std::string> sets = run.sets;
  for (const auto& [key, factor] : run.times) {
    const toml::table own = toml::parse("value = " + study_case.loaded.entries.at(key).literal);
    sets.push_back(fmt::format("{}={}", key, factor * own["value"].value_or(0.0)));
  }
  const auto kind = std::ranges::find(run_kinds(), run.kind, &RunKind::name);
  if (kind->at_rest) sets.emplace_back("press.mode=static");
  try {
    LoadedConfig loaded = with_sets(study_case.loaded, sets);
    const meshes::PressProtocol& protocol = loaded.config.press.protocol;
    // What moves along the plane does so at rest.
    const bool in_time =
        run.is("variant") && !protocol.program.empty() && !protocol.has_plane_moves();
    if (in_time) loaded = with_sets(loaded, {"press.mode=quasi-static"});
    keep_spacing(loaded, study_case.loaded);
    return loaded;
  } catch (const ConfigError& error) {
    throw at_run(error, run);
  }
}

ConfigError at_run(const ConfigError& error, const CaseRun& run) {
  std::vector<meshes::Violation> problems = error.violations();
  for (meshes::Violation& problem : problems) {
    if (sets_key(run, problem.key)) problem.place = run.place;
    problem.place += " (variant " + full_name(run) + ")";
  }
  return ConfigError(std::move(problems));
}

}  // namespace fingertip::studies::inline cases
