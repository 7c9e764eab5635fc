/// A parameter sweep: which points it has, and which of them a shard computes.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "studies/config/loader.h"

namespace fingertip::studies::inline sweep {

/// One combination of values. Its identity is a digest of the verb, what the whole sweep was given
/// and its own settings, in whatever order they were written; threads do not count.
struct SweepPoint {
  std::string id;                               ///< 12 hexadecimal digits, its folder's name
  std::map<std::string, std::string> settings;  ///< key: TOML literal, of the axes
};

struct Sweep {
  std::string verb;                ///< press, modes, reference or grasp
  LoadedConfig base;               ///< what all points share
  std::vector<std::string> axes;   ///< keys that vary, sorted
  std::vector<SweepPoint> points;  ///< without repetitions, sorted by id
};

/// Part `number` (1 ... of) of a sweep.
struct Shard {
  int number = 1, of = 1;
};

/// "3/8". Throws ConfigError for anything that is not i/N with 1 <= i <= N.
Shard parse_shard(const std::string& text);

/// The sweep that `source` describes. Axes are keys with a list of values where one value is meant
/// (a list of lists where the key takes a list): in the table [sweep] of the file, or by --set,
/// which replaces an axis of the file. Instead of all combinations, or times those, `points` in
/// [sweep] or --set sweep.points lists settings one by one: [{press.depth = "2 mm"}, ...]. `verb`
/// empty: sweep.verb of the file, else press. Throws ConfigError with all problems: no axis, an
/// empty one, unknown keys, values that cannot be read.
Sweep read_sweep(const ConfigSource& source, const std::string& verb);

/// Every of-th point from the number-th on, in the order of identities: shards are disjoint, make
/// up the whole, differ by at most one point, and do not depend on how axes were written.
std::vector<SweepPoint> points_of(const Sweep& sweep, const Shard& shard);

/// The point's own configuration. Throws ConfigError naming the point's settings.
LoadedConfig config_of(const Sweep& sweep, const SweepPoint& point);

/// "lattice.spacing=tip_radius/6; press.speed=\"1 cm/s\""
std::string settings_text(const SweepPoint& point);

}  // namespace fingertip::studies::inline sweep
