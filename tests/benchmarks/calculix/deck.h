/// CalculiX input: the axial frictionless press of the tip's meridian, one step per depth.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "meridian_mesh.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::benchmarks {

/// What is pressed.
enum class Problem {
  small_strain,  ///< Hooke's law
  law_a,         ///< large strain, fingertip-fem's law A: *HYPERFOAM of three terms
  law_c,         ///< large strain, law C: two elements on the same nodes, *HYPERELASTIC, NEO HOOKE
                 ///< for the shape and *HYPERFOAM for the volume
  neo_hooke,     ///< large strain, *HYPERELASTIC, NEO HOOKE alone: law C but for K/2 (J - 1)²
  yeoh,          ///< *HYPERELASTIC, YEOH, with K/2 (J - 1)² as those below
  mooney_rivlin,
  ogden,  ///< of two terms
};

/// The rubber of a problem: the usual E and G, and the law as fingertip-fem has it.
meshes::Rubber rubber_of(Problem problem);

/// CalculiX' axisymmetric quadrilaterals: linear or quadratic, fully integrated or reduced.
enum class Element { cax4, cax4r, cax8, cax8r };

/// Where the penalty acts that keeps the tip from passing the plane.
enum class Contact {
  node,     ///< at the nodes of the tip
  surface,  ///< at integration points of its faces
};

/// Linear solvers of Debian's CalculiX: direct, or conjugate gradients with a preconditioner.
enum class Solver { spooles, iterative_scaling, iterative_cholesky };

std::string_view name(Problem problem);
std::string_view name(Element element);
std::string_view name(Contact contact);
std::string_view name(Solver solver);

bool is_quadratic(Element element);

struct DeckOptions {
  Element element = Element::cax8r;
  Contact contact = Contact::node;
  Solver solver = Solver::spooles;
  /// Penalty over Young's modulus, pressure over penetration [1/m]; 0 takes CalculiX' own choice.
  double stiffness = 0.0;
  /// Change in the number of touching points, relative, below which contact surface counts as
  /// settled; 0 takes CalculiX' own 0.001.
  double contact_change = 0.0;
};

/// Lengths in the deck are mm, forces mN, stresses kPa, which belong together: CalculiX prints
/// seven digits and starts from tolerances made for forces of order one.
inline constexpr double millimetres = 1e3;   ///< per metre
inline constexpr double millinewtons = 1e3;  ///< per newton
inline constexpr double kilopascals = 1e-3;  ///< per pascal

/// CalculiX computes a sector of two degrees and prints the forces on it.
inline constexpr double sectors = 180.0;

/// Writes the deck: `mesh` (linear or quadratic as `options.element` asks) of the meridian, y along
/// the axis, bonded at the rod's surface, held on the axis, pressed by a plane that descends from
/// the pole to each of `depths` [m] in a step of one increment. The reactions of the bonded nodes,
/// summed, are printed at the end of each step.
void write_deck(const MeridianMesh& mesh, const meshes::Geometry& geometry,
                const meshes::Rubber& rubber, Problem problem, const std::vector<double>& depths,
                const DeckOptions& options, const std::filesystem::path& file);

/// The same of a cylinder that stands at y = 0, `height` [m] high, between plates that hold its
/// ends: the upper one descends by each of `depths`.
void write_cylinder_deck(const MeridianMesh& mesh, double height, const meshes::Rubber& rubber,
                         Problem problem, const std::vector<double>& depths,
                         const DeckOptions& options, const std::filesystem::path& file);

}  // namespace fingertip::benchmarks
