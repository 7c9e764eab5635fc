#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "meshes/base/errors.h"
#include "studies/cases/validation.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/report/report.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> wanted_cases(const CommandLine& line) {
  if (!line.config.file.empty()) {
    if (line.all || !line.arguments.empty()) {
      throw ConfigError({"", "", "validate takes either cases or a configuration, not both",
                         "leave out one of them", "--config " + line.config.file.string()});
    }
    return {line.config.file};
  }
  if (line.all) return all_cases();
  if (line.arguments.empty()) return {find_case("01_paper_rubber")};
  std::vector<fs::path> files;
  for (const std::string& name : line.arguments) files.push_back(find_case(name));
  return files;
}

/// Where the case's run goes: a sub-folder of its own when there are several.
CommandLine line_for(const CommandLine& line, const Case& study_case, bool several) {
  CommandLine own = line;
  if (several && !line.out.empty()) own.out = line.out / study_case.name;
  if (several) own.folder_stem = line.verb + "-" + study_case.name;
  return own;
}

int validate_one(const CommandLine& line, const Case& study_case) {
  return run_in_folder(line, study_case.loaded, study_case.text, [&](Session& session) {
    const Verdict verdict = validate(session, study_case);
    if (!line.quiet) {
      fmt::print("{}\nreport: {}\n", report::verdict_text(session.folder().path()),
                 (session.folder().path() / "report.html").string());
    }
    return verdict == Verdict::passed ? 0 : 4;
  });
}

}  // namespace

int run_validate(const CommandLine& line) {
  std::vector<Case> cases;
  const std::vector<fs::path> files = wanted_cases(line);
  const bool several = files.size() > 1;
  for (const fs::path& file : files) {
    Case study_case = load_case(file, line.config);
    // Of several cases the others are carried out; one that is asked for alone is refused.
    if (const std::string missing = missing_data(study_case); several && !missing.empty()) {
      fmt::print(stderr, "fingertip: note: {} is skipped: {}\n", study_case.name, missing);
      continue;
    }
    check_case(study_case);
    cases.push_back(std::move(study_case));
  }
  int worst = 0;
  for (const Case& study_case : cases) {
    try {
      worst = std::max(worst, validate_one(line_for(line, study_case, several), study_case));
    } catch (const meshes::NotConverged& error) {
      if (!several) throw;
      // The other cases still have something to say.
      fmt::print(stderr, "fingertip: error: {}: {}\n", study_case.name, error.what());
      worst = std::max(worst, 3);
    }
  }
  return worst;
}

}  // namespace fingertip::studies::inline cli::inline verbs
