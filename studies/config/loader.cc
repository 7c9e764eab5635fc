#include "studies/config/loader.h"

#include <Eigen/Geometry>
#include <algorithm>

#include <toml++/toml.h>

#include "calibration/files/toml_depth.h"
#include "calibration/files/toml_file.h"
#include "meshes/base/files.h"
#include "studies/config/elasticity.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/law_card_keys.h"
#include "studies/config/press_depths.h"
#include "studies/config/shapes/profile_file.h"
#include "studies/config/text/trimmed.h"
#include "studies/config/text/units.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline config {

namespace {

/// Collects values and problems from all sources.
class Reader {
 public:
  /// Begins with the defaults, which are read once.
  Reader() {
    static const Reader defaults(key_table());
    loaded_ = defaults.loaded_;
    loaded_.material = std::make_shared<std::optional<calibration::Material>>();
  }

  void read_file(const std::filesystem::path& file);
  void read_set(const std::string& text);
  /// One assignment outside of a file. `place` is how the user wrote it.
  void read_assignment(const std::string& place, const std::string& name, const std::string& value);

  LoadedConfig finish();

 private:
  explicit Reader(const std::vector<Key>& keys) {
    for (const Key& key : keys)
      take(key, *parsed_literal(key.preset).get("v"), default_place, false, {});
  }
  void resolve_shape();
  void resolve_sensors();
  void resolve_card();
  void check_continuum_law();
  /// Files named by a value are relative to `base`: the configuration file's folder.
  void take(const Key& key, const toml::node& node, const std::string& place, bool given,
            const std::filesystem::path& base);
  void read_section(const std::string& section, const toml::node& node,
                    const std::filesystem::path& file);
  void unknown(const std::string& place, const std::string& name, const std::string& value) {
    problems_.push_back(
        {name, value, "unknown key", "the nearest valid key is " + nearest_key(name), place});
  }

  LoadedConfig loaded_;
  std::vector<meshes::Violation> problems_;
};

void Reader::take(const Key& key, const toml::node& node, const std::string& place, bool given,
                  const std::filesystem::path& base) {
  const std::string name = key.full_name();
  Entry& entry = loaded_.entries[name] = {{}, place, given};
  try {
    Reading reading = read(key, node, base);
    entry.literal = std::move(reading.literal);
    key.assign(loaded_.config, reading.value);
  } catch (const UnitError& error) {
    entry.literal = toml_literal(node);
    problems_.push_back({name, unquoted(entry.literal), error.rule, error.remedy, place});
  }
}

void Reader::read_section(const std::string& section, const toml::node& node,
                          const std::filesystem::path& file) {
  const auto place = [&](const toml::node& at) {
    return file.string() + ":" + std::to_string(at.source().begin.line);
  };
  const bool known = std::ranges::any_of(
      sections(), [&](const Section& candidate) { return candidate.name == section; });
  const auto* table = node.as_table();
  if (!known || table == nullptr) {
    std::vector<std::string> names;
    for (const Section& candidate : sections()) names.push_back(candidate.name);
    problems_.push_back({section, "", known ? "must be a section" : "unknown section",
                         "the nearest valid section is [" + nearest_word(section, names) + "]",
                         place(node)});
    return;
  }
  for (const auto& [name, value] : *table) {
    const std::string full_name = section + "." + std::string(name.str());
    if (const Key* key = find_key(full_name)) {
      take(*key, value, place(value), true, file.parent_path());
    } else {
      unknown(place(value), full_name, unquoted(toml_literal(value)));
    }
  }
}

void Reader::read_file(const std::filesystem::path& file) {
  try {
    const toml::table root =
        calibration::parsed_toml(file, "compare with the template that fingertip init writes");
    for (const auto& [section, node] : root) {
      // [case] and [sweep] are read by those who know them.
      if (section.str() != "case" && section.str() != "sweep")
        read_section(std::string(section.str()), node, file);
    }
  } catch (const meshes::InvalidInput& error) {
    append(problems_, error.violations());
  }
}

void Reader::read_set(const std::string& text) {
  const std::string place = "--set " + text;
  const auto equals = text.find('=');
  const std::string name(trimmed(std::string_view(text).substr(0, equals)));
  if (equals == text.npos) {
    problems_.push_back({name, "", "must have the form section.key=value",
                         "write e.g. --set press.depth=\"0.2 cm\"", place});
    return;
  }
  read_assignment(place, name, std::string(trimmed(std::string_view(text).substr(equals + 1))));
}

void Reader::read_assignment(const std::string& place, const std::string& name,
                             const std::string& value) {
  toml::table parsed = parsed_literal(value);
  if (parsed.empty()) parsed = toml::table{{"v", value}};
  if (const Key* key = find_key(name)) {
    take(*key, *parsed.get("v"), place, true, {});
  } else {
    unknown(place, name, value);
  }
}

/// What was set and does nothing under the other settings.
std::vector<std::string> inert_keys(const LoadedConfig& loaded) {
  std::vector<std::string> notes;
  for (const Key& key : key_table()) {
    const Entry& entry = loaded.entries.at(key.full_name());
    if (key.matters_with.empty() || !entry.given || entry.literal == default_literal(key)) continue;
    const std::string word = unquoted(loaded.entries.at(key.matters_with).literal);
    if (std::ranges::find(key.matters_words, word) != key.matters_words.end()) continue;
    notes.push_back(key.full_name() + " = " + unquoted(entry.literal) + " has no effect while " +
                    key.matters_with + " = " + word);
  }
  return notes;
}

/// The finger of geometry.shape.
void Reader::resolve_shape() {
  Config& config = loaded_.config;
  if (config.shape == ShapeKind::dome) return;
  const bool profile = config.shape == ShapeKind::profile;
  const std::string key = profile ? "geometry.profile" : "geometry.file";
  const std::filesystem::path& file = profile ? config.profile : config.solid.file;
  if (file.empty()) {
    problems_.push_back({key, "none",
                         profile ? "a profile needs the file of its meridian"
                                 : "a solid needs the file of its surface",
                         "write e.g. " + key + " = \"finger." + (profile ? "csv" : "stl") + '"',
                         loaded_.entries.at("geometry.shape").place});
    return;
  }
  try {
    if (profile && is_solid_file(file))
      throw meshes::InvalidInput({key, file.filename().string(),
                                  "a profile is the meridian of a body of revolution, a CSV file",
                                  "write geometry.shape = \"solid\" and geometry.file"});
    config.press.geometry =
        profile ? meshes::Geometry::of_profile(read_profile(file), config.endpoint)
                : meshes::Geometry::of_solid(read_solid(config.solid), config.endpoint);
  } catch (const meshes::InvalidInput& error) {
    for (const meshes::Violation& broken : error.violations()) {
      // Else a line of the file.
      const auto entry = loaded_.entries.find(broken.key);
      std::string place = broken.place.empty() ? broken.key : broken.place;
      if (entry != loaded_.entries.end())
        place =
            loaded_.entries.at(entry->second.given ? broken.key : key).place + ", " + file.string();
      problems_.push_back({"", "", (broken.value.empty() ? "" : broken.value + ": ") + broken.rule,
                           broken.remedy, place});
    }
  }
}

/// Skin and markers of the finger.
void Reader::resolve_sensors() {
  Config& config = loaded_.config;
  lattice::PressSetup& press = config.press;
  const auto lay = [&](const std::string& key, const auto& sensors) {
    try {
      sensors();
    } catch (const meshes::InvalidInput& error) {
      // Else their file cannot be read.
      const bool of_sensors = error.violations().front().key.starts_with("sensor.");
      append(problems_,
             (of_sensors ? loaded_.locate(error.violations()) : refused_file(loaded_, key, error))
                 .violations());
    }
  };
  lay("sensor.taxels", [&] {
    if (config.taxels.has_skin()) lay_taxels(config.taxels, press.geometry, press.hardware.skin);
  });
  lay("sensor.markers",
      [&] { press.protocol.markers = lay_markers(config.markers, press.geometry); });
}

/// What the card says takes the place of defaults.
void Reader::resolve_card() {
  const Config& config = loaded_.config;
  if (config.card.empty()) return;
  try {
    const calibration::LawCard card = calibration::read_law_card(config.card);
    for (const auto& [name, literal] : keys_of(card)) {
      const Entry& known = loaded_.entries.at(name);
      // The rubber of the card after long times.
      if (known.given && name == "rubber.relaxation" && known.literal == "[]") continue;
      if (!known.given) {
        read_assignment(config.card.string(), name, literal);
      } else if (known.literal != toml_literal(*parsed_literal(literal).get("v"))) {
        problems_.push_back({name, unquoted(known.literal),
                             "the card " + config.card.filename().string() + " says " + literal,
                             "leave one of the two out", known.place});
      }
    }
    for (const std::string& warning : card_warnings(card, loaded_))
      loaded_.notes.push_back(config.card.filename().string() + ": " + warning);
  } catch (const meshes::InvalidInput& error) {
    append(problems_, refused_file(loaded_, "rubber.card", error).violations());
  }
}

/// The older key changes what a change of volume costs in the continuum alone.
void Reader::check_continuum_law() {
  const Config& config = loaded_.config;
  if (config.continuum_law == ContinuumLaw::a ||
      config.press.rubber.energy == meshes::StrainEnergy())
    return;
  const Entry& entry = loaded_.entries.at("reference.law");
  problems_.push_back({"reference.law", unquoted(entry.literal),
                       "means a neo-Hookean rubber with volumetric = logarithmic",
                       "leave it out and give rubber.law and rubber.volumetric", entry.place});
}

LoadedConfig Reader::finish() {
  Config& config = loaded_.config;
  lattice::PressSetup& press = config.press;
  resolve_shape();
  resolve_card();
  resolve_elasticity(loaded_, problems_);
  if (config.spacing_divisor) {
    press.lattice.spacing = press.geometry.tip_radius / *config.spacing_divisor;
  }
  if (!config.rotation.empty()) {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    press.lattice.axes = (AngleAxisd(config.rotation[2], Vector3d::UnitZ()) *
                          AngleAxisd(config.rotation[1], Vector3d::UnitY()) *
                          AngleAxisd(config.rotation[0], Vector3d::UnitX()))
                             .toRotationMatrix();
  }
  press.lattice.kinematics = config.kinematics.value_or(default_kinematics(press.lattice.model));
  const meshes::PressProtocol& protocol = press.protocol;
  choose_for_finger(loaded_);
  resolve_depths(loaded_, problems_);
  check_continuum_law();

  std::vector<meshes::Violation> broken = press.rubber.violations();
  // Without its file the finger is still the dome: rules about it mean nothing.
  if (config.shape == ShapeKind::dome || !press.geometry.is_dome()) {
    append(broken, press.geometry.violations());
    append(broken, protocol.violations(press.geometry));
    if (broken.empty()) resolve_sensors();
    append(broken, press.hardware.skin.violations());
  }
  const ConfigError located = loaded_.locate(broken);
  for (const meshes::Violation& problem : located.violations()) {
    // A value that could not be read still holds its default: rules about it mean nothing.
    const bool unread = std::ranges::any_of(problems_, [&](const meshes::Violation& earlier) {
      const Key* key = find_key(problem.key);
      return earlier.key == problem.key ||
             (key != nullptr && std::ranges::find(key->related, earlier.key) != key->related.end());
    });
    if (!unread) problems_.push_back(problem);
  }
  if (!problems_.empty()) throw ConfigError(problems_);
  choose_automatic_spacing(loaded_);
  choose_limits(loaded_);
  const std::vector<std::string> inert = inert_keys(loaded_);
  loaded_.notes.insert(loaded_.notes.end(), inert.begin(), inert.end());
  return std::move(loaded_);
}

}  // namespace

LoadedConfig with_sets(const LoadedConfig& loaded, const std::vector<std::string>& further_sets) {
  ConfigSource source;
  for (const auto& [name, entry] : loaded.entries) {
    if (entry.given) source.sets.push_back(name + "=" + entry.literal);
  }
  source.sets.insert(source.sets.end(), further_sets.begin(), further_sets.end());
  return load_config(source);
}

LoadedConfig load_config(const ConfigSource& source) {
  Reader reader;
  if (!source.file.empty()) reader.read_file(source.file);
  for (const std::string& text : source.sets) reader.read_set(text);
  if (source.threads) {
    reader.read_assignment("--threads " + *source.threads, "run.threads", *source.threads);
  }
  return reader.finish();
}

}  // namespace fingertip::studies::inline config
