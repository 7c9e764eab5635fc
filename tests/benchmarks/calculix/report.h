/// The comparison as text and as JSON.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparison.h"

namespace fingertip::benchmarks {

/// All runs of one program.
struct ProgramRuns {
  std::string name;
  std::string settings;  ///< as a person reads it
  std::vector<Measurement> runs;

  /// Worst error against wall or processor time of the runs that reached every depth.
  std::vector<ErrorAndTime> errors_and_times(double Cost::*time) const;
};

/// One line per mesh: unknowns, error at each depth, worst error, times, memory.
void print_runs(std::ostream& out, const ProgramRuns& program, const Truth& truth);

/// Per target: the times of both, wall and processor, and the ratio first over second.
void print_times_to_error(std::ostream& out, const ProgramRuns& first, const ProgramRuns& second,
                          const std::vector<double>& targets);

/// The same, with every number in SI; a time that was not reached is null.
nlohmann::json to_json(const ProgramRuns& first, const ProgramRuns& second, const Truth& truth,
                       const std::vector<double>& targets);

}  // namespace fingertip::benchmarks
