/// The job file between the two programs: `fingertip` writes it, `fingertip-fem` carries it out.
/// Free of deal.II, so that the application does not link it.
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/base/names.h"
#include "meshes/press/fields.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::fem_reference::inline job {

/// How the linear systems are solved.
enum class LinearSolver {
  automatic,  ///< condensed on one process while it fits into memory, multigrid beyond
  condensed,  ///< sparse Cholesky factorisation; small strain: one, condensed to the contact
  multigrid,  ///< conjugate gradients preconditioned by algebraic multigrid
};

/// Which continuum.
enum class Strain {
  linear,  ///< small strain, Hooke's law, gap and moments at reference positions
  finite,  ///< large strain, the rubber's law, gap and moments at current positions
};

/// What is computed.
enum class Analysis {
  static_press,  ///< one equilibrium per sample
  transient,     ///< the press at constant speed, with inertia and Kelvin-Voigt damping
  modes,         ///< natural frequencies and shapes of the tip bonded to a fixed rod
  verification,  ///< the code against analytic solutions; ignores the press
};

/// How the volumetric part of the energy is integrated.
enum class Volumetric {
  pointwise,        ///< at every quadrature point: the plain displacement element
  mean_dilatation,  ///< its dilatation projected, element by element, on polynomials one degree
                    ///< lower
};

/// Whether a press along the axis is computed on the meridian of the body of revolution.
enum class Symmetry {
  automatic,     ///< wherever nothing breaks the symmetry
  axisymmetric,  ///< as automatic; a job that breaks it is refused
  none,          ///< as a solid
};

using meshes::name, meshes::values;
constexpr auto names_of(LinearSolver) {
  using enum LinearSolver;
  return meshes::names<LinearSolver>(
      {{automatic, "automatic"}, {condensed, "condensed"}, {multigrid, "multigrid"}});
}
constexpr auto names_of(Strain) {
  return meshes::names<Strain>({{Strain::linear, "linear"}, {Strain::finite, "finite"}});
}
constexpr auto names_of(Analysis) {
  using enum Analysis;
  return meshes::names<Analysis>({{static_press, "static"},
                                  {transient, "transient"},
                                  {modes, "modes"},
                                  {verification, "verification"}});
}
constexpr auto names_of(Volumetric) {
  using enum Volumetric;
  return meshes::names<Volumetric>({{pointwise, "pointwise"}, {mean_dilatation, "projected"}});
}
constexpr auto names_of(Symmetry) {
  using enum Symmetry;
  return meshes::names<Symmetry>(
      {{automatic, "automatic"}, {axisymmetric, "axisymmetric"}, {none, "none"}});
}

/// One order to the continuum, SI.
struct ReferenceJob {
  Analysis analysis = Analysis::static_press;
  meshes::Geometry geometry;
  meshes::Rubber rubber;
  /// Its samples are the indentations to solve for; its speed matters to a transient press and to a
  /// rubber that relaxes, its mode and clearance never.
  meshes::PressProtocol protocol;
  Strain strain = Strain::linear;
  Symmetry symmetry = Symmetry::automatic;
  int modes = 10;  ///< how many, lowest first
  int degree = 2;  ///< polynomial degree of the elements, 1, 2 or 3
  Volumetric volumetric = Volumetric::mean_dilatation;
  double refinement = 0.5;     ///< factor on the element counts of the first mesh, 0.25 ... 4
  double tolerance = 5e-3;     ///< wanted force_error over normal_force, at every sample
  double max_unknowns = 4e5;   ///< no mesh beyond this many is tried
  bool estimate_error = true;  ///< refine until `tolerance` is met; otherwise the first mesh alone
  LinearSolver solver = LinearSolver::automatic;
  double solver_tolerance = 1e-10;  ///< relative residual of the multigrid solver
  bool write_fields = true;         ///< VTU per sample and a PVD over them
  int field_sectors = 0;  ///< of the solid into which a meridian's fields are turned; 0: none

  /// Whether the meridian is meshed: a press of a body of revolution without tilt and lateral
  /// motion.
  bool axisymmetric() const;
  /// Whether time matters: to a transient press, and where the rubber relaxes.
  bool in_time() const {
    return analysis == Analysis::transient ||
           (analysis == Analysis::static_press && !rubber.relaxation.empty());
  }
  /// Solves for these indentations [m], increasing; the press ends at the last, without a program.
  void press_to(std::vector<double> samples);
  std::vector<meshes::Violation> violations() const;
};

FINGERTIP_FIELDS(ReferenceJob, analysis, geometry, rubber, protocol, strain, symmetry, modes,
                 degree, volumetric, refinement, tolerance, max_unknowns, estimate_error, solver,
                 solver_tolerance, write_fields, field_sectors);

/// JSON in and out (file `job.json` in the run folder). The surface of a solid, of which the job
/// has a digest, stands beside it in `solid.json`. Reading throws InvalidInput with the file and
/// the offending entry; entries that are absent keep their defaults.
void write_job(const ReferenceJob& job, const std::filesystem::path& file);
ReferenceJob read_job(const std::filesystem::path& file);

}  // namespace fingertip::fem_reference::inline job
