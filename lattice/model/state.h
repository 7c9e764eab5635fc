/// What changes in time: displacement and velocity of every particle.
#pragma once

#include <array>
#include <vector>

#include "lattice/model/model.h"

namespace fingertip::lattice::inline model {

/// Three components of a vector per grid point, structure of arrays.
struct VectorField {
  std::array<std::vector<double>, 3> component;

  VectorField() = default;
  explicit VectorField(std::size_t points) {
    for (auto& c : component) c.assign(points, 0.0);
  }
  meshes::Vector3 at(std::size_t point) const {
    return {component[0][point], component[1][point], component[2][point]};
  }
  void set(std::size_t point, const meshes::Vector3& value) {
    for (std::size_t c = 0; c < 3; ++c) component[c][point] = value[Eigen::Index(c)];
  }
  void add(std::size_t point, const meshes::Vector3& value) {
    for (std::size_t c = 0; c < 3; ++c) component[c][point] += value[Eigen::Index(c)];
  }
};

/// Displacement u = x - X and velocity v, components along the grid's axes; zero at points without
/// a particle.
struct State {
  VectorField displacement;  ///< [m]
  VectorField velocity;      ///< [m/s]

  State() = default;
  explicit State(const LatticeModel& model)
      : displacement(model.points()), velocity(model.points()) {}
};

/// Displacement of a point embedded among particles (corners are grid indices), along the grid's
/// axes, after `ahead` seconds at the present velocities [m].
inline meshes::Vector3 shift(const EmbeddedPoint& tie, const State& state, double ahead) {
  meshes::Vector3 sum = meshes::Vector3::Zero();
  for (std::size_t c = 0; c < 8; ++c) {
    const std::uint32_t i = tie.corners[c];
    sum += tie.weights[c] * (state.displacement.at(i) + ahead * state.velocity.at(i));
  }
  return sum;
}

/// x = X + u [m] in the tip's frame.
inline meshes::Vector3 position(const LatticeModel& model, const State& state, std::size_t point) {
  return model.rest_position(point) + model.grid.axes * state.displacement.at(point);
}

}  // namespace fingertip::lattice::inline model
