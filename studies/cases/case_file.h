/// A case: a configuration with a title, a description, the criteria it is judged by and, when it
/// is a study, the variants it compares.
#pragma once

#include <filesystem>
#include <limits>
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

/// One run of a study: the case's configuration with some keys set otherwise.
struct CaseVariant {
  std::string name;    ///< unique within its series
  std::string series;  ///< variants that are drawn and judged together; may be empty
  double x = std::numeric_limits<double>::quiet_NaN();  ///< its place on Case::abscissa, NaN: none
  std::vector<std::string> sets;                        ///< "section.key=TOML literal"
  std::string place;                                    ///< where it is written, "file:line"
};

/// A press in time of a case on virtual control.
struct CasePress : CaseVariant {
  bool continuum = false;  ///< measured against the transient continuum at the same speed
  bool snapshots = false;  ///< drawn in the report
  std::string beside;      ///< full name of the press its forces are compared with; may be empty
};

/// "series, name", or the name alone.
std::string full_name(const CaseVariant& variant);

/// What a press's force error is made of. Each part is a series whose x is a compliance in units of
/// the press's own (x = 1): its share is the error at x = 1 minus the error continued to x = 0.
struct CaseBudget {
  std::string name;
  std::vector<std::string> parts;  ///< series
};

struct Case {
  std::string name;  ///< of its folder, e.g. "01_paper_rubber"
  std::string title;
  std::string description;
  std::string abscissa;  ///< label of the variants' x, with its unit in brackets
  std::vector<CaseCriterion> criteria;
  std::vector<CaseVariant> variants;  ///< of a study
  std::vector<CaseBudget> budgets;
  std::vector<CaseVariant> fits;         ///< calibrations that are compared; then no variants
  std::vector<CaseVariant> predictions;  ///< static presses that every fit is asked to predict
  std::vector<CasePress> presses;        ///< under controllers; then no variants and fits
  std::vector<CaseVariant> grasps;       ///< of a rigid block; then none of those above
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

/// The case's configuration with the variant's own settings, as a static press. Settings of the
/// variant come last. Throws ConfigError, see at_variant.
LoadedConfig variant_config(const Case& one, const CaseVariant& variant);

/// `error` as told to the author of the case: problems that the variant's settings cause lie at its
/// line, and all of them name it.
ConfigError at_variant(const ConfigError& error, const CaseVariant& variant);

}  // namespace fingertip::studies
