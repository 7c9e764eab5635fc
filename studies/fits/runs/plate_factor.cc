#include "studies/fits/runs/plate_factor.h"

#include <cmath>
#include <numbers>

#include "meshes/press/press_response.h"
#include "meshes/tables/interpolation.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::SizedLaw;
using fem_reference::ReferenceJob;

namespace {

/// Shares of the height.
const std::vector<double> compressions = {0.02, 0.05, 0.1, 0.2, 0.3, deepest_stuck_compression};

}  // namespace

double PlateFactor::at(double mean_stretch) const {
  return mean_stretch >= 1.0 ? 1.0 : meshes::interpolated(stretch, factor, mean_stretch);
}

ReferenceJob stuck_cylinder(const Plates& plates, const SizedLaw& law) {
  using meshes::ProfileCorner, meshes::ProfileSurface;
  const double radius = 0.5 * plates.diameter, height = plates.height;
  const auto corner = [](double r, double z, ProfileSurface surface) {
    ProfileCorner made;
    made.r = r;
    made.z = z;
    made.surface = surface;
    return made;
  };
  ReferenceJob job;
  // The sides may come to lie on the plate.
  job.geometry = meshes::Geometry::of_profile(
      {corner(radius, 0.0, ProfileSurface::contact),
       corner(radius, height, ProfileSurface::contact), corner(0.0, height, ProfileSurface::axis),
       corner(0.0, 0.0, ProfileSurface::bond)},
      std::nullopt);
  job.rubber.shear_modulus = law.shear_modulus;
  job.rubber.youngs_modulus = 2.0 * law.shear_modulus * (1.0 + plate_poissons_ratio);
  job.rubber.energy = law.energy;
  job.rubber.energy.volumetric = meshes::VolumetricLaw::quadratic;
  job.strain = fem_reference::Strain::finite;
  job.protocol.contact = meshes::ContactMode::stick;
  job.estimate_error = false;
  job.write_fields = false;
  std::vector<double> samples;
  for (const double share : compressions) samples.push_back(share * height);
  job.press_to(samples);
  return job;
}

PlateFactor plate_factor(const Plates& plates, const SizedLaw& law, const std::string& place,
                         const JobContext& context) {
  const ReferenceJob job = stuck_cylinder(plates, law);
  const auto broken = job.violations();
  if (!broken.empty()) throw meshes::InvalidInput(broken);
  const auto folders = context.run_all({{place, reference_job(job)}});
  const double area = 0.25 * std::numbers::pi * plates.diameter * plates.diameter;
  PlateFactor found;
  const auto response = meshes::PressResponse::read_csv(folders.front() / "response.csv");
  for (const meshes::PressSample& sample : response.samples()) {
    const double stretch = 1.0 - sample.indentation / plates.height;
    const double slipping = -area * test_stress(law, calibration::TestKind::uniaxial,
                                                calibration::StressMeasure::nominal, stretch);
    found.stretch.insert(found.stretch.begin(), stretch);
    found.factor.insert(found.factor.begin(), sample.normal_force / slipping);
  }
  return found;
}

}  // namespace fingertip::studies::inline fits::inline runs
