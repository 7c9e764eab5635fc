#include "tests/benchmarks/springs/engine/spring_problem.h"

#include <cmath>
#include <string>

namespace fingertip::lattice::springs {

namespace {

using meshes::Violation;

class Rules {
 public:
  void require(bool holds, const std::string& key, double value, const std::string& rule) {
    if (holds) return;
    found_.push_back({"springs." + key, std::to_string(value), rule, "change it"});
  }
  std::vector<Violation> found() && { return std::move(found_); }

 private:
  std::vector<Violation> found_;
};

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}
bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

}  // namespace

bool SpringProblem::occupied(int i, int j, int k) const {
  const bool inside = i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  return inside && (mask.empty() || mask[index(i, j, k)] != 0);
}

std::vector<Violation> SpringProblem::violations() const {
  Rules rules;
  for (const int n : size) rules.require(n >= 1, "size", n, "every side has at least one point");
  rules.require(mask.empty() || mask.size() == points(), "mask", double(mask.size()),
                "one entry per point of the grid, or none");
  rules.require(positive(spacing), "spacing", spacing, "positive");
  for (const double k : stiffness) rules.require(not_negative(k), "stiffness", k, "not negative");
  for (const double mu : damping) rules.require(not_negative(mu), "damping", mu, "not negative");
  rules.require(positive(mass), "mass", mass, "positive");
  rules.require(positive(step), "step", step, "positive");
  rules.require(gravity.allFinite(), "gravity", gravity.norm(), "finite");
  rules.require(std::abs(plane.normal.norm() - 1.0) < 1e-12, "plane.normal", plane.normal.norm(),
                "a unit vector");
  rules.require(std::isfinite(plane.height), "plane.height", plane.height, "finite");
  rules.require(not_negative(plane.stiffness), "plane.stiffness", plane.stiffness, "not negative");
  rules.require(not_negative(plane.damping), "plane.damping", plane.damping, "not negative");
  return std::move(rules).found();
}

std::vector<std::size_t> mass_points(const SpringProblem& problem) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < problem.points(); ++i) {
    if (problem.mask.empty() || problem.mask[i] != 0) points.push_back(i);
  }
  return points;
}

Eigen::Matrix3Xd rest_positions(const SpringProblem& problem) {
  const std::vector<std::size_t> points = mass_points(problem);
  const std::size_t nx = std::size_t(problem.size[0]), ny = std::size_t(problem.size[1]);
  Eigen::Matrix3Xd positions(3, Eigen::Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) {
    const std::size_t p = points[n];
    positions.col(Eigen::Index(n)) =
        problem.spacing * Eigen::Vector3d(double(p % nx), double(p / nx % ny), double(p / nx / ny));
  }
  return positions;
}

}  // namespace fingertip::lattice::springs
