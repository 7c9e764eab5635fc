#include "studies/config/value_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "meshes/base/files.h"
#include "studies/config/text/named_folder.h"
#include "studies/config/text/trimmed.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config {

namespace {

[[noreturn]] void refuse(std::string rule, std::string remedy) {
  throw UnitError(std::move(rule), std::move(remedy));
}

/// The default, or where that is a word in place of a value, a value.
std::string preset_advice(const Key& key) {
  std::string literal = key.preset;
  if (literal == "\"auto\"" && key.kind == Kind::quantity) literal = '"' + key.example() + '"';
  if (literal == "\"auto\"" && key.kind == Kind::number)
    literal = meshes::to_text(std::isfinite(key.range.minimum + key.range.maximum)
                                  ? 0.5 * (std::max(0.0, key.range.minimum) + key.range.maximum)
                                  : std::max(1.0, key.range.minimum));
  return "write e.g. " + key.name + " = " + literal;
}

/// The number that somebody has put into quotes, or given a unit; else an example.
std::string number_advice(const Key& key, const toml::node& node) {
  const std::string text(trimmed(node.value_or(std::string())));
  double number = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !key.range.contains(number)) return preset_advice(key);
  return "write " + key.name + " = " + std::string(text.data(), rest);
}

void check_range(const Key& key, double value) {
  if (!std::isfinite(value)) refuse("must be a finite number", preset_advice(key));
  if (!key.range.contains(value)) refuse("must be " + key.allowed(), "choose a value in range");
}

/// Of a node that is a number. Throws for an integer that no double holds.
double number_in(const toml::node& node) {
  const std::optional<double> number = node.value<double>();
  if (!number) refuse("must lie within +-2^53", "choose a number of plausible size");
  return *number;
}

/// "tip_radius/12" against the pattern "tip_radius/N": the number N.
double read_fraction(const Key& key, const std::string& text) {
  const std::string prefix = key.pattern.substr(0, key.pattern.find('N'));
  double divisor = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix.size(), end, divisor);
  if (error != std::errc() || rest != end || !std::isfinite(divisor) || !(divisor > 0.0)) {
    refuse("must be a length, \"auto\" or " + key.pattern + " with a number N > 0",
           preset_advice(key));
  }
  return divisor;
}

Value read_quantity(const Key& key, const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) {
    if (!node.is_number()) refuse("must be a text with number and unit", preset_advice(key));
    const double number = number_in(node);
    if (!std::isfinite(number)) refuse("must be a finite number with a unit", preset_advice(key));
    refuse("the unit is missing", "write it as \"" + key.example() + "\"");
  }
  Value value;
  const std::string prefix = key.pattern.substr(0, key.pattern.find('N'));
  if (!prefix.empty() && text->get().starts_with(prefix)) {
    value.word = key.pattern;
    value.number = read_fraction(key, text->get());
    return value;
  }
  value.number = parse_quantity(text->get(), key.unit, key.example());
  check_range(key, value.number);
  return value;
}

Value read_quantities(const Key& key, const toml::node& node) {
  const auto* list = node.as_array();
  if (list == nullptr)
    refuse("must be a list of quantities" + (key.word.empty() ? "" : ", or \"" + key.word + '"'),
           "write e.g. [\"" + key.example() + "\"]");
  if (key.length > 0 && list->size() != key.length)
    refuse("must be a list of " + std::to_string(key.length) + " quantities", preset_advice(key));
  Value value;
  Key each = key;
  each.word.clear();
  for (const toml::node& element : *list) {
    value.numbers.push_back(read_quantity(each, element).number);
  }
  return value;
}

Value read_number(const Key& key, const toml::node& node);

Value read_terms(const Key& key, const toml::node& node) {
  const bool first = key.number_first;
  const std::string quantity = '"' + key.example() + '"',
                    advice =
                        "write e.g. [[" + (first ? "0.2, " + quantity : quantity + ", 1.3") + "]]",
                    rule = std::string("must be a list of pairs of ") +
                           (first ? "a number and a quantity" : "a quantity and a number");
  const auto* list = node.as_array();
  if (list == nullptr) refuse(rule, advice);
  Value value;
  for (const toml::node& element : *list) {
    const auto* pair = element.as_array();
    if (pair == nullptr || pair->size() != 2) refuse(rule, advice);
    for (const bool number : {first, !first}) {
      const toml::node& part = pair->at(number == first ? 0 : 1);
      if (part.is_number() != number) refuse(rule, advice);
      value.numbers.push_back((number ? read_number(key, part) : read_quantity(key, part)).number);
    }
  }
  return value;
}

constexpr const char* stage_advice =
    "write e.g. [[\"0.3 cm\", \"1 cm/s\"], [\"hold\", \"2 s\"], "
    "[\"twist\", \"5 deg\", \"10 deg/s\"], [\"0 cm\", \"1 cm/s\"]]";

/// One of a program; `reached` is the one before it.
meshes::PressStage read_stage(const toml::node& node, const meshes::PressStage& reached) {
  const auto* list = node.as_array();
  std::vector<std::string> texts;
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
    texts.push_back(list->at(i).value<std::string>().value_or(""));
  const auto move = texts.empty() ? std::nullopt : meshes::enumerator<meshes::StageMove>(texts[0]);
  const bool along_plane = move && *move != meshes::StageMove::press;
  if (texts.size() != (along_plane ? 3U : 2U) ||
      std::ranges::any_of(texts, [](const std::string& text) { return text.empty(); }))
    refuse(
        "must be a list of texts, [indentation, speed], [\"hold\", duration], [\"lateral\", "
        "displacement, speed] or [\"twist\", angle, speed]",
        stage_advice);
  meshes::PressStage stage = reached;
  stage.move = move.value_or(meshes::StageMove::press);
  stage.speed = stage.hold = 0.0;
  if (texts[0] == "hold") {
    stage.hold = parse_quantity(texts[1], "s", "2 s");
    if (!(stage.hold > 0.0)) refuse("a hold must take a time above 0", "drop the stage");
    return stage;
  }
  const bool twist = stage.move == meshes::StageMove::twist;
  if (twist)
    stage.twist = parse_quantity(texts[1], "rad", "5 deg");
  else
    (along_plane ? stage.lateral : stage.indentation) =
        parse_quantity(texts[along_plane ? 1 : 0], "m", "0.3 cm");
  stage.speed =
      parse_quantity(texts.back(), twist ? "rad/s" : "m/s", twist ? "10 deg/s" : "1 cm/s");
  if (!(stage.speed > 0.0))
    refuse("the speed of a move must be positive", "what is below the last one moves back");
  return stage;
}

Value read_stages(const toml::node& node) {
  const auto* list = node.as_array();
  if (list == nullptr) refuse("must be a list of stages", stage_advice);
  Value value;
  meshes::PressStage reached;
  for (std::size_t i = 0; i < list->size(); ++i) {
    try {
      reached = read_stage(list->at(i), reached);
      value.numbers.insert(value.numbers.end(),
                           {reached.indentation, reached.speed, reached.hold, double(reached.move),
                            reached.lateral, reached.twist});
    } catch (const UnitError& error) {
      refuse("stage " + std::to_string(i + 1) + ": " + error.rule, error.remedy);
    }
  }
  return value;
}

Value read_number(const Key& key, const toml::node& node) {
  if (!node.is_number())
    refuse("must be a number without quotes or unit" +
               (key.word.empty() ? "" : ", or \"" + key.word + '"') +
               (key.rule.empty() ? "" : " (" + key.rule + ')'),
           number_advice(key, node));
  Value value;
  value.number = number_in(node);
  check_range(key, value.number);
  return value;
}

Value read_numbers(const Key& key, const toml::node& node) {
  const std::size_t length = key.kind == Kind::number_pair ? 2 : 3;
  const auto* list = node.as_array();
  if (list == nullptr || list->size() != length)
    refuse("must be a list of " + std::to_string(length) + " numbers", preset_advice(key));
  Value value;
  for (const toml::node& element : *list) value.numbers.push_back(read_number(key, element).number);
  if (key.kind == Kind::number_pair && !(value.numbers[0] < value.numbers[1]))
    refuse("the first number must be the smaller one", preset_advice(key));
  return value;
}

Value read_text(const Key& key, const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) refuse("must be a text", preset_advice(key));
  Value value;
  value.word = text->get();
  return value;
}

Value read_texts(const Key& key, const toml::node& node) {
  const auto* list = node.as_array();
  const std::string advice = "write e.g. " + key.name + " = [\"one\", \"another\"]";
  if (list == nullptr) refuse("must be a list of texts", advice);
  Value value;
  for (const toml::node& element : *list) {
    const auto* text = element.as_string();
    if (text == nullptr || text->get().empty()) refuse("must be a list of texts", advice);
    value.words.push_back(text->get());
  }
  return value;
}

bool is_choice(const Key& key, const std::string& word) {
  return std::ranges::any_of(key.choices,
                             [&](const Choice& choice) { return choice.word == word; });
}

std::string likely_word(const Key& key, const std::string& word) {
  std::vector<std::string> words;
  for (const Choice& choice : key.choices) words.push_back(choice.word);
  return "did you mean \"" + nearest_word(word, words) + "\"?";
}

Value read_word(const Key& key, const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) refuse("must be one of " + key.allowed(), preset_advice(key));
  const std::string& word = text->get();
  if (!is_choice(key, word) && (key.kind == Kind::choice || word.empty()))
    refuse("must be one of " + key.allowed(), likely_word(key, word));
  Value value;
  value.word = word;
  return value;
}

/// The whole number of a field without unit.
double read_count(const Field& field, const toml::node& node) {
  const auto count = node.value_exact<std::int64_t>();
  if (!count || *count < 1 || *count > 10000)
    refuse(field.name + " must be a whole number from 1 to 10000",
           "write e.g. " + field.name + " = " + field.example);
  return double(*count);
}

/// "fit", "0.1 mm/N", or with its standard deviation "0.1 +- 0.02 mm/N": 1 for fit, value,
/// deviation.
std::array<double, 3> read_field(const Field& field, const toml::node& node) {
  const std::string advice = "write \"fit\", or e.g. \"" + field.example +
                             "\", with a standard deviation \"" +
                             field.example.substr(0, field.example.find(' ')) + " +- 0.02" +
                             field.example.substr(field.example.find(' ')) + '"';
  const auto text = node.value_exact<std::string>();
  if (!text) refuse(field.name + " must be a text", advice);
  if (*text == "fit") return {1.0, 0.0, 0.0};
  try {
    const auto sign = text->find("+-");
    if (sign == text->npos) return {0.0, parse_quantity(*text, field.unit, field.example), 0.0};
    const std::string after = text->substr(sign + 2);
    const double deviation = parse_quantity(after, field.unit, field.example);
    // Both numbers have the unit that stands at the end.
    const auto unit = after.find_first_not_of(" 0123456789.eE+-");
    const auto gap = after.find_last_of("0123456789. ", unit);
    const double mean = parse_quantity(text->substr(0, sign) + " " + after.substr(gap + 1),
                                       field.unit, field.example);
    if (!(deviation > 0.0)) refuse(field.name + ": a standard deviation is positive", advice);
    return {1.0, mean, deviation};
  } catch (const UnitError& error) {
    refuse(error.rule.starts_with(field.name) ? error.rule : field.name + ": " + error.rule,
           advice);
  }
}

Value read_fields(const Key& key, const toml::node& node) {
  const Field& first = key.fields.front();
  std::vector<std::string> names;
  for (const Field& field : key.fields) names.push_back(field.name);
  const auto* table = node.as_table();
  if (key.or_file && !node.is_table()) return read_word(key, node);
  if (table == nullptr)
    refuse("must be a table", "write e.g. {" + first.name + " = " + first.literal() + "}");
  if (key.or_file && table->empty())
    refuse("the table must name something",
           "write e.g. {" + first.name + " = " + first.literal() + "}");
  Value value;
  for (const auto& [name, entry] : *table) {
    const auto field = std::ranges::find(key.fields, name.str(), &Field::name);
    if (field == key.fields.end())
      refuse("knows no " + std::string(name.str()),
             "did you mean " + nearest_word(std::string(name.str()), names) + "?");
    if (field->unit.empty()) {
      const auto* file = entry.as_string();
      if (file == nullptr || file->get().empty())
        refuse(field->name + " must be the path of a file", "write e.g. \"" + field->example + '"');
      value.word = file->get();
      continue;
    }
    const auto numbers = field->unit == "1"
                             ? std::array<double, 3>{0.0, read_count(*field, entry), 0.0}
                             : read_field(*field, entry);
    value.words.push_back(field->name);
    value.numbers.insert(value.numbers.end(), numbers.begin(), numbers.end());
  }
  return value;
}

Value read_value(const Key& key, const toml::node& node) {
  if (!key.word.empty() && node.value<std::string>() == key.word) {
    Value value;
    value.word = key.word;
    return value;
  }
  switch (key.kind) {
    case Kind::quantity: return read_quantity(key, node);
    case Kind::quantities: return read_quantities(key, node);
    case Kind::terms: return read_terms(key, node);
    case Kind::stages: return read_stages(node);
    case Kind::fields: return read_fields(key, node);
    case Kind::integer:
      if (!node.is_integer()) refuse("must be an integer", preset_advice(key));
      [[fallthrough]];
    case Kind::number: return read_number(key, node);
    case Kind::numbers:
    case Kind::number_pair: return read_numbers(key, node);
    case Kind::choice:
    case Kind::source: return read_word(key, node);
    case Kind::text:
    case Kind::file: return read_text(key, node);
    case Kind::texts:
    case Kind::files: return read_texts(key, node);
    case Kind::boolean: break;
  }
  if (!node.is_boolean()) refuse("must be true or false", preset_advice(key));
  Value value;
  value.number = *node.value<bool>() ? 1.0 : 0.0;
  return value;
}

}  // namespace

Reading read(const Key& key, const toml::node& node, const std::filesystem::path& base) {
  Reading reading{read_value(key, node), toml_literal(node)};
  Value& value = reading.value;
  const auto locate = [&](std::string& file) {
    const auto found = located(file, base);
    if (!found)
      refuse("no environment variable " + variable_in(file) + " is set",
             "set it to the folder of the data");
    file = std::filesystem::absolute(*found).lexically_normal().string();
  };
  if (key.kind == Kind::files) {
    toml::array files;
    for (std::string& file : value.words) locate(file), files.push_back(file);
    reading.literal = toml_literal(files);
  } else if (key.kind == Kind::fields && node.is_table() && !value.word.empty()) {
    locate(value.word);
    toml::table whole = *node.as_table();
    for (const Field& field : key.fields)
      if (field.unit.empty()) whole.insert_or_assign(field.name, value.word);
    reading.literal = toml_literal(whole);
  } else if (key.kind == Kind::source || key.kind == Kind::file ||
             (key.kind == Kind::fields && node.is_string())) {
    if (!value.word.empty() && !is_choice(key, value.word)) {
      const std::string word = value.word;
      locate(value.word);
      // One word without an extension is rather a slip than a file.
      if (!key.choices.empty() && word.find_first_of("./") == word.npos &&
          !std::filesystem::exists(value.word))
        refuse("must be one of " + key.allowed() + ", and there is no file " + value.word,
               likely_word(key, word) + " Else name a file that is there");
    }
    reading.literal = toml_literal(toml::value<std::string>(value.word));
  }
  return reading;
}

std::string default_literal(const Key& key) {
  return toml_literal(*parsed_literal(key.preset).get("v"));
}

}  // namespace fingertip::studies::inline config
