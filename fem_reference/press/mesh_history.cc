#include "fem_reference/press/mesh_history.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
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

/// All of a state but its errors: what files tell of it and of its sample, and the rest.
Json state_to_json(const PressState& state) {
  Json json = meshes::json_of<Json>(state);
  json["sample"] = meshes::json_of<Json>(static_cast<const meshes::PressSample&>(state));
  json["indicator"] = state.indicator;
  json["contact"] = Json::array();
  for (const ContactPoint& point : state.contact)
    json["contact"].push_back({point.radius, point.pressure});
  return json;
}

/// What is unknown is null, or not there.
template <class Struct>
void take(const Json& json, Struct& into) {
  meshes::for_each_field<Struct>([&](const auto& field) {
    const auto found = json.find(std::string(field.name));
    if (found != json.end() && !found->is_null()) found->get_to(std::invoke(field.member, into));
  });
}

PressState state_from_json(const Json& json) {
  PressState state;
  take(json.at("sample"), static_cast<meshes::PressSample&>(state));
  take(json, state);
  json.at("indicator").get_to(state.indicator);
  for (const Json& point : json.at("contact"))
    state.contact.push_back({point.at(0).get<double>(), point.at(1).get<double>()});
  return state;
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
    for (const PressState& state : record.states) states.push_back(state_to_json(state));
    all.push_back({{"cells", record.mesh.cells},
                   {"unknowns", record.mesh.unknowns},
                   {"contact_unknowns", record.mesh.contact_unknowns},
                   {"solver", int(record.mesh.solver)},
                   {"wall_time", record.wall_time},
                   {"states", states}});
  }
  return all;
}

MeshHistory MeshHistory::from_json(const Json& json, MeshHistory like) {
  like.meshes_.clear();
  for (const Json& entry : json) {
    MeshRecord record;
    record.mesh = {entry.at("cells").get<std::size_t>(), entry.at("unknowns").get<std::size_t>(),
                   entry.at("contact_unknowns").get<std::size_t>(),
                   LinearSolver(entry.at("solver").get<int>())};
    record.wall_time = entry.at("wall_time").get<double>();
    for (const Json& state : entry.at("states")) record.states.push_back(state_from_json(state));
    like.meshes_.push_back(std::move(record));
  }
  return like;
}

}  // namespace fingertip::fem_reference::inline press
