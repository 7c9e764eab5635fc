// The press with its contact: Hertz's limit, symmetry, balance of forces.
#include <Eigen/QR>
#include <cmath>

#include "fem_reference/analytic/hertz.h"
#include "fem_reference/press/press.h"
#include "fem_reference/tip/job_mesh.h"
#include "fem_reference/verification/verification.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline verification {
namespace {

ReferenceJob frictionless(const meshes::Geometry& geometry, std::vector<double> samples) {
  ReferenceJob job;
  job.symmetry = Symmetry::none;
  job.geometry = geometry;
  job.protocol.contact = meshes::ContactMode::frictionless;
  job.press_to(std::move(samples));
  return job;
}

}  // namespace

HertzResult press_towards_hertz(double rod, const std::vector<double>& indentations,
                                int refinements, const std::filesystem::path& folder) {
  meshes::Geometry geometry;
  geometry.rod_radius = rod * geometry.tip_radius;
  geometry.sleeve_length = 0.0;
  const ReferenceJob job = frictionless(geometry, indentations);
  meshes::TipMeshOptions options;
  options.cap_elements = 8, options.cap_grading = 20.0;
  options.ring_elements = 3, options.radial_elements = 8, options.radial_grading = 8.0;
  write_mesh_once(geometry, options, folder / verification_mesh);
  const auto press = ContinuumPress::on(job, folder / verification_mesh);
  HertzResult result;
  result.rod = rod;
  const analytic::Hertz hertz(job.rubber, geometry.tip_radius);
  for (int mesh = 0; mesh <= refinements; ++mesh) {
    if (mesh > 0) press->refine(0.7);
    result.forces.clear(), result.radii.clear();
    for (const double indentation : indentations) {
      const PressState state = press->advance(indentation);
      result.forces.push_back(state.normal_force);
      result.radii.push_back(state.contact_radius);
    }
  }
  result.indentations = indentations;
  const auto count = Eigen::Index(indentations.size());
  Eigen::MatrixXd powers(count, 3);
  Eigen::VectorXd excess(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double delta = indentations[std::size_t(i)] / geometry.tip_radius;
    powers.row(i) << 1.0, std::sqrt(delta), delta;
    excess[i] = result.forces[std::size_t(i)] / hertz.force(indentations[std::size_t(i)]) - 1.0;
    result.excess.push_back(excess[i]);
  }
  const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(excess);
  result.intercept = fit[0];
  result.slope = fit[1];
  return result;
}

std::vector<Check> check_hertz(const HertzResult& result) {
  const analytic::Hertz hertz(meshes::Rubber{}, meshes::Geometry{}.tip_radius);
  const std::string title = "Hertz, hemisphere on a rod of " + meshes::to_text(result.rod) + " R";
  // Radius and force belong to the neighbourhood of the contact; the indentation also has in it how
  // far the rest of the body gives way.
  const double at_force = hertz.contact_radius(hertz.indentation_at_force(result.forces.front()));
  return {vanishing(title, "F/F_Hertz - 1, extrapolated to delta = 0", "Johnson 1985, section 4.2",
                    result.intercept, 0.01),
          compare(title, "contact radius at the force of the smallest indentation [m]",
                  "Johnson 1985, section 4.2", result.radii.front(), at_force, 0.01)};
}

std::vector<Check> check_press(const std::filesystem::path& folder) {
  const meshes::TipMeshOptions quarter = meshes::TipMeshOptions{}.refined(0.35);
  meshes::TipMeshOptions half = quarter;
  half.sector = meshes::Sector::half;
  constexpr double depth = 2e-3;
  ReferenceJob job = frictionless({}, {depth});
  std::vector<Check> checks;
  const auto force = [&](ContinuumPress& press, const std::string& mesh, double sectors) {
    const double normal_force = press.advance(depth).normal_force;
    checks.push_back(vanishing("balance of forces, " + mesh,
                               "force of the rod over force of the plane - 1", "equilibrium",
                               sectors * press.bond_reaction().z() / normal_force - 1.0, 1e-8));
    return normal_force;
  };
  write_mesh_once(job.geometry, quarter, folder / verification_mesh);
  const auto quarter_press = ContinuumPress::on(job, folder / verification_mesh);
  const double of_quarter = force(*quarter_press, "quarter", 4.0);
  // Twice by a half of the estimated error: hanging nodes come to stand beside the bond, too.
  quarter_press->refine(0.5);
  force(*quarter_press, "quarter, refined once", 4.0);
  quarter_press->refine(0.5);
  force(*quarter_press, "quarter, refined twice", 4.0);
  // A tilt that changes nothing but makes the press take the half.
  job.protocol.tilt = 1e-12;
  write_mesh_once(job.geometry, half, folder / verification_mesh);
  const auto half_press = ContinuumPress::on(job, folder / verification_mesh);
  const double of_half = force(*half_press, "half", 2.0);
  checks.push_back(compare("symmetry", "force of the half against four quarters [N]",
                           "mirror planes of the press", of_half, of_quarter, 1e-6));
  return checks;
}

}  // namespace fingertip::fem_reference::inline verification
