#include "lattice/dynamics/scaling/multigrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "lattice/dynamics/scaling/edge_inertia.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::GridHierarchy;
using lattice::LatticeModel;
using lattice::Multigrid;
using lattice::MultigridFields;
using lattice::VectorField;

namespace {

/// A tip cut at random places, or one that is its own mirror image or a part of it, with the
/// inertia that steps of `step` ask for.
struct Scene {
  LatticeModel model;
  lattice::EdgeInertia edges;
  std::shared_ptr<const GridHierarchy> hierarchy;
  std::vector<lattice::PointTie> contact;

  Scene(int per_radius, double step, bool touches, int sectors)
      : Scene(per_radius, step, touches, sectors, sectors > 1) {}

  Scene(int per_radius, double step, bool touches, int sectors, bool even) {
    lattice::LatticeSettings settings =
        settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius);
    settings.constants = lattice::hookean_constants({}, settings.spacing);
    settings.offset = even ? Vector3(0.0, 0.0, 0.1) : Vector3(0.3, -0.2, 0.1);
    model = lattice::build_tip({}, {}, settings, sectors);
    hierarchy = std::make_shared<GridHierarchy>(model);
    const std::size_t points = hierarchy->levels().front().points();
    for (auto& component : edges) component.fill(std::vector<float>(points, 0.0F));
    lattice::Team team(1);
    lattice::EdgeInertiaRule(model).find(lattice::State(model), step, 1.0, team, edges);
    for (const std::uint32_t i : model.particles) {
      const Vector3 at = (model.rest_position(i) / settings.spacing).cwiseAbs();
      const long place = std::lround(at.x()) + 2 * std::lround(at.y()) + std::lround(at.z());
      if (!touches || place % 3 != 0) continue;
      // Each on a surface of its own.
      const Vector3 normal = model.grid.axes.transpose() * model.rest_position(i).normalized();
      const Eigen::Matrix3d along = normal * normal.transpose();
      contact.push_back(
          {i, (model.mass[i] * (50.0 * along + double(place % 2) * Eigen::Matrix3d::Identity()))
                  .cast<float>()});
    }
  }

  /// A u, A = D + S.
  VectorField product(const VectorField& u) const {
    VectorField result(model.points());
    for (const std::uint32_t i : model.particles) {
      result.add(i, model.mass[i] * u.at(i));
      for (std::size_t d = 0; d < 3; ++d) {
        const std::size_t other = i + std::size_t(hierarchy->levels()[0].next[d]);
        Vector3 pull = u.at(i) - u.at(other);
        for (std::size_t c = 0; c < 3; ++c) pull[Eigen::Index(c)] *= double(edges[c][d][i]);
        result.add(i, pull);
        result.add(other, -pull);
      }
    }
    for (const lattice::PointTie& tie : contact) {
      result.add(tie.point, tie.inertia.cast<double>() * u.at(tie.point));
    }
    return held(model, result);
  }

  double dot(const VectorField& u, const VectorField& v) const {
    double sum = 0.0;
    for (const std::uint32_t i : model.particles) sum += u.at(i).dot(v.at(i));
    return sum;
  }

  VectorField random(unsigned seed) const {
    return held(model, random_state(model, 1.0, 0.0, seed).displacement);
  }
};

/// B, by V-cycles.
class Solver {
 public:
  explicit Solver(const Scene& scene)
      : scene_(&scene), grids_(scene.hierarchy), fields_(*scene.hierarchy), team_(1) {
    grids_.finest_edges() = scene.edges;
    grids_.set(scene.model.mass, team_);
    fields_.levels[0].contact = scene.contact;
  }

  VectorField solve(const VectorField& load) {
    MultigridFields::Level& finest = fields_.levels[0];
    for (const std::uint32_t i : scene_->model.particles)
      for (std::size_t c = 0; c < 3; ++c) finest.load[c][i] = float(load.component[c][i]);
    grids_.solve(team_, fields_);
    VectorField result(scene_->model.points());
    for (const std::uint32_t i : scene_->model.particles)
      result.set(i, Vector3(finest.solution[0][i], finest.solution[1][i], finest.solution[2][i]));
    return result;
  }

 private:
  const Scene* scene_;
  Multigrid grids_;
  MultigridFields fields_;
  lattice::Team team_;
};

/// Largest eigenvalue of B A - shift, of which the other sign wins if |shift| does: power iteration
/// with quotients in the product <., A .>, in which it is self-adjoint.
double dominant(const Scene& scene, double shift) {
  Solver solver(scene);
  VectorField u = scene.random(5);
  double quotient = 0.0;
  for (int n = 0; n < 60; ++n) {
    VectorField load = scene.product(u);
    const double size = scene.dot(u, load);
    for (const std::uint32_t i : scene.model.particles) load.set(i, load.at(i) / std::sqrt(size));
    VectorField next = solver.solve(load);
    quotient = scene.dot(load, next) - shift;
    for (const std::uint32_t i : scene.model.particles)
      next.add(i, -shift / std::sqrt(size) * u.at(i));
    u = next;
  }
  return quotient + shift;
}

class VCycle : public testing::TestWithParam<std::tuple<int, double, bool, int>> {
 protected:
  const Scene scene_{std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()),
                     std::get<3>(GetParam())};
};

class VCycleOfAPart : public testing::TestWithParam<std::tuple<int, double, bool, int>> {};

}  // namespace

TEST_P(VCycle, IsSymmetric) {
  Solver solver(scene_);
  const VectorField f = scene_.random(1), g = scene_.random(2);
  const VectorField to_f = solver.solve(f), to_g = solver.solve(g);
  EXPECT_NEAR(scene_.dot(f, to_g), scene_.dot(g, to_f), 1e-5 * scene_.dot(f, to_f));
}

TEST_P(VCycle, LeavesWhatMirrorPlanesHold) {
  Solver solver(scene_);
  const VectorField u = solver.solve(random_state(scene_.model, 1.0, 0.0, 1).displacement);
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint32_t p : scene_.model.held[c]) ASSERT_EQ(u.component[c][p], 0.0);
}

TEST_P(VCycle, LiesBetweenAShareOfTheInverseAndTheInverse) {
  EXPECT_LT(dominant(scene_, 0.0), 1.0 + 1e-5);
  EXPECT_GT(dominant(scene_, 0.0), 0.8);
  EXPECT_GT(dominant(scene_, 1.0), 0.18);
}

INSTANTIATE_TEST_SUITE_P(Steps, VCycle,
                         testing::Combine(testing::Values(4, 6, 8),
                                          testing::Values(1e-5, 2.5e-4, 1e-3), testing::Bool(),
                                          testing::Values(1, 4)));

/// Of a load that is its own mirror image: the coarse grids of a part are parts of the whole's.
TEST_P(VCycleOfAPart, IsThatOfTheWholeTip) {
  const auto& [per_radius, step, touches, sectors] = GetParam();
  const auto solved = [&, n = per_radius, dt = step, tied = touches](int parts) {
    const Scene scene(n, dt, tied, parts, true);
    VectorField load(scene.model.points());
    for (const std::uint32_t i : scene.model.particles) {
      const Vector3 x = scene.model.rest_position(i) / 0.01;
      const Vector3 even(x.x() * std::sin(9.0 * x.z()), x.y() * x.x() * x.x(),
                         std::cos(7.0 * x.y()) + x.z());
      load.set(i, scene.model.mass[i] * (scene.model.grid.axes.transpose() * even));
    }
    return std::pair(scene.model, Solver(scene).solve(held(scene.model, load)));
  };
  const auto [part, of_part] = solved(sectors);
  const auto [whole, of_whole] = solved(1);
  double largest = 0.0, apart = 0.0;
  for (const std::uint32_t i : part.particles) {
    const auto [x, y, z] = whole.grid.nearest(part.rest_position(i));
    const std::size_t other = whole.grid.index(x, y, z);
    ASSERT_LT((whole.rest_position(other) - part.rest_position(i)).norm(), 1e-12);
    largest = std::max(largest, of_part.at(i).norm());
    apart = std::max(apart, (of_part.at(i) - of_whole.at(other)).norm());
  }
  EXPECT_LT(apart, 1e-5 * largest);
}

INSTANTIATE_TEST_SUITE_P(Steps, VCycleOfAPart,
                         testing::Combine(testing::Values(4, 6, 8, 9), testing::Values(1e-5, 1e-3),
                                          testing::Bool(), testing::Values(2, 4)));
