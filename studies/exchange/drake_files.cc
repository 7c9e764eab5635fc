#include "studies/exchange/drake_files.h"

#include <fmt/format.h>

#include <numbers>

#include "calibration/contact_laws/hydroelastic_ball.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline exchange {

namespace {

using calibration::HydroelasticBall;
using meshes::to_text;

/// Edges of the ball's mesh over its radius: contacts of a twelfth of the depth are seen.
constexpr double resolution = 0.1;
constexpr double no_bouncing = 5.0;  ///< Hunt and Crossley's dissipation [s/m]

std::string friction(const LoadedConfig& loaded) {
  const meshes::PressProtocol& protocol = loaded.config.press.protocol;
  return protocol.contact == meshes::ContactMode::frictionless ? "0"
         : protocol.contact == meshes::ContactMode::coulomb    ? to_text(protocol.friction)
                                                               : "10";
}

std::string sdf(const LoadedConfig& loaded, const ContactCurve& curve,
                const HydroelasticBall& ball) {
  const double mass = loaded.config.press.rubber.density * 4.0 / 3.0 * std::numbers::pi *
                      ball.radius * ball.radius * ball.radius;
  const double inertia = 0.4 * mass * ball.radius * ball.radius;
  const std::string sphere =
      "<geometry><sphere><radius>" + to_text(ball.radius) + "</radius></sphere></geometry>";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!-- {}, fitted to {:.4g} mm on a {}; pole at the origin, SI. README.md says how to use "
      "it. -->\n"
      "<sdf version=\"1.7\" xmlns:drake=\"drake.mit.edu\">\n<model name=\"finger\">\n"
      "  <link name=\"tip\">\n    <pose>0 0 {} 0 0 0</pose>\n"
      "    <inertial>\n      <mass>{:.9g}</mass>\n"
      "      <inertia><ixx>{:.9g}</ixx><ixy>0</ixy><ixz>0</ixz><iyy>{:.9g}</iyy><iyz>0</iyz>"
      "<izz>{:.9g}</izz></inertia>\n    </inertial>\n"
      "    <visual name=\"visual\">{}</visual>\n"
      "    <collision name=\"collision\">\n      {}\n"
      "      <drake:proximity_properties>\n"
      "        <drake:compliant_hydroelastic/>\n"
      "        <drake:hydroelastic_modulus>{:.9g}</drake:hydroelastic_modulus>\n"
      "        <drake:mesh_resolution_hint>{:.9g}</drake:mesh_resolution_hint>\n"
      "        <drake:hunt_crossley_dissipation>{}</drake:hunt_crossley_dissipation>\n"
      "        <drake:mu_static>{}</drake:mu_static>\n"
      "        <drake:mu_dynamic>{}</drake:mu_dynamic>\n"
      "      </drake:proximity_properties>\n    </collision>\n  </link>\n</model>\n</sdf>\n",
      loaded.config.press.geometry.shape_name(), 1e3 * curve.forces.indentation.back(), curve.name,
      to_text(-ball.radius), mass, inertia, inertia, inertia, sphere, sphere, ball.modulus,
      resolution * ball.radius, to_text(no_bouncing), friction(loaded), friction(loaded));
}

}  // namespace

ContactExport drake_export(const ContactSource& source) {
  const ContactCurve& own = source.curves.front();
  const double radius = meshes::shape_of(source.loaded.config.press.geometry)->pole_radius();
  const HydroelasticBall ball =
      calibration::fitted_hydroelastic_ball(own.forces, own.obstacle, radius);
  ContactExport made;
  made.files = {{"finger.sdf", sdf(source.loaded, own, ball)}};
  made.readme = fmt::format(
      "# A finger for Drake\n\n"
      "`finger.sdf`: a ball of {:.4g} mm, pole up at the origin, with hydroelastic contact. What "
      "it touches must be `rigid_hydroelastic`;\nset `contact_model = \"hydroelastic\"`. Its "
      "pressure is E_h (1 - r/R), r from the ball's centre; E_h = {:.6g} Pa is what meets\nthe "
      "continuum's forces best. Dissipation is chosen for calm, friction as `press.contact` "
      "says.\n\n",
      1e3 * ball.radius, ball.modulus);
  made.said = fmt::format("hydroelastic modulus {:.4g} Pa of a ball of {:.4g} mm\n", ball.modulus,
                          1e3 * ball.radius);
  made.transfer = transfer_of(
      "drake",
      "Force of the pressure field over the rigid obstacle's surface within the ball, over that of "
      "the continuum",
      source.lost, source.curves,
      {by_law("hydroelastic ball", [ball](const ContactCurve& curve, double at) {
        return ball.force(curve.obstacle, at);
      })});
  return made;
}

}  // namespace fingertip::studies::inline exchange
