#include "studies/exchange/lammps_import.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "lattice/forces/energy.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/exchange/lammps_files.h"
#include "studies/exchange/mass_frames.h"
#include "studies/exchange/undamped_march.h"

namespace fingertip::studies {

using lattice::LatticeModel;
using lattice::State;
using meshes::Vector3;

namespace {

TrajectoryRow row_of(const UndampedBody& body, const State& state, double time) {
  TrajectoryRow row;
  row.time = time;
  for (const std::uint32_t i : body.model.particles) {
    row.centre += body.model.mass[i] * lattice::position(body.model, state, i);
  }
  row.centre /= body.model.total_mass();
  row.momentum = lattice::linear_momentum(body.model, state);
  const Energies energy = energies(body, state, time);
  row.kinetic_energy = energy.kinetic;
  row.elastic_energy = energy.elastic;
  const OuterForces outer = outer_forces(body, state, time);
  row.rod_force = outer.rod;
  if (body.wall) row.wall_force = -outer.wall.dot(body.wall->plane.normal);
  return row;
}

double largest_difference(const lattice::VectorField& a, const lattice::VectorField& b,
                          const LatticeModel& model) {
  double largest = 0.0;
  for (const std::uint32_t i : model.particles) {
    const double difference = (a.at(i) - b.at(i)).norm();
    if (!(difference <= largest)) largest = difference;  // keeps a NaN visible
  }
  return largest;
}

/// Our own march, stepped to wherever the next frame is.
class Comparison {
 public:
  Comparison(const UndampedBody& body, int threads) : body_(body), march_(body, threads) {}

  void measure(const LammpsFrame& frame, const State& theirs, TrajectoryRow& row,
               const std::function<bool(long)>& go_on) {
    while (march_.steps() < frame.step) {
      if (go_on && !go_on(march_.steps())) throw meshes::Interrupted("the import was stopped");
      march_.advance();
    }
    const LatticeModel& model = body_.model;
    const State ours = march_.synchronised();
    const double frequency =
        std::sqrt(model.stiffness[0] * model.inverse_mass[model.particles.front()]);
    row.deviation =
        largest_difference(theirs.displacement, ours.displacement, model) / model.spacing();
    row.velocity_deviation =
        largest_difference(theirs.velocity, ours.velocity, model) / (model.spacing() * frequency);
  }

 private:
  const UndampedBody& body_;
  UndampedMarch march_;
};

void write_trajectory(const std::vector<TrajectoryRow>& rows, const std::filesystem::path& file) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "time [s],centre_x [m],centre_y [m],centre_z [m],momentum_x [N s],momentum_y [N s],"
           "momentum_z [N s],kinetic_energy [J],elastic_energy [J],rod_force_x [N],"
           "rod_force_y [N],rod_force_z [N],wall_force [N],deviation [1],velocity_deviation [1]\n";
    for (const TrajectoryRow& row : rows) {
      const auto put = [&](double value) { out << meshes::to_text(value) << ','; };
      put(row.time);
      for (const double value : row.centre) put(value);
      for (const double value : row.momentum) put(value);
      put(row.kinetic_energy);
      put(row.elastic_energy);
      for (const double value : row.rod_force) put(value);
      put(row.wall_force);
      put(row.deviation);
      out << meshes::to_text(row.velocity_deviation) << '\n';
    }
  });
}

/// Nothing where there is no log, or one without an end: a dump may be looked at before.
std::optional<LammpsTiming> timing_in(const std::filesystem::path& folder) {
  try {
    return read_lammps_log(folder / lammps_log);
  } catch (const meshes::InvalidInput&) {
    return {};
  }
}

double largest(const std::vector<TrajectoryRow>& rows, double TrajectoryRow::*member) {
  double worst = rows.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  for (const TrajectoryRow& row : rows) {
    if (!(row.*member <= worst)) worst = row.*member;
  }
  return worst;
}

}  // namespace

double LammpsImport::worst_deviation() const {
  return largest(rows, &TrajectoryRow::deviation);
}

double LammpsImport::worst_velocity_deviation() const {
  return largest(rows, &TrajectoryRow::velocity_deviation);
}

State state_of(const LammpsFrame& frame, const LatticeModel& model) {
  if (frame.position.size() != model.particles.size()) {
    throw meshes::InvalidInput({lammps_dump, std::to_string(frame.position.size()),
                                "the lattice has another number of masses",
                                "import into the folder that was exported"});
  }
  State state(model);
  for (std::size_t n = 0; n < model.particles.size(); ++n) {
    const std::uint32_t i = model.particles[n];
    const auto to_grid = model.grid.axes.transpose();
    state.displacement.set(i, to_grid * (frame.position[n] - model.rest_position(i)));
    state.velocity.set(i, to_grid * frame.velocity[n]);
  }
  return state;
}

LammpsImport import_lammps(const UndampedBody& body, const std::filesystem::path& folder,
                           const ImportOptions& options,
                           const std::function<bool(long step)>& go_on) {
  LammpsImport result;
  LammpsDump dump(folder / lammps_dump, body.model.particles.size());
  std::optional<Comparison> comparison;
  if (options.compare) comparison.emplace(body, options.threads);
  std::optional<MassFrames> frames;
  if (options.pictures) frames.emplace(folder / "frames", body.model);
  while (const auto frame = dump.next()) {
    if (go_on && !go_on(frame->step)) throw meshes::Interrupted("the import was stopped");
    const State state = state_of(*frame, body.model);
    TrajectoryRow row = row_of(body, state, double(frame->step) * body.step);
    if (comparison) comparison->measure(*frame, state, row, go_on);
    if (frames) frames->add(state, row.time);
    result.rows.push_back(row);
  }
  result.broke_off = dump.broke_off();
  result.timing = timing_in(folder);
  result.springs = body.model.spring_count();
  write_trajectory(result.rows, folder / "trajectory.csv");
  return result;
}

}  // namespace fingertip::studies
