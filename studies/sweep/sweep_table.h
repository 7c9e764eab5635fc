/// One table of all points of a sweep.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline sweep {

struct SweepCensus {
  std::size_t points = 0;
  std::size_t finished = 0;
  std::size_t missing = 0;
  std::size_t damaged = 0;                ///< have files that cannot be read
  std::vector<meshes::Violation> damage;  ///< what is wrong with them
  std::string text;                       ///< points with their settings and answers
  std::size_t failed() const { return points - finished - missing - damaged; }  ///< not converged
};

/// Reads FOLDER/sweep.json and what shards have left in FOLDER/points, writes
///   table.csv   a row per point: id, status, the axes' values, the answer (indentation, normal
///               force and contact radius at full depth, or the lowest frequency), and every number
///               in its summary.json (entries of entries with dots, lists left out);
///   curves.csv  the rows of all response.csv behind id and axes, when there are any.
/// Rows go by id: equal for any number and order of shards. Of a point with damaged files what can
/// be read is written, with the status "damaged". Throws ConfigError when the folder is not that of
/// a sweep, InvalidInput when sweep.json is damaged.
SweepCensus collect(const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline sweep
