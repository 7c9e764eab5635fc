#include "studies/presses/press_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "calibration/material/material.h"
#include "lattice/model/cut_tip.h"
#include "lattice/press/press_deviation.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/base/files.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/rubber/plausible.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/law_card_keys.h"
#include "studies/config/text/units.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/controller_choice.h"

namespace fingertip::studies::inline presses {

namespace {

using lattice::ModelKind;

/// Beyond this a press would need more memory than a workstation has.
constexpr double max_particles = 2e7;
/// What equilibrium takes per particle computed (lattice/MEASUREMENTS.md) [byte].
constexpr double memory_at_rest = 9e3;

void check_constants_source(const LoadedConfig& loaded) {
  const bool published = loaded.config.press.lattice.model == ModelKind::published;
  if (published && loaded.config.constants == ConstantsSource::calibrated) {
    throw loaded.locate({{"lattice.constants", "calibrated",
                          "the published model has a rule for its constants and is not calibrated",
                          "use auto or rule, or the model central or hookean"}});
  }
  if (loaded.config.press.lattice.model == ModelKind::network &&
      loaded.config.constants == ConstantsSource::calibrated) {
    throw loaded.locate({{"lattice.constants", "calibrated",
                          "the network takes G and lambda from the rubber, moduli are all it has",
                          "use auto, or the file of a fit to curves"}});
  }
}

const calibration::Material& material_of(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  std::optional<calibration::Material>& known = *loaded.material;
  try {
    if (!known) known = calibration::read_material_toml(config.constants_file);
  } catch (const meshes::InvalidInput& error) {
    throw refused_file(loaded, "lattice.constants", error);
  }
  if (known->model != config.press.lattice.model) {
    throw loaded.locate(
        {{"lattice.constants", config.constants_file.string(),
          "the file holds constants of the model " + std::string(lattice::name(known->model)) +
              ", not of " + std::string(lattice::name(config.press.lattice.model)),
          "calibrate this model, or change lattice.model"}});
  }
  return *known;
}

/// Where keys are left at their defaults the material's values take their place.
void take_over(const calibration::Material& material, LoadedConfig& loaded) {
  const auto given = [&](const char* key) { return loaded.entries.at(key).given; };
  const auto take = [&](const std::string& name, double ours, double& value) {
    const Key& key = *find_key(name);
    const std::string text = meshes::to_text(ours);
    const std::string quantity = text + ' ' + key.unit;
    loaded.entries.at(name) = {key.unit.empty() ? text : '"' + quantity + '"',
                               loaded.config.constants_file.string(), true};
    // As it will be read from the run's parameters, to the last bit.
    value = key.unit.empty() ? ours : parse_quantity(quantity, key.unit, key.example());
  };
  meshes::Rubber& rubber = loaded.config.press.rubber;
  // One of them says nothing about the others, and two together must make a rubber.
  if (!given("rubber.youngs_modulus") && !given("rubber.shear_modulus") &&
      !given("rubber.poissons_ratio") && !given("rubber.shore_hardness") &&
      !given("rubber.bulk_modulus") && !given("rubber.yeoh") && !given("rubber.mooney_rivlin") &&
      !given("rubber.ogden")) {
    take("rubber.youngs_modulus", material.rubber.youngs_modulus, rubber.youngs_modulus);
    take("rubber.shear_modulus", material.rubber.shear_modulus, rubber.shear_modulus);
  }
  if (const auto& branches = material.rubber.relaxation.branches;
      !branches.empty() && !given("rubber.relaxation")) {
    rubber.relaxation.branches = branches;
    for (meshes::RelaxationBranch& branch : rubber.relaxation.branches)
      branch.time = parse_quantity(meshes::to_text(branch.time) + " s", "s", "0.1 s");
    loaded.entries.at("rubber.relaxation") = {branches_literal(branches),
                                              loaded.config.constants_file.string(), true};
  }
  lattice::LatticeSettings& lattice = loaded.config.press.lattice;
  const auto take_default = [&](const char* key, double ours, double& value) {
    if (!given(key)) take(key, ours, value);
  };
  if (material.density_known)
    take_default("rubber.density", material.rubber.density, rubber.density);
  if (material.retardation_time_known)
    take_default("rubber.retardation_time", material.rubber.retardation_time,
                 rubber.retardation_time);
  take_default("lattice.ligament_stiffness", material.ligament_stiffness,
               lattice.ligament_stiffness);
  take_default("lattice.contact_stiffness", material.contact_stiffness, lattice.contact_stiffness);
}

lattice::SpringConstants resolve_constants(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  const ModelKind model = config.press.lattice.model;
  const double spacing = config.press.lattice.spacing;
  const bool fitted =
      config.constants == ConstantsSource::calibrated ||
      (config.constants == ConstantsSource::automatic && model == ModelKind::central);
  if (fitted)
    return calibration::fit_moduli(config.press.rubber, fit_options(loaded, model)).constants;
  return model == ModelKind::hookean || model == ModelKind::network
             ? lattice::hookean_constants(config.press.rubber, spacing)
             : lattice::published_constants(config.press.rubber, spacing);
}

/// Of a lattice that nobody could build, or hold in memory.
std::vector<meshes::Violation> broken_by_spacing(const LoadedConfig& loaded) {
  const meshes::Geometry& geometry = loaded.config.press.geometry;
  const double spacing = loaded.config.press.lattice.spacing, radius = geometry.tip_radius;
  if (!(spacing <= geometry.coarsest_spacing())) return {meshes::too_coarse(geometry, spacing)};
  const double particles = meshes::expected_particle_count(geometry, spacing),
               memory = equilibrium_memory(loaded.config.press),
               crowd = std::max(particles / max_particles, memory / memory_of_machine());
  if (crowd <= 1.0 && spacing >= lattice::smallest_spacing * radius) return {};
  const double finest = std::max(spacing * std::cbrt(crowd), lattice::smallest_spacing * radius);
  const std::string thin = thin_part(geometry);
  std::string rule = "the spacing must be at least R/320";
  if (particles > max_particles)
    rule = "the tip would consist of more than 20 million masses";
  else if (crowd > 1.0)
    rule = fmt::format("its equilibrium would take some {:.2g} GB of the {:.2g} GB here",
                       1e-9 * memory, 1e-9 * memory_of_machine());
  return {{"lattice.spacing", calibration::rounded(spacing) + " m",
           rule + (thin.empty() ? "" : ": " + thin),
           finest <= geometry.coarsest_spacing()
               ? "choose a coarser lattice, at most tip_radius/" +
                     calibration::rounded(std::floor(radius / finest), 6)
               : "make the thin part thicker or leave it out, or press the continuum (reference), "
                 "which needs no lattice"}};
}

/// A rod of the usual density may be too light for this finger under the controller: nobody chose
/// it, so take one that is not.
void choose_rod(LoadedConfig& loaded) {
  lattice::PressSetup& press = loaded.config.press;
  Entry& entry = loaded.entries.at("rod.density");
  if (entry.given || press.protocol.mode != meshes::DriveMode::pid ||
      !broken_by_spacing(loaded).empty())
    return;
  const double usual = press.rod.density;
  const double rod = lattice::rod_body(press.geometry, press.rod).mass,
               tip = press.rubber.density * press.geometry.tip_volume();
  press.rod.density *= std::max(1.0, tip / rod);
  if (const auto sways = lattice::swaying_hand(press)) press.rod.density = sways->density;
  if (press.rod.density == usual) return;
  const std::string heavier = fmt::format("{:.3g} g/cm^3", 1.05e-3 * press.rod.density);
  press.rod.density = parse_quantity(heavier, "kg/m^3", heavier);
  entry = {'"' + heavier + '"', "default for this finger", false};
  loaded.notes.push_back("rod.density = " + heavier +
                         ": under the controller a rod of the usual density is too light for this "
                         "finger");
}

/// What the file of the constants says.
void add_material(LatticeUse use, LoadedConfig& complete) {
  const calibration::Material& material = material_of(complete);
  take_over(material, complete);
  const lattice::PressSetup& press = complete.config.press;
  const auto warnings = use == LatticeUse::press ? calibration::warnings(material, press)
                                                 : calibration::lattice_warnings(material, press);
  const std::string place = complete.config.constants_file.filename().string() + ": ";
  for (const std::string& warning : warnings) complete.notes.push_back(place + warning);
  // The stiffness is the material's, whatever was given.
  meshes::Rubber& rubber = complete.config.press.rubber;
  rubber.youngs_modulus = material.rubber.youngs_modulus;
  rubber.shear_modulus = material.rubber.shear_modulus;
  if (const std::string odd = meshes::implausible_modulus(rubber.youngs_modulus); !odd.empty())
    complete.notes.push_back(place + odd);
  choose_limits(complete);
}

}  // namespace

LoadedConfig with_material(const LoadedConfig& loaded, LatticeUse use) {
  LoadedConfig complete = loaded;
  if (const std::string note = spacing_note(loaded); use != LatticeUse::none && !note.empty())
    complete.notes.push_back(note);
  if (loaded.config.constants == ConstantsSource::file) add_material(use, complete);
  if (use == LatticeUse::press) choose_rod(complete);
  return complete;
}

namespace {

/// Whether scaled masses can press it, faster, and keep the force.
bool serves_scaled(lattice::PressSetup setup) {
  setup.integrator = lattice::Integrator::mass_scaled;
  if (setup.protocol.mode == meshes::DriveMode::equilibrium || setup.time_step ||
      !setup.violations().empty())
    return false;
  return lattice::best_scaling(setup).scaled;
}

}  // namespace

double equilibrium_memory(const lattice::PressSetup& press) {
  if (press.protocol.mode != meshes::DriveMode::equilibrium) return 0.0;
  return memory_at_rest * meshes::expected_particle_count(press.geometry, press.lattice.spacing) /
         lattice::largest_symmetry(press.geometry, press.lattice, press.protocol);
}

lattice::PressSetup press_setup(const LoadedConfig& loaded, LatticeUse use) {
  const bool any_spacing = use == LatticeUse::none && loaded.config.automatic_spacing;
  if (const auto broken = broken_by_spacing(loaded); !broken.empty() && !any_spacing)
    throw loaded.locate(broken);
  check_constants_source(loaded);
  lattice::PressSetup setup = loaded.config.press;
  if (loaded.config.constants == ConstantsSource::file) {
    const calibration::Material& material = material_of(loaded);
    setup = with_material(loaded, LatticeUse::press).config.press;
    setup.lattice.constants = calibration::at_spacing(material, setup.lattice.spacing);
  } else {
    setup.lattice.constants = resolve_constants(loaded);
  }
  choose_controller(loaded, setup);
  if (loaded.config.automatic_integrator && serves_scaled(setup))
    setup.integrator = lattice::Integrator::mass_scaled;
  const std::vector<meshes::Violation> broken = setup.violations();
  if (!broken.empty()) throw loaded.locate(broken);
  return setup;
}

LoadedConfig at_pace(const LoadedConfig& loaded) {
  LoadedConfig coarser = loaded;
  Entry& tolerance = coarser.entries.at("lattice.tolerance");
  if (!loaded.config.automatic_spacing || tolerance.given) return coarser;
  coarser.config.spacing_tolerance = 0.05;
  tolerance = {"0.05", "default for this verb", false};
  choose_automatic_spacing(coarser);
  return coarser;
}

lattice::PressSetup free_press(ConfigSource source) {
  source.sets.emplace_back("press.mode=pid");
  return press_setup(with_material(at_pace(load_config(source)), LatticeUse::press));
}

fem_reference::ReferenceJob continuum_setup(const LoadedConfig& loaded) {
  fem_reference::ReferenceJob job = loaded.config.continuum();
  std::vector<meshes::Violation> broken = job.violations();
  for (meshes::Violation& violation : broken) {
    // About E and G together: the key that asks for finite strain names both.
    if (violation.key == "rubber") violation.key = "reference.strain";
  }
  if (!broken.empty()) throw loaded.locate(broken);
  return job;
}

fem_reference::ReferenceJob continuum_at_rest(const LoadedConfig& loaded,
                                              fem_reference::Strain strain) {
  LoadedConfig own = loaded;
  fem_reference::ReferenceJob& reference = own.config.reference;
  reference.analysis = fem_reference::Analysis::static_press;
  reference.strain = strain;
  reference.write_fields = false;
  return continuum_setup(own);
}

fem_reference::Strain strain_of(lattice::Kinematics kinematics) {
  return kinematics == lattice::Kinematics::finite ? fem_reference::Strain::finite
                                                   : fem_reference::Strain::linear;
}

fem_reference::ReferenceJob continuum_beside(const LoadedConfig& loaded,
                                             lattice::Kinematics kinematics) {
  LoadedConfig own = loaded;
  own.config.continuum_law = ContinuumLaw::a;
  own.config.press.protocol.markers.clear();  // its forces are what is asked for
  return continuum_at_rest(own, strain_of(kinematics));
}

calibration::ModuliFitOptions fit_options(const LoadedConfig& loaded, lattice::ModelKind model) {
  calibration::ModuliFitOptions options;
  options.model = model;
  options.spacing = loaded.config.press.lattice.spacing;
  options.isotropy_weight = loaded.config.calibration.isotropy_weight;
  options.bulk_weight = loaded.config.calibration.bulk_weight;
  return options;
}

std::vector<meshes::Violation> beyond_the_lattice(const LoadedConfig& loaded) {
  const std::vector<meshes::Violation> broken = broken_by_spacing(loaded);
  return broken.empty() ? lattice::beyond_the_lattice(loaded.config.press) : broken;
}

void check_all(const LoadedConfig& loaded) {
  continuum_setup(loaded);
  if (const auto broken = broken_by_spacing(loaded); !broken.empty()) {
    if (loaded.config.automatic_spacing) return;  // whoever builds a lattice will be told
    throw loaded.locate(broken);
  }
  LoadedConfig within_the_lattice = loaded;
  meshes::PressProtocol& protocol = within_the_lattice.config.press.protocol;
  const meshes::PressProtocol straight;
  protocol.contact = straight.contact;
  protocol.tilt = straight.tilt;
  protocol.lateral = straight.lateral;
  protocol.twist = straight.twist;
  // What a moving lattice still cannot do, one at rest can; the verbs that move it tell.
  if (!lattice::beyond_the_lattice(within_the_lattice.config.press).empty())
    protocol.mode = meshes::DriveMode::equilibrium;
  press_setup(within_the_lattice);
}

void check_validation(const LoadedConfig& loaded) {
  check_all(loaded);
  // Every model is pressed, whatever lattice.model says; the published one can do least.
  lattice::PressSetup published = loaded.config.press;
  published.lattice.model = lattice::ModelKind::published;
  published.lattice.kinematics = lattice::Kinematics::finite;
  published.lattice.constants =
      lattice::published_constants(published.rubber, published.lattice.spacing);
  std::vector<meshes::Violation> broken = published.violations();
  if (loaded.config.press.protocol.mode == meshes::DriveMode::equilibrium) {
    broken.push_back({"press.mode", "static",
                      "a validation judges moving lattices: their controller, momentum and speed",
                      "choose pid or quasi-static, or use press, reference and compare"});
  }
  if (loaded.config.reference.analysis == fem_reference::Analysis::modes) {
    broken.push_back({"reference.mode", "modes",
                      "a validation compares forces, and natural frequencies have none",
                      "choose static or transient"});
  }
  if (!broken.empty()) throw loaded.locate(broken);
}

}  // namespace fingertip::studies::inline presses
