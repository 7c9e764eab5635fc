#include "studies/config/documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meshes/base/files.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config {

namespace {

/// "Pa; > 0 Pa; greater than youngs_modulus/3": unit, range and rule in one line.
std::string constraints(const Key& key) {
  std::string text = key.description();
  if (key.kind == Kind::quantities && !key.word.empty()) text += " or \"" + key.word + '"';
  for (const Field& field : key.fields)
    text += (&field == &key.fields.front() ? " of " : ", ") + field.name + " [" +
            (field.unit.empty() ? "path" : field.unit) + "]";
  if (!key.unit.empty()) text += " in units of " + key.unit;
  if (!key.allowed().empty()) text += "; " + key.allowed();
  if (!key.rule.empty()) text += "; " + key.rule;
  if (!key.matters_with.empty())
    text += fmt::format("; with {} = {}", key.matters_with, fmt::join(key.matters_words, " | "));
  return text;
}

nlohmann::json element_schema(const Key& key) {
  using nlohmann::json;
  constexpr double endless = std::numeric_limits<double>::infinity();
  json schema;
  switch (key.kind) {
    case Kind::quantity:
    case Kind::quantities: {
      std::string pattern = R"(^\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*[^0-9\s].*$)";
      if (key.word == "auto") pattern = "^auto$|" + pattern;
      if (!key.pattern.empty()) pattern = "^tip_radius/[0-9.]+$|" + pattern;
      schema = {{"type", "string"}, {"pattern", pattern}};
      break;
    }
    case Kind::boolean: return {{"type", "boolean"}};
    case Kind::fields:
      schema = {{"type", "object"}, {"additionalProperties", false}};
      for (const Field& field : key.fields)
        schema["properties"][field.name] = {
            {"type", field.unit == "1" ? "integer" : "string"},
            {"description", field.help + (field.unit.empty() ? "" : " [" + field.unit + "]")}};
      if (!key.or_file) return schema;
      schema["minProperties"] = 1;
      return {{"anyOf", {schema, {{"type", "string"}, {"minLength", 1}}}}};
    case Kind::choice:
      schema["enum"] = json::array();
      for (const Choice& choice : key.choices) schema["enum"].push_back(choice.word);
      break;
    case Kind::text:
    case Kind::file: schema = {{"type", "string"}}; break;
    case Kind::source:
    case Kind::texts:
    case Kind::files: schema = {{"type", "string"}, {"minLength", 1}}; break;
    case Kind::terms: return {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}};
    case Kind::stages:
      return {{"type", "array"},
              {"minItems", 2},
              {"maxItems", 3},
              {"items", {{"type", "string"}, {"minLength", 1}}}};
    case Kind::integer: schema["type"] = "integer"; break;
    case Kind::number:
    case Kind::number_pair:
    case Kind::numbers: schema["type"] = "number"; break;
  }
  if (key.kind == Kind::number && !key.word.empty()) schema["type"] = {"number", "string"};
  if (key.unit.empty() && key.range.minimum > -endless) {
    schema[key.range.minimum_allowed ? "minimum" : "exclusiveMinimum"] = key.range.minimum;
  }
  if (key.unit.empty() && key.range.maximum < endless) schema["maximum"] = key.range.maximum;
  return schema;
}

nlohmann::json key_schema(const Key& key) {
  nlohmann::json schema = element_schema(key);
  const bool list = key.takes_list();
  if (list) schema = {{"type", "array"}, {"items", schema}};
  const std::size_t length = key.kind == Kind::numbers       ? 3
                             : key.kind == Kind::number_pair ? 2
                                                             : key.length;
  if (length > 0) schema["minItems"] = schema["maxItems"] = length;
  if (list && !key.word.empty()) schema = {{"anyOf", {schema, {{"const", key.word}}}}};
  schema["description"] = key.help + " (" + constraints(key) + ")";
  // The defaults are TOML literals of the kind that JSON shares.
  schema["default"] = nlohmann::json::parse(key.preset);
  return schema;
}

/// The SI value behind a literal, for a comment; empty when it would repeat the literal.
std::string si_comment(const Key& key, const std::string& literal) {
  if (key.kind != Kind::quantity) return {};
  try {
    const std::string text = literal.substr(1, literal.size() - 2);
    const double value = parse_quantity(text, key.unit, key.example());
    return meshes::to_text(value) + " " + key.unit;
  } catch (const UnitError&) {
    return {};  // a word such as auto
  }
}

template <typename WriteKey>
std::string by_section(const WriteKey& write_key) {
  std::string text;
  for (const Section& section : sections()) {
    text += fmt::format("\n[{}]  # {}\n", section.name, section.help);
    for (const Key& key : key_table()) {
      if (key.section == section.name) text += write_key(key);
    }
  }
  return text;
}

}  // namespace

std::string config_template() {
  std::string text =
      "# Configuration of fingertip. Every key is shown with its default; delete what you do not\n"
      "# change. Quantities are texts with any unit of the right dimension (gf is gram-force).\n"
      "# `fingertip explain section.key` tells more, `fingertip check FILE` checks this file.\n";
  text += by_section([](const Key& key) {
    return fmt::format("# {}\n#   ({})\n{} = {}\n", key.help, constraints(key), key.name,
                       key.preset);
  });
  return text;
}

std::string explanation(const Key& key) {
  std::string text =
      fmt::format("{}\n  {}\n  kind:    {}{}\n", key.full_name(), key.help, key.description(),
                  key.unit.empty() ? "" : " (any unit of the dimension of " + key.unit + ")");
  if (key.choices.empty() && !key.allowed().empty()) {
    text += fmt::format("  allowed: {}\n", key.allowed());
  }
  for (const Choice& choice : key.choices) {
    text += fmt::format("  {:<18} {}\n", choice.word, choice.meaning);
  }
  for (const Field& field : key.fields)
    text += fmt::format("  {:<18} {}, e.g. {}\n", field.name, field.help, field.literal());
  if (key.kind == Kind::source) text += fmt::format("  {:<18} {}\n", "PATH", "a file");
  if (!key.rule.empty()) text += fmt::format("  rule:    {}\n", key.rule);
  if (!key.matters_with.empty())
    text += fmt::format("  matters: with {} = {}\n", key.matters_with,
                        fmt::join(key.matters_words, " | "));
  const std::string si = si_comment(key, key.preset);
  text += fmt::format("  default: {}{}\n", key.preset, si.empty() ? "" : " = " + si);
  text += fmt::format("  set it:  --set {}={}\n", key.full_name(), key.preset);
  return text;
}

std::string key_overview() {
  std::size_t width = 0;
  for (const Key& key : key_table()) width = std::max(width, key.full_name().size());
  return by_section([&](const Key& key) {
           return fmt::format("  {:<{}} {:<18} {}\n", key.full_name(), width, key.preset, key.help);
         })
      .substr(1);
}

std::string json_schema() {
  using nlohmann::ordered_json;
  ordered_json properties;
  for (const Section& section : sections()) {
    ordered_json keys = ordered_json::object();
    for (const Key& key : key_table()) {
      if (key.section == section.name) keys[key.name] = key_schema(key);
    }
    properties[section.name] = {{"type", "object"},
                                {"description", section.help},
                                {"additionalProperties", false},
                                {"properties", keys}};
  }
  properties["case"] = {{"type", "object"},
                        {"description", "title, description, criteria and variants of a case"}};
  properties["sweep"] = {{"type", "object"},
                         {"description",
                          "verb, and a list of values per key in tables [sweep.section]: see "
                          "`fingertip sweep --help`"}};
  const ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                               {"title", "Configuration of fingertip"},
                               {"type", "object"},
                               {"additionalProperties", false},
                               {"properties", properties}};
  return schema.dump(2) + "\n";
}

std::string markdown_reference() {
  const auto escaped = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != text.npos; at += 2) text.insert(at, "\\");
    return text;
  };
  std::string text =
      "# Configuration keys\n\nGenerated by `fingertip explain --markdown`. Quantities are texts "
      "with a unit.\n";
  for (const Section& section : sections()) {
    text += fmt::format(
        "\n## [{}]\n\n{}.\n\n| key | default | meaning | allowed |\n|---|---|---|---|\n",
        section.name, section.help);
    for (const Key& key : key_table()) {
      if (key.section != section.name) continue;
      text += fmt::format("| `{}` | `{}` | {} | {} |\n", key.name, key.preset, escaped(key.help),
                          escaped(constraints(key)));
    }
  }
  return text;
}

std::string parameters_toml(const LoadedConfig& loaded, const std::string& head) {
  std::string text = "# " + head + "\n";
  text += by_section([&](const Key& key) {
    const Entry& entry = loaded.entries.at(key.full_name());
    const std::string si = si_comment(key, entry.literal);
    std::string place = entry.place;
    std::replace(place.begin(), place.end(), '\n', ' ');
    return fmt::format("{} = {}  # {}{}\n", key.name, entry.literal, si.empty() ? "" : si + ", ",
                       place);
  });
  return text;
}

}  // namespace fingertip::studies::inline config
