#include "studies/cases/case_file.h"

#include <algorithm>
#include <cstdlib>

#include "studies/cases/case_table.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// Whether the variant has a setting of its own for the key.
bool sets_key(const CaseVariant& variant, const std::string& key) {
  return std::ranges::any_of(variant.sets,
                             [&](const std::string& one) { return one.starts_with(key + "="); });
}

}  // namespace

std::string full_name(const CaseVariant& variant) {
  return (variant.series.empty() ? "" : variant.series + ", ") + variant.name;
}

fs::path cases_folder() {
  const char* const chosen = std::getenv("FINGERTIP_CASES");
  return chosen != nullptr && *chosen != '\0' ? fs::path(chosen) : fs::path(FINGERTIP_CASES_FOLDER);
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
    const std::string one = file.parent_path().filename();
    if (one.starts_with(name)) return file;
    known += (known.empty() ? "" : ", ") + one;
  }
  throw ConfigError({{"CASE " + name, "", "", "there is no such case",
                      "use a folder with a case.toml, or one of " + known}});
}

Case load_case(const fs::path& file, const ConfigSource& source) {
  Case one;
  one.name = file.filename() == "case.toml" ? fs::absolute(file).parent_path().filename().string()
                                            : file.stem().string();
  one.title = one.name;
  std::vector<Problem> problems;
  try {
    ConfigSource with_file = source;
    with_file.file = file;
    one.loaded = load_config(with_file);
  } catch (const ConfigError& error) {
    problems = error.problems();
  }
  const std::vector<Problem> more = read_case_table(file, one);
  problems.insert(problems.end(), more.begin(), more.end());
  if (!problems.empty()) throw ConfigError(problems);
  one.text = case_toml(one);
  return one;
}

LoadedConfig variant_config(const Case& one, const CaseVariant& variant) {
  std::vector<std::string> sets = variant.sets;
  sets.emplace_back("press.mode=static");
  try {
    return one.loaded.with(sets);
  } catch (const ConfigError& error) {
    throw at_variant(error, variant);
  }
}

ConfigError at_variant(const ConfigError& error, const CaseVariant& variant) {
  std::vector<Problem> problems = error.problems();
  const std::string who = " (variant " + full_name(variant) + ")";
  for (Problem& problem : problems) {
    if (sets_key(variant, problem.key)) problem.place = variant.place;
    problem.place += who;
  }
  return ConfigError(std::move(problems));
}

}  // namespace fingertip::studies
