/// Young's modulus against direction as a surface in space.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibration/material/moduli.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline figure {

/// A cubic material from tension along a cube axis and shear of its faces [Pa]: S11 = 1/E_100,
/// S12 = -nu_100/E_100, C11 - C12 = 1/(S11 - S12), C11 + 2 C12 = 1/(S11 + 2 S12) (Nye, Physical
/// Properties of Crystals, ch. VIII). `poissons_ratio` < 1/2.
calibration::ElasticModuli cubic_material(double youngs_modulus, double poissons_ratio,
                                          double shear_modulus);

/// E(n) n over all directions n, a panel per material under its title, all at the same scale and
/// with the same colours. Materials without finite positive moduli are left out; no panel
/// when none is left.
Figure modulus_surface_figure(
    const std::string& name,
    const std::vector<std::pair<std::string, calibration::ElasticModuli>>& materials);

}  // namespace fingertip::studies::report::inline figure
