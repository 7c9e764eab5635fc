#include "studies/config/loaded_config.h"

#include "studies/config/keys/key_table.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline config {

namespace {

/// A list of many values fills a screen.
std::string shortened(const std::string& text) {
  constexpr std::size_t most = 120;
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

}  // namespace

ConfigError LoadedConfig::locate(const std::vector<meshes::Violation>& violations) const {
  std::vector<meshes::Violation> problems = violations;
  for (meshes::Violation& problem : problems) {
    if (!problem.place.empty()) continue;
    const auto entry = entries.find(problem.key);
    if (entry != entries.end()) {
      problem.place = entry->second.place;
      problem.value = unquoted(entry->second.literal);
    }
    // The culprit may be a key that the rule also depends on; certainly when this one is a default.
    const Key* key = find_key(problem.key);
    for (const std::string& other : key != nullptr ? key->related : std::vector<std::string>{}) {
      const Entry& related = entries.at(other);
      if (!related.given) continue;
      problem.rule += " (here " + other + " = " + shortened(unquoted(related.literal)) + ", " +
                      shortened(related.place) + ")";
      if (problem.place.starts_with(default_place)) problem.place = related.place;
    }
    if (problem.place.empty()) problem.place = "input";
  }
  return ConfigError(std::move(problems));
}

ConfigError refused_file(const LoadedConfig& loaded, const std::string& key,
                         const meshes::InvalidInput& error) {
  std::vector<meshes::Violation> broken;
  for (const meshes::Violation& violation : error.violations())
    broken.push_back({key, "", without_remedy(violation), violation.remedy});
  return loaded.locate(broken);
}

ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy) {
  return loaded.locate({{key, value, rule, remedy}});
}

}  // namespace fingertip::studies::inline config
