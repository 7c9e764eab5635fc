#include "fem_reference/press/mesh_history.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "meshes/tables/fields_json.h"

namespace fingertip::fem_reference::inline press {
namespace {

using Json = nlohmann::json;

/// Meshes that are finer by less than this factor for a sample count as one.
constexpr double min_refinement = 1.2;

/// Most that a mesh's energy is in excess, over its indicator (MeshHistory::error).
constexpr double excess_per_indicator = 2.0, excess_of_stick = 1.0;

/// The radius of a contact with a free edge is off by up to this share of the node spacing there,
/// however meshes agree, for its nodes come and go; 95 of 100 are within 0.23 (MEASUREMENTS.md).
constexpr double radius_share = 0.3;
/// The largest pressure is a node's, and off by up to this factor more than the force is, ...
constexpr double pressure_factor = 2.0;
/// ... or by this share of the squared spacing at the peak over the contact's radius, for a node's
/// pressure is a mean over the elements around it, which refinement at the edge does not touch. Of
/// Hertz's contact on a meridian it is 0.06.
constexpr double peak_share = 0.2;

/// h, how coarse a mesh is for a sample: the node spacing at an edge that is free to move [m]; else
/// the root of the share of its energy that a mesh stores in excess.
double coarseness(const PressState& state, bool free_edge) {
  return free_edge ? state.node_spacing : std::sqrt(state.indicator / state.energy);
}

/// w, by which errors of different samples are compared, in the unit of the value.
double error_scale(const PressState& state, MeshHistory::Value value) {
  const double h = coarseness(state, state.free_edge),
               share = state.free_edge ? h / state.contact_radius : h;
  return state.*value * share * share;
}

/// To what the meshes tell of a vector, where it has an error at all.
void raise(double& error, double told) {
  if (told > error) error = told;
}

/// Calls use(name, part) for what a checkpoint tells of a state: its entry in summary.json, its row
/// of response.csv, and the rest.
void for_each_part(PressState& state, const auto& use) {
  use("state", state);
  use("sample", static_cast<meshes::PressSample&>(state));
  use("indicator", state.indicator);
  use("free_edge", state.free_edge);
  use("peak_spacing", state.peak_spacing);
  use("contact", state.contact);
  use("markers", state.markers);
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
  ForceError error = contact_error(index, &PressState::normal_force);
  const PressState* state = finest_state(index);
  if (std::isnan(error.value) || state->contact.empty()) return error;
  const double excess = (sticks_ ? excess_of_stick : excess_per_indicator) * state->indicator /
                        state->energy * state->normal_force;
  error.value = safety_ * std::max(error.value, excess);
  if (index < step_errors_.size()) error.value += step_errors_[index] * state->normal_force;
  return error;
}

double MeshHistory::radius_error(std::size_t index) const {
  const PressState* state = finest_state(index);
  const double own = contact_error(index, &PressState::contact_radius).value;
  if (std::isnan(own) || state->contact.empty()) return own;
  return std::max({safety_ * own, error(index).value / state->normal_force * state->contact_radius,
                   state->free_edge ? radius_share * state->node_spacing : 0.0});
}

double MeshHistory::pressure_error(std::size_t index) const {
  const PressState* state = finest_state(index);
  const double own = contact_error(index, &PressState::max_pressure).value;
  if (std::isnan(own) || state->contact.empty()) return own;
  const double coarse = state->peak_spacing / state->contact_radius;
  return std::max({safety_ * own,
                   pressure_factor * error(index).value / state->normal_force * state->max_pressure,
                   peak_share * coarse * coarse * state->max_pressure});
}

ForceError MeshHistory::contact_error(std::size_t index, Value value) const {
  const PressState* finest = finest_state(index);
  if (!finest) return {};
  ForceError error = mesh_error(index, value);
  if (finest->contact.empty()) {  // what other meshes still feel
    error.value = 0.0;
    for (const MeshRecord& record : meshes_)
      if (index < record.states.size())
        error.value = std::max(error.value, record.states[index].*value);
  } else if (const double typical =
                 typical_error(finest->free_edge, value) * error_scale(*finest, value);
             typical > error.value) {
    error.value = typical;
  }
  return error;
}

/// m; 0 if no sample can be compared.
double MeshHistory::typical_error(bool free_edge, Value value) const {
  std::vector<double> ratios;
  for (std::size_t i = 0; const PressState* state = finest_state(i); ++i) {
    if (state->free_edge != free_edge) continue;
    const double ratio = mesh_error(i, value).value / error_scale(*state, value);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (ratios.empty()) return 0.0;
  const auto middle = ratios.begin() + std::ptrdiff_t((ratios.size() - 1) / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

double MeshHistory::vector_error(std::size_t index, std::initializer_list<Value> parts) const {
  double sum = 0.0;
  for (const Value part : parts) sum += std::pow(mesh_error(index, part, 1.0).value, 2);
  return safety_ * std::sqrt(sum);
}

ForceError MeshHistory::mesh_error(std::size_t index,
                                   const std::function<double(const PressState&)>& value,
                                   double noise) const {
  const bool free_edge = finest_state(index)->free_edge;
  std::vector<MeshForce> sequence;
  for (const MeshRecord& record : meshes_) {
    if (index >= record.states.size()) continue;
    const PressState& state = record.states[index];
    const double h = coarseness(state, free_edge);
    if (!(h > 0.0)) continue;
    // As if nodes were as far apart as makes the noise one of second order.
    const MeshForce next{std::pow(h, -1.5 * noise), value(state)};
    const bool finer = sequence.empty() || std::pow(next.unknowns / sequence.back().unknowns,
                                                    1.0 / (1.5 * noise)) > min_refinement;
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
    using Sample = meshes::PressSample;
    raise(result[i].lateral_force_error,
          vector_error(i, {&Sample::lateral_force_x, &Sample::lateral_force_y}));
    raise(result[i].torque_error,
          vector_error(i, {&Sample::torque_x, &Sample::torque_y, &Sample::torque_z}));
    result[i].convergence = name(found.convergence);
    result[i].order = found.order;
    result[i].max_pressure_error = pressure_error(i);
    result[i].contact_radius_error = radius_error(i);
    result[i].contact_area_error =
        2.0 * std::numbers::pi * result[i].contact_radius * result[i].contact_radius_error;
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
