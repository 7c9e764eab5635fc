#include "studies/config/keys/key_table.h"

#include <algorithm>
#include <tuple>

#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

/// Restricted Damerau-Levenshtein distance: insertions, deletions, substitutions and swaps of
/// neighbouring letters cost one each. Of absurdly long words the beginnings count.
int edit_distance(std::string_view a, std::string_view b) {
  constexpr std::size_t most = 120;
  a = a.substr(0, most);
  b = b.substr(0, most);
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = int(i);
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

std::string_view last_part(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

}  // namespace

const std::vector<Key>& key_table() {
  static const std::vector<Key> table = [] {
    std::vector<Key> keys;
    for (const auto& part : {specimen_keys(), lattice_keys(), press_keys(), obstacle_keys(),
                             controller_keys(), hardware_keys(), sensor_keys(), grasp_keys(),
                             reference_keys(), calibration_keys(), exchange_keys(), run_keys()}) {
      keys.insert(keys.end(), part.begin(), part.end());
    }
    return keys;
  }();
  return table;
}

const Key* find_key(std::string_view full_name) {
  const auto found = std::ranges::find_if(
      key_table(), [&](const Key& key) { return key.full_name() == full_name; });
  return found == key_table().end() ? nullptr : &*found;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& words) {
  return *std::ranges::min_element(
      words, {}, [&](const std::string& candidate) { return edit_distance(word, candidate); });
}

std::string nearest_key(std::string_view name) {
  const std::string_view last = last_part(name);
  const std::string section(name.substr(0, name.size() - last.size()));
  // The last part is a key's name, or a part of it, or neither.
  const auto likeness = [&](const Key& key) {
    if (key.name == last) return 0;
    constexpr std::size_t shortest = 3;
    return last.size() >= shortest && key.name.find(last) != key.name.npos ? 1 : 2;
  };
  // A right name in the wrong section is the likelier slip than a wrong name in the right one; a
  // name that nothing is like is compared with its own section's.
  const auto distance = [&](const Key& key) {
    return std::tuple(likeness(key), key.section + "." != section,
                      edit_distance(last, key.name) + edit_distance(name, key.full_name()));
  };
  return std::ranges::min_element(key_table(), {}, distance)->full_name();
}

}  // namespace fingertip::studies::inline config::inline keys
