/// A finger of tetrahedra for simulators of soft bodies, with the modulus that suits them.
#pragma once

#include <string>
#include <vector>

#include "calibration/contact_laws/tetrahedral_body.h"
#include "studies/exchange/transfer.h"

namespace fingertip::studies::inline exchange {

struct SoftBody {
  calibration::TetrahedralBody body;
  double edge = 0.0;            ///< of its tetrahedra [m]
  double youngs_modulus = 0.0;  ///< fitted [Pa]
  double poissons_ratio = 0.0;  ///< the rubber's
  double stiffness = 0.0;       ///< of a vertex behind the plane, force over depth [N/m]
  std::vector<double> forces;   ///< at the first indentations of the curve [N]

  double shear_modulus() const;    ///< mu [Pa]
  double lambda() const;           ///< [Pa]
  std::string places() const;      ///< of the vertices, as lists in XML
  std::string tetrahedra() const;  ///< numbers of their vertices
  std::string held() const;        ///< numbers of vertices
  /// " Beyond 2 mm ... collapse." where the curve goes on beyond the body's forces.
  std::string limit(const ContactCurve& curve) const;
};

/// With tetrahedra as large as exchange.edge says and the Young's modulus whose forces are nearest
/// to the curve's, a plane's; contact is as stiff in proportion. Throws ConfigError where such
/// tetrahedra bear no press.
SoftBody fitted_soft_body(const LoadedConfig& loaded, const ContactCurve& curve);

/// Its forces on planes; on other obstacles they are not known.
ForetoldModel foretold(const std::string& name, const SoftBody& body);

/// What it is, for a README and in short for the screen.
std::string description(const SoftBody& body);
std::string summary(const SoftBody& body, const ContactCurve& curve);

}  // namespace fingertip::studies::inline exchange
