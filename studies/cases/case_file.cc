#include "studies/cases/case_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "meshes/files.h"
#include "studies/cases/measures.h"
#include "studies/config/key_table.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// The table [case] of a file; empty when the file has none or is no TOML (load_config reports).
toml::table case_table(const fs::path& file) {
  try {
    const toml::table root = toml::parse_file(file.string());
    const auto* table = root["case"].as_table();
    return table == nullptr ? toml::table{} : *table;
  } catch (const toml::parse_error&) {
    return {};
  }
}

/// Reads [case], collecting problems with their line.
class CaseReader {
 public:
  CaseReader(const fs::path& file, Case& target) : file_(file), target_(target) {}

  std::vector<Problem> read() {
    const toml::table table = case_table(file_);
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (name == "title") {
        target_.title = text(node, "case.title");
      } else if (name == "description") {
        target_.description = text(node, "case.description");
      } else if (name == "criteria" && node.is_array_of_tables()) {
        for (const toml::node& entry : *node.as_array()) read_criterion(*entry.as_table());
      } else {
        problem(node, "case." + name, "", "unknown entry of [case]",
                "use title, description and [[case.criteria]] with name, measure, limit");
      }
    }
    return problems_;
  }

 private:
  void problem(const toml::node& node, const std::string& key, const std::string& value,
               const std::string& rule, const std::string& remedy) {
    problems_.push_back({file_.string() + ":" + std::to_string(node.source().begin.line), key,
                         value, rule, remedy});
  }

  std::string text(const toml::node& node, const std::string& key) {
    if (const auto* value = node.as_string()) return value->get();
    problem(node, key, toml_literal(node), "must be a text", "put it in quotes");
    return {};
  }

  void read_criterion(const toml::table& entry) {
    CaseCriterion criterion;
    criterion.name = entry["name"].value_or(std::string());
    criterion.measure = entry["measure"].value_or(std::string());
    criterion.limit = entry["limit"].value_or(no_limit());
    const std::vector<std::string> measures = measure_names();
    if (criterion.name.empty() || !std::isfinite(criterion.limit) || entry.size() != 3) {
      problem(entry, "case.criteria", criterion.name, "needs exactly name, measure and limit",
              "complete the entry");
    } else if (std::ranges::find(measures, criterion.measure) == measures.end()) {
      problem(entry, "case.criteria.measure", criterion.measure, "unknown measure",
              "the nearest one is " + nearest_word(criterion.measure, measures));
    }
    target_.criteria.push_back(std::move(criterion));
  }

  static double no_limit() { return std::nan(""); }

  fs::path file_;
  Case& target_;
  std::vector<Problem> problems_;
};

std::string case_toml(const Case& one) {
  const auto quoted = [](const std::string& text) {
    return toml_literal(toml::value<std::string>(text));
  };
  std::string text = fmt::format("\n[case]\ntitle = {}\ndescription = {}\n", quoted(one.title),
                                 quoted(one.description));
  for (const CaseCriterion& criterion : one.criteria) {
    text += fmt::format("\n[[case.criteria]]\nname = {}\nmeasure = {}\nlimit = {}\n",
                        quoted(criterion.name), quoted(criterion.measure),
                        toml_literal(toml::value<double>(criterion.limit)));
  }
  return text;
}

}  // namespace

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
  const std::vector<Problem> more = CaseReader(file, one).read();
  problems.insert(problems.end(), more.begin(), more.end());
  if (!problems.empty()) throw ConfigError(problems);
  one.text = case_toml(one);
  return one;
}

}  // namespace fingertip::studies
