#include "studies/report/figure/modulus_surfaces.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/press/press_response.h"
#include "studies/report/figure/format.h"

namespace fingertip::studies::report::inline figure {
namespace {

using calibration::ElasticModuli;

/// Facets from pole to pole: so many that a figure stays below 300 kB.
int facets_of(std::size_t surfaces) {
  return surfaces <= 2 ? 20 : surfaces <= 4 ? 16 : 12;
}

/// Rows of polar angle, columns of azimuth.
std::vector<std::vector<Surface::Point>> polar_surface(const ElasticModuli& moduli, int facets) {
  std::vector<std::vector<Surface::Point>> rows;
  for (int i = 0; i <= facets; ++i) {
    const double polar = i * std::numbers::pi / facets;
    rows.emplace_back();
    for (int j = 0; j <= 2 * facets; ++j) {
      const double azimuth = j * std::numbers::pi / facets;
      const Eigen::Vector3d n(std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth), std::cos(polar));
      const double E = shown_units().stress(calibration::youngs_modulus_along(moduli, n));
      rows.back().push_back({E * n.x(), E * n.y(), E * n.z(), E});
    }
  }
  return rows;
}

/// E of a cubic material is extreme along a cube axis or a body diagonal: a surface is drawn only
/// where both are lengths.
bool drawable(const ElasticModuli& moduli) {
  return moduli.youngs_modulus_100 > 0.0 && moduli.youngs_modulus_111 > 0.0 &&
         std::isfinite(moduli.youngs_modulus_100 + moduli.youngs_modulus_111);
}

}  // namespace

ElasticModuli cubic_material(double youngs_modulus, double poissons_ratio, double shear_modulus) {
  const double difference = youngs_modulus / (1.0 + poissons_ratio);
  const double sum = youngs_modulus / (1.0 - 2.0 * poissons_ratio);
  const double c12 = (sum - difference) / 3.0;
  return calibration::moduli_from_stiffness(c12 + difference, c12, shear_modulus);
}

Figure modulus_surface_figure(const std::string& name,
                              const std::vector<std::pair<std::string, ElasticModuli>>& materials) {
  Figure figure{name, 860, 370, 1, {}};
  double least = meshes::unknown, most = meshes::unknown;
  for (const auto& [title, moduli] : materials) {
    if (!drawable(moduli)) continue;
    for (const double E : {moduli.youngs_modulus_100, moduli.youngs_modulus_111}) {
      least = std::fmin(least, shown_units().stress(E));
      most = std::fmax(most, shown_units().stress(E));
    }
    Panel panel;
    panel.title = title;
    panel.x_label = shown_units().stress.label("E·n₁");
    panel.y_label = shown_units().stress.label("E·n₂");
    panel.surface = Surface{polar_surface(moduli, facets_of(materials.size())),
                            shown_units().stress.label("E·n₃"), shown_units().stress.label("E")};
    figure.panels.push_back(std::move(panel));
  }
  // Isotropic materials alone would leave the colours without a range.
  const double slack = std::fmax(0.0, 0.1 * most - (most - least)) / 2.0;
  for (Panel& panel : figure.panels) {
    panel.surface->extent = 1.02 * most;
    panel.surface->values = {least - slack, most + slack};
  }
  figure.columns = figure.panels.size() > 1 ? 2 : 1;
  figure.height *= std::max(1, int(figure.panels.size() + 1) / 2);
  return figure;
}

}  // namespace fingertip::studies::report::inline figure
