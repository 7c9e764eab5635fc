/// One table of all points of a sweep.
#pragma once

#include <cstddef>
#include <filesystem>

namespace fingertip::studies {

struct SweepCensus {
  std::size_t points = 0;
  std::size_t finished = 0;
  std::size_t failed = 0;  ///< did not converge
  std::size_t missing() const { return points - finished - failed; }
};

/// Reads FOLDER/sweep.json and what shards have left in FOLDER/points, writes
///   table.csv   a row per point: id, status, the axes' values, every number in its summary.json
///               (entries of entries with dots, lists left out);
///   curves.csv  the rows of all response.csv behind id and axes, when there are any.
/// Rows go by id: equal for any number and order of shards. Throws ConfigError when the folder is
/// not that of a sweep.
SweepCensus collect(const std::filesystem::path& folder);

}  // namespace fingertip::studies
