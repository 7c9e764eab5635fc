/// CalculiX input: the axial frictionless press of the quarter tip, one step per depth.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "meshes/geometry.h"
#include "meshes/rubber.h"
#include "solid_mesh.h"

namespace fingertip::benchmarks {

/// CalculiX' hexahedra: linear, linear with incompatible modes, quadratic with 27 or 8 points.
enum class Element { c3d8, c3d8i, c3d20, c3d20r };

/// How the tip is kept from passing the plane.
enum class Contact {
  gap,      ///< GAPUNI between every surface node and a node that moves with the plane
  node,     ///< penalty, nodes against the plane's face
  surface,  ///< penalty at integration points of the faces
  mortar,   ///< Lagrange multipliers with dual shape functions, along the tip's normals
};

/// Linear solvers of Debian's CalculiX: direct, or conjugate gradients with a preconditioner.
enum class Solver { spooles, iterative_scaling, iterative_cholesky };

std::string_view name(Element element);
std::string_view name(Contact contact);
std::string_view name(Solver solver);

bool is_quadratic(Element element);

struct DeckOptions {
  Element element = Element::c3d20;
  Contact contact = Contact::surface;
  Solver solver = Solver::spooles;
  /// Penalty over Young's modulus: pressure over penetration [1/m] for contact surface and node,
  /// force over penetration [m] of one gap element; 0 takes CalculiX' own choice. Not used by
  /// mortar.
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

/// Writes the deck: `mesh` (linear or quadratic as `options.element` asks) of the quarter x >= 0,
/// y >= 0, bonded at the rod's surface, symmetric, pressed by a plane that descends from the pole
/// to each of `depths` [m] in a step of one increment. Small strain: no NLGEOM. The reactions of
/// the bonded nodes, summed, are printed at the end of each step.
void write_deck(const SolidMesh& mesh, const meshes::Geometry& geometry,
                const meshes::Rubber& rubber, const std::vector<double>& depths,
                const DeckOptions& options, const std::filesystem::path& file);

}  // namespace fingertip::benchmarks
