/// A case: a configuration, the runs that are made of it, and the criteria these are judged by.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "studies/config/loader.h"

namespace fingertip::studies::inline cases {

/// "the measure must not exceed the limit" (studies/manual/files.md lists the measures).
struct CaseCriterion {
  std::string name;     ///< for people
  std::string measure;  ///< e.g. "hookean.speed_deviation"
  double limit = 0.0;   ///< in the measure's unit
};

/// What a table [[case.KIND]] asks for.
struct RunKind {
  std::string name;    ///< KIND
  std::string verb;    ///< what its runs compute; empty: they say it themselves
  std::string folder;  ///< of its runs, below that of the case's run; empty: no such folder
  bool at_rest;        ///< static presses (variants with a program that does not move along the
                       ///< plane: quasi-static), measured against the continuum of their kinematics
  std::set<std::string> entries;  ///< beside name, series, x and set
};

/// In the order in which a case's runs are planned.
const std::vector<RunKind>& run_kinds();

/// One run of a case: the case's configuration with some keys set otherwise.
struct CaseRun {
  std::string kind = {};    ///< of run_kinds()
  std::string verb = {};    ///< a planner's (planner.h), e.g. "press"
  std::string name = {};    ///< unique within its series
  std::string series = {};  ///< runs that are drawn and judged together; may be empty
  double x = std::numeric_limits<double>::quiet_NaN();  ///< its place on Case::abscissa, NaN: none
  std::vector<std::string> sets = {};                   ///< "section.key=TOML literal"
  std::map<std::string, double> times = {};  ///< keys: their number is the case's times this
  std::string place = {};                    ///< where it is written, "file:line"
  std::string beside = {};  ///< full name of a run above, to compare forces with; or empty
  std::string varied = {};  ///< for tables: what its series varies here
  std::string when = {};    ///< only if its spacing is "coarser" or "another" than the case's
  std::string law = {};     ///< of a fit of laws: which one is measured; empty: every one
  std::string test = {};    ///< likewise, by which of the tests; empty: by all
  std::string displacements =
      {};                   ///< measured ones, whose points are its markers; a file, or empty
  bool continuum = false;   ///< measured against a continuum: the transient one at the same speed
  bool snapshots = false;   ///< drawn in the report; of a variant its contact
  bool exhibit = false;     ///< may fail to converge without failing the case

  bool is(std::string_view wanted) const { return kind == wanted; }
  /// Whether it is a press of [[case.run]]: measured at the verdict depths.
  bool is_verdict() const { return is("run") && verb == "press"; }
};

/// "series, name", or the name alone.
std::string full_name(const CaseRun& run);

/// A prediction of a series is asked of the fits of that series alone.
bool is_asked(const CaseRun& prediction, const CaseRun& fit);

/// A CSV file with a row per run of a series and depth.
struct CaseTable {
  std::string file;                  ///< its name
  std::string series;                ///< of the [[case.run]]s it shows
  std::vector<std::string> columns;  ///< of table_columns()
};

/// What a press's force error is made of. Each part is a series whose x is a compliance in units of
/// the press's own (x = 1): its share is the error at x = 1 minus the error continued to x = 0.
struct CaseBudget {
  std::string name;
  std::vector<std::string> parts;  ///< series
};

/// Files from elsewhere that a case reads.
struct CaseData {
  std::string variable;  ///< of the environment, which names their folder; empty: no such files
  std::string source;    ///< where they are to be had
};

struct Case {
  std::string name;  ///< of its folder, e.g. "01_paper_rubber"
  std::string title;
  std::string description;
  std::string abscissa;  ///< label of the runs' x, with its unit in brackets
  CaseData data;
  std::vector<CaseCriterion> criteria;
  std::vector<CaseRun> runs;     ///< by kind
  bool takes_core_runs = false;  ///< and tables, for the file names no runs
  std::vector<CaseTable> tables;
  std::vector<CaseBudget> budgets;
  LoadedConfig loaded;
  std::string text;  ///< the table [case] as TOML, to be kept in parameters.toml
};

/// The folder with all cases: $FINGERTIP_CASES, else studies/cases of the sources this program
/// was built from.
std::filesystem::path cases_folder();

/// Files case.toml of all sub-folders of cases_folder(), sorted by name.
std::vector<std::filesystem::path> all_cases();

/// The case that `validate` alone runs: its runs are those of every case that names none.
inline constexpr const char* core_case = "01_paper_rubber";

/// The case file that `name` means: a file, a folder with a case.toml, or the name (or its start)
/// of a case under cases_folder(). Throws ConfigError naming the cases there are.
std::filesystem::path find_case(const std::string& name);

/// Reads a case file, or any configuration file as a case without criteria. Further settings come
/// from `source` (whose file is ignored). Throws ConfigError with all problems.
Case load_case(const std::filesystem::path& file, const ConfigSource& source);

/// Why the files that the case needs are not at hand, with the remedy, in one sentence; empty: it
/// has them, or needs none.
std::string missing_data(const Case& study_case);

/// The case's configuration with the run's own settings, which come last. Throws ConfigError, see
/// at_run.
LoadedConfig run_config(const Case& study_case, const CaseRun& run);

/// `error` as told to the author of the case: problems that the run's settings cause lie at its
/// line, and all of them name it.
ConfigError at_run(const ConfigError& error, const CaseRun& run);

/// Fills title, description, runs, tables, budgets and criteria of `target` from the table [case]
/// of `file`, runs and tables from the core case's where it names no run. Returns every problem
/// with its line.
std::vector<meshes::Violation> read_case_table(const std::filesystem::path& file, Case& target);

/// The same as TOML text, which read_case_table understands.
std::string case_toml(const Case& study_case);

}  // namespace fingertip::studies::inline cases
