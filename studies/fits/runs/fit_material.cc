#include "studies/fits/runs/fit_material.h"

#include <algorithm>

#include "calibration/moduli/moduli_fit.h"
#include "calibration/press_fit/lattice_forward_model.h"
#include "lattice/model/constants.h"
#include "studies/fits/models/fit_relaxation.h"

namespace fingertip::studies::inline fits::inline runs {

namespace {

/// Of another rubber than the setup's: its constants in closed form, or fitted to its moduli.
void put_rubber(const meshes::Rubber& rubber, lattice::PressSetup& setup) {
  setup.rubber = rubber;
  calibration::ModuliFitOptions options;
  options.model = setup.lattice.model;
  options.spacing = setup.lattice.spacing;
  setup.lattice.constants = options.model == lattice::ModelKind::central
                                ? calibration::fit_moduli(rubber, options).constants
                                : lattice::hookean_constants(rubber, options.spacing);
}

/// The lattice and rubber that the estimates stand for.
lattice::PressSetup fitted_setup(const FitInput& input, const Eigen::VectorXd& estimates) {
  lattice::PressSetup setup = input.base;
  if (input.problem == CalibrationProblem::damping) {
    setup.rubber.retardation_time = estimates(0);
  } else if (input.problem == CalibrationProblem::finite_strain || by_continuum(input)) {
    put_rubber(calibration::with_moduli(input.base.rubber, parameters_of(input), estimates), setup);
  } else {
    return calibration::LatticeForwardModel(setup, parameters_of(input)).setup_with(estimates);
  }
  return setup;
}

calibration::Validity validity_of(const FitInput& input, const calibration::FitRecord& record) {
  calibration::Validity validity;
  if (!has_presses(input)) return validity;
  const lattice::PressSetup& press =
      std::ranges::max_element(input.curves, {}, [](const FitCurve& curve) {
        return curve.press.protocol.samples.back() / curve.press.geometry.thickness();
      })->press;
  validity.largest_indentation = press.protocol.samples.back();
  validity.thickness = press.geometry.thickness();
  if (press.geometry.is_dome())
    validity.rod_ratio = press.geometry.rod_radius / press.geometry.tip_radius;
  // Of what a lattice makes of the rubber a fit of the continuum knows nothing.
  if (!by_continuum(input)) {
    validity.smallest_spacing = validity.largest_spacing = press.lattice.spacing;
    validity.model_error = calibration::worst_relative_residual(record);
  }
  for (const FitCurve& curve : input.curves)
    if (const auto contact = curve.press.protocol.contact;
        std::ranges::find(validity.contacts, contact) == validity.contacts.end())
      validity.contacts.push_back(contact);
  return validity;
}

}  // namespace

calibration::Material material_of(const FitInput& input, const calibration::FitRecord& record) {
  const lattice::PressSetup setup = fitted_setup(input, record.fit.estimates);
  calibration::Material material;
  material.model = setup.lattice.model;
  material.kinematics = setup.lattice.kinematics;
  material.spacing = setup.lattice.spacing;
  material.constants = setup.lattice.constants;
  material.rubber = setup.rubber;
  material.rubber.relaxation = relaxation_of(input, record.fit.estimates);
  if (setup.geometry.is_dome()) material.geometry = setup.geometry;
  material.density_known = input.density_known;
  material.retardation_time_known =
      input.retardation_time_known || input.problem == CalibrationProblem::damping;
  material.ligament_stiffness = setup.lattice.ligament_stiffness;
  material.contact_stiffness = setup.lattice.contact_stiffness;
  material.validity = validity_of(input, record);
  material.provenance = input.provenance;
  material.program = input.program;
  return material;
}

}  // namespace fingertip::studies::inline fits::inline runs
