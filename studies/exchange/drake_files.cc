#include "studies/exchange/drake_files.h"

#include <fmt/format.h>

#include <numbers>

#include "calibration/contact_laws/pressure_law.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/exchange/texts/texts.h"

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
  return filled("finger.sdf", fmt::arg("finger", loaded.config.press.geometry.shape_name()),
                fmt::arg("depth", 1e3 * curve.forces.indentation.back()),
                fmt::arg("obstacle", curve.name), fmt::arg("radius", to_text(ball.radius)),
                fmt::arg("mass", mass), fmt::arg("inertia", 0.4 * mass * ball.radius * ball.radius),
                fmt::arg("modulus", ball.modulus), fmt::arg("edge", resolution * ball.radius),
                fmt::arg("dissipation", to_text(no_bouncing)),
                fmt::arg("friction", friction(loaded)));
}

}  // namespace

ContactExport drake_export(const ContactSource& source) {
  const ContactCurve& own = source.curves.front();
  const double radius = meshes::shape_of(source.loaded.config.press.geometry)->pole_radius();
  const HydroelasticBall ball =
      calibration::fitted_hydroelastic_ball(own.forces, own.obstacle, radius);
  ContactExport made;
  made.files = {{"finger.sdf", sdf(source.loaded, own, ball)}};
  made.readme = filled("drake_readme.txt", fmt::arg("radius", 1e3 * ball.radius),
                       fmt::arg("modulus", ball.modulus));
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
