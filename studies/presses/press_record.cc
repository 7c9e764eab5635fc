#include "studies/presses/press_record.h"

#include <cmath>

#include "lattice/press/press_task.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"

namespace fingertip::studies::inline presses {

using meshes::json_of;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

void drop(ordered_json& inputs, std::initializer_list<const char*> idle) {
  for (const char* key : idle) inputs.erase(key);
}

ordered_json inputs_of(const meshes::PressProtocol& protocol, bool moves) {
  ordered_json inputs = json_of(protocol);
  if (!protocol.moves_after()) drop(inputs, {"lateral_path"});
  if (!protocol.moves_after() && !protocol.has_plane_moves()) drop(inputs, {"lateral_samples"});
  if (protocol.contact != meshes::ContactMode::coulomb) drop(inputs, {"friction"});
  if (moves) return inputs;
  drop(inputs, {"speed", "clearance"});
  if (protocol.program.empty()) return inputs;
  ordered_json stages = ordered_json::array();
  for (const meshes::PressStage& stage : protocol.program)  // without time a hold only counts
    if (!stage.moves())
      stages.push_back(nullptr);
    else if (stage.moves_along_plane())
      stages.push_back({stage.indentation, stage.lateral, stage.twist});
    else
      stages.push_back(stage.indentation);
  inputs["program"] = stages;
  return inputs;
}

ordered_json rubber_inputs(const meshes::Rubber& rubber, lattice::Kinematics kinematics) {
  ordered_json inputs = json_of(rubber);
  if (kinematics == lattice::Kinematics::small) drop(inputs, {"energy"});
  return inputs;
}

ordered_json inputs_of(const lattice::PressSetup& setup) {
  const bool moves = setup.protocol.mode != meshes::DriveMode::equilibrium;
  ordered_json inputs = json_of(setup);
  inputs["protocol"] = inputs_of(setup.protocol, moves);
  if (setup.integrator != lattice::Integrator::runge_kutta) drop(inputs, {"tolerance"});
  if (setup.integrator != lattice::Integrator::energy_controlled) drop(inputs, {"energy_bound"});
  // Nobody asks it but people's own controllers; taxels.csv is made of what is computed anyway.
  if (!setup.make_controller)
    drop(inputs["hardware"], {"skin", "taxel", "taxel_rate", "taxel_latency"});
  if (setup.protocol.mode != meshes::DriveMode::pid) {
    drop(inputs, {"rod", "controller_identity", "follows_path", "hardware"});
    // Steps divide it, whatever moves the rod.
    inputs["controller"] = {{"period", setup.controller.period}};
  }
  inputs["rubber"] = rubber_inputs(setup.rubber, setup.lattice.kinematics);
  if (!moves) drop(inputs["rubber"], {"density", "retardation_time"});
  if (!moves)
    drop(inputs, {"controller", "duration", "gravity", "integrator", "time_step", "tolerance",
                  "energy_bound", "symmetry"});
  return inputs;
}

double press_weight(const lattice::PressSetup& setup) {
  const double finer = setup.geometry.tip_radius / (12.0 * setup.lattice.spacing);
  return setup.protocol.mode == meshes::DriveMode::equilibrium
             ? 0.5 * std::pow(finer, 4)
             : 10.0 * std::pow(finer, 4) / lattice::moving_sectors(setup);
}

GeometryEntry geometry_entry(const meshes::Geometry& geometry) {
  return {geometry.tip_radius, geometry.rod_radius, geometry.sleeve_length, geometry.rod_length,
          geometry.is_dome() ? "" : std::string(geometry.shape_name())};
}

ConstantsEntry constants_entry(const lattice::SpringConstants& constants) {
  return {constants.k1, constants.k2, constants.k3, constants.kappa};
}

ModuliEntry moduli_entry(const calibration::ElasticModuli& moduli) {
  return {moduli.youngs_modulus_100, moduli.youngs_modulus_110, moduli.youngs_modulus_111,
          moduli.shear_modulus,      moduli.poissons_ratio_100, moduli.bulk_modulus,
          moduli.anisotropy};
}

PressSummary press_summary_head(const lattice::PressSetup& setup, const std::string& status) {
  PressSummary summary;
  summary.model = lattice::name(setup.lattice.model);
  summary.kinematics = lattice::name(setup.lattice.kinematics);
  summary.mode = meshes::name(setup.protocol.mode);
  summary.contact = meshes::name(setup.protocol.contact);
  const meshes::Obstacle& obstacle = setup.protocol.obstacle;
  if (!obstacle.is_plane())
    summary.obstacle = {std::string(name(obstacle.shape)), obstacle.radius,
                        std::string(name(obstacle.along)), obstacle.offset};
  summary.status = status;
  summary.spacing = setup.lattice.spacing;
  summary.constants = constants_entry(setup.lattice.constants);
  summary.geometry = geometry_entry(setup.geometry);
  return summary;
}

void set_press_status(const fs::path& folder, const std::string& status) {
  if (!fs::exists(folder / "summary.json")) return;
  ordered_json summary = parse_json(folder / "summary.json");
  summary["status"] = status;
  meshes::write_json_file(summary, folder / "summary.json");
}

}  // namespace fingertip::studies::inline presses
