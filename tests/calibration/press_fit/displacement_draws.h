/// Measured displacements made up of a lattice's press: noise, and a frame that moves.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "calibration/press_fit/displacement_fit.h"
#include "lattice/press/static_press.h"
#include "meshes/press/markers.h"
#include "tests/calibration/fit_fixtures.h"

namespace displacement_draws {

using namespace fit_fixtures;
using meshes::Vector3;

/// Displacements of points in the dome, some on its surface, under two loads of a press that
/// sticks, by Poisson's ratio; pressed once for each.
class PressedDome {
 public:
  PressedDome() : setup_(with_samples(press(ContactMode::stick), {0.6e-3, 1.2e-3})) {
    const auto shape = meshes::shape_of(setup_.geometry);
    setup_.protocol.markers = marker_grid(*shape, 3.4e-3, 0.0);
    for (const Vector3& inside : marker_grid(*shape, 3.4e-3, 1.5e-3))
      setup_.protocol.markers.push_back(inside);
  }
  const std::vector<Vector3>& places() const { return setup_.protocol.markers; }
  const std::vector<double>& depths() const { return setup_.protocol.samples; }

  using Fields = std::vector<std::vector<Vector3>>;
  const Fields& at(double poissons_ratio) {
    const auto [known, is_new] = known_.try_emplace(poissons_ratio);
    if (!is_new) return known->second;
    PressSetup own = setup_;
    own.rubber.youngs_modulus = 2.0 * own.rubber.shear_modulus * (1.0 + poissons_ratio);
    own.lattice.constants = lattice::hookean_constants(own.rubber, own.lattice.spacing);
    const auto rows = lattice::run_static_press(own).markers;
    for (std::size_t s = 0; s < depths().size(); ++s) {
      std::vector<Vector3>& field = known->second.emplace_back();
      for (std::size_t i = 0; i < places().size(); ++i)
        field.push_back(rows[s * places().size() + i].displacement);
    }
    return known->second;
  }

  /// What a camera sees of it that has moved, with normal errors of every component [m].
  std::vector<MeasuredDisplacements> seen(double poissons_ratio, double noise, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&] {
      const double x = normal(generator), y = normal(generator), z = normal(generator);
      return Vector3(x, y, z);
    };
    std::vector<MeasuredDisplacements> loads;
    const Fields& fields = at(poissons_ratio);
    for (std::size_t s = 0; s < depths().size(); ++s) {
      MeasuredDisplacements& load = loads.emplace_back();
      load.indentation = depths()[s];
      const Eigen::AngleAxisd turn(0.05 * normal(generator), vector().normalized());
      const Vector3 shift = 1e-3 * vector();
      for (std::size_t i = 0; i < places().size(); ++i)
        load.displacement.push_back(turn * (places()[i] + fields[s][i]) + shift - places()[i] +
                                    noise * vector());
    }
    return loads;
  }

  DisplacementFitFile fit(const std::vector<MeasuredDisplacements>& measured,
                          FrameMotion frame = FrameMotion::fitted, const FreedPress& freed = {}) {
    const DisplacementMoments moments(places(), measured, frame);
    DisplacementModel model(
        [&](const std::vector<double>& ratios) {
          std::vector<VectorXd> answers;
          for (const double nu : ratios) answers.push_back(moments.of(at(nu)));
          return answers;
        },
        0.0);
    return fit_poissons_ratio(moments, measured, model, nullptr, frame, freed);
  }

 private:
  PressSetup setup_;
  std::map<double, Fields> known_;
};

/// So many of `draws` experiments have the truth in their 95 % interval.
inline int inside(int draws, double truth, double noise) {
  PressedDome dome;
  int count = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const DisplacementFitFile fit = dome.fit(dome.seen(truth, noise, unsigned(draw) + 1));
    count += fit.lower <= truth && truth <= fit.upper;
  }
  return count;
}

}  // namespace displacement_draws
