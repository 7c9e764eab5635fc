#include "calibration/material_tests/law_card.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ostream>
#include <set>

#include "calibration/files/toml_file.h"
#include "calibration/files/words.h"
#include "calibration/material/material.h"
#include "meshes/base/files.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::VectorXd;
using meshes::InvalidInput;
using meshes::to_text;
using meshes::Violation;

namespace {

VectorXd estimates_of(const LawCard& card) {
  VectorXd values(Eigen::Index(card.coefficients.size()));
  for (std::size_t i = 0; i < card.coefficients.size(); ++i)
    values(Eigen::Index(i)) = card.coefficients[i].value;
  return values;
}

std::string toml_quantity(double value, std::string_view unit) {
  return unit == "1" ? to_text(value) : toml_text(to_text(value) + " " + std::string(unit));
}

/// What else bounds the tests, where it is known.
struct Range {
  std::string_view first, last, unit;
  std::optional<std::array<double, 2>> LawCard::*range;
};
constexpr Range ranges[] = {{"slowest_rate", "fastest_rate", "1/s", &LawCard::rates},
                            {"shortest_time", "longest_time", "s", &LawCard::times}};

/// The texts of [about] but the last ones; one that may be missing is left out where it is empty.
struct AboutText {
  std::string_view key;
  std::string LawCard::*text;
  bool required = false;
};
constexpr AboutText about_texts[] = {
    {"material", &LawCard::material}, {"source", &LawCard::source},
    {"licence", &LawCard::licence},   {"provenance", &LawCard::provenance, true},
    {"program", &LawCard::program},   {"date", &LawCard::date},
    {"rejected", &LawCard::rejected}};

std::string lines_of(std::string_view key, const CardValue& number, std::string_view unit) {
  std::string text = std::string(key) + " = " + toml_quantity(number.value, unit) + '\n';
  if (std::isfinite(number.lower) && std::isfinite(number.upper))
    text += std::string(key) + "_interval = [" + toml_quantity(number.lower, unit) + ", " +
            toml_quantity(number.upper, unit) + "]\n";
  return text;
}

std::string list_text(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += (text.empty() ? "\n  " : ",\n  ") + toml_text(sentence);
  return "[" + text + (text.empty() ? "]" : "\n]");
}

std::string card_toml(const LawCard& card) {
  const SizedLaw law = card.law();
  const double g = law.shear_modulus;
  const double k = card.bulk_modulus ? card.bulk_modulus->value : 0.0;
  std::string text =
      "# A law of rubber from material tests, SI. Use: rubber.card = \"<path of this file>\"\n"
      "\n[law]\nname = " +
      toml_text(name(card.choice)) + '\n';
  const auto names = coefficients(card.choice);
  for (std::size_t i = 0; i < names.size(); ++i)
    text += lines_of(name(names[i]), card.coefficients[i], unit(names[i]));
  if (card.bulk_modulus) text += lines_of("bulk_modulus", *card.bulk_modulus, "Pa");
  text +=
      "\n[rubber]  # at small strain, of the coefficients, after long times\nyoungs_modulus = " +
      toml_quantity(card.bulk_modulus ? 9.0 * k * g / (3.0 * k + g) : 3.0 * g, "Pa") +
      "\nshear_modulus = " + toml_quantity(g, "Pa") + '\n';
  text += "\n[validity]\nsmallest_stretch = " + to_text(card.tested[0]) +
          "\nlargest_stretch = " + to_text(card.tested[1]) + '\n';
  for (const Range& each : ranges)
    if (const auto& range = card.*each.range)
      text += std::string(each.first) + " = " + toml_quantity((*range)[0], each.unit) + '\n' +
              std::string(each.last) + " = " + toml_quantity((*range)[1], each.unit) + '\n';
  for (const CardTest& test : card.tests)
    text +=
        "\n[[test]]\nname = " + toml_text(test.name) + "\nkind = " + toml_text(name(test.kind)) +
        (test.course == TestCourse::slow ? "" : "\ncourse = " + toml_text(name(test.course))) +
        "\nuse = " + toml_text(test.fitted ? "fit" : "predict") +
        "\npoints = " + std::to_string(test.points) +
        "\nrms_error = " + to_text(test.rms_relative) +
        "  # over the root mean square stress\nlargest_error = " + to_text(test.largest_relative) +
        "  # over the largest stress\n";
  text += "\n[about]\n";
  for (const AboutText& each : about_texts)
    if (each.required || !(card.*each.text).empty())
      text += std::string(each.key) + " = " + toml_text(card.*each.text) + '\n';
  text += "contradictions = " + list_text(card.contradictions) + '\n';
  // Last, so that a file cut short is noticed.
  return text + "statement = " + toml_text(card.statement) + '\n';
}

class CardReader : TomlFile {
 public:
  explicit CardReader(std::filesystem::path file)
      : TomlFile(std::move(file), "run calibrate with calibration.problem = \"material\" again") {}

  LawCard read() {
    if (!table().contains("law"))
      fail(1, "law", "",
           table().contains("lattice") ? "the file holds constants of a lattice, no law of rubber"
                                       : "the section is missing",
           "take a material.toml of calibration.problem = \"material\"; constants of a lattice go "
           "into lattice.constants");
    LawCard card;
    const std::string law = text("law", "name");
    const auto choice = law_named(law);
    if (!choice) {
      std::string names;
      for (const LawChoice& known : known_laws())
        names += (names.empty() ? "" : ", ") + name(known);
      fail(line("law", "name"), "law.name", law, "must be one of " + names, "give one of them");
    }
    card.choice = *choice;
    for (const MaterialParameter parameter : coefficients(card.choice))
      card.coefficients.push_back(value_at(name(parameter), unit(parameter)));
    if (find("law", "bulk_modulus") != nullptr) card.bulk_modulus = value_at("bulk_modulus", "Pa");
    card.tested = {bare_number("validity", "smallest_stretch"),
                   bare_number("validity", "largest_stretch")};
    for (const Range& each : ranges)
      if (find("validity", each.first) != nullptr)
        card.*each.range = {number("validity", each.first, each.unit),
                            number("validity", each.last, each.unit)};
    read_tests(card);
    read_about(card);
    refuse_unknown_keys();
    std::vector<Violation> broken = card.violations();
    for (Violation& violation : broken) violation.key = file().string() + ": " + violation.key;
    if (!broken.empty()) throw InvalidInput(broken);
    return card;
  }

 private:
  double value_in(const toml::node& node, std::string_view key, std::string_view unit) const {
    if (unit == "1") {
      if (const auto value = node.value<double>(); value && std::isfinite(*value)) return *value;
    } else if (const auto written = node.value_exact<std::string>()) {
      return number_in(*written, unit, "law", key);
    }
    fail(int(node.source().begin.line), dotted("law", key), "",
         unit == "1" ? "must be a finite number" : "must be a text with the unit Pa",
         "write for instance \"1.5 Pa\"");
  }

  CardValue value_at(std::string_view key, std::string_view unit) {
    const std::string interval = std::string(key) + "_interval";
    known_.insert(std::string(key));
    known_.insert(interval);
    const double nan = std::nan("");
    CardValue value{value_in(node("law", key), key, unit), nan, nan};
    const toml::node* ends = find("law", interval);
    if (ends == nullptr) return value;
    const toml::array* list = ends->as_array();
    if (list == nullptr || list->size() != 2)
      fail(line("law", interval), dotted("law", interval), "", "must be a list of two values",
           "give the ends of the 95 % interval");
    value.lower = value_in(*list->get(0), interval, unit);
    value.upper = value_in(*list->get(1), interval, unit);
    return value;
  }

  void read_tests(LawCard& card) const {
    const toml::array* list = table()["test"].as_array();
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const toml::table* one = list->get(i)->as_table();
      CardTest test;
      bool complete = one != nullptr && one->size() == (one->contains("course") ? 7 : 6);
      if (complete) {
        const auto word = [&](const char* key) { return (*one)[key].value_or(std::string()); };
        const std::string use = word("use");
        const auto kind = meshes::enumerator<TestKind>(word("kind"));
        const auto course = meshes::enumerator<TestCourse>(word("course"));
        const auto points = (*one)["points"].value<std::int64_t>();
        const auto rms = (*one)["rms_error"].value<double>(),
                   largest = (*one)["largest_error"].value<double>();
        test.course = course.value_or(TestCourse::slow);
        complete = one->contains("course") == (test.course != TestCourse::slow) &&
                   (*one)["name"].is_string() && kind && points && *points > 0 && rms && largest &&
                   (use == "fit" || use == "predict");
        if (complete)
          test = {word("name"), *kind,    use == "fit", std::size_t(*points),
                  *rms,         *largest, test.course};
      }
      if (!complete)
        fail(
            int(list->get(i)->source().begin.line), "test", "",
            "a test has name, kind, use (fit or predict), points, rms_error and largest_error, and "
            "in time a course (relaxation or cycles)",
            "run calibrate again");
      card.tests.push_back(test);
    }
  }

  void read_about(LawCard& card) const {
    for (const AboutText& each : about_texts)
      if (each.required || find("about", each.key) != nullptr)
        card.*each.text = text("about", each.key);
    const toml::array* list = node("about", "contradictions").as_array();
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
      if (const auto sentence = list->get(i)->value_exact<std::string>())
        card.contradictions.push_back(*sentence);
    if (list == nullptr || list->size() != card.contradictions.size())
      fail(line("about", "contradictions"), "about.contradictions", "", "must be a list of texts",
           "run calibrate again");
    card.statement = text("about", "statement");
  }

  void refuse_unknown_keys() const {
    std::set<std::string> known = {"law.name",
                                   "rubber.youngs_modulus",
                                   "rubber.shear_modulus",
                                   "validity.smallest_stretch",
                                   "validity.largest_stretch",
                                   "about.contradictions",
                                   "about.statement"};
    for (const std::string& key : known_) known.insert(dotted("law", key));
    for (const AboutText& each : about_texts) known.insert(dotted("about", each.key));
    for (const Range& each : ranges)
      known.insert({dotted("validity", each.first), dotted("validity", each.last)});
    for (const auto& [section, content] : table()) {
      if (section.str() == "test") continue;
      if (!content.is_table())
        fail(int(content.source().begin.line), std::string(section.str()), "", "no such key",
             "remove it");
      for (const auto& [key, value] : *content.as_table())
        if (const std::string full = dotted(section.str(), key.str()); !known.contains(full))
          fail(int(value.source().begin.line), full, "", "no such key", "remove it");
    }
  }

  std::set<std::string> known_;  ///< of [law], besides the name
};

}  // namespace

SizedLaw LawCard::law() const {
  return sized_law(choice, estimates_of(*this));
}

meshes::Relaxation LawCard::relaxation() const {
  return relaxation_of(choice, estimates_of(*this));
}

std::vector<Violation> LawCard::violations() const {
  std::vector<Violation> found;
  const auto refuse = [&](const char* key, const std::string& value, const char* rule,
                          const char* remedy) {
    found.push_back({key, value, rule, remedy});
  };
  if (coefficients.size() != calibration::coefficients(choice).size()) {
    refuse("law", std::to_string(coefficients.size()) + " coefficients",
           "must be as many as the law has", "run calibrate again");
    return found;
  }
  for (const CardValue& number : coefficients)
    if (!std::isfinite(number.value))
      refuse("law", to_text(number.value), "coefficients must be finite", "run calibrate again");
  if (!found.empty()) return found;
  try {
    const SizedLaw sized = law();
    for (std::size_t i = 1; choice.law == meshes::RubberLaw::ogden && i < coefficients.size();
         i += 2)
      if (coefficients[i].value == 0.0)
        refuse("law.ogden_alpha1", "0", "exponents must not be 0", "give another exponent");
    if (choice.law == meshes::RubberLaw::gent && !(sized.energy.shape[0] > 0.0))
      refuse("law.gent_jm", to_text(sized.energy.shape[0]), "Jm must be positive", "correct it");
  } catch (const InvalidInput& error) {
    refuse("law", name(choice), "the coefficients must make a positive shear modulus",
           "correct them");
  }
  for (const Violation& broken : relaxation().violations())
    refuse("law.relaxation_g1", broken.value, broken.rule.c_str(),
           "correct the shares and times of [law]");
  if (bulk_modulus && !(bulk_modulus->value > 0.0 && std::isfinite(bulk_modulus->value)))
    refuse("law.bulk_modulus", to_text(bulk_modulus->value), "must be positive", "leave it out");
  if (!(tested[0] > 0.0 && tested[0] <= 1.0 && tested[1] >= 1.0 && std::isfinite(tested[1])))
    refuse("validity.smallest_stretch", to_text(tested[0]) + " to " + to_text(tested[1]),
           "the range of stretch holds 1, the rubber at rest", "correct it");
  if (rates && !((*rates)[0] > 0.0 && (*rates)[0] <= (*rates)[1] && std::isfinite((*rates)[1])))
    refuse("validity.slowest_rate", to_text((*rates)[0]), "rates are positive and in order",
           "correct them");
  if (times.has_value() != (choice.branches > 0) ||
      (times && !((*times)[0] > 0.0 && (*times)[0] <= (*times)[1] && std::isfinite((*times)[1]))))
    refuse("validity.shortest_time", times ? to_text((*times)[0]) + " s" : "none",
           "a law that relaxes has its range of times, positive and in order", "correct them");
  return found;
}

LawCard card_of(const LawFit& fit, const std::vector<MaterialTest>& tests,
                const std::vector<MaterialTest>& validation) {
  LawCard card;
  card.choice = fit.choice;
  const Eigen::Index own = Eigen::Index(coefficients(fit.choice).size());
  const auto value = [&](Eigen::Index i) {
    return CardValue{fit.fit.estimates(i), fit.fit.lower(i), fit.fit.upper(i)};
  };
  for (Eigen::Index i = 0; i < own; ++i) card.coefficients.push_back(value(i));
  if (fit.bulk_modulus) card.bulk_modulus = value(own);
  card.tested = fit.tested;
  if (fit.choice.branches > 0) card.times = fit.times;
  const auto add = [&](const std::vector<MaterialTest>& from,
                       const std::vector<TestMisfit>& misfits, bool fitted) {
    for (std::size_t i = 0; i < misfits.size(); ++i) {
      card.tests.push_back({from[i].name, from[i].kind, fitted, misfits[i].points,
                            misfits[i].rms_relative, misfits[i].largest_relative, from[i].course});
      if (!fitted) continue;
      card.provenance += (card.provenance.empty() ? "" : "; ") + from[i].source;
      if (const auto& rate = from[i].rate; rate && !card.rates)
        card.rates = {*rate, *rate};
      else if (rate)
        card.rates = {std::min((*card.rates)[0], *rate), std::max((*card.rates)[1], *rate)};
      card.licence = from[i].licence;
    }
  };
  add(tests, fit.fitted, true);
  add(validation, fit.predicted, false);
  card.contradictions = fit.contradictions;
  card.rejected = in_one(fit.failed);
  if (!fit.bulk_modulus)
    card.contradictions.push_back(
        "no test tells the bulk modulus: a press takes its own Poisson's ratio");
  card.statement = (card.rejected.empty() ? "The law " : "Not accepted: the law ") +
                   name(fit.choice) + " met " + std::to_string(fit.fitted.size()) +
                   " test(s) between the principal stretches " + rounded(fit.tested[0]) + " and " +
                   rounded(fit.tested[1]) + "; " +
                   (card.contradictions.empty() ? "nothing seen contradicts it."
                                                : "what contradicts it stands in contradictions.");
  return card;
}

void write_law_card(const LawCard& card, const std::filesystem::path& file) {
  const std::vector<Violation> broken = card.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  write_toml(card_toml(card), card.rejected, file);
}

LawCard read_law_card(const std::filesystem::path& file) {
  return CardReader(file).read();
}

std::vector<std::string> warnings(const LawCard& card,
                                  const std::optional<std::array<double, 2>>& used) {
  std::vector<std::string> found;
  if (!card.rejected.empty()) found.push_back(std::string(failed_its_tests) + card.rejected);
  if (used && ((*used)[0] < 0.999 * card.tested[0] || (*used)[1] > 1.001 * card.tested[1]))
    found.push_back("principal stretches from " + rounded((*used)[0]) + " to " +
                    rounded((*used)[1]) + " are asked for, and the law was fitted between " +
                    rounded(card.tested[0]) + " and " + rounded(card.tested[1]) +
                    ": beyond, it is a guess");
  std::ranges::copy_if(card.contradictions, std::back_inserter(found), [&](const auto& sentence) {
    return card.rejected.find(sentence) == std::string::npos;
  });
  return found;
}

}  // namespace fingertip::calibration::inline material_tests
