/// A case: a configuration with a title, a description and the criteria it is judged by.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/config/loader.h"

namespace fingertip::studies {

/// "the measure must not exceed the limit" (studies/cases/README.md lists the measures).
struct CaseCriterion {
  std::string name;     ///< for people
  std::string measure;  ///< e.g. "hookean.speed_deviation"
  double limit = 0.0;   ///< in the measure's unit
};

struct Case {
  std::string name;  ///< of its folder, e.g. "01_paper_rubber"
  std::string title;
  std::string description;
  std::vector<CaseCriterion> criteria;
  LoadedConfig loaded;
  std::string text;  ///< the table [case] as TOML, to be kept in parameters.toml
};

/// The folder with all cases: $FINGERTIP_CASES, else studies/cases of the sources this program
/// was built from.
std::filesystem::path cases_folder();

/// Files case.toml of all sub-folders of cases_folder(), sorted by name.
std::vector<std::filesystem::path> all_cases();

/// The case file that `name` means: a file, a folder with a case.toml, or the name (or its start)
/// of a case under cases_folder(). Throws ConfigError naming the cases there are.
std::filesystem::path find_case(const std::string& name);

/// Reads a case file, or any configuration file as a case without criteria. Further settings come
/// from `source` (whose file is ignored). Throws ConfigError with all problems.
Case load_case(const std::filesystem::path& file, const ConfigSource& source);

}  // namespace fingertip::studies
