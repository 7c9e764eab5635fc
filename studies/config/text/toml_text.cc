#include "studies/config/text/toml_text.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calibration/files/toml_depth.h"
#include "calibration/files/toml_file.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::studies::inline config::inline text {

toml::table parsed_file(const std::filesystem::path& file) {
  try {
    return calibration::parsed_toml(file, "");
  } catch (const meshes::InvalidInput&) {
    return {};
  }
}

toml::table parsed_literal(const std::string& text) {
  try {
    if (!calibration::nests_too_deep(text)) {
      toml::table parsed = toml::parse("v = " + text);
      // A text with line breaks could smuggle in further keys.
      if (parsed.size() == 1) return parsed;
    }
  } catch (const toml::parse_error&) {
    // No literal.
  }
  return {};
}

std::string toml_literal(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    // JSON's escapes are a subset of those of TOML's basic strings.
    return nlohmann::json(text->get())
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  if (const auto* number = node.as_floating_point()) {
    const double value = number->get();
    if (std::isnan(value)) return "nan";
    const std::string text = meshes::to_text(value);
    return text.find_first_of(".ein") == text.npos ? text + ".0" : text;
  }
  if (const auto* list = node.as_array()) {
    std::string text;
    for (const toml::node& element : *list) {
      text += (text.empty() ? "" : ", ") + toml_literal(element);
    }
    return "[" + text + "]";
  }
  if (const auto* table = node.as_table()) {
    std::string text;
    for (const auto& [name, entry] : *table)
      text += (text.empty() ? "" : ", ") + toml_literal(toml::value<std::string>(name.str())) +
              " = " + toml_literal(entry);
    return "{" + text + "}";
  }
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  // What no key takes, for the message that refuses it.
  std::ostringstream text;
  node.visit([&text](const auto& value) {
    if constexpr (!toml::is_table<decltype(value)>) text << value;
  });
  return text.str();
}

std::string unquoted(const std::string& literal) {
  const bool quoted = literal.size() >= 2 && (literal.front() == '"' || literal.front() == '\'') &&
                      literal.front() == literal.back();
  return quoted ? literal.substr(1, literal.size() - 2) : literal;
}

}  // namespace fingertip::studies::inline config::inline text
