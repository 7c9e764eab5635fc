#include "studies/exchange/mujoco_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/contact_laws/soft_contact.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/exchange/soft_body.h"
#include "studies/exchange/texts/texts.h"

namespace fingertip::studies::inline exchange {

namespace {

using namespace calibration;
using meshes::to_text;

/// Of the geom's carriage [kg]; its contact's stiffness in MuJoCo's units goes with it.
constexpr double carriage = 0.1;
/// Time step times the angular frequency of the stiffest spring, and the longest step [s].
constexpr double calm = 0.3, longest_step = 1e-3;
/// The servo's stiffness over the contact's largest, F' <= S: at rest it gives way by F/(servo S),
/// at most 1/servo of the indentation, and at full depth the force by 1/servo.
constexpr double servo = 300.0;
constexpr double vertex_impedance = 0.9;  ///< of a flex's contacts, constant
constexpr double min_damping = 1e-4;      ///< of a flex [s]; without any it would ring for ever

/// Of a flex; what an older version says of it.
constexpr const char* needed =
    "It loads from MuJoCo 3.13 on (older ones: invalid keyword 'discrete')";

std::string comment(const LoadedConfig& loaded, const ContactCurve& curve) {
  return fmt::format(
      "<!-- {}, E = {:.6g} Pa, nu = {:.4g}, fitted to {:.4g} mm on a {}; pole up, SI. README.md "
      "says how to use it. -->\n",
      loaded.config.press.geometry.shape_name(), loaded.config.press.rubber.youngs_modulus,
      loaded.config.press.rubber.poissons_ratio(), 1e3 * curve.forces.indentation.back(),
      curve.name);
}

/// The obstacle as a geom over the origin.
std::string obstacle_geom(const meshes::Obstacle& obstacle) {
  using meshes::ObstacleShape;
  const std::string at = fmt::format("<geom name=\"obstacle\" pos=\"{} 0 {}\" ",
                                     to_text(obstacle.along_x() ? 0.0 : obstacle.offset),
                                     to_text(obstacle.is_plane() ? 0.0 : obstacle.radius));
  switch (obstacle.shape) {
    case ObstacleShape::plane:
      return at + "type=\"plane\" euler=\"180 0 0\" size=\".05 .05 .01\"/>";
    case ObstacleShape::sphere:
      return at + fmt::format("type=\"sphere\" size=\"{}\"/>", to_text(obstacle.radius));
    case ObstacleShape::cylinder:
      return at + fmt::format("type=\"capsule\" euler=\"{}\" size=\"{} .1\"/>",
                              obstacle.along_x() ? "0 90 0" : "90 0 0", to_text(obstacle.radius));
    case ObstacleShape::edge: break;  // refused before
  }
  return "";
}

/// MuJoCo's coefficient of torsion over that of sliding [m]: the moment that friction holds over
/// the normal force, by least squares of the moments, for MuJoCo's is one length where the contact
/// grows with the load. NaN where the contact is not known.
double torsion_arm(const ContactCurve& curve) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < curve.forces.force.size(); ++i) {
    const double force = curve.forces.force[i];
    product += force * curve.greatest_moment[i];
    square += force * force;
  }
  return product / square;
}

/// `arm`: that of a geom's single contact; many of them turn by themselves, NaN.
std::string friction_of(const LoadedConfig& loaded, double arm = meshes::unknown) {
  constexpr double sticking = 10.0;  // MuJoCo has no stick
  const meshes::PressProtocol& protocol = loaded.config.press.protocol;
  if (protocol.contact == meshes::ContactMode::frictionless) return "condim=\"1\"";
  const double sliding =
      protocol.contact == meshes::ContactMode::coulomb ? protocol.friction : sticking;
  if (std::isnan(arm)) return fmt::format("condim=\"3\" friction=\"{} 0 0\"", to_text(sliding));
  return fmt::format("condim=\"4\" friction=\"{} {:.6g} 0\"", to_text(sliding), sliding * arm);
}

/// Largest dF/dr of a contact up to a penetration [N/m].
double stiffest(const SoftContact& contact, double depth) {
  double most = 0.0;
  for (int i = 0; i < 100; ++i)
    most =
        std::max(most, 100.0 / depth *
                           (contact.force(depth * (i + 1) / 100) - contact.force(depth * i / 100)));
  return most;
}

/// Stiffness over mass [1/s²], and the critical damping.
std::string solref(double k) {
  return fmt::format("{:.9g} {:.9g}", -k, -2.0 * std::sqrt(k));
}

std::string solimp(const SoftContact& contact, int digits) {
  return fmt::format("{1:.{0}g} {2:.{0}g} {3:.{0}g} {4:.{0}g} {5:.{0}g}", digits, contact.dmin,
                     contact.dmax, contact.width, contact.midpoint, contact.power);
}

std::string rigid_model(const LoadedConfig& loaded, const ContactCurve& curve,
                        const SoftContact& contact) {
  const double gain = servo * stiffest(contact, curve.forces.indentation.back());
  const double radius = meshes::shape_of(loaded.config.press.geometry)->pole_radius();
  return filled("finger_rigid.xml", fmt::arg("comment", comment(loaded, curve)),
                fmt::arg("step", std::min(longest_step, calm / std::sqrt(gain / carriage))),
                fmt::arg("obstacle", obstacle_geom(curve.obstacle)),
                fmt::arg("radius", to_text(radius)), fmt::arg("mass", to_text(carriage)),
                fmt::arg("friction", friction_of(loaded, torsion_arm(curve))),
                fmt::arg("solref", solref(contact.stiffness / carriage)),
                fmt::arg("solimp", solimp(contact, 9)), fmt::arg("gain", gain));
}

/// Young's modulus and Poisson's ratio that MuJoCo's flex needs for those of the rubber. Its energy
/// is mu E:E + lambda (tr E)², with lambda of its `young` and `poisson`, twice the law's second
/// term (measured with 3.14), so it must be given half of lambda.
struct FlexModuli {
  double young, poisson;
  FlexModuli(double youngs_modulus, double poissons_ratio)
      : poisson(poissons_ratio / (2.0 - 2.0 * poissons_ratio)) {
    young = youngs_modulus * (1.0 + poisson) / (1.0 + poissons_ratio);
  }
};

std::string flex_model(const LoadedConfig& loaded, const ContactCurve& curve,
                       const SoftBody& flex) {
  const meshes::Rubber& rubber = loaded.config.press.rubber;
  const double mass = rubber.density * flex.body.volume();
  const double vertex = mass / double(flex.body.mesh.vertices.size());
  // Force of a vertex: its mass times k r/(1 - d).
  const double k = flex.stiffness * (1.0 - vertex_impedance) / vertex;
  const FlexModuli moduli(flex.youngs_modulus, flex.poissons_ratio);
  return filled("finger_flex.xml", fmt::arg("comment", comment(loaded, curve)),
                fmt::arg("needed", needed),
                fmt::arg("step", std::min(longest_step, calm * std::sqrt(1.0 / k) * 2.0)),
                fmt::arg("top", to_text(flex.body.top())),
                fmt::arg("obstacle", obstacle_geom(curve.obstacle)), fmt::arg("mass", mass),
                fmt::arg("places", flex.places()), fmt::arg("tetrahedra", flex.tetrahedra()),
                fmt::arg("friction", friction_of(loaded)), fmt::arg("solref", solref(k)),
                fmt::arg("impedance", vertex_impedance), fmt::arg("young", moduli.young),
                fmt::arg("poisson", moduli.poisson),
                fmt::arg("damping", std::max(rubber.retardation_time, min_damping)),
                fmt::arg("held", flex.held()));
}

std::string mujoco_readme(const LoadedConfig& loaded, const ContactCurve& curve,
                          const SoftContact& contact, const SoftBody* flex) {
  std::string text =
      filled("mujoco_readme.txt", fmt::arg("precision", 100.0 / servo),
             fmt::arg("stiffness", contact.stiffness), fmt::arg("solimp", solimp(contact, 4)));
  const double arm = torsion_arm(curve);
  if (loaded.config.press.protocol.contact != meshes::ContactMode::frictionless && !std::isnan(arm))
    text += filled("mujoco_torsion_readme.txt", fmt::arg("arm", 1e3 * arm));
  if (flex == nullptr)
    return text + fmt::format(
                      "There is no flex: its forces are foretold under a plane only, and this is a "
                      "{}.\n\n",
                      curve.name);
  const FlexModuli moduli(flex->youngs_modulus, flex->poissons_ratio);
  return text + filled("mujoco_flex_readme.txt", fmt::arg("body", description(*flex)),
                       fmt::arg("young", moduli.young), fmt::arg("poisson", moduli.poisson),
                       fmt::arg("limit", flex->limit(curve)), fmt::arg("needed", needed));
}

}  // namespace

ContactExport mujoco_export(const ContactSource& source) {
  const ContactCurve& own = source.curves.front();
  const SoftContact contact = fitted_soft_contact(own.forces);
  ContactExport made;
  made.files.push_back({"finger_rigid.xml", rigid_model(source.loaded, own, contact)});
  std::vector<ForetoldModel> models = {by_law(
      "rigid geom", [contact](const ContactCurve&, double at) { return contact.force(at); })};
  const SoftBody* flex = own.obstacle.is_plane() ? &source.soft() : nullptr;
  if (flex != nullptr) {
    made.files.push_back({"finger_flex.xml", flex_model(source.loaded, own, *flex)});
    models.push_back(foretold("flex", *flex));
  }
  made.readme = mujoco_readme(source.loaded, own, contact, flex);
  made.said = fmt::format("rigid geom: K = {:.4g} N/m\n", contact.stiffness);
  if (flex != nullptr) made.said += "flex: " + summary(*flex, own) + "\n";
  made.transfer = transfer_of(
      "mujoco",
      "Force in MuJoCo at rest over that of the continuum: of the geom from its contact's formula, "
      "of the flex from an equilibrium of the same tetrahedra and contacts",
      source.lost, source.curves, models);
  const meshes::PressProtocol& protocol = source.loaded.config.press.protocol;
  if (const double arm = torsion_arm(own);
      protocol.contact == meshes::ContactMode::coulomb && !std::isnan(arm)) {
    add_torsion(made.transfer, source.curves,
                {"rigid geom", protocol.friction, [&](const ContactCurve& curve) {
                   std::vector<double> moments;
                   for (const double at : curve.forces.indentation)
                     moments.push_back(protocol.friction * arm * contact.force(at));
                   return moments;
                 }});
    made.said +=
        fmt::format("rigid geom: friction turns at {:.3g} mm times its sliding force\n", 1e3 * arm);
  }
  return made;
}

}  // namespace fingertip::studies::inline exchange
