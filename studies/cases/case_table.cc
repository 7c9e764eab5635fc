#include "studies/cases/case_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "calibration/toml_depth.h"
#include "studies/cases/control_measures.h"
#include "studies/cases/fit_measures.h"
#include "studies/cases/grasp_measures.h"
#include "studies/cases/measures.h"
#include "studies/cases/variant_measures.h"
#include "studies/config/key_table.h"
#include "studies/config/units.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// The file as TOML; empty when it is none (load_config reports).
toml::table parsed(const fs::path& file) {
  try {
    std::ostringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    if (calibration::nests_too_deep(content.str())) return {};
    return toml::parse(content.str(), file.string());
  } catch (const toml::parse_error&) {
    return {};
  }
}

/// Keys that follow from what a variant is: a press in equilibrium, measured against the continuum
/// of its own kinematics.
const std::set<std::string>& derived_keys() {
  static const std::set<std::string> keys = {"press.mode", "reference.strain", "reference.law",
                                             "reference.mode"};
  return keys;
}

/// "key=literal". A file that a value names is relative to the folder of the case.
std::string setting(const std::string& key, const toml::node& value, const fs::path& base) {
  const std::string literal = toml_literal(value);
  const Key* known = find_key(key);
  if (known == nullptr) return key + "=" + literal;
  try {
    Value read = read_value(*known, value);
    locate_files(*known, base, read);
    return key + "=" + located_literal(*known, read, literal);
  } catch (const UnitError&) {
    return key + "=" + literal;  // told when the variant is loaded
  }
}

/// Reads [case], collecting problems with their line.
class CaseReader {
 public:
  CaseReader(const fs::path& file, Case& target) : file_(file), target_(target) {}

  std::vector<Problem> read() {
    // By reference: a copy of a TOML node forgets its line.
    const toml::table root = parsed(file_);
    const auto* found = root["case"].as_table();
    if (found == nullptr) return {};
    const toml::table& table = *found;
    for (const auto& [key, node] : table) read_entry(std::string(key.str()), node);
    // Budgets and criteria speak of variants.
    each(table, "variant", &CaseReader::read_variant);
    each(table, "fit", &CaseReader::read_fit);
    each(table, "prediction", &CaseReader::read_prediction);
    each(table, "press", &CaseReader::read_press);
    each(table, "grasp", &CaseReader::read_grasp);
    each(table, "budget", &CaseReader::read_budget);
    each(table, "criteria", &CaseReader::read_criterion);
    return problems_;
  }

 private:
  void read_entry(const std::string& name, const toml::node& node) {
    static const std::set<std::string> lists = {"variant", "budget", "fit",     "prediction",
                                                "press",   "grasp",  "criteria"};
    const bool list = lists.contains(name);
    if (name == "title") {
      target_.title = text(node, "case.title");
    } else if (name == "description") {
      target_.description = text(node, "case.description");
    } else if (name == "x") {
      target_.abscissa = text(node, "case.x");
    } else if (!list || !node.is_array_of_tables()) {
      problem(node, "case." + name, "", "unknown entry of [case]",
              "use title, description, x, [[case.variant]], [[case.budget]], [[case.fit]], "
              "[[case.prediction]], [[case.press]], [[case.grasp]] and [[case.criteria]] with "
              "name, measure, limit");
    }
  }

  void each(const toml::table& table, const char* name,
            void (CaseReader::*reader)(const toml::table&)) {
    const auto* list = table[name].as_array();
    if (list == nullptr || !list->is_array_of_tables()) return;
    for (const toml::node& entry : *list) (this->*reader)(*entry.as_table());
  }

  void problem(const toml::node& node, const std::string& key, const std::string& value,
               const std::string& rule, const std::string& remedy) {
    problems_.push_back({place(node), key, value, rule, remedy});
  }

  std::string place(const toml::node& node) const {
    return file_.string() + ":" + std::to_string(node.source().begin.line);
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
    criterion.limit = entry["limit"].value_or(std::nan(""));
    const std::vector<std::string> measures = measures_of_case();
    if (criterion.name.empty() || !std::isfinite(criterion.limit) || entry.size() != 3) {
      problem(entry, "case.criteria", criterion.name, "needs exactly name, measure and limit",
              "complete the entry");
    } else if (std::ranges::find(measures, criterion.measure) == measures.end()) {
      problem(entry, "case.criteria.measure", criterion.measure, "unknown measure",
              "the nearest one is " + nearest_word(criterion.measure, measures));
    }
    target_.criteria.push_back(std::move(criterion));
  }

  std::vector<std::string> measures_of_case() const {
    if (!target_.fits.empty()) return fit_measure_names(target_);
    if (!target_.presses.empty()) return control_measure_names(target_);
    if (!target_.grasps.empty()) return grasp_measure_names(target_);
    return target_.variants.empty() ? measure_names() : variant_measure_names(target_);
  }

  void read_press(const toml::table& entry) {
    CasePress press;
    toml::table common = entry;
    const auto take = [&](const char* name, auto& value) {
      using Value = std::remove_reference_t<decltype(value)>;
      const toml::node* node = entry.get(name);
      if (node == nullptr) return;
      common.erase(name);
      if (const auto found = node->value_exact<Value>()) {
        value = *found;
      } else {
        problem(*node, fmt::format("case.press.{}", name), toml_literal(*node),
                "must be of another type", "use continuum and snapshots = true, beside = \"NAME\"");
      }
    };
    take("continuum", press.continuum);
    take("snapshots", press.snapshots);
    take("beside", press.beside);
    std::vector<CaseVariant> before(target_.presses.begin(), target_.presses.end());
    const bool known =
        press.beside.empty() || std::ranges::find(before, press.beside, full_name) != before.end();
    if (!known)
      problem(entry, "case.press.beside", press.beside, "must be a press above",
              "name it \"series, name\"");
    read_run(common, "press", before);
    static_cast<CaseVariant&>(press) = std::move(before.back());
    target_.presses.push_back(std::move(press));
  }

  void read_variant(const toml::table& entry) { read_run(entry, "variant", target_.variants); }
  void read_grasp(const toml::table& entry) { read_run(entry, "grasp", target_.grasps); }
  void read_fit(const toml::table& entry) { read_run(entry, "fit", target_.fits); }
  void read_prediction(const toml::table& entry) {
    read_run(entry, "prediction", target_.predictions);
  }

  void read_run(const toml::table& entry, const std::string& kind, std::vector<CaseVariant>& runs) {
    CaseVariant variant;
    variant.place = place(entry);
    for (const auto& [key, node] : entry) {
      const std::string name(key.str());
      if (name == "name" || name == "series") {
        (name == "name" ? variant.name : variant.series) = text(node, "case." + kind + "." + name);
      } else if (name == "x" && node.is_number() &&
                 std::isfinite(node.value<double>().value_or(NAN))) {
        variant.x = *node.value<double>();
      } else if (name == "set" && node.is_table()) {
        read_settings(*node.as_table(), kind, variant);
      } else {
        problem(node, "case." + kind + "." + name, toml_literal(node), "no such entry of a " + kind,
                "use name, series (texts), x (a number) and set = { \"section.key\" = value }");
      }
    }
    const bool twice = std::ranges::any_of(runs, [&](const CaseVariant& other) {
      return other.name == variant.name && other.series == variant.series;
    });
    if (variant.name.empty() || twice)
      problem(entry, "case." + kind + ".name", variant.name, "must be given, once in a series",
              "name every " + kind);
    runs.push_back(std::move(variant));
  }

  void read_settings(const toml::table& settings, const std::string& kind, CaseVariant& variant) {
    for (const auto& [key, value] : settings) {
      const std::string name(key.str());
      if (value.is_table()) {
        problem(value, "case.variant.set", name, "must be a full key and its value",
                "put the key in quotes: \"" + name + ".key\" = value");
      } else if (derived_keys().contains(name) && !(kind == "press" && name == "press.mode")) {
        problem(value, name, toml_literal(value),
                "a variant is a static press, measured against the continuum of its kinematics, a "
                "press is measured against the transient one",
                "leave it out, or set lattice.kinematics");
      } else {
        variant.sets.push_back(setting(name, value, file_.parent_path()));
      }
    }
  }

  void read_budget(const toml::table& entry) {
    CaseBudget budget;
    budget.name = entry["name"].value_or(std::string());
    if (const auto* parts = entry["parts"].as_array())
      for (const toml::node& part : *parts) budget.parts.push_back(part.value_or(std::string()));
    if (budget.name.empty() || budget.parts.empty() || entry.size() != 2)
      problem(entry, "case.budget", budget.name, "needs exactly name and parts, a list of series",
              "complete the entry");
    for (const std::string& part : budget.parts) {
      if (soft_variants(target_, part).size() >= 2) continue;
      problem(entry, "case.budget.parts", part,
              "must be a series above with a variant at x = 1 and another one at x > 1",
              "add the variants");
    }
    target_.budgets.push_back(std::move(budget));
  }

  fs::path file_;
  Case& target_;
  std::vector<Problem> problems_;
};

std::string quoted(const std::string& text) {
  return toml_literal(toml::value<std::string>(text));
}

std::string number(double value) {
  return toml_literal(toml::value<double>(value));
}

std::string run_toml(const char* kind, const CaseVariant& variant) {
  std::string text = fmt::format("\n[[case.{}]]\nname = ", kind) + quoted(variant.name) + "\n";
  if (!variant.series.empty()) text += "series = " + quoted(variant.series) + "\n";
  if (std::isfinite(variant.x)) text += "x = " + number(variant.x) + "\n";
  std::string settings;
  for (const std::string& one : variant.sets) {
    const auto equals = one.find('=');
    settings += fmt::format("{}{} = {}", settings.empty() ? "" : ", ",
                            quoted(one.substr(0, equals)), one.substr(equals + 1));
  }
  return text + "set = { " + settings + " }\n";
}

}  // namespace

std::vector<Problem> read_case_table(const fs::path& file, Case& target) {
  return CaseReader(file, target).read();
}

std::string case_toml(const Case& one) {
  std::string text = fmt::format("\n[case]\ntitle = {}\ndescription = {}\n", quoted(one.title),
                                 quoted(one.description));
  if (!one.abscissa.empty()) text += "x = " + quoted(one.abscissa) + "\n";
  for (const CaseVariant& variant : one.variants) text += run_toml("variant", variant);
  for (const CaseVariant& fit : one.fits) text += run_toml("fit", fit);
  for (const CaseVariant& prediction : one.predictions) text += run_toml("prediction", prediction);
  for (const CasePress& press : one.presses) {
    text += run_toml("press", press);
    if (press.continuum) text += "continuum = true\n";
    if (press.snapshots) text += "snapshots = true\n";
    if (!press.beside.empty()) text += "beside = " + quoted(press.beside) + "\n";
  }
  for (const CaseVariant& grasp : one.grasps) text += run_toml("grasp", grasp);
  for (const CaseBudget& budget : one.budgets) {
    std::string parts;
    for (const std::string& part : budget.parts)
      parts += (parts.empty() ? "" : ", ") + quoted(part);
    text += fmt::format("\n[[case.budget]]\nname = {}\nparts = [{}]\n", quoted(budget.name), parts);
  }
  for (const CaseCriterion& criterion : one.criteria) {
    text += fmt::format("\n[[case.criteria]]\nname = {}\nmeasure = {}\nlimit = {}\n",
                        quoted(criterion.name), quoted(criterion.measure), number(criterion.limit));
  }
  return text;
}

}  // namespace fingertip::studies
