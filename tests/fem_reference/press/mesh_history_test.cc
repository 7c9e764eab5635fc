#include "fem_reference/press/mesh_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "fem_reference/job/run_tables.h"
#include "fem_reference/runs/run_files.h"
#include "meshes/tables/table_rows.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::LinearSolver;
using fem_reference::MeshHistory;
using fem_reference::MeshSummary;
using fem_reference::PressState;

namespace {

MeshSummary mesh(std::size_t unknowns) {
  return {unknowns / 20, unknowns, unknowns / 100, LinearSolver::condensed};
}

/// A state whose nodes at the contact edge are `spacing` apart.
PressState state(double indentation, double force, double spacing) {
  PressState result;
  result.indentation = indentation;
  result.normal_force = force;
  result.contact_radius = std::sqrt(indentation * 0.01);
  result.markers = meshes::marker_rows({{0.0, 0.0, 8e-3}}, {{0.0, 0.0, -0.7 * indentation}});
  result.max_pressure = 1e5 * force;
  for (const double pressure : {1e5 * force, 1.0 / 3.0}) {
    meshes::ContactPoint& point = result.contact.emplace_back();
    point.place = {1.0 / 3.0, 0.0, 0.01};
    point.normal_traction = pressure;
    point.state = meshes::ContactState::slip;
  }
  result.node_spacing = spacing;
  result.min_jacobian = 0.9;
  result.energy = force * indentation / 3;
  result.steps = 3;
  result.newton_iterations = 12;
  result.active_set_iterations = 14;
  result.cg_iterations = 150;
  result.active_nodes = 7;
  result.sliding_nodes = 2;
  result.wall_time = 0.5;
  return result;
}

/// Node spacings of three meshes [m], each 1.5 times finer than the last.
constexpr double coarse = 9e-4, medium = 6e-4, fine = 4e-4;

/// Two samples on three meshes, the finest not finished.
MeshHistory three_meshes() {
  MeshHistory history;
  history.start_mesh(mesh(1000));
  history.add(state(1e-3, 1.10, coarse));
  history.add(state(2e-3, 3.30, coarse));
  history.start_mesh(mesh(3000));
  history.add(state(1e-3, 1.02, medium));
  history.add(state(2e-3, 3.06, medium));
  history.start_mesh(mesh(9000));
  history.add(state(1e-3, 1.01, fine));
  return history;
}

/// The formula of force_error.h: h_k/h_n to the power of 1.5, minus 1.
double decay(double coarser, double finer) {
  return std::pow(coarser / finer, 1.5) - 1;
}

TEST(MeshHistory, BestIsTheFinestMeshThatHasTheSample) {
  const auto best = three_meshes().best();
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0].normal_force, 1.01);
  EXPECT_EQ(best[1].normal_force, 3.06);
  EXPECT_TRUE(MeshHistory().best().empty());
}

TEST(MeshHistory, ErrorsComeFromTheMeshesThatHaveTheSample) {
  const MeshHistory history = three_meshes();
  const double three = 1.25 * std::max(0.01 / decay(medium, fine), 0.09 / decay(coarse, fine));
  const double two = 3.0 * 0.24 / decay(coarse, medium);
  EXPECT_NEAR(history.error(0).value, three, 1e-12);
  EXPECT_NEAR(history.error(1).value, two, 1e-12);
  EXPECT_NEAR(history.best()[0].force_error, three, 1e-12);
  EXPECT_NEAR(history.worst_relative_error(), two / 3.06, 1e-12);
}

TEST(MeshHistory, OneMeshTellsNoError) {
  MeshHistory history;
  history.start_mesh(mesh(1000));
  history.add(state(1e-3, 1.0, coarse));
  EXPECT_TRUE(std::isnan(history.error(0).value));
  EXPECT_TRUE(std::isnan(history.worst_relative_error()));
  EXPECT_TRUE(std::isnan(history.best()[0].force_error));
  // A second mesh that has not reached the second sample leaves that one unknown.
  history.add(state(2e-3, 3.0, coarse));
  history.start_mesh(mesh(3000));
  history.add(state(1e-3, 1.01, medium));
  EXPECT_FALSE(std::isnan(history.best()[0].force_error));
  EXPECT_TRUE(std::isnan(history.worst_relative_error()));
}

/// A mesh that was refined elsewhere has the better force, but tells nothing about the error.
TEST(MeshHistory, MeshesThatAreNoFinerAtTheEdgeCountAsOne) {
  MeshHistory history = three_meshes();
  history.start_mesh(mesh(20000));
  history.add(state(1e-3, 1.012, fine));
  const double expected = 1.25 * std::max(0.008 / decay(medium, fine), 0.088 / decay(coarse, fine));
  EXPECT_NEAR(history.error(0).value, expected, 1e-12);
  EXPECT_EQ(history.best()[0].normal_force, 1.012);
}

/// No edge of a pad moves, and no refinement goes there: how fine a mesh is tells the energy that
/// it stores in excess.
TEST(MeshHistory, MeshesOfAPadAreMeasuredByTheirEnergy) {
  MeshHistory history;
  const auto add = [&](double force, double share) {
    PressState pad = state(1e-3, force, fine);
    pad.free_edge = false;
    pad.indicator = share * pad.energy;
    history.start_mesh(mesh(std::size_t(1.0 / share)));
    history.add(pad);
  };
  // Of h by which `coarse`, `medium` and `fine` differ.
  add(1.10, 81e-4);
  add(1.02, 36e-4);
  add(1.01, 16e-4);
  const double three = 1.25 * std::max(0.01 / decay(medium, fine), 0.09 / decay(coarse, fine));
  EXPECT_NEAR(history.error(0).value, three, 1e-12);
  const PressState best = history.best()[0];
  EXPECT_NEAR(best.contact_radius_error, three / 1.01 * best.contact_radius, 1e-12);
}

/// As the force's, here of values in proportion to it, with floors of their own.
TEST(MeshHistory, RadiusAndPressureHaveErrors) {
  MeshHistory history = three_meshes();
  const double three = history.error(0).value, share = three / 1.01;
  PressState& finest = history.finest().states[0];
  const double a = finest.contact_radius, p = finest.max_pressure;
  EXPECT_NEAR(history.pressure_error(0), 2.0 * share * p, 1e-9 * p);
  finest.peak_spacing = a;
  EXPECT_NEAR(history.pressure_error(0), 0.2 * p, 1e-9 * p);
  EXPECT_NEAR(history.radius_error(0), std::max(share * a, 0.3 * fine), 1e-12);
  finest.contact_radius = 1.1 * a;  // the meshes before said a
  EXPECT_NEAR(history.radius_error(0), 1.25 * 0.1 * a / decay(medium, fine), 1e-12);
  EXPECT_NEAR(history.best()[0].contact_radius_error, history.radius_error(0), 1e-15);
  EXPECT_NEAR(history.best()[0].max_pressure_error, 0.2 / 1.21 * p, 1e-9 * p);
  MeshHistory single;
  single.start_mesh(mesh(1000));
  single.add(state(1e-3, 1.0, coarse));
  EXPECT_TRUE(std::isnan(single.best()[0].contact_radius_error));
  EXPECT_TRUE(std::isnan(single.best()[0].max_pressure_error));
}

/// Three samples with the same relative contact: of the second, all meshes agree by chance.
TEST(MeshHistory, ForcesThatAgreeByChanceGetTheTypicalError) {
  MeshHistory history;
  const auto add = [&](double spacing, double first, double second, double third) {
    history.start_mesh(mesh(std::size_t(1.0 / spacing)));
    history.add(state(1e-3, first, spacing));
    history.add(state(2e-3, second, spacing));
    history.add(state(3e-3, third, spacing));
  };
  add(coarse, 1.01, 3.0, 5.05);
  add(medium, 1.01, 3.0, 5.05);
  add(fine, 1.00, 3.0, 5.00);
  const double single = 1.25 * 0.01 / decay(medium, fine);  // of the first, over its force
  EXPECT_NEAR(history.error(0).value, single, 1e-12);
  // (h/a)² falls as 1/indentation in this history; the median of (single, 0, 3 single) is single.
  EXPECT_NEAR(history.error(1).value, 3.0 * single / 2.0, 1e-12);
  EXPECT_NEAR(history.error(2).value, 5.0 * single, 1e-12);
  EXPECT_EQ(history.error(1).convergence, fem_reference::MeshConvergence::unknown);
}

/// Under stick the radius of what sticks jumps with the nodes, and a torque with it in the first
/// order: refinement by 1.5 tells less of it than of a force.
TEST(MeshHistory, VectorsHaveNoiseOfTheFirstOrder) {
  MeshHistory history;
  const auto add = [&](double spacing, double force, double aside, double turn) {
    history.start_mesh(mesh(std::size_t(1.0 / spacing)));
    PressState next = state(1e-3, force, spacing);
    next.lateral_force_x = aside;
    next.lateral_force_y = 0.0;
    next.torque_x = 0.0;
    next.torque_y = 0.75 * turn;
    next.torque_z = turn;
    history.add(next);
  };
  add(coarse, 1.0001, 0.25, 0.020);
  add(medium, 1.0, 0.22, 0.018);
  add(fine, 1.0, 0.21, 0.017);
  const auto decay_of_noise = [](double coarser) { return std::pow(coarser / fine, 0.75) - 1.0; };
  const auto told = [&](double to_medium, double to_coarse) {
    return 1.25 * std::max(to_medium / decay_of_noise(medium), to_coarse / decay_of_noise(coarse));
  };
  const PressState best = history.best().front();
  EXPECT_NEAR(best.lateral_force_error, told(0.01, 0.04), 1e-12);
  EXPECT_NEAR(best.torque_error, 1.25 * told(0.001, 0.003), 1e-12) << "of a length of 5/4";
  EXPECT_LT(best.force_error, 1e-3) << "nothing of it goes over to the force";
}

/// Radii of what sticks that are off by a share of the node spacing which meshes have in common,
/// and by another that each draws anew: of torques that go as a³ 95 % are within what three meshes
/// tell.
TEST(MeshHistory, TorquesOfRadiiThatJumpFromNodeToNodeAreWithinTheirErrors) {
  std::mt19937 numbers(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int within = 0;
  constexpr int count = 2000;
  for (int n = 0; n < count; ++n) {
    MeshHistory history;
    double spacing = 2e-4, last = 0.0;
    const double bias = uniform(numbers) - 0.5;
    for (int m = 0; m < 3; ++m, spacing /= 1.2 + 0.4 * uniform(numbers)) {
      const double radius = 3e-3 + spacing * (bias + uniform(numbers) - 0.5);
      last = std::pow(radius / 3e-3, 3);
      history.start_mesh(mesh(std::size_t(1e3) << m));
      PressState next = state(1e-3, 1.0, spacing);
      next.lateral_force_x = next.lateral_force_y = next.torque_x = next.torque_y = 0.0;
      next.torque_z = last;
      history.add(next);
    }
    within += std::abs(last - 1.0) <= history.best().front().torque_error;
  }
  EXPECT_GE(within, 0.95 * count);
}

/// What no refinement touches, the indicators show.
TEST(MeshHistory, ErrorIndicatorsRaiseTheBar) {
  MeshHistory history = three_meshes();
  const double before = history.error(0).value;
  PressState& finest = history.finest().states[0];
  finest.indicator = 1e-3 * finest.energy;
  EXPECT_EQ(history.error(0).value, before);
  finest.indicator = 0.1 * finest.energy;
  EXPECT_NEAR(history.error(0).value, 0.2 * 1.01, 1e-12);
  EXPECT_NEAR(MeshHistory::from_json(history.to_json(), MeshHistory(1.0, 0.0, true)).error(0).value,
              0.1 * 1.01, 1e-12);
}

TEST(MeshHistory, AddsWhatTheStepsAreOff) {
  MeshHistory history = three_meshes();
  const double before = history.error(0).value;
  history.set_step_errors({1e-3, 0.0});
  EXPECT_NEAR(history.error(0).value, before + 1e-3 * 1.01, 1e-12);
}

TEST(MeshHistory, SmallForcesOfAProgramNeedNoBetterErrorThanLargeOnes) {
  const auto with = [](double min_share) {
    MeshHistory history(1.0, min_share);
    for (const double spacing : {coarse, medium, fine}) {
      history.start_mesh(mesh(std::size_t(1e-7 / (spacing * spacing * spacing))));
      history.add(state(1e-3, 1.0 + 100.0 * spacing * spacing, spacing));
      history.add(state(1e-3, 0.01 + 100.0 * spacing * spacing, spacing));
      PressState open = state(0.0, 0.0, 0.0);
      open.contact.clear();
      open.energy = 0.0;
      history.add(open);
    }
    return history;
  };
  const MeshHistory strict = with(0.0), program = with(0.1);
  EXPECT_EQ(program.error(2).value, 0.0);
  EXPECT_NEAR(program.worst_relative_error(), 0.1 * strict.worst_relative_error(), 1e-6);
  const double between = 0.5 * strict.worst_relative_error();
  EXPECT_EQ(strict.beyond(between), (std::vector<char>{0, 1, 0}));
  EXPECT_EQ(program.beyond(between), (std::vector<char>{0, 0, 0}));
}

TEST(MeshHistory, AddsUpTheTimeOfAMesh) {
  MeshHistory history = three_meshes();
  EXPECT_EQ(history.meshes()[0].wall_time, 1.0);
  EXPECT_EQ(history.finest().wall_time, 0.5);
}

TEST(MeshHistory, SurvivesJson) {
  const MeshHistory history = three_meshes();
  const std::string text = history.to_json().dump();
  const MeshHistory read = MeshHistory::from_json(nlohmann::json::parse(text));
  EXPECT_EQ(read.to_json().dump(), text);
  ASSERT_EQ(read.meshes().size(), 3u);
  const auto& mesh_read = read.meshes()[1].mesh;
  EXPECT_EQ(mesh_read.cells, 150u);
  EXPECT_EQ(mesh_read.unknowns, 3000u);
  EXPECT_EQ(mesh_read.contact_unknowns, 30u);
  EXPECT_EQ(mesh_read.solver, LinearSolver::condensed);
  const PressState &a = history.meshes()[0].states[1], &b = read.meshes()[0].states[1];
  EXPECT_EQ(b.indentation, a.indentation);
  EXPECT_EQ(b.normal_force, a.normal_force);
  EXPECT_EQ(b.contact_radius, a.contact_radius);  // to the last bit
  EXPECT_EQ(b.max_pressure, a.max_pressure);
  EXPECT_TRUE(std::isnan(b.lateral_force_x));
  EXPECT_TRUE(std::isnan(b.time));
  EXPECT_EQ(b.contact.size(), 2u);
  EXPECT_EQ(b.contact[1].place, a.contact[1].place);
  ASSERT_EQ(b.markers.size(), 1u);
  EXPECT_EQ(b.markers[0].displacement, a.markers[0].displacement);
  EXPECT_EQ(b.contact[1].normal_traction, 1.0 / 3.0);
  EXPECT_EQ(b.contact[1].state, meshes::ContactState::slip);
  EXPECT_EQ(b.node_spacing, a.node_spacing);
  EXPECT_EQ(b.min_jacobian, a.min_jacobian);
  EXPECT_EQ(b.energy, a.energy);
  EXPECT_EQ(b.indicator, a.indicator);
  EXPECT_EQ(b.steps, a.steps);
  EXPECT_EQ(b.newton_iterations, a.newton_iterations);
  EXPECT_EQ(b.active_set_iterations, a.active_set_iterations);
  EXPECT_EQ(b.cg_iterations, a.cg_iterations);
  EXPECT_EQ(b.active_nodes, a.active_nodes);
  EXPECT_EQ(b.sliding_nodes, a.sliding_nodes);
  EXPECT_EQ(b.wall_time, a.wall_time);
  EXPECT_EQ(read.worst_relative_error(), history.worst_relative_error());
  MeshHistory pad = three_meshes();
  pad.finest().states[0].free_edge = false;
  pad.finest().states[0].peak_spacing = 1e-4 / 3.0;
  const MeshHistory again = MeshHistory::from_json(nlohmann::json::parse(pad.to_json().dump()));
  EXPECT_FALSE(again.meshes()[2].states[0].free_edge);
  EXPECT_EQ(again.meshes()[2].states[0].peak_spacing, 1e-4 / 3.0);
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(RunFiles, SamplesAreTheBestOnesWithTheirErrors) {
  const TemporaryFolder folder;
  fem_reference::ReferenceJob job;
  job.protocol.markers = {{0.0, 0.0, 8e-3}, {3e-3, 0.0, 0.0}};
  std::vector<PressState> best = three_meshes().best();
  for (PressState& sample : best)
    sample.markers = meshes::marker_rows(
        job.protocol.markers, {{0.0, 0.0, -0.8 * sample.indentation}, meshes::Vector3::Zero()});
  fem_reference::write_samples(best, job, folder.path());
  const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
  ASSERT_EQ(response.samples().size(), 2u);
  EXPECT_EQ(response.samples()[0].normal_force, 1.01);
  EXPECT_NEAR(response.samples()[0].force_error, three_meshes().error(0).value, 1e-12);
  const auto markers = meshes::read_rows<meshes::MarkerRow>(folder / "markers.csv");
  ASSERT_EQ(markers.size(), 4u);
  const meshes::PressSample& sample = response.samples()[0];
  const double off = sample.force_error / sample.normal_force * sample.indentation;
  ASSERT_GT(sample.contact_radius, 2e-3);
  EXPECT_NEAR(markers[0].error, off, 1e-12) << "in the contact of all of the way";
  EXPECT_NEAR(markers[1].error, std::pow(sample.contact_radius / std::hypot(3e-3, 10e-3), 2) * off,
              1e-12);
  const auto points = meshes::read_rows<meshes::ContactPoint>(folder / "contact_field.csv");
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[3].sample, 2);
  EXPECT_EQ(points[3].indentation, response.samples()[1].indentation);
  EXPECT_EQ(points[3].normal_traction, 1.0 / 3.0);
}

TEST(RunFiles, ConvergenceHasARowPerMeshAndSample) {
  const TemporaryFolder folder;
  fem_reference::write_convergence(three_meshes(), folder.path());
  const auto lines = lines_of(folder / "convergence.csv");
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0].substr(0, 31), "mesh,cells,unknowns,indentation");
  EXPECT_EQ(lines[5].substr(0, 11), "3,450,9000,");
  EXPECT_NE(lines[5].find(",1.01,"), std::string::npos);
}

TEST(RunFiles, SectionAndFieldSeriesNameWhatIsThere) {
  const TemporaryFolder folder;
  meshes::write_rows(std::vector<fem_reference::SectionRow>{{{0, 1, 2, 3}, {0, 1, 2, 2.5}}},
                     folder.path() / "section.csv");
  const auto section = lines_of(folder / "section.csv");
  ASSERT_EQ(section.size(), 2u);
  EXPECT_EQ(section[1], "0,1,2,3,0,1,2,2.5");

  EXPECT_EQ(fem_reference::field_name(0), "press_0001.vtu");
  EXPECT_EQ(fem_reference::field_name(11), "press_0012.vtu");
  std::filesystem::create_directories(folder / "fields");
  write_text(folder / "fields/press_0002.vtu", "");
  fem_reference::write_field_series({1e-3, 2e-3}, folder.path());
  const std::string series = read_text(folder / "fields/press.pvd");
  EXPECT_EQ(series.find("press_0001.vtu"), std::string::npos);  // not written, not named
  EXPECT_NE(series.find("timestep=\"0.002\" part=\"0\" file=\"press_0002.vtu\""),
            std::string::npos);
}

}  // namespace
