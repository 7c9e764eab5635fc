#include "studies/presses/grasp_job.h"

#include <cmath>

#include "lattice/grasp/grasp_fields.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/grasp_summary.h"
#include "studies/presses/journal.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline presses {

namespace {

using meshes::json_of;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

GraspSummary summary_of(const lattice::GraspSetup& setup, const lattice::GraspOutcome& outcome,
                        const std::string& status) {
  const lattice::FingerSetup& finger = setup.hand.finger;
  return {.model = std::string(lattice::name(finger.lattice.model)),
          .contact = std::string(meshes::name(finger.contact.mode)),
          .status = status,
          .fate = std::string(lattice::name(outcome.fate)),
          .spacing = finger.lattice.spacing,
          .wanted_force = setup.grip.force,
          .least_force = outcome.least_force,
          .least_force_at_rest = setup.least_force(0.0),
          .friction = finger.contact.friction,
          .lift_height = setup.grip.lift_height,
          .slip_force = outcome.slip_force,
          .slip_ratio = outcome.slip_ratio,
          .sliding_ratio = outcome.sliding_ratio,
          .momentum_defect = outcome.momentum_defect,
          .lift_off_time = outcome.lift_off_time,
          .held_force = outcome.held_force,
          .held_load = outcome.held_load,
          .held_ratio = outcome.held_ratio,
          .held_slip = outcome.held_slip,
          .coupling = outcome.coupling,
          .step = outcome.step,
          .simulated_time = outcome.simulated_time,
          .wall_time = outcome.wall_time};
}

void run_grasp_job(lattice::GraspSetup setup, const fs::path& folder, const JobContext& context) {
  setup.hand.finger.threads = context.threads;
  Journal<lattice::GraspOutcome> journal(
      folder, context, "grasping",
      [&](const lattice::GraspOutcome& outcome, const std::string& status) {
        meshes::write_rows(outcome.rows, folder / "grasp.csv");
        meshes::write_json_file(summary_of(setup, outcome, status), folder / "summary.json");
      });
  journal.run(
      [&](const lattice::GraspObserver& observe) { return lattice::run_grasp(setup, observe); });
}

ordered_json inputs_of(const lattice::GraspSetup& setup) {
  const lattice::FingerSetup& finger = setup.hand.finger;
  return {{"geometry", json_of(finger.geometry)},
          {"rubber", rubber_inputs(finger.rubber, finger.lattice.kinematics)},
          {"lattice", json_of(finger.lattice)},
          {"contact", meshes::name(finger.contact.mode)},
          {"friction", finger.contact.friction},
          {"time_step", json_of(finger.time_step)},
          {"clearance", setup.hand.clearance},
          {"gravity", setup.hand.gravity},
          {"block", json_of(setup.hand.block)},
          {"grip", json_of(setup.grip)}};
}

}  // namespace

lattice::GraspSetup grasp_setup(const LoadedConfig& loaded) {
  LoadedConfig fingers = loaded;  // how one finger would be pressed does not matter
  meshes::PressProtocol& protocol = fingers.config.press.protocol;
  const meshes::PressProtocol straight;
  protocol.mode = meshes::DriveMode::quasi_static;
  protocol.tilt = straight.tilt;
  protocol.lateral = straight.lateral;
  protocol.twist = straight.twist;
  protocol.obstacle = straight.obstacle;
  protocol.program = straight.program;
  const lattice::PressSetup press = press_setup(fingers);
  lattice::GraspSetup setup;
  lattice::FingerSetup& finger = setup.hand.finger;
  finger.geometry = press.geometry;
  finger.rubber = press.rubber;
  finger.lattice = press.lattice;
  finger.rod = press.rod;
  const bool rubs = protocol.contact == meshes::ContactMode::coulomb;
  finger.contact = {protocol.contact, rubs ? protocol.friction : 0.0};
  finger.integrator = press.integrator;
  finger.time_step = press.time_step;
  finger.threads = press.threads;
  setup.hand.block = loaded.config.block;
  setup.hand.clearance = protocol.clearance;
  setup.hand.gravity = loaded.config.grasp_gravity;
  setup.grip = loaded.config.grip;
  setup.grip.period = press.controller.period;
  std::vector<meshes::Violation> broken = setup.violations();
  if (protocol.contact == meshes::ContactMode::frictionless)
    broken.push_back({"press.contact", "frictionless", "no grip lifts a block without friction",
                      "take coulomb with press.friction, or stick"});
  if (!broken.empty()) throw loaded.locate(broken);
  return setup;
}

Job grasp_job(const lattice::GraspSetup& setup) {
  Job job;
  job.kind = "grasp";
  job.inputs = inputs_of(setup);
  job.source_hash = source_hash::lattice;
  const lattice::FingerSetup& finger = setup.hand.finger;
  job.weight = 50.0 * std::pow(finger.geometry.tip_radius / (12.0 * finger.lattice.spacing), 4);
  job.run = [setup](const fs::path& folder, const JobContext& context) {
    run_grasp_job(setup, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies::inline presses
