#include "fem_reference/runs/runs.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_generator.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/motion/generalised_alpha.h"
#include "fem_reference/motion/transient_press.h"
#include "fem_reference/press/press.h"
#include "fem_reference/press/press_course.h"
#include "fem_reference/solvers/eigen_solver.h"
#include "fem_reference/tip/tip_body.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using namespace fingertip::fem_reference;
using meshes::ContactMode;

namespace {

// --- The integrator, without contact. ---

/// Free vibration of one mode of a small tip.
struct FreeVibration {
  explicit FreeVibration(double retardation_time)
      : body(read_tip<3>(MPI_COMM_WORLD, mesh.file(), 2, 0.0)),
        stiffness(rubber, Volumetric::mean_dilatation),
        mass(rubber.density),
        tau(retardation_time) {
    body->number(tip_supports<3>());
    const auto pair = lowest_eigenpairs(*body, stiffness, mass, 1).front();
    shape = pair.shape;
    omega = std::sqrt(pair.eigenvalue);
  }

  /// Amplitude of the mode after `time` from amplitude 1, in `steps` steps.
  double amplitude_after(double time, int steps, LinearMemory<3> memory = {}) {
    auto solver = make_condensed_solver(*body, {});
    GeneralisedAlpha<3> motion(*body, stiffness, mass, tau, false, std::move(memory));
    Vector acceleration = shape, zero = body->fine.vector();
    acceleration *= -omega * omega;
    motion.set_state(shape, zero, acceleration);
    motion.set_step(time / steps, *solver);
    for (int i = 0; i < steps; ++i) {
      solver->set_load(motion.load());
      solver->solve_constrained({}, Eigen::VectorXd(0), Eigen::VectorXd(0));
      motion.advance(solver->field());
    }
    // The shape is M-orthonormal and stays alone: u = q v.
    return (motion.displacement() * shape) / (shape * shape);
  }

  /// q'' + tau omega² q' + omega² q = 0 from q = 1 at rest: zeta = omega tau/2.
  double exact_after(double time) const {
    const double zeta = omega * tau / 2, damped = omega * std::sqrt(1 - zeta * zeta);
    return std::exp(-zeta * omega * time) *
           (std::cos(damped * time) + zeta * omega / damped * std::sin(damped * time));
  }

  SharedMesh mesh{0.25};
  meshes::Rubber rubber;
  std::unique_ptr<Body<3>> body;
  HookeKernel<3> stiffness;
  MassKernel<3> mass;
  double tau;
  Vector shape;
  double omega = 0.0;
};

TEST(GeneralisedAlpha, FollowsAModeAtSecondOrder) {
  for (const double tau : {0.0, 0.3e-3}) {
    FreeVibration vibration(tau);
    const double time = 1.3 * 2 * std::numbers::pi / vibration.omega;
    const double exact = vibration.exact_after(time);
    const double coarse = vibration.amplitude_after(time, 64) - exact;
    const double fine = vibration.amplitude_after(time, 128) - exact;
    const double finest = vibration.amplitude_after(time, 256) - exact;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2.0, 0.15) << tau;
    EXPECT_NEAR(std::log2(std::abs(fine / finest)), 2.0, 0.1) << tau;
    // Extrapolated, it is the exact motion.
    EXPECT_LT(std::abs(finest + (finest - fine) / 3), 0.03 * std::abs(finest)) << tau;
  }
}

TEST(GeneralisedAlpha, FollowsAModeOfARubberThatRelaxes) {
  // q'' + omega² (q + b d) = 0, d' + d/tau = q': three first-order equations, solved by their
  // eigenvectors.
  FreeVibration vibration(0.0);
  const double omega = vibration.omega, tau = 0.7 / omega, time = 8.0 / omega;
  ReferenceJob job;
  job.rubber.relaxation = {{{0.4, tau}}, true};
  const double b = job.rubber.relaxation.relative_modulus(0);
  Eigen::Matrix3d rates;
  rates << 0, 1, 0, -omega * omega, 0, -b * omega * omega, 0, 1, -1 / tau;
  const Eigen::EigenSolver<Eigen::Matrix3d> solver(rates);
  const Eigen::Vector3cd start =
      solver.eigenvectors().fullPivLu().solve(Eigen::Vector3cd(1.0, 0.0, 0.0));
  const Eigen::Vector3cd end =
      ((solver.eigenvalues() * time).array().exp() * start.array()).matrix();
  const double exact = (solver.eigenvectors() * end)[0].real();
  std::vector<double> errors;
  for (const int steps : {256, 512, 1024}) {
    LinearMemory<3> memory(*vibration.body, job);
    const double found = vibration.amplitude_after(time, steps, std::move(memory));
    errors.push_back(std::abs(found - exact));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.15);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.1);
  EXPECT_LT(errors[2], 1e-3);
}

TEST(GeneralisedAlpha, KeepsWhatMovesUniformlyAndKnowsItsMass) {
  // A box that slides freely along x between smooth walls: no force, momentum m v for ever.
  const meshes::Rubber rubber;
  Body<3> body(MPI_COMM_WORLD, 2);
  dealii::GridGenerator::subdivided_hyper_rectangle(
      body.triangulation, {2, 1, 1}, dealii::Point<3>(), dealii::Point<3>(0.02, 0.01, 0.005), true);
  body.number({{2, 1}, {3, 1}, {4, 2}, {5, 2}});
  HookeKernel<3> stiffness(rubber, Volumetric::pointwise);
  MassKernel<3> mass(rubber.density);
  GeneralisedAlpha<3> motion(body, stiffness, mass, 1e-3, false);
  Vector u = body.fine.vector(), v = u, zero = u;
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    std::vector<dealii::types::global_dof_index> indices(body.fine.element.n_dofs_per_cell());
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < indices.size(); ++i)
      if (body.fine.element.system_to_component_index(i).first == 0) v[indices[i]] = 0.7;
  }
  v.compress(dealii::VectorOperation::insert);
  motion.set_state(u, v, zero);
  auto solver = make_condensed_solver(body, {});
  motion.set_step(1e-3, *solver);
  for (int i = 0; i < 5; ++i) {
    solver->set_load(motion.load());
    solver->solve_constrained({}, Eigen::VectorXd(0), Eigen::VectorXd(0));
    motion.advance(solver->field());
  }
  const double body_mass = rubber.density * 0.02 * 0.01 * 0.005;
  EXPECT_NEAR(motion.momentum().x(), 0.7 * body_mass, 1e-9 * body_mass);
  EXPECT_NEAR(motion.energy().kinetic, 0.5 * 0.49 * body_mass, 1e-9 * body_mass);
  EXPECT_NEAR(motion.momentum_rate().norm(), 0.0, 1e-6 * body_mass);
  EXPECT_NEAR(motion.displacement().linfty_norm(), 5e-3 * 0.7, 1e-9);
}

/// A bar bonded at one end, hit at the other by a wall of constant speed: one-dimensional by smooth
/// side walls. Exact: sigma = rho c_p V behind the front until it returns from the bond.
TEST(GeneralisedAlpha, CarriesAPressureWaveAtItsSpeed) {
  constexpr double length = 0.02, width = 1e-3, speed = 0.01;
  const meshes::Rubber rubber;
  Body<3> body(MPI_COMM_WORLD, 2);
  dealii::GridGenerator::subdivided_hyper_rectangle(body.triangulation, {80, 1, 1},
                                                    dealii::Point<3>(),
                                                    dealii::Point<3>(length, width, width), true);
  body.number({{0, 0}, {0, 1}, {0, 2}, {2, 1}, {3, 1}, {4, 2}, {5, 2}});
  HookeKernel<3> stiffness(rubber, Volumetric::pointwise);
  MassKernel<3> mass(rubber.density);
  std::vector<long> face;  // x unknowns of the free end
  const dealii::IndexSet end = dealii::DoFTools::extract_boundary_dofs(
      body.fine.dofs, dealii::ComponentMask({true, false, false}), {1});
  for (const auto i : end) face.push_back(long(i));
  auto solver = make_condensed_solver(body, face);
  GeneralisedAlpha<3> motion(body, stiffness, mass, 0.0, false);
  const double transit = length / rubber.longitudinal_wave_speed();
  constexpr int steps = 400;  // a transit
  motion.set_step(transit / steps, *solver);
  const auto count = Eigen::Index(face.size());
  const std::vector<char> held(face.size(), 1);
  const double pressure = rubber.density * rubber.longitudinal_wave_speed() * speed * width * width;
  const auto advance_to = [&](int step) {
    solver->set_load(motion.load());
    const auto end_state = solver->solve_constrained(
        held, Eigen::VectorXd::Constant(count, -speed * transit * step / steps),
        Eigen::VectorXd::Zero(count));
    motion.advance(solver->field());
    return -end_state.reaction.sum();
  };
  double contact = 0.0, bond = 0.0;
  for (int step = 1; step <= 8 * steps / 10; ++step) {
    contact = advance_to(step);
    bond = contact + motion.momentum_rate().x();
    if (step < 7 * steps / 10) {
      EXPECT_LT(std::abs(bond), 0.02 * pressure) << step;
    }
  }
  EXPECT_NEAR(contact / pressure, 1.0, 0.02);
  EXPECT_NEAR(motion.momentum().x() / (-pressure * 0.8 * transit), 1.0, 0.01);
  // The front is reflected at the bond, where the pressure doubles.
  for (int step = 8 * steps / 10 + 1; step <= 13 * steps / 10; ++step)
    bond = advance_to(step) + motion.momentum_rate().x();
  EXPECT_NEAR(bond / pressure, 2.0, 0.04);
}

// --- The press. ---

struct Press {
  explicit Press(double speed, ContactMode contact = ContactMode::frictionless) {
    job.analysis = Analysis::transient;
    job.protocol.contact = contact;
    job.symmetry = fingertip::fem_reference::Symmetry::none;
    job.protocol.speed = speed;
    job.press_to({5e-4, 1e-3, 2e-3});
  }
  std::unique_ptr<TransientPress> transient() const { return TransientPress::on(job, mesh.file()); }
  double static_force(double indentation) const {
    return ContinuumPress::on(job, mesh.file())->advance(indentation).normal_force;
  }
  SharedMesh mesh{0.35};
  ReferenceJob job;
};

TEST(TransientPress, IsTheStaticPressWhenSlow) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    Press press(1e-5, contact);
    const auto transient = press.transient();
    for (const double indentation : press.job.protocol.samples)
      EXPECT_NEAR(transient->advance(indentation).normal_force / press.static_force(indentation),
                  1.0, contact == ContactMode::frictionless ? 2e-5 : 1e-3)
          << meshes::name(contact) << " " << indentation;
  }
}

TEST(TransientPress, ForceConvergesWithTheStep) {
  for (const double speed : {0.01, 0.2}) {
    Press press(speed);
    std::vector<std::vector<double>> forces;
    for (const double factor : {2.0, 1.0, 0.25}) {
      const auto transient = press.transient();
      transient->set_step_factor(factor);
      forces.emplace_back();
      for (const double indentation : press.job.protocol.samples)
        forces.back().push_back(transient->advance(indentation).normal_force);
    }
    for (std::size_t i = 0; i < press.job.protocol.samples.size(); ++i) {
      const double coarse = std::abs(forces[0][i] / forces[2][i] - 1);
      const double fine = std::abs(forces[1][i] / forces[2][i] - 1);
      EXPECT_LT(fine, 1.5e-3) << speed << " " << i;
      EXPECT_LT(fine, std::max(coarse, 2e-4)) << speed << " " << i;
    }
  }
}

TEST(TransientPress, BalancesEnergyAndMomentum) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    Press press(0.2, contact);
    const auto transient = press.transient();
    for (const double indentation : press.job.protocol.samples) transient->advance(indentation);
    const TransientStep& end = transient->steps().back();
    const double spent = end.kinetic_energy + end.elastic_energy + end.dissipated_energy;
    EXPECT_GT(end.dissipated_energy, 0.02 * end.work);
    EXPECT_GT(end.kinetic_energy, 0.0);
    // The method takes a little energy itself, and never gives any.
    EXPECT_LT(spent, end.work * (1 + 1e-3)) << meshes::name(contact);
    EXPECT_GT(spent, end.work * (1 - 1e-2)) << meshes::name(contact);

    // d(momentum)/dt = contact force - force on the rod, integrated with the method's own rule:
    // v' = -v/2 + ... is not trapezoidal, hence of second order only.
    double impulse = 0.0, scale = 0.0;
    const auto& steps = transient->steps();
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const double dt = steps[i].time - steps[i - 1].time;
      impulse += 0.5 * dt *
                 (steps[i].contact_force - steps[i].normal_force + steps[i - 1].contact_force -
                  steps[i - 1].normal_force);
      scale += dt * steps[i].contact_force;
    }
    EXPECT_NEAR(end.momentum, impulse, 2e-3 * scale) << meshes::name(contact);
  }
}

TEST(TransientPress, BalancesEnergyAndMomentumOfARubberThatRelaxesOnAProgram) {
  for (const bool bulk : {true, false}) {
    Press press(0.1);
    press.job.rubber.retardation_time = 1e-4;
    press.job.rubber.relaxation = {{{0.2, 2e-3}, {0.2, 0.02}}, bulk};
    press.job.protocol.program = {{2e-3, 0.1, 0.0}, {2e-3, 0.0, 0.05}, {5e-4, 0.05, 0.0}};
    const auto transient = press.transient();
    const PressCourse course(press.job.protocol, true);
    double max_inertia = 0.0, max_work = 0.0;
    for (const double place : course.samples()) {
      const PressState state = transient->advance(place);
      const TransientStep& now = transient->steps().back();
      // Of the bond itself, whose nodes the rod's acceleration loads, too.
      EXPECT_NEAR(transient->bond_force() / state.normal_force, 1.0, 1e-6) << place;
      const double spent = now.kinetic_energy + now.elastic_energy + now.dissipated_energy;
      max_work = std::max(max_work, now.work);
      EXPECT_LT(spent, now.work + 3e-3 * max_work) << place;
      EXPECT_GT(spent, now.work - 1e-2 * max_work) << place;
      max_inertia = std::max(max_inertia, std::abs(now.contact_force / now.normal_force - 1.0));
    }
    EXPECT_GT(max_inertia, 1e-3);
    const auto& steps = transient->steps();
    EXPECT_GT(steps.back().dissipated_energy, 0.05 * steps.back().work);
  }
}

TEST(TransientPress, IsTheRelaxingPressWithoutInertia) {
  Press press(0.02);
  press.job.rubber.retardation_time = 0.0;
  press.job.rubber.relaxation = {{{0.3, 0.01}, {0.2, 0.1}}, true};
  press.job.protocol.program = {{2e-3, 0.02, 0.0}, {2e-3, 0.0, 0.2}, {1e-3, 0.02, 0.0}};
  const auto transient = press.transient();
  ReferenceJob still = press.job;
  still.analysis = Analysis::static_press;
  const auto quiet = ContinuumPress::on(still, press.mesh.file());
  const PressCourse course(press.job.protocol, true);
  const double largest = press.static_force(2e-3);
  for (const double place : course.samples()) {
    const double wanted = quiet->advance(place).normal_force;
    EXPECT_NEAR(transient->advance(place).normal_force, wanted, 5e-3 * largest) << place;
  }
}

TEST(TransientPress, ForceIsThatOfTheBond) {
  // The resultant of the bond from the residual there, elastic alone (tau = 0), as K u.
  Press press(0.2);
  press.job.rubber.retardation_time = 0.0;
  const auto transient = press.transient();
  const PressState state = transient->advance(1e-3);
  const double bond = transient->bond_force();
  EXPECT_NEAR(bond / state.normal_force, 1.0, 1e-6);
  // Inertia is at work, or this would tell nothing.
  EXPECT_GT(std::abs(transient->steps().back().contact_force / bond - 1.0), 1e-3);
}

TEST(TransientPress, ViscousForceIsTheTangentStiffnessTimesTauTimesSpeed) {
  // Without inertia K (u + tau u') = reaction: what is in contact moves at the plane's speed, and
  // at a given contact zone the press has the stiffness dF/d(delta), for the edge bears no
  // pressure. Hence F = F_static + tau V dF/d(delta): 0.5, 2.7, 11 % of F here.
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
    for (const double speed : {0.01, 0.05, 0.2}) {
      Press press(speed, contact);
      press.job.rubber.density = 1e-3;
      const double indentation = 1e-3, h = 5e-5;
      const double force = press.transient()->advance(indentation).normal_force;
      const double still = press.static_force(indentation);
      const double stiffness =
          (press.static_force(indentation + h) - press.static_force(indentation - h)) / (2 * h);
      const double share = force / still - 1.0;
      const double expected = press.job.rubber.retardation_time * speed * stiffness / still;
      EXPECT_NEAR(share / expected, 1.0, 0.08)
          << meshes::name(contact) << " " << speed << ": " << share << " " << expected;
      RecordProperty(std::string(meshes::name(contact)) + std::to_string(speed),
                     std::to_string(share) + " " + std::to_string(expected));
    }
}

TEST(TransientRun, WritesWhatTheContractSays) {
  const SharedFolder folder;
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.analysis = Analysis::transient;
  job.protocol.contact = ContactMode::frictionless;
  job.press_to({5e-4, 1e-3});
  job.protocol.speed = 0.05;
  job.refinement = 0.25;
  job.tolerance = 0.05;
  std::ostringstream progress;
  const RunOutcome outcome = run_transient(folder.path(), job, progress, [] { return false; });
  ASSERT_EQ(outcome.status, RunOutcome::Status::ok) << outcome.message;
  MPI_Barrier(MPI_COMM_WORLD);
  const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
  ASSERT_EQ(response.samples().size(), 2U);
  EXPECT_DOUBLE_EQ(response.samples()[1].time, 0.02);
  for (const auto& sample : response.samples()) {
    EXPECT_GT(sample.force_error, 0.0);
    EXPECT_LT(sample.force_error, 0.2 * sample.normal_force);
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "fields" / "press_0002.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder / "meshes"));
  std::ifstream steps(folder / "transient.csv");
  std::string line;
  std::getline(steps, line);
  EXPECT_EQ(line, "time [s],indentation [m],normal_force [N],contact_force [N]");
}

/// Forces at rest may be near on a coarse mesh by chance; those in motion are not.
TEST(TransientRun, BarsOfAMeridianReachTheFinerForce) {
  const auto press = [](double tolerance) {
    const SharedFolder folder;
    ReferenceJob job;
    job.analysis = Analysis::transient;
    job.press_to({1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3});
    job.protocol.clearance = 5e-3;
    job.protocol.speed = 0.05;
    job.tolerance = tolerance;
    job.write_fields = false;
    std::ostringstream progress;
    run_transient(folder.path(), job, progress, [] { return false; });
    return meshes::PressResponse::read_csv(folder / "response.csv");
  };
  const auto coarse = press(0.01), fine = press(0.002);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto &a = coarse.samples().at(i), &b = fine.samples().at(i);
    EXPECT_NEAR(a.normal_force, b.normal_force, a.force_error + b.force_error) << i;
    EXPECT_LT(a.force_error, 0.01 * a.normal_force) << i;
  }
}

TEST(TransientRun, KeepsFinishedSamplesWhenStopped) {
  const SharedFolder folder;
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.analysis = Analysis::transient;
  job.protocol.contact = ContactMode::frictionless;
  job.press_to({2e-4, 1e-3});
  job.refinement = 0.25;
  job.estimate_error = false;
  job.write_fields = false;
  std::ostringstream progress;
  int asked = 0;
  const RunOutcome outcome =
      run_transient(folder.path(), job, progress, [&] { return ++asked > 40; });
  EXPECT_EQ(outcome.status, RunOutcome::Status::interrupted);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(meshes::PressResponse::read_csv(folder / "response.csv").samples().size(), 1U);
}

}  // namespace
