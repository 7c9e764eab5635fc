#include "studies/cases/case_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "calibration/material_tests/law_model.h"
#include "studies/cases/measures.h"
#include "studies/cases/outputs.h"
#include "studies/cases/planner.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/text/toml_text.h"
#include "studies/config/text/units.h"
#include "studies/config/value_reader.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;

/// Keys that follow from what a run is: a press in equilibrium, or slow, measured against the
/// continuum of its own kinematics, or one in time, beside the transient continuum.
bool is_derived(const std::string& key, const std::string& kind) {
  static const std::set<std::string> keys = {"press.mode", "reference.strain", "reference.law",
                                             "reference.mode"};
  return kind != "run" && keys.contains(key) && !(kind == "press" && key == "press.mode");
}

const std::map<std::string, std::string CaseRun::*>& run_texts() {
  static const std::map<std::string, std::string CaseRun::*> texts = {
      {"name", &CaseRun::name},
      {"series", &CaseRun::series},
      {"verb", &CaseRun::verb},
      {"beside", &CaseRun::beside},
      {"varied", &CaseRun::varied},
      {"when", &CaseRun::when},
      {"law", &CaseRun::law},
      {"test", &CaseRun::test},
      {"displacements", &CaseRun::displacements}};
  return texts;
}

const std::map<std::string, bool CaseRun::*>& run_flags() {
  static const std::map<std::string, bool CaseRun::*> flags = {{"continuum", &CaseRun::continuum},
                                                               {"snapshots", &CaseRun::snapshots},
                                                               {"exhibit", &CaseRun::exhibit}};
  return flags;
}

/// "key=literal". A file that a value names is relative to the folder of the case.
std::string setting(const std::string& key, const toml::node& value, const fs::path& base) {
  const Key* known = find_key(key);
  try {
    if (known != nullptr) return key + "=" + read(*known, value, base).literal;
  } catch (const UnitError&) {
    // Told when the variant is loaded.
  }
  return key + "=" + toml_literal(value);
}

/// Reads [case], collecting problems with their line.
class CaseReader {
 public:
  CaseReader(const fs::path& file, Case& target) : file_(file), target_(target) {}

  std::vector<meshes::Violation> read() {
    // By reference: a copy of a TOML node forgets its line.
    const toml::table root = parsed_file(file_);
    static const toml::table none;
    const auto* found = root["case"].as_table();
    const toml::table& table = found == nullptr ? none : *found;
    for (const auto& [key, node] : table) read_entry(std::string(key.str()), node);
    for (const RunKind& kind : run_kinds())
      each(table, kind.name, [&](const toml::table& entry) { read_run(entry, kind); });
    each(table, "table", [&](const toml::table& entry) { read_table(entry); });
    if (target_.runs.empty() && !is_core_) take_core_runs();
    // Budgets and criteria speak of runs.
    each(table, "budget", [&](const toml::table& entry) { read_budget(entry); });
    const std::vector<std::string> measures = measure_names(target_);
    each(table, "criteria", [&](const toml::table& entry) { read_criterion(entry, measures); });
    return problems_;
  }

 private:
  void take_core_runs() {
    static const Case core = [] {
      Case study_case;
      const fs::path file = data_folder("cases", FINGERTIP_CASES_FOLDER) / core_case / "case.toml";
      CaseReader reader(file, study_case);
      reader.is_core_ = true;
      std::vector<meshes::Violation> problems = reader.read();
      if (study_case.runs.empty())
        problems.push_back({"case.run", "", "the core case must say what is run",
                            "restore the file", file.string()});
      if (!problems.empty()) throw ConfigError(problems);
      return study_case;
    }();
    target_.takes_core_runs = true;
    target_.runs = core.runs;
    target_.tables = core.tables;
  }

  void read_entry(const std::string& name, const toml::node& node) {
    const bool list = name == "table" || name == "budget" || name == "criteria" ||
                      std::ranges::find(run_kinds(), name, &RunKind::name) != run_kinds().end();
    if (name == "title") {
      target_.title = text(node, "case.title");
    } else if (name == "description") {
      target_.description = text(node, "case.description");
    } else if (name == "x") {
      target_.abscissa = text(node, "case.x");
    } else if (name == "data" && node.is_table()) {
      read_data(*node.as_table());
    } else if (!list || !node.is_array_of_tables()) {
      problem(node, "case." + name, "", "unknown entry of [case]",
              "use title, description, x, [case.data], [[case.run]], [[case.variant]], "
              "[[case.budget]], [[case.fit]], [[case.prediction]], [[case.press]], "
              "[[case.grasp]], [[case.material]], [[case.table]] and [[case.criteria]] with name, "
              "measure, limit");
    }
  }

  void read_data(const toml::table& table) {
    target_.data = {table["folder"].value_or(std::string()),
                    table["source"].value_or(std::string())};
    if (target_.data.variable.empty() || target_.data.source.empty() || table.size() != 2)
      problem(table, "case.data", target_.data.variable,
              "needs exactly folder, the environment variable that names it, and source, where "
              "the files are to be had",
              "complete the entry");
  }

  /// A file is relative to the folder of the case.
  std::string located(const std::string& path) const {
    return fs::absolute(file_.parent_path() / path).lexically_normal();
  }

  template <class Reader>
  void each(const toml::table& table, const std::string& name, const Reader& reader) {
    const auto* list = table[name].as_array();
    if (list == nullptr || !list->is_array_of_tables()) return;
    for (const toml::node& entry : *list) reader(*entry.as_table());
  }

  void problem(const toml::node& node, const std::string& key, const std::string& value,
               const std::string& rule, const std::string& remedy) {
    problems_.push_back({key, value, rule, remedy, place(node)});
  }

  std::string place(const toml::node& node) const {
    return file_.string() + ":" + std::to_string(node.source().begin.line);
  }

  std::string text(const toml::node& node, const std::string& key) {
    if (const auto* value = node.as_string()) return value->get();
    problem(node, key, toml_literal(node), "must be a text", "put it in quotes");
    return {};
  }

  std::vector<std::string> texts(const toml::table& entry, const char* name) {
    std::vector<std::string> list;
    if (const auto* found = entry[name].as_array())
      for (const toml::node& element : *found) list.push_back(element.value_or(std::string()));
    return list;
  }

  void read_criterion(const toml::table& entry, const std::vector<std::string>& measures) {
    CaseCriterion criterion;
    criterion.name = entry["name"].value_or(std::string());
    criterion.measure = entry["measure"].value_or(std::string());
    criterion.limit = entry["limit"].value_or(std::nan(""));
    if (criterion.name.empty() || !std::isfinite(criterion.limit) || entry.size() != 3) {
      problem(entry, "case.criteria", criterion.name, "needs exactly name, measure and limit",
              "complete the entry");
    } else if (std::ranges::find(measures, criterion.measure) == measures.end()) {
      problem(entry, "case.criteria.measure", criterion.measure, "unknown measure",
              "the nearest one is " + nearest_word(criterion.measure, measures));
    }
    target_.criteria.push_back(std::move(criterion));
  }

  void read_run(const toml::table& entry, const RunKind& kind) {
    CaseRun run;
    run.kind = kind.name;
    run.verb = kind.verb;
    run.place = place(entry);
    for (const auto& [key, node] : entry) read_entry_of(run, kind, std::string(key.str()), node);
    const auto problem_of = [&](const std::string& name, const std::string& value,
                                const std::string& rule, const std::string& remedy) {
      problem(entry, "case." + run.kind + "." + name, value, rule, remedy);
    };
    bool twice = false, known = run.beside.empty();
    for (const CaseRun& other : target_.runs) {
      if (!other.is(run.kind)) continue;
      twice |= other.name == run.name && other.series == run.series;
      if (full_name(other) != run.beside) continue;
      known = true;
      if (run.is("run")) run.continuum = other.verb == "reference";
    }
    if (run.name.empty() || twice)
      problem_of("name", run.name, "must be given, once in a series", "name every " + run.kind);
    if (!known)
      problem_of("beside", run.beside, "must be a press above", "name it \"series, name\"");
    if (kind.verb.empty() && std::ranges::find(run_verbs(), run.verb) == run_verbs().end())
      problem_of("verb", run.verb, "must say what is run",
                 "use one of " + fmt::format("{}", fmt::join(run_verbs(), ", ")));
    if (run.verb == "displacements" && run.displacements.empty())
      problem_of("displacements", "", "must name the file that is fitted", "give it");
    if (!run.law.empty() && !calibration::law_named(run.law))
      problem_of("law", run.law, "must be a law of calibration.laws", "name one of those fitted");
    if (!run.when.empty() && run.when != "coarser" && run.when != "another")
      problem_of("when", run.when, "must be coarser or another",
                 "leave it out for a run that is always made");
    target_.runs.push_back(std::move(run));
  }

  void read_entry_of(CaseRun& run, const RunKind& kind, const std::string& name,
                     const toml::node& node) {
    const std::string key = "case." + kind.name + "." + name;
    const bool common = name == "name" || name == "series";
    const bool own = kind.entries.contains(name);
    if ((own || common) && run_texts().contains(name)) {
      run.*run_texts().at(name) = text(node, key);
      if (name == "displacements") run.displacements = located(run.displacements);
    } else if (own && run_flags().contains(name)) {
      const std::optional<bool> value = node.value_exact<bool>();
      if (!value)
        problem(node, key, toml_literal(node), "must be of another type",
                "use " + name + " = true");
      run.*run_flags().at(name) = value.value_or(false);
    } else if (name == "x" && node.is_number() &&
               std::isfinite(node.value<double>().value_or(NAN))) {
      run.x = *node.value<double>();
    } else if (name == "set" && node.is_table()) {
      read_settings(*node.as_table(), run);
    } else if (own && name == "times" && node.is_table()) {
      read_factors(*node.as_table(), run);
    } else {
      std::string others;
      for (const std::string& other : kind.entries) others += ", " + other;
      problem(node, key, toml_literal(node), "no such entry of a " + kind.name,
              "use name, series (texts), x (a number), set = { \"section.key\" = value }" + others);
    }
  }

  void read_settings(const toml::table& settings, CaseRun& run) {
    for (const auto& [key, value] : settings) {
      const std::string name(key.str());
      const Key* known = find_key(name);
      if (value.is_table() && (known == nullptr || known->kind != Kind::fields)) {
        problem(value, "case.variant.set", name, "must be a full key and its value",
                "put the key in quotes: \"" + name + ".key\" = value");
      } else if (is_derived(name, run.kind)) {
        problem(
            value, name, toml_literal(value),
            "a variant is a static press, with a program a quasi-static one, measured against the "
            "continuum of its kinematics, a press is measured against the transient one",
            "leave it out, or set lattice.kinematics");
      } else {
        run.sets.push_back(setting(name, value, file_.parent_path()));
      }
    }
  }

  void read_factors(const toml::table& factors, CaseRun& run) {
    for (const auto& [key, value] : factors) {
      const std::string name(key.str());
      const Key* known = find_key(name);
      const double factor = value.is_number() ? value.value<double>().value_or(NAN) : NAN;
      if (known == nullptr || known->kind != Kind::number || !std::isfinite(factor))
        problem(value, "case.run.times", name, "must be the key of a number and a factor",
                "use times = { \"section.key\" = 10.0 }");
      else
        run.times[name] = factor;
    }
  }

  void read_table(const toml::table& entry) {
    CaseTable table{entry["file"].value_or(std::string()), entry["series"].value_or(std::string()),
                    texts(entry, "columns")};
    const bool plain = table.file.ends_with(".csv") && as_folder(table.file) == table.file;
    const auto shown = [&](const CaseRun& run) {
      return run.is_verdict() && run.series == table.series;
    };
    if (!plain || entry.size() != 3 || table.columns.empty() ||
        std::ranges::none_of(target_.runs, shown))
      problem(entry, "case.table", table.file,
              "needs exactly file, a name that ends with .csv, series, one of presses above, and "
              "columns",
              "complete the entry");
    for (const std::string& column : table.columns) {
      const std::vector<std::string> columns = table_columns();
      if (std::ranges::find(columns, column) == columns.end())
        problem(entry, "case.table.columns", column, "unknown column",
                "the nearest one is " + nearest_word(column, columns));
    }
    target_.tables.push_back(std::move(table));
  }

  void read_budget(const toml::table& entry) {
    const std::size_t problems = problems_.size();
    CaseBudget budget{entry["name"].value_or(std::string()), texts(entry, "parts")};
    if (budget.name.empty() || budget.parts.empty() || entry.size() != 2)
      problem(entry, "case.budget", budget.name, "needs exactly name and parts, a list of series",
              "complete the entry");
    for (const std::string& part : budget.parts) {
      if (soft_variants(blank_results(target_), part).size() >= 2) continue;
      problem(entry, "case.budget.parts", part,
              "must be a series above with a variant at x = 1 and another one at x > 1",
              "add the variants");
    }
    if (problems_.size() == problems) target_.budgets.push_back(std::move(budget));
  }

  fs::path file_;
  Case& target_;
  bool is_core_ = false;
  std::vector<meshes::Violation> problems_;
};

std::string quoted(const std::string& text) {
  return toml_literal(toml::value<std::string>(text));
}

std::string number(double value) {
  return toml_literal(toml::value<double>(value));
}

std::string texts_toml(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + quoted(text);
  return "[" + list + "]";
}

std::string run_toml(const CaseRun& run) {
  const RunKind& kind = *std::ranges::find(run_kinds(), run.kind, &RunKind::name);
  std::string text = fmt::format("\n[[case.{}]]\n", run.kind);
  for (const auto& [name, member] : run_texts()) {
    const bool own = name == "name" || name == "series" || kind.entries.contains(name);
    if (own && !(run.*member).empty()) text += name + " = " + quoted(run.*member) + "\n";
  }
  for (const auto& [name, member] : run_flags())
    if (run.*member && kind.entries.contains(name)) text += name + " = true\n";
  if (std::isfinite(run.x)) text += "x = " + number(run.x) + "\n";
  std::string settings, factors;
  for (const std::string& setting : run.sets) {
    const auto equals = setting.find('=');
    settings += fmt::format("{}{} = {}", settings.empty() ? "" : ", ",
                            quoted(setting.substr(0, equals)), setting.substr(equals + 1));
  }
  for (const auto& [key, factor] : run.times)
    factors += (factors.empty() ? "" : ", ") + quoted(key) + " = " + number(factor);
  if (!factors.empty()) text += "times = { " + factors + " }\n";
  return text + "set = { " + settings + " }\n";
}

}  // namespace

std::vector<meshes::Violation> read_case_table(const fs::path& file, Case& target) {
  return CaseReader(file, target).read();
}

std::string case_toml(const Case& study_case) {
  std::string text = fmt::format("\n[case]\ntitle = {}\ndescription = {}\n",
                                 quoted(study_case.title), quoted(study_case.description));
  if (!study_case.abscissa.empty()) text += "x = " + quoted(study_case.abscissa) + "\n";
  if (const CaseData& data = study_case.data; !data.variable.empty())
    text += fmt::format("\n[case.data]\nfolder = {}\nsource = {}\n", quoted(data.variable),
                        quoted(data.source));
  if (!study_case.takes_core_runs) {
    for (const CaseRun& run : study_case.runs) text += run_toml(run);
    for (const CaseTable& table : study_case.tables)
      text += fmt::format("\n[[case.table]]\nfile = {}\nseries = {}\ncolumns = {}\n",
                          quoted(table.file), quoted(table.series), texts_toml(table.columns));
  }
  for (const CaseBudget& budget : study_case.budgets)
    text += fmt::format("\n[[case.budget]]\nname = {}\nparts = {}\n", quoted(budget.name),
                        texts_toml(budget.parts));
  for (const CaseCriterion& criterion : study_case.criteria) {
    text += fmt::format("\n[[case.criteria]]\nname = {}\nmeasure = {}\nlimit = {}\n",
                        quoted(criterion.name), quoted(criterion.measure), number(criterion.limit));
  }
  return text;
}

}  // namespace fingertip::studies::inline cases
