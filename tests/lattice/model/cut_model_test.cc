#include "lattice/model/cut_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "lattice/contact/tied_bond.h"
#include "lattice/forces/energy.h"
#include "lattice/forces/forces.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::EmbeddedPoint;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::LatticeSettings;
using lattice::ModelKind;
using lattice::State;

namespace {

const meshes::Rubber rubber;
const meshes::Geometry geometry;

Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).matrix();
}

LatticeSettings turned(LatticeSettings settings) {
  settings.axes = some_rotation();
  settings.offset = Vector3(0.3, -0.2, 0.1);
  return settings;
}

/// Largest eigenvalue of every particle's own block of K over its mass [1/s²]. No two particles
/// three points apart share a spring or a cell, so that 27 sets of particles can be moved at once.
std::vector<double> own_frequencies(const LatticeModel& model) {
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  const std::size_t nx = std::size_t(model.grid.size[0]), ny = std::size_t(model.grid.size[1]);
  const auto set_of = [&](std::size_t i) {
    return i % nx % 3 + 3 * (i / nx % ny % 3) + 9 * (i / (nx * ny) % 3);
  };
  std::vector<Eigen::Matrix3d> blocks(model.points(), Eigen::Matrix3d::Zero());
  const double h = 1e-6 * model.spacing();
  for (std::size_t set = 0; set < 27; ++set) {
    for (int c = 0; c < 3; ++c) {
      for (const double sign : {1.0, -1.0}) {
        State state(model);
        for (const std::size_t i : model.particles) {
          if (set_of(i) == set) state.displacement.set(i, sign * h * Vector3::Unit(c));
        }
        lattice::VectorField force(model.points());
        forces.accumulate(state, force);
        for (const std::size_t i : model.particles) {
          if (set_of(i) == set) blocks[i].col(c) -= sign / (2.0 * h) * force.at(i);
        }
      }
    }
  }
  std::vector<double> result;
  for (const std::size_t i : model.particles) {
    const Eigen::Matrix3d symmetric = 0.5 * (blocks[i] + blocks[i].transpose());
    result.push_back(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric).eigenvalues()[2] /
                     model.mass[i]);
  }
  return result;
}

double largest_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Of the particle in the middle of eight whole cells.
double whole_frequency(const LatticeSettings& settings) {
  const LatticeModel model = cell_block(settings, {2, 2, 2});
  return own_frequencies(model).at(13);
}

/// Pairs of particles joined by an edge (`axes_alone`) or by any spring of a cell.
std::size_t pairs_in_cells(const LatticeModel& model, bool axes_alone) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::size_t cell : model.cells) {
    for (int a = 0; a < 8; ++a) {
      for (int b = a + 1; b < 8; ++b) {
        const int apart = a ^ b;
        if (axes_alone && (apart & (apart - 1)) != 0) continue;
        pairs.emplace(lattice::cell_corner(model.grid.size, cell, a),
                      lattice::cell_corner(model.grid.size, cell, b));
      }
    }
  }
  return pairs.size();
}

/// Runs `check(settings, model)` on a straight and on a turned grid.
template <typename Check>
void for_both_grids(ModelKind kind, Kinematics kinematics, int per_radius, const Check& check) {
  const LatticeSettings straight = settings_for(kind, kinematics, per_radius);
  for (const LatticeSettings& settings : {straight, turned(straight)}) {
    SCOPED_TRACE(label(kind, kinematics) + (settings.axes.isIdentity() ? "" : ", turned"));
    check(settings, lattice::build_cut_model(geometry, rubber, settings));
  }
}

template <typename Check>
void for_all_tips(int per_radius, const Check& check) {
  for (const ModelKind kind : cell_models) {
    for (const Kinematics kinematics : both_kinematics) {
      for_both_grids(kind, kinematics, per_radius, check);
    }
  }
}

}  // namespace

TEST(CutModel, WeighsWhatTheRubberWeighsAndLittleMore) {
  const double exact = rubber.density * geometry.tip_volume();
  const auto check = [&](const LatticeSettings&, const LatticeModel& model) {
    EXPECT_NEAR(model.total_mass(), exact + model.added_mass, 1e-5 * exact);
    EXPECT_GT(model.added_mass, 0.0);
    // Central springs are stiffer in the corners of slivers than fibres are.
    EXPECT_LT(model.added_mass, (model.has_springs() ? 0.0125 : 0.006) * exact);
  };
  for_all_tips(8, check);
  for_both_grids(ModelKind::hookean, Kinematics::small, 12, check);
}

TEST(CutModel, NoParticleVibratesMuchFasterThanAmongWholeCells) {
  const auto check = [](const LatticeSettings& settings, const LatticeModel& model) {
    const double ratio = largest_of(own_frequencies(model)) / whole_frequency(settings);
    EXPECT_NEAR(ratio, 1.7, 1e-5);  // reached where mass was added
  };
  for_all_tips(8, check);
  for_both_grids(ModelKind::hookean, Kinematics::small, 12, check);
}

TEST(CutModel, OnlyLightParticlesGainMass) {
  const LatticeSettings settings = settings_for(ModelKind::hookean, Kinematics::small, 8);
  const LatticeModel model = lattice::build_cut_model(geometry, rubber, settings);
  const lattice::LatticeBody body = lattice::build_cut_tip(geometry, rubber, settings, 1);
  const double cube = rubber.density * std::pow(model.spacing(), 3);
  ASSERT_EQ(body.mass.size(), model.particles.size());
  double gained = 0.0;
  for (std::size_t p = 0; p < body.mass.size(); ++p) {
    const double gain = model.mass[model.particles[p]] - body.mass[p];
    EXPECT_GE(gain, -1e-12 * cube);
    EXPECT_LT(gain, 0.2 * cube);
    if (body.mass[p] > 0.5 * cube) {
      EXPECT_LT(gain, 1e-12 * cube);
    }
    EXPECT_DOUBLE_EQ(model.inverse_mass[model.particles[p]], 1.0 / model.mass[model.particles[p]]);
    gained += gain;
  }
  EXPECT_NEAR(gained, model.added_mass, 1e-9 * model.added_mass);
}

TEST(CutModel, SpringsAndFibresAreThoseOfItsCells) {
  for_all_tips(6, [](const LatticeSettings& settings, const LatticeModel& model) {
    const bool springs =
        settings.model == ModelKind::central ||
        (settings.model == ModelKind::hookean && settings.kinematics == Kinematics::finite);
    EXPECT_EQ(model.has_springs(), springs);
    EXPECT_EQ(model.spring_count(), pairs_in_cells(model, !springs));
    // Cells without a law of their own still tell when springs turn them inside out.
    EXPECT_EQ(model.cell_lattice.empty(),
              settings.model == ModelKind::central && settings.kinematics == Kinematics::small);
    EXPECT_TRUE(model.ligaments.empty());
    EXPECT_TRUE(model.is_cut());
  });
}

TEST(CutModel, StoresTheEnergyOfTheBodyThatEquilibriumIsSoughtWith) {
  for_all_tips(6, [](const LatticeSettings& settings, const LatticeModel& model) {
    lattice::LatticeBody body = lattice::build_cut_tip(geometry, rubber, settings, 1);
    State state = random_state(model, 0.03, 0.0, 8);
    Eigen::VectorXd u(body.unknowns());
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      const std::size_t i = model.particles[p];
      ASSERT_LT((model.rest_position(i) - body.rest[p]).norm(), 1e-15);
      u.segment<3>(3 * Eigen::Index(p)) = model.grid.axes * state.displacement.at(i);
    }
    lattice::Team team(1);
    const lattice::TiedBond bond(model, team);
    const double ties = bond.energy(state, lattice::RodState(lattice::rod_body({}, {})));
    const double whole = lattice::ElasticSystem(body).energy(u);
    EXPECT_NEAR(lattice::elastic_energy(model, state) + ties, whole, 1e-11 * whole);
    body.bond.clear();
    const double rubber_alone = lattice::ElasticSystem(body).energy(u);
    EXPECT_NEAR(lattice::elastic_energy(model, state), rubber_alone, 1e-11 * rubber_alone);
    EXPECT_GT(rubber_alone, 1e-3 * whole);
  });
}

TEST(CutModel, EmbeddedPointsLieOnTheTrueSurfacesAndBelongToTheirCorners) {
  for_all_tips(8, [](const LatticeSettings&, const LatticeModel& model) {
    const auto check = [&](const std::vector<EmbeddedPoint>& points, double radius) {
      for (const EmbeddedPoint& point : points) {
        EXPECT_NEAR(meshes::Geometry::radial_distance(point.rest), radius, 1e-12);
        Vector3 at = Vector3::Zero();
        for (std::size_t c = 0; c < 8; ++c) {
          EXPECT_EQ(model.is_particle[point.corners[c]], 1);
          at += point.weights[c] * model.rest_position(point.corners[c]);
        }
        EXPECT_LT((at - point.rest).norm(), 1e-14);
      }
    };
    check(model.bond, geometry.rod_radius);
    check(model.outer, geometry.tip_radius);
  });
}

TEST(CutModel, CentreOfMassStaysWhereTheRubbersIs) {
  // Of the shell between two hemispheres and the sleeve: z by their volumes and centroids.
  const double R = geometry.tip_radius, r = geometry.rod_radius, L = geometry.sleeve_length;
  const double pi = std::numbers::pi;
  const double moment =
      pi / 4.0 * (std::pow(R, 4) - std::pow(r, 4)) - 0.5 * pi * L * L * (R * R - r * r);
  const double centre = moment / geometry.tip_volume();
  for_all_tips(8, [&](const LatticeSettings&, const LatticeModel& model) {
    Vector3 sum = Vector3::Zero();
    for (const std::size_t i : model.particles) sum += model.mass[i] * model.rest_position(i);
    EXPECT_LT((sum / model.total_mass() - Vector3(0.0, 0.0, centre)).norm(), 0.003 * R);
  });
}

TEST(CutModel, AGridTurnedByARightAngleIsTheSameLattice) {
  LatticeSettings settings = settings_for(ModelKind::network, Kinematics::finite, 6);
  const LatticeModel straight = lattice::build_cut_model(geometry, rubber, settings);
  settings.axes << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const LatticeModel turned = lattice::build_cut_model(geometry, rubber, settings);
  ASSERT_EQ(turned.particles.size(), straight.particles.size());
  EXPECT_NEAR(turned.added_mass, straight.added_mass, 1e-9 * straight.added_mass);
  std::vector<double> a(straight.mass), b(turned.mass);
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  for (std::size_t n = 1; n <= straight.particles.size(); ++n) {
    EXPECT_NEAR(a[a.size() - n], b[b.size() - n], 1e-9 * a.back());
  }
  EXPECT_EQ(turned.spring_count(), straight.spring_count());
}
