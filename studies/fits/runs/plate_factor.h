/// How much more force a cylinder takes between plates that hold its ends than between plates that
/// slip, by the axisymmetric continuum.
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/law_fit.h"
#include "fem_reference/job/job.h"
#include "studies/jobs/job.h"
#include "studies/measurements/material_test_file.h"

namespace fingertip::studies::inline fits::inline runs {

/// Of the rubber between stuck plates: its bulk modulus is 500 times its shear modulus, which
/// changes the force by less than the mesh does.
inline constexpr double plate_poissons_ratio = 0.499;

/// F(stuck)/F(homogeneous) over the mean stretch along the axis.
struct PlateFactor {
  std::vector<double> stretch, factor;  ///< stretch increasing, below 1
  /// Linear between, and the last one beyond, either end; 1 in tension.
  double at(double mean_stretch) const;
};

/// The cylinder glued to one plate and pressed by the other, sticking, to 2 ... 40 % of its height,
/// on one mesh (0.1 to 1 % of the force). `law` tells the shape of the energy; forces scale with G.
fem_reference::ReferenceJob stuck_cylinder(const Plates& plates, const calibration::SizedLaw& law);

/// Runs it by `context.run_all` in `place`. Throws as the job does, InvalidInput for a law that the
/// continuum refuses, unstable between 0.5 and 2.
PlateFactor plate_factor(const Plates& plates, const calibration::SizedLaw& law,
                         const std::string& place, const JobContext& context);

}  // namespace fingertip::studies::inline fits::inline runs
