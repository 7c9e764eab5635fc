#include "lattice/press/press_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "lattice/kernels/stencil.h"
#include "lattice/model/formulation.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/base/errors.h"

namespace fingertip::lattice::inline press {

namespace {

/// What one unit of way in a direction adds to the quantities that a body is made of.
struct Rates {
  SpringConstants constants;         ///< of the springs, or of a cubic law
  double shear = 0.0, lambda = 0.0;  ///< C44 or G; lambda of the network at finite strain
  double bond = 0.0, contact = 0.0;  ///< factors on ties
};

void add(PressParameter parameter, double rate, double a, Rates& rates) {
  SpringConstants& constants = rates.constants;
  switch (parameter) {
    case PressParameter::k1: constants.k1 += rate; break;
    case PressParameter::k2: constants.k2 += rate; break;
    case PressParameter::k3: constants.k3 += rate; break;
    case PressParameter::kappa: constants.kappa += rate; break;
    // The network at small strain is hookean with k1 = k2 = a G, k3 = 0, kappa = lambda - G.
    case PressParameter::shear_modulus:
      constants.k1 += a * rate;
      constants.k2 += a * rate;
      constants.kappa -= rate;
      break;
    case PressParameter::lambda:
      constants.kappa += rate;
      rates.lambda += rate;
      break;
    case PressParameter::bond: rates.bond += rate; break;
    case PressParameter::contact: rates.contact += rate; break;
  }
}

Rates rates_of(const PressDirections& directions, Eigen::Index direction, double spacing) {
  Rates rates;
  for (std::size_t i = 0; i < directions.parameters.size(); ++i)
    add(directions.parameters[i], directions.rates(Eigen::Index(i), direction), spacing, rates);
  rates.shear = shear_stiffness(rates.constants, spacing);
  return rates;
}

/// Every law is linear in its moduli.
CellMaterial material_slope(const Formulation& formulation, const Rates& rates, double spacing,
                            const meshes::StrainEnergy& energy) {
  if (formulation.central_springs)
    return volume_material(formulation.cell_law ? rates.constants.kappa : 0.0, formulation.finite);
  if (formulation.material.large_strain())
    return network_material(energy, rates.shear, rates.lambda, fibre_share);
  return cubic_material(rates.constants, spacing, fibre_share);
}

/// The family whose springs have the length of this one.
std::size_t family_of(const Spring& spring, const LatticeBody& body, double spacing) {
  const double length = (body.rest[spring.ends[1]] - body.rest[spring.ends[0]]).norm();
  return std::size_t(std::lround(length * length / (spacing * spacing))) - 1;
}

/// The springs of a family per unit of its constant. Where that is zero the body has none: they are
/// taken from one made with another constant.
std::vector<Spring> unit_springs(const LatticeBody& body, const PressSetup& setup,
                                 PressParameter parameter, std::size_t family) {
  const double constant = value_of(parameter, setup);
  if (constant == 0.0) {
    PressSetup other = setup;
    set_value(parameter, 1.0, other);
    const LatticeBody full =
        build_cut_tip(other.geometry, other.rubber, other.lattice, body.sectors);
    return unit_springs(full, other, parameter, family);
  }
  std::vector<Spring> springs;
  for (const Spring& spring : body.springs)
    if (family_of(spring, body, setup.lattice.spacing) == family)
      springs.push_back({spring.ends, spring.stiffness / constant});
  return springs;
}

void add_springs(const LatticeBody& body, const PressSetup& setup,
                 const PressDirections& directions, Eigen::Index direction,
                 std::vector<Spring>& springs) {
  using enum PressParameter;
  constexpr std::pair<PressParameter, std::size_t> families[] = {
      {k1, axis}, {k2, face_diagonal}, {k3, body_diagonal}};
  for (std::size_t i = 0; i < directions.parameters.size(); ++i) {
    const double rate = directions.rates(Eigen::Index(i), direction);
    for (const auto& [parameter, family] : families) {
      if (parameter != directions.parameters[i] || rate == 0.0) continue;
      for (const Spring& spring : unit_springs(body, setup, parameter, family))
        springs.push_back({spring.ends, rate * spring.stiffness});
    }
  }
}

template <typename Element>
void scale(double factor, std::vector<Element>& elements) {
  for (Element& element : elements) element.stiffness *= factor;
}

}  // namespace

std::vector<PressParameter> press_parameters(const LatticeSettings& settings) {
  using enum PressParameter;
  switch (settings.model) {
    case ModelKind::published: return {};
    case ModelKind::central: return {k1, k2, k3, bond, contact};
    case ModelKind::hookean: return {k1, k2, k3, kappa, bond, contact};
    case ModelKind::network: return {shear_modulus, lambda, bond, contact};
  }
  return {};
}

PressDirections::PressDirections(std::vector<PressParameter> each)
    : parameters(std::move(each)),
      rates(Eigen::MatrixXd::Identity(Eigen::Index(parameters.size()),
                                      Eigen::Index(parameters.size()))) {}

PressDirections::PressDirections(std::vector<PressParameter> own, Eigen::MatrixXd along)
    : parameters(std::move(own)), rates(std::move(along)) {}

PressDirections lame_directions(const LatticeSettings& settings) {
  using enum PressParameter;
  const double a = settings.spacing;
  if (settings.model == ModelKind::network) return {{shear_modulus, lambda}};
  if (settings.model != ModelKind::hookean) return {};
  // k1 = k2 = a G, k3 = 0, kappa = lambda - G.
  return {{k1, k2, kappa}, Eigen::MatrixXd{{a, 0.0}, {a, 0.0}, {-1.0, 1.0}}};
}

double value_of(PressParameter parameter, const PressSetup& setup) {
  const LatticeSettings& lattice = setup.lattice;
  switch (parameter) {
    case PressParameter::k1: return lattice.constants.k1;
    case PressParameter::k2: return lattice.constants.k2;
    case PressParameter::k3: return lattice.constants.k3;
    case PressParameter::kappa: return lattice.constants.kappa;
    case PressParameter::shear_modulus: return setup.rubber.shear_modulus;
    case PressParameter::lambda: return setup.rubber.lame_lambda();
    case PressParameter::bond: return lattice.ligament_stiffness;
    case PressParameter::contact: return lattice.contact_stiffness;
  }
  return 0.0;
}

void set_value(PressParameter parameter, double value, PressSetup& setup) {
  LatticeSettings& lattice = setup.lattice;
  meshes::Rubber& rubber = setup.rubber;
  switch (parameter) {
    case PressParameter::k1: lattice.constants.k1 = value; break;
    case PressParameter::k2: lattice.constants.k2 = value; break;
    case PressParameter::k3: lattice.constants.k3 = value; break;
    case PressParameter::kappa: lattice.constants.kappa = value; break;
    case PressParameter::shear_modulus: rubber.set_lame(value, rubber.lame_lambda()); break;
    case PressParameter::lambda: rubber.set_lame(rubber.shear_modulus, value); break;
    case PressParameter::bond: lattice.ligament_stiffness = value; break;
    case PressParameter::contact: lattice.contact_stiffness = value; break;
  }
}

LatticeBody body_slope(const LatticeBody& body, const PressSetup& setup,
                       const PressDirections& directions, Eigen::Index direction) {
  const std::vector<PressParameter> known = press_parameters(setup.lattice);
  for (const PressParameter parameter : directions.parameters) {
    if (std::ranges::find(known, parameter) != known.end()) continue;
    throw meshes::InvalidInput({"parameter", std::string(name(parameter)),
                                "a press of the " + std::string(name(setup.lattice.model)) +
                                    " model has no derivative with respect to it",
                                "ask for those of press_parameters"});
  }
  const Formulation formulation = formulation_for(setup.rubber, setup.lattice);
  const Rates rates = rates_of(directions, direction, setup.lattice.spacing);
  const double shear = rates.shear / formulation.shear;  // fibres and ties are proportional to it
  LatticeBody slope = body;
  slope.law.material =
      material_slope(formulation, rates, setup.lattice.spacing, setup.rubber.energy);
  if (slope.law.none()) slope.cells.clear();
  slope.springs.clear();
  if (formulation.central_springs) add_springs(body, setup, directions, direction, slope.springs);
  scale(shear, slope.fibres);
  scale(shear + rates.bond / setup.lattice.ligament_stiffness, slope.bond);
  scale(shear + rates.contact / setup.lattice.contact_stiffness, slope.outer);
  const auto idle = [](const auto& element) { return element.stiffness == 0.0; };
  std::erase_if(slope.fibres, idle);
  std::erase_if(slope.bond, idle);
  return slope;
}

}  // namespace fingertip::lattice::inline press
