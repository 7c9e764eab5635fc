#include "fem_reference/press/mesh_history.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "meshes/tables/fields_json.h"

namespace fingertip::fem_reference::inline press {
namespace {

using Json = nlohmann::json;

/// Meshes whose spacing at a sample's contact edge differs by less than this factor count as one.
constexpr double min_refinement = 1.2;

/// Excess of a mesh's energy over its indicator (MeshHistory::error), with a factor of safety of
/// two.
constexpr double excess_per_indicator = 2.0;

/// w, by which edge errors of different samples are compared [N].
double edge_scale(const PressState& state) {
  const double share = state.node_spacing / state.contact_radius;
  return state.normal_force * share * share;
}

/// Calls use(name, part) for what a checkpoint tells of a state: its entry in summary.json, its row
/// of response.csv, and the rest.
void for_each_part(PressState& state, const auto& use) {
  use("state", state);
  use("sample", static_cast<meshes::PressSample&>(state));
  use("indicator", state.indicator);
  use("contact", state.contact);
}

}  // namespace

void MeshHistory::add(PressState state) {
  finest().wall_time += state.wall_time;
  finest().states.push_back(std::move(state));
}

const PressState* MeshHistory::finest_state(std::size_t index) const {
  const PressState* state = nullptr;
  for (const MeshRecord& record : meshes_)
    if (index < record.states.size()) state = &record.states[index];
  return state;
}

ForceError MeshHistory::error(std::size_t index) const {
  ForceError error = edge_error(index);
  const PressState* finest = finest_state(index);
  if (finest && finest->contact.empty()) {  // what other meshes still feel
    error.value = 0.0;
    for (const MeshRecord& record : meshes_)
      if (index < record.states.size())
        error.value = std::max(error.value, record.states[index].normal_force);
    return error;
  }
  if (std::isnan(error.value)) return error;
  const PressState& state = *finest;
  const double typical = typical_edge_error() * edge_scale(state);
  if (typical > error.value) error.value = typical;
  const double excess = excess_per_indicator * state.indicator / state.energy * state.normal_force;
  if (excess > error.value) error.value = excess;
  error.value *= safety_;
  if (index < step_errors_.size()) error.value += step_errors_[index] * state.normal_force;
  return error;
}

/// m; 0 if no sample can be compared.
double MeshHistory::typical_edge_error() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; const PressState* state = finest_state(i); ++i) {
    const double ratio = edge_error(i).value / edge_scale(*state);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (ratios.empty()) return 0.0;
  const auto middle = ratios.begin() + std::ptrdiff_t((ratios.size() - 1) / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

ForceError MeshHistory::edge_error(std::size_t index) const {
  std::vector<MeshForce> sequence;
  for (const MeshRecord& record : meshes_) {
    if (index >= record.states.size() || !(record.states[index].node_spacing > 0.0)) continue;
    const PressState& state = record.states[index];
    const MeshForce next{std::pow(state.node_spacing, -3.0), state.normal_force};
    const bool finer =
        sequence.empty() || std::cbrt(next.unknowns / sequence.back().unknowns) > min_refinement;
    if (finer)
      sequence.push_back(next);
    else
      sequence.back().force = next.force;  // better elsewhere, no finer here
  }
  return estimate_force_error(sequence);
}

std::vector<PressState> MeshHistory::best() const {
  std::vector<PressState> result;
  for (const MeshRecord& record : meshes_)
    for (std::size_t i = 0; i < record.states.size(); ++i) {
      if (i == result.size()) result.emplace_back();
      result[i] = record.states[i];
    }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const ForceError found = error(i);
    result[i].set_errors(found.value / std::abs(result[i].normal_force));
    result[i].force_error = found.value;
    result[i].convergence = name(found.convergence);
    result[i].order = found.order;
  }
  return result;
}

std::vector<double> MeshHistory::relative_errors() const {
  const std::vector<PressState> states = best();
  double largest = 0.0;
  for (const PressState& state : states) largest = std::max(largest, state.normal_force);
  std::vector<double> errors;
  for (const PressState& state : states) {
    const double force = state.normal_force, error = state.force_error,
                 least = min_share_ * largest;
    constexpr double none = 1e-3;  // of that, a force is round-off where it should vanish
    const bool vanishes = error == 0.0 || (std::isnan(error) && force < none * least);
    errors.push_back(vanishes ? 0.0 : error / std::max(force, least));
  }
  return errors;
}

std::vector<char> MeshHistory::beyond(double tolerance) const {
  std::vector<char> result;
  for (const double error : relative_errors()) result.push_back(!(error <= tolerance));
  return result;
}

double MeshHistory::worst_relative_error() const {
  double worst = 0.0;
  for (const double error : relative_errors()) {
    if (std::isnan(error)) return meshes::unknown;
    worst = std::max(worst, error);
  }
  return worst;
}

Json MeshHistory::to_json() const {
  Json all = Json::array();
  for (const MeshRecord& record : meshes_) {
    Json states = Json::array();
    for (PressState state : record.states)
      for_each_part(state, [&json = states.emplace_back()](const char* name, const auto& part) {
        json[name] = meshes::json_of<Json>(part);
      });
    all.push_back({{"mesh", meshes::json_of<Json>(record.mesh)},
                   {"wall_time", record.wall_time},
                   {"states", states}});
  }
  return all;
}

MeshHistory MeshHistory::from_json(const Json& json, MeshHistory like) {
  like.meshes_.clear();
  for (const Json& entry : json) {
    MeshRecord& record = like.meshes_.emplace_back();
    meshes::read_json(entry.at("mesh"), record.mesh);
    entry.at("wall_time").get_to(record.wall_time);
    for (const Json& state : entry.at("states"))
      for_each_part(record.states.emplace_back(),
                    [&](const char* name, auto& part) { meshes::read_json(state.at(name), part); });
  }
  return like;
}

}  // namespace fingertip::fem_reference::inline press
