/// Verification of the continuum: its elements, loads, contact and solver against solutions that
/// come from elsewhere. As functions, which tests call in small, and as a run.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/run_progress.h"
#include "fem_reference/verification/elastic_problem.h"
#include "fem_reference/verification/verification_file.h"

namespace fingertip::fem_reference::inline verification {

/// The default rubber's E with another Poisson's ratio, -1 < nu < 0.5.
meshes::Rubber rubber_with(double poissons_ratio);
/// "Q2 projected"
std::string name(const ElementType& element);

/// Name of the mesh of a press in its folder.
inline constexpr const char* verification_mesh = "verification.msh";

/// `value` against `expected`, which is not zero.
inline Check compare(std::string name, std::string quantity, std::string source, double value,
                     double expected, double tolerance) {
  const double error = std::abs(value / expected - 1.0);
  return {std::move(name), std::move(quantity), std::move(source), value, expected,
          error,           tolerance,           error <= tolerance};
}

/// A ratio that should vanish.
inline Check vanishing(std::string name, std::string quantity, std::string source, double value,
                       double tolerance) {
  const double error = std::abs(value);
  return {std::move(name), std::move(quantity), std::move(source), value, 0.0,
          error,           tolerance,           error <= tolerance};
}

// Orders of convergence. `divisions` are element counts along an edge, coarse to fine, at least
// two.

/// A smooth displacement without symmetry (analytic::ManufacturedDisplacement) on a unit block,
/// held on three faces, under its tractions on the others. The block is curved (elements follow it
/// isoparametrically), or straight-sided with vertices moved at random by 15 % of their edge.
/// Nearly solenoidal: the variant whose load stays bounded as nu -> 1/2.
struct ManufacturedCase {
  bool curved = true;
  bool nearly_solenoidal = false;
  double poissons_ratio = 3.0 / 7.0;
};
ConvergenceStudy study_manufactured(const ManufacturedCase& problem, const ElementType& element,
                                    const std::vector<int>& divisions);
/// analytic::ManufacturedRevolution on the meridian of a unit cylinder, curved or distorted, held
/// at its outside and one end.
ConvergenceStudy study_manufactured_meridian(bool curved, const ElementType& element,
                                             const std::vector<int>& divisions);
/// Thick sphere (an octant, or its meridian) and cylinder (a quarter, plane strain) under pressure
/// inside and outside; the load is the pressure on the meshed surface, all else slides.
ConvergenceStudy study_sphere(const ElementType& element, double poissons_ratio,
                              const std::vector<int>& divisions, Meshed meshed = Meshed::solid);
ConvergenceStudy study_cylinder(const ElementType& element, double poissons_ratio,
                                const std::vector<int>& divisions, Meshed meshed = Meshed::solid);
/// Plate in plane strain under an end load, with the exact displacement at its root; `divisions`
/// through its height, four times as many along it.
ConvergenceStudy study_cantilever(const ElementType& element, double poissons_ratio,
                                  const std::vector<int>& divisions);

// Single figures.

/// Linear displacements: to round-off on distorted, curved and hanging-node meshes, of solids and
/// of meridians.
std::vector<Check> check_patch(const ElementType& element);
/// Six motions without energy, not five and not seven; of a meridian one.
std::vector<Check> check_rigid_modes(const ElementType& element);
/// Displacement and stress of sphere, cylinder and cantilever, on meshes of `divisions`.
std::vector<Check> check_fields(const ElementType& element, int divisions);
/// Bonded disc of radius 1 cm and `thickness` [m]: energy on a mesh refined at its edge, against
/// Ritz, and force of the plate against energy.
std::vector<Check> check_disc(double thickness, double poissons_ratio, const ElementType& element,
                              int local_refinements, Meshed meshed = Meshed::solid);

/// A hemispherical tip on a rod of radius `rod` R pressed by the indentations [m], meshes refined
/// until nodes stand densely enough at the edge; the excess of the force over Hertz is fitted by
/// c_0 + c_1 sqrt(delta/R) + c_2 delta/R, whose c_0 must vanish.
struct HertzResult {
  double rod = 0.0;                                         ///< its radius over R
  std::vector<double> indentations, forces, radii, excess;  ///< [m], [N], [m], F/F_Hertz - 1
  double intercept = 0.0, slope = 0.0;
};
HertzResult press_towards_hertz(double rod, const std::vector<double>& indentations,
                                int refinements, const std::filesystem::path& folder);
/// The intercept, and the contact radius against the force at the smallest indentation.
std::vector<Check> check_hertz(const HertzResult& result);
/// Quarter against half; force of the plane against force of the rod, before and after refinement.
std::vector<Check> check_press(const std::filesystem::path& folder);

// Locking: the same mesh for all elements.

std::vector<LockingPoint> lock_cantilever(const std::vector<double>& poissons_ratios);
std::vector<LockingPoint> lock_disc(const std::vector<double>& poissons_ratios);
/// Force of the default tip at 1 mm, frictionless, against a finer mesh of Q2 projected. These and
/// the functions above that take one keep a mesh file in `folder`.
std::vector<LockingPoint> lock_press(const std::vector<double>& poissons_ratios,
                                     const std::filesystem::path& folder);

/// All of it, into `folder`/verification.json, which is complete and readable after every part:
/// {"studies", "checks", "locking"}, the members of the structs above as keys, SI; summary.json
/// says how the run ended. Of the job only `analysis` matters. All processes of MPI_COMM_WORLD call
/// it, the first one writes; `progress` as for run_job, stage "verify". A check that fails is a
/// result, not an error.
RunOutcome run_verification(const std::filesystem::path& folder, const ReferenceJob& job,
                            std::ostream& progress, const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline verification
