#include "fem_reference/press/mesh_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

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
  const double share = state.node_spacing / state.sample.contact_radius;
  return state.sample.normal_force * share * share;
}

/// JSON has no NaN; an unknown quantity is null.
Json known(double value) {
  return std::isnan(value) ? Json() : Json(value);
}

double value_of(const Json& json) {
  return json.is_null() ? meshes::unknown : json.get<double>();
}

constexpr std::pair<const char*, double meshes::PressSample::*> sample_entries[] = {
    {"indentation", &meshes::PressSample::indentation},
    {"normal_force", &meshes::PressSample::normal_force},
    {"lateral_force_x", &meshes::PressSample::lateral_force_x},
    {"lateral_force_y", &meshes::PressSample::lateral_force_y},
    {"torque_x", &meshes::PressSample::torque_x},
    {"torque_y", &meshes::PressSample::torque_y},
    {"torque_z", &meshes::PressSample::torque_z},
    {"contact_radius", &meshes::PressSample::contact_radius},
    {"max_pressure", &meshes::PressSample::max_pressure},
    {"time", &meshes::PressSample::time},
    {"lateral_displacement", &meshes::PressSample::lateral_displacement},
    {"stage", &meshes::PressSample::stage}};
constexpr std::pair<const char*, double PressState::*> real_entries[] = {
    {"node_spacing", &PressState::node_spacing},
    {"min_jacobian", &PressState::min_jacobian},
    {"energy", &PressState::energy},
    {"indicator", &PressState::indicator},
    {"wall_time", &PressState::wall_time}};
constexpr std::pair<const char*, int PressState::*> whole_entries[] = {
    {"steps", &PressState::steps},
    {"newton_iterations", &PressState::newton_iterations},
    {"active_set_iterations", &PressState::active_set_iterations},
    {"cg_iterations", &PressState::cg_iterations},
    {"active_nodes", &PressState::active_nodes},
    {"sliding_nodes", &PressState::sliding_nodes}};

Json state_to_json(const PressState& state) {
  Json json;
  for (const auto& [key, member] : sample_entries) json[key] = known(state.sample.*member);
  for (const auto& [key, member] : real_entries) json[key] = known(state.*member);
  for (const auto& [key, member] : whole_entries) json[key] = state.*member;
  Json points = Json::array();
  for (const ContactPoint& point : state.contact) points.push_back({point.radius, point.pressure});
  json["contact"] = points;
  return json;
}

PressState state_from_json(const Json& json) {
  PressState state;
  // A checkpoint of an earlier version has no stage and no indicator.
  for (const auto& [key, member] : sample_entries)
    state.sample.*member = value_of(json.value(key, Json()));
  for (const auto& [key, member] : real_entries) state.*member = value_of(json.value(key, Json()));
  for (const auto& [key, member] : whole_entries) state.*member = json.at(key).get<int>();
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
        error.value = std::max(error.value, record.states[index].sample.normal_force);
    return error;
  }
  if (std::isnan(error.value)) return error;
  const PressState& state = *finest;
  const double typical = typical_edge_error() * edge_scale(state);
  if (typical > error.value) error.value = typical;
  const double excess =
      excess_per_indicator * state.indicator / state.energy * state.sample.normal_force;
  if (excess > error.value) error.value = excess;
  error.value *= safety_;
  if (index < step_errors_.size()) error.value += step_errors_[index] * state.sample.normal_force;
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
    const MeshForce next{std::pow(state.node_spacing, -3.0), state.sample.normal_force};
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
  for (std::size_t i = 0; i < result.size(); ++i) result[i].sample.force_error = error(i).value;
  return result;
}

std::vector<double> MeshHistory::relative_errors() const {
  const std::vector<PressState> states = best();
  double largest = 0.0;
  for (const PressState& state : states) largest = std::max(largest, state.sample.normal_force);
  std::vector<double> errors;
  for (const PressState& state : states) {
    const double force = state.sample.normal_force, error = state.sample.force_error,
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
