#include "studies/sweep/sweep.h"

#include <algorithm>
#include <charconv>
#include <set>

#include <toml++/toml.h>

#include "studies/config/keys/key_table.h"
#include "studies/config/text/toml_text.h"
#include "studies/config/text/units.h"
#include "studies/config/value_reader.h"
#include "studies/jobs/digest.h"

namespace fingertip::studies::inline sweep {

namespace {

constexpr std::size_t max_points = 1000000;
constexpr std::size_t id_digits = 12;

const std::vector<std::string>& verbs() {
  static const std::vector<std::string> all = {"press", "modes", "reference", "grasp"};
  return all;
}

/// Whether this value of `key` is a list of values for it.
bool is_axis(const Key& key, const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return false;
  // Terms and stages are lists of lists.
  if (!key.takes_list() || key.kind == Kind::terms || key.kind == Kind::stages) return true;
  return !list->empty() && list->front().is_array();
}

/// Collects axes and problems.
class SweepReader {
 public:
  std::string verb;
  std::map<std::string, std::vector<std::string>> axes;  ///< key: literals, without repetitions
  std::vector<SweepPoint> points;                        ///< given one by one
  std::vector<meshes::Violation> problems;

  void read_file(const std::filesystem::path& file) {
    file_ = file;
    const toml::table root = parsed_file(file);
    if (const toml::table* table = root["sweep"].as_table()) read_table(*table, "");
  }

  /// Takes --set texts that are axes, returns the others.
  std::vector<std::string> read_sets(const std::vector<std::string>& sets) {
    std::vector<std::string> others;
    for (const std::string& text : sets) {
      if (!read_set(text)) others.push_back(text);
    }
    return others;
  }

 private:
  void read_table(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      const std::string place = file_.string() + ":" + std::to_string(node.source().begin.line);
      if (key == "verb" && node.is_string()) {
        verb = node.as_string()->get();
      } else if (key == "points") {
        take_points(node, place, file_.parent_path());
      } else if (const toml::table* inner = node.as_table()) {
        read_table(*inner, key + ".");
      } else if (const Key* known = find_key(key); known == nullptr) {
        problems.push_back({"sweep." + key, "", "unknown key",
                            "the nearest valid key is " + nearest_key(key), place});
      } else {
        take(*known, node, place, file_.parent_path());
      }
    }
  }

  bool read_set(const std::string& text) {
    const auto equals = text.find('=');
    const bool listed = text.substr(0, equals) == "sweep.points";
    const Key* key = find_key(text.substr(0, equals));
    if (equals == text.npos || (key == nullptr && !listed)) return false;
    const toml::table parsed = parsed_literal(text.substr(equals + 1));
    if (listed && !parsed.empty()) {
      take_points(*parsed.get("v"), "--set " + text, {});
      return true;
    }
    if (parsed.empty() || listed || !is_axis(*key, *parsed.get("v"))) return false;
    take(*key, *parsed.get("v"), "--set " + text, {});
    return true;
  }

  void take(const Key& key, const toml::node& node, const std::string& place,
            const std::filesystem::path& base) {
    const std::string name = key.full_name();
    if (!is_axis(key, node) || node.as_array()->empty()) {
      problems.push_back({name, toml_literal(node), "a sweep varies lists of values",
                          "write a list in brackets, or the single value in its own section",
                          place});
      return;
    }
    std::vector<std::string>& values = axes[name];
    values.clear();
    for (const toml::node& element : *node.as_array()) {
      const std::string literal = literal_of(key, element, place, base);
      if (std::ranges::find(values, literal) == values.end()) values.push_back(literal);
    }
  }

  /// Empty where it cannot be read, which is a problem.
  std::string literal_of(const Key& key, const toml::node& node, const std::string& place,
                         const std::filesystem::path& base) {
    try {
      return read(key, node, base).literal;
    } catch (const UnitError& error) {
      problems.push_back(
          {key.full_name(), unquoted(toml_literal(node)), error.rule, error.remedy, place});
      return "";
    }
  }

  void take_points(const toml::node& node, const std::string& place,
                   const std::filesystem::path& base) {
    points.clear();
    const toml::array* list = node.as_array();
    const bool tables = list != nullptr && !list->empty() &&
                        std::ranges::all_of(*list, [](const auto& one) { return one.is_table(); });
    if (!tables) {
      problems.push_back(
          {"sweep.points", toml_literal(node), "points are a list of settings",
           "write e.g. points = [{press.contact = \"stick\"}, {press.depth = \"2 mm\"}]", place});
      return;
    }
    for (const toml::node& one : *list)
      add_settings(*one.as_table(), "", place, base, points.emplace_back());
  }

  void add_settings(const toml::table& table, const std::string& prefix, const std::string& place,
                    const std::filesystem::path& base, SweepPoint& point) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      if (const Key* known = find_key(key))
        point.settings[key] = literal_of(*known, node, place, base);
      else if (node.is_table())
        add_settings(*node.as_table(), key + ".", place, base, point);
      else
        problems.push_back({"sweep.points", key, "unknown key",
                            "the nearest valid key is " + nearest_key(key), place});
    }
  }

  std::filesystem::path file_;
};

/// What identifies a point apart from its own settings.
std::string common_text(const std::string& verb, const LoadedConfig& base,
                        const std::set<std::string>& axes) {
  std::string text = verb + "\n";
  for (const auto& [name, entry] : base.entries) {
    if (!entry.given || name == "run.threads" || name == "run.units" || axes.contains(name))
      continue;
    text += name + "=" + entry.literal + "\n";
  }
  return text;
}

/// Throws ConfigError before there are more than memory may hold.
std::vector<SweepPoint> combinations(const SweepReader& reader) {
  std::vector<SweepPoint> points =
      reader.points.empty() ? std::vector<SweepPoint>(1) : reader.points;
  for (const auto& [key, values] : reader.axes) {
    if (points.size() * values.size() > max_points)
      throw ConfigError({"", "", "more than a million points", "shorten an axis", "sweep"});
    std::vector<SweepPoint> more;
    for (const SweepPoint& point : points) {
      for (const std::string& value : values) {
        more.push_back(point);
        more.back().settings[key] = value;
      }
    }
    points = std::move(more);
  }
  return points;
}

void check(const SweepReader& reader, const std::string& verb) {
  std::vector<meshes::Violation> problems = reader.problems;
  if (std::ranges::find(verbs(), verb) == verbs().end()) {
    problems.push_back({"verb", verb, "a sweep consists of press, modes, reference or grasp",
                        "the nearest one is " + nearest_word(verb, verbs()), "sweep"});
  }
  if (reader.axes.empty() && reader.points.empty() && problems.empty()) {
    problems.push_back({"", "", "no key has a list of values",
                        "write e.g. --set 'lattice.spacing=[\"tip_radius/6\", \"tip_radius/8\"]', "
                        "or a table [sweep]",
                        "sweep"});
  }
  if (!problems.empty()) throw ConfigError(problems);
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto of = slash ? std::from_chars(number.ptr + 1, end, shard.of) : number;
  if (!slash || of.ec != std::errc() || of.ptr != end || shard.number < 1 ||
      shard.number > shard.of) {
    throw ConfigError(
        {"", "", "must be i/N with 1 <= i <= N", "write e.g. --shard 1/8", "--shard " + text});
  }
  return shard;
}

Sweep read_sweep(const ConfigSource& source, const std::string& verb) {
  SweepReader reader;
  if (!source.file.empty()) reader.read_file(source.file);
  ConfigSource shared = source;
  shared.sets = reader.read_sets(source.sets);
  Sweep sweep;
  sweep.verb = !verb.empty() ? verb : reader.verb.empty() ? "press" : reader.verb;
  check(reader, sweep.verb);
  sweep.base = load_config(shared);
  std::set<std::string> axes;
  for (const auto& [key, values] : reader.axes) axes.insert(key);
  for (const SweepPoint& point : reader.points)
    for (const auto& [key, value] : point.settings) axes.insert(key);
  sweep.axes.assign(axes.begin(), axes.end());
  sweep.points = combinations(reader);
  // What only some of them set is for the others as for the whole sweep.
  for (SweepPoint& point : sweep.points)
    for (const std::string& key : axes)
      if (const Entry& entry = sweep.base.entries.at(key); entry.given)
        point.settings.try_emplace(key, entry.literal);
  const std::string common = common_text(sweep.verb, sweep.base, axes);
  for (SweepPoint& point : sweep.points) {
    point.id = sha256(common + settings_text(point)).substr(0, id_digits);
  }
  std::ranges::sort(sweep.points, {}, &SweepPoint::id);
  const auto twins = std::ranges::unique(sweep.points, {}, &SweepPoint::id);
  sweep.points.erase(twins.begin(), twins.end());
  return sweep;
}

std::vector<SweepPoint> points_of(const Sweep& sweep, const Shard& shard) {
  std::vector<SweepPoint> points;
  for (std::size_t p = std::size_t(shard.number - 1); p < sweep.points.size();
       p += std::size_t(shard.of)) {
    points.push_back(sweep.points[p]);
  }
  return points;
}

LoadedConfig config_of(const Sweep& sweep, const SweepPoint& point) {
  std::vector<std::string> sets;
  for (const auto& [key, value] : point.settings) sets.push_back(key + "=" + value);
  return with_sets(sweep.base, sets);
}

std::string settings_text(const SweepPoint& point) {
  std::string text;
  for (const auto& [key, value] : point.settings) {
    text += (text.empty() ? "" : "; ") + key + "=" + value;
  }
  return text;
}

}  // namespace fingertip::studies::inline sweep
