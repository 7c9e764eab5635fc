#include "deck.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>

#include "meshes/files.h"

namespace fingertip::benchmarks {
namespace {

using meshes::Vector3;

/// Surface nodes and faces further below the pole than this many times the largest depth can
/// never be reached and are left out of the contact search.
constexpr double reach = 1.1;

class Deck {
 public:
  Deck(const SolidMesh& mesh, const meshes::Geometry& geometry, const meshes::Rubber& rubber,
       const std::vector<double>& depths, const DeckOptions& options, std::ostream& out)
      : mesh_(mesh),
        geometry_(geometry),
        rubber_(rubber),
        depths_(depths),
        options_(options),
        out_(out),
        lowest_(geometry.tip_radius - reach * depths.back()) {}

  void write() {
    out_ << std::setprecision(12);
    solid();
    bond();
    if (options_.contact == Contact::gap)
      gaps();
    else
      plane_and_pair();
    symmetry();
    fixed();
    for (std::size_t step = 0; step < depths_.size(); ++step) press(step);
  }

 private:
  /// CalculiX numbers from 1.
  static std::size_t number(std::size_t index) { return index + 1; }

  void node(std::size_t index, const Vector3& w) {
    const Vector3 scaled = w * millimetres;
    out_ << number(index) << ", " << scaled.x() << ", " << scaled.y() << ", " << scaled.z() << '\n';
  }

  void node_set(const char* set, const std::vector<std::size_t>& nodes) {
    out_ << "*NSET, NSET=" << set << '\n';
    for (const std::size_t index : nodes) out_ << number(index) << ",\n";
  }

  void solid() {
    out_ << "*NODE, NSET=TIPNODES\n";
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) node(i, mesh_.nodes[i]);
    out_ << "*ELEMENT, TYPE=" << name(options_.element) << ", ELSET=TIP\n";
    const std::size_t count = mesh_.nodes_per_element();
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      out_ << number(e);
      for (std::size_t i = 0; i < count; ++i) {
        // A line holds at most 16 entries.
        out_ << ", " << (i == 10 ? "\n" : "") << number(mesh_.elements[e][i]);
      }
      out_ << '\n';
    }
    out_ << "*MATERIAL, NAME=RUBBER\n*ELASTIC\n"
         << rubber_.youngs_modulus * kilopascals << ", " << rubber_.poissons_ratio() << '\n'
         << "*SOLID SECTION, ELSET=TIP, MATERIAL=RUBBER\n";
  }

  void bond() {
    const double tolerance = 1e-9 * geometry_.tip_radius;
    node_set("BOND", mesh_.nodes_where([&](const Vector3& w) {
      return meshes::Geometry::radial_distance(w) < geometry_.rod_radius + tolerance;
    }));
  }

  std::vector<std::size_t> reachable_nodes() const {
    const double tolerance = 1e-9 * geometry_.tip_radius;
    return mesh_.nodes_where([&](const Vector3& w) {
      return w.z() > lowest_ && w.norm() > geometry_.tip_radius - tolerance;
    });
  }

  /// One gap element per surface node; its clearance is the node's distance from the plane.
  void gaps() {
    const auto nodes = reachable_nodes();
    const std::size_t first = mesh_.nodes.size();
    out_ << "*NODE, NSET=PLANE\n";
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vector3 above = mesh_.nodes[nodes[i]];
      above.z() = geometry_.tip_radius;
      node(first + i, above);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t element = number(mesh_.elements.size() + i);
      const double clearance = geometry_.tip_radius - mesh_.nodes[nodes[i]].z();
      out_ << "*ELEMENT, TYPE=GAPUNI, ELSET=GAP" << i << '\n'
           << element << ", " << number(nodes[i]) << ", " << number(first + i) << '\n'
           << "*GAP, ELSET=GAP" << i << '\n'
           << std::max(clearance, 0.0) * millimetres << ", 0., 0., 1.";
      if (options_.stiffness > 0.0) {
        const double spring = options_.stiffness * rubber_.youngs_modulus;  // N/m = mN/mm
        out_ << ", , " << spring << ", 1e-6";
      }
      out_ << '\n';
    }
  }

  /// The plane as the lower face of one prescribed hexahedron, and the contact pair.
  void plane_and_pair() {
    const double r = geometry_.tip_radius;
    const std::size_t first = mesh_.nodes.size();
    const std::array<double, 2> side{-0.3 * r, 1.3 * r};
    out_ << "*NODE, NSET=PLANE\n";
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t corner = i % 4;
      node(first + i, {side[corner == 1 || corner == 2], side[corner >= 2], i < 4 ? r : 1.5 * r});
    }
    out_ << "*ELEMENT, TYPE=C3D8, ELSET=PLATE\n" << number(mesh_.elements.size());
    for (std::size_t i = 0; i < 8; ++i) out_ << ", " << number(first + i);
    out_ << "\n*SOLID SECTION, ELSET=PLATE, MATERIAL=RUBBER\n"
         << "*SURFACE, NAME=PLANEFACE\n"
         << number(mesh_.elements.size()) << ", S1\n";
    if (options_.contact == Contact::node && !mesh_.quadratic) {
      node_set("REACH", reachable_nodes());
      out_ << "*SURFACE, NAME=TIPFACE, TYPE=NODE\nREACH\n";
    } else {
      out_ << "*SURFACE, NAME=TIPFACE\n";
      for (const auto& [element, face] : outer_faces(mesh_, geometry_, lowest_))
        out_ << number(element) << ", S" << face << '\n';
    }
    interaction();
  }

  void interaction() {
    const bool penalty = options_.contact == Contact::node || options_.contact == Contact::surface;
    out_ << "*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=";
    if (penalty && options_.stiffness > 0.0) {
      const double stiffness =
          options_.stiffness * rubber_.youngs_modulus * kilopascals / millimetres;
      out_ << "LINEAR\n" << stiffness << ", 1e-6\n";
    } else {
      out_ << "HARD\n";
    }
    out_ << "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=" << name(options_.contact)
         << "\nTIPFACE, PLANEFACE\n";
  }

  /// The symmetry planes. CalculiX 2.20 ends without a word when mortar contact meets a fixed
  /// degree of freedom on the slave surface; there stiff springs to the ground stand in.
  void symmetry() {
    const double tolerance = 1e-9 * geometry_.tip_radius;
    const bool springs = options_.contact == Contact::mortar;
    const std::set<std::size_t> slaves = springs ? nodes_of_outer_faces() : std::set<std::size_t>{};
    std::size_t element = mesh_.elements.size() + 1;  // after the plate
    for (int axis = 0; axis < 2; ++axis) {
      const std::string letter = axis == 0 ? "X" : "Y";
      const auto on_plane =
          mesh_.nodes_where([&](const Vector3& w) { return w[axis] < tolerance; });
      out_ << "*NSET, NSET=SYM" << letter << '\n';
      for (const std::size_t index : on_plane)
        if (!slaves.contains(index)) out_ << number(index) << ",\n";
      if (!springs) continue;
      out_ << "*ELEMENT, TYPE=SPRING1, ELSET=SPRING" << letter << '\n';
      for (const std::size_t index : on_plane)
        if (slaves.contains(index)) out_ << number(element++) << ", " << number(index) << '\n';
      // CalculiX tells a stiffness from a degree of freedom by its decimal point.
      out_ << "*SPRING, ELSET=SPRING" << letter << '\n' << axis + 1 << "\n1000000.\n";
    }
  }

  std::set<std::size_t> nodes_of_outer_faces() const {
    const double tolerance = 1e-9 * geometry_.tip_radius;
    std::set<std::size_t> nodes;
    for (const auto& [element, face] : outer_faces(mesh_, geometry_, lowest_))
      for (std::size_t i = 0; i < mesh_.nodes_per_element(); ++i) {
        const std::size_t index = mesh_.elements[element][i];
        if (meshes::Geometry::radial_distance(mesh_.nodes[index]) >
            geometry_.tip_radius - tolerance)
          nodes.insert(index);
      }
    return nodes;
  }

  void fixed() { out_ << "*BOUNDARY\nBOND, 1, 3\nSYMX, 1\nSYMY, 2\nPLANE, 1, 2\n"; }

  void press(std::size_t step) {
    // GAPUNI is a nonlinear spring, but does not by itself make CalculiX iterate. NLGEOM does, and
    // NLGEOM=NO after it takes large strain back while the iterations stay (ccx' steps.f).
    const bool gaps = options_.contact == Contact::gap;
    out_ << "*STEP, INC=1000" << (gaps ? ", NLGEOM, NLGEOM=NO" : "")
         << "\n*STATIC, SOLVER=" << name(options_.solver) << "\n1., 1.\n";
    if (options_.contact_change > 0.0 && step == 0)
      out_ << "*CONTROLS, PARAMETERS=CONTACT\n" << options_.contact_change << ", 0.1, 100, 60\n";
    out_ << "*BOUNDARY\nPLANE, 3, 3, " << -depths_[step] * millimetres << '\n';
    if (step == 0) out_ << "*NODE PRINT, NSET=BOND, TOTALS=ONLY, FREQUENCY=1000\nRF\n";
    out_ << "*END STEP\n";
  }

  const SolidMesh& mesh_;
  const meshes::Geometry& geometry_;
  const meshes::Rubber& rubber_;
  const std::vector<double>& depths_;
  const DeckOptions& options_;
  std::ostream& out_;
  double lowest_;
};

}  // namespace

std::string_view name(Element element) {
  switch (element) {
    case Element::c3d8: return "C3D8";
    case Element::c3d8i: return "C3D8I";
    case Element::c3d20: return "C3D20";
    case Element::c3d20r: return "C3D20R";
  }
  return "";
}

std::string_view name(Contact contact) {
  switch (contact) {
    case Contact::gap: return "GAPUNI";
    case Contact::node: return "NODE TO SURFACE";
    case Contact::surface: return "SURFACE TO SURFACE";
    case Contact::mortar: return "MORTAR";
  }
  return "";
}

std::string_view name(Solver solver) {
  switch (solver) {
    case Solver::spooles: return "SPOOLES";
    case Solver::iterative_scaling: return "ITERATIVE SCALING";
    case Solver::iterative_cholesky: return "ITERATIVE CHOLESKY";
  }
  return "";
}

bool is_quadratic(Element element) {
  return element == Element::c3d20 || element == Element::c3d20r;
}

void write_deck(const SolidMesh& mesh, const meshes::Geometry& geometry,
                const meshes::Rubber& rubber, const std::vector<double>& depths,
                const DeckOptions& options, const std::filesystem::path& file) {
  if (mesh.quadratic != is_quadratic(options.element))
    throw std::invalid_argument("the mesh and the element must be of the same degree");
  meshes::write_atomically(
      file, [&](std::ostream& out) { Deck(mesh, geometry, rubber, depths, options, out).write(); });
}

}  // namespace fingertip::benchmarks
