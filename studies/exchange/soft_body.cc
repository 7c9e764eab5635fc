#include "studies/exchange/soft_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/exchange/texts/texts.h"

namespace fingertip::studies::inline exchange {

namespace {

/// Stiffness of a vertex behind the plane over E times the edges' length: vertices sink in by a few
/// hundredths of an edge.
constexpr double vertex_stiffness = 10.0;

}  // namespace

double SoftBody::shear_modulus() const {
  return 0.5 * youngs_modulus / (1.0 + poissons_ratio);
}

double SoftBody::lambda() const {
  return 2.0 * shear_modulus() * poissons_ratio / (1.0 - 2.0 * poissons_ratio);
}

std::string SoftBody::places() const {
  std::string text;
  for (const meshes::Vector3& v : body.mesh.vertices)
    fmt::format_to(std::back_inserter(text), "{:.9g} {:.9g} {:.9g}  ", v.x(), v.y(), v.z());
  return text;
}

std::string SoftBody::tetrahedra() const {
  std::string text;
  for (const auto& t : body.mesh.tetrahedra)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}  ", t[0], t[1], t[2], t[3]);
  return text;
}

std::string SoftBody::held() const {
  std::string text;
  for (std::size_t v = 0; v < body.held.size(); ++v)
    if (body.held[v]) text += std::to_string(v) + " ";
  return text;
}

std::string SoftBody::limit(const ContactCurve& curve) const {
  if (forces.size() == curve.forces.force.size()) return "";
  return fmt::format(" Beyond {:.3g} mm it finds no equilibrium: elements collapse.",
                     1e3 * curve.forces.indentation[forces.size() - 1]);
}

SoftBody fitted_soft_body(const LoadedConfig& loaded, const ContactCurve& curve) {
  const lattice::PressSetup& press = loaded.config.press;
  SoftBody soft;
  soft.edge = loaded.config.exchange.edge.value_or(
      std::min(0.25 * press.geometry.tip_radius, 0.5 * meshes::shape_of(press.geometry)->wall()));
  soft.poissons_ratio = press.rubber.poissons_ratio();
  soft.body = calibration::tetrahedral_body(press.geometry, soft.edge);
  soft.forces = calibration::forces_of(
      soft.body, {soft.poissons_ratio, vertex_stiffness * soft.edge}, curve.forces.indentation);
  soft.youngs_modulus = calibration::fitted_factor(soft.forces, curve.forces);
  if (!std::isfinite(soft.youngs_modulus))
    throw ConfigError({"exchange.edge", meshes::to_text(soft.edge) + " m",
                       "tetrahedra of that size bear no press", "choose smaller ones",
                       loaded.entries.at("exchange.edge").place});
  soft.stiffness = vertex_stiffness * soft.edge * soft.youngs_modulus;
  for (double& force : soft.forces) force *= soft.youngs_modulus;
  return soft;
}

ForetoldModel foretold(const std::string& name, const SoftBody& body) {
  return {name, [forces = body.forces](const ContactCurve& curve) {
            std::vector<double> known(curve.forces.force.size(), meshes::unknown);
            if (curve.obstacle.is_plane()) std::ranges::copy(forces, known.begin());
            return known;
          }};
}

std::string description(const SoftBody& body) {
  return filled("soft_body_readme.txt", fmt::arg("vertices", body.body.mesh.vertices.size()),
                fmt::arg("tetrahedra", body.body.mesh.tetrahedra.size()),
                fmt::arg("edge", 1e3 * body.edge), fmt::arg("young", body.youngs_modulus),
                fmt::arg("shear", body.shear_modulus()), fmt::arg("lambda", body.lambda()),
                fmt::arg("poisson", body.poissons_ratio));
}

std::string summary(const SoftBody& body, const ContactCurve& curve) {
  return fmt::format("E = {:.4g} Pa with nu = {:.3g}, {} vertices.{}", body.youngs_modulus,
                     body.poissons_ratio, body.body.mesh.vertices.size(), body.limit(curve));
}

}  // namespace fingertip::studies::inline exchange
