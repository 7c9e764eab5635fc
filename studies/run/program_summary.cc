#include "studies/run/program_summary.h"

#include <algorithm>
#include <cmath>

#include "meshes/press_motion.h"

namespace fingertip::studies {

namespace {

using meshes::PressProtocol;

/// Linear between rows; unknown beyond the last one.
double force_at(const std::vector<lattice::TraceRow>& trace, double time) {
  const auto after = std::ranges::lower_bound(trace, time, {}, &lattice::TraceRow::time);
  if (after == trace.end()) return meshes::unknown;
  if (after == trace.begin() || after->time == time) return after->normal_force;
  const auto before = after - 1;
  const double part = (time - before->time) / (after->time - before->time);
  return before->normal_force + part * (after->normal_force - before->normal_force);
}

StageEntry entry_of(const meshes::PressStage& stage) {
  StageEntry entry;
  entry.kind = stage.moves() ? "move" : "hold";
  entry.indentation = stage.indentation;
  return entry;
}

}  // namespace

std::vector<StageEntry> stage_entries(const PressProtocol& protocol,
                                      const std::vector<lattice::TraceRow>& trace) {
  std::vector<StageEntry> entries;
  if (protocol.program.empty()) return entries;
  const meshes::PressMotion motion(protocol);
  for (std::size_t i = 0; i < protocol.program.size(); ++i) {
    StageEntry& entry = entries.emplace_back(entry_of(protocol.program[i]));
    if (entry.moves()) entry.speed = protocol.program[i].speed;
    entry.begin = motion.stages()[i].begin;
    entry.end = motion.stages()[i].end;
    entry.begin_force = force_at(trace, entry.begin);
    entry.end_force = force_at(trace, entry.end);
    if (entry.holds() && entry.begin_force > 0.0)
      entry.relaxation = 1.0 - entry.end_force / entry.begin_force;
  }
  return entries;
}

std::vector<StageEntry> stage_entries(const PressProtocol& protocol,
                                      const meshes::PressResponse& response) {
  std::vector<StageEntry> entries;
  double force = 0.0;
  for (std::size_t i = 0; i < protocol.program.size(); ++i) {
    StageEntry& entry = entries.emplace_back(entry_of(protocol.program[i]));
    entry.begin_force = force;
    if (entry.moves()) {
      force = meshes::unknown;
      for (const meshes::PressSample& sample : response.samples())
        if (sample.stage == double(i + 1) && sample.indentation == entry.indentation)
          force = sample.normal_force;
    }
    entry.end_force = force;
  }
  return entries;
}

}  // namespace fingertip::studies
