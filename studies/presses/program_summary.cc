#include "studies/presses/program_summary.h"

#include <algorithm>
#include <cmath>

// pchip.hpp of Boost 1.74 calls isnan of the global namespace.
#include <math.h>

#include <boost/math/interpolators/pchip.hpp>

#include "meshes/press/press_motion.h"

namespace fingertip::studies::inline presses {

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

/// Area under points whose x grows [J].
double area_below(std::vector<double> x, std::vector<double> y) {
  double area = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) area += 0.5 * (y[i - 1] + y[i]) * (x[i] - x[i - 1]);
  constexpr std::size_t fewest = 4;  // of a monotone cubic
  if (x.size() < fewest) return area;
  const std::vector<double> places = x;
  const boost::math::interpolators::pchip<std::vector<double>> curve(std::move(x), std::move(y));
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double way = places[i] - places[i - 1];
    area += way * way * (curve.prime(places[i - 1]) - curve.prime(places[i])) / 12.0;
  }
  return area;
}

StageEntry entry_of(const meshes::PressStage& stage) {
  StageEntry entry;
  entry.kind = !stage.moves()              ? "hold"
               : stage.moves_along_plane() ? std::string(name(stage.move))
                                           : "move";
  entry.indentation = stage.indentation;
  if (stage.move == meshes::StageMove::lateral) entry.lateral = stage.lateral;
  if (stage.move == meshes::StageMove::twist) entry.twist = stage.twist;
  return entry;
}

/// Of the plane on the tip between two rows [J].
double work_along_plane(const meshes::PressSample& from, const meshes::PressSample& to) {
  const auto between = [&](double meshes::PressSample::*way, double meshes::PressSample::*load) {
    const double moved = to.*way - from.*way;
    return std::isnan(moved) || moved == 0.0 ? 0.0 : 0.5 * moved * (from.*load + to.*load);
  };
  return between(&meshes::PressSample::lateral_displacement,
                 &meshes::PressSample::lateral_force_x) +
         between(&meshes::PressSample::twist, &meshes::PressSample::spin_torque);
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
  if (protocol.program.empty()) return entries;
  const meshes::PressMotion motion(protocol);
  double force = 0.0;
  for (std::size_t i = 0; i < protocol.program.size(); ++i) {
    StageEntry& entry = entries.emplace_back(entry_of(protocol.program[i]));
    entry.begin_force = force;
    const meshes::PressSample* last = nullptr;
    for (const meshes::PressSample& sample : response.samples())
      if (sample.stage == double(i + 1)) last = &sample;
    const bool in_time = last != nullptr && !std::isnan(last->time);
    if (in_time) {
      const meshes::MotionStage& stage = motion.stages()[i];
      if (entry.moves()) entry.speed = protocol.program[i].speed;
      entry.begin = i == 0 ? 0.0 : entries[i - 1].end;
      entry.end = stage.end - motion.touch_time();
    }
    if (last != nullptr && last->indentation == entry.indentation)
      force = last->normal_force;
    else if (entry.moves())
      force = meshes::unknown;
    entry.end_force = force;
    if (entry.holds() && in_time && entry.begin_force > 0.0)
      entry.relaxation = 1.0 - entry.end_force / entry.begin_force;
  }
  return entries;
}

double work_along(const meshes::PressResponse& response) {
  double work = 0.0;
  std::vector<double> x{0.0}, y{0.0};
  const meshes::PressSample* before = nullptr;
  const auto end_leg = [&] {
    if (x.back() >= x.front())
      work += area_below(x, y);
    else  // a way back is walked forwards, with the sign turned
      work -= area_below({x.rbegin(), x.rend()}, {y.rbegin(), y.rend()});
  };
  for (const meshes::PressSample& sample : response.samples()) {
    const double here = sample.indentation;
    const bool goes_on = x.size() < 2 || (here - x.back()) * (x.back() - x[x.size() - 2]) > 0.0;
    if (!goes_on) {
      end_leg();
      x = {x.back()};
      y = {y.back()};
    }
    if (before) work += work_along_plane(*before, sample);
    if (here == x.back()) {  // a hold, or a move along the plane
      y.back() = sample.normal_force;
    } else {
      x.push_back(here);
      y.push_back(sample.normal_force);
    }
    before = &sample;
  }
  end_leg();
  const auto moves = [&](double meshes::PressSample::*way) {
    return std::ranges::any_of(response.samples(), [way](const meshes::PressSample& sample) {
      return std::abs(sample.*way) > 0.0;
    });
  };
  const bool both =
      moves(&meshes::PressSample::twist) && moves(&meshes::PressSample::lateral_displacement);
  return both ? meshes::unknown : work;
}

}  // namespace fingertip::studies::inline presses
