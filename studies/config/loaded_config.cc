#include "studies/config/loaded_config.h"

#include "studies/config/keys/key_table.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline config {

namespace {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + to_string(problem);
  return text;
}

/// A list of many values fills a screen.
std::string shortened(const std::string& text) {
  constexpr std::size_t most = 120;
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

}  // namespace

std::string to_string(const Problem& problem) {
  std::string text = problem.place + ": ";
  if (!problem.key.empty()) {
    text += problem.key + (problem.value.empty() ? "" : " = " + problem.value) + ": ";
  }
  return text + problem.rule + "; " + problem.remedy;
}

ConfigError::ConfigError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

ConfigError LoadedConfig::locate(const std::vector<meshes::Violation>& violations) const {
  std::vector<Problem> problems;
  for (const meshes::Violation& violation : violations) {
    Problem problem{"", violation.key, violation.value, violation.rule, violation.remedy};
    const auto entry = entries.find(violation.key);
    if (entry != entries.end()) {
      problem.place = entry->second.place;
      problem.value = unquoted(entry->second.literal);
    }
    // The culprit may be a key that the rule also depends on; certainly when this one is a default.
    const Key* key = find_key(violation.key);
    for (const std::string& other : key != nullptr ? key->related : std::vector<std::string>{}) {
      const Entry& related = entries.at(other);
      if (!related.given) continue;
      problem.rule += " (here " + other + " = " + shortened(unquoted(related.literal)) + ", " +
                      shortened(related.place) + ")";
      if (problem.place.starts_with(default_place)) problem.place = related.place;
    }
    if (problem.place.empty()) problem.place = "input";
    problems.push_back(std::move(problem));
  }
  return ConfigError(std::move(problems));
}

ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy) {
  return loaded.locate({{key, value, rule, remedy}});
}

}  // namespace fingertip::studies::inline config
