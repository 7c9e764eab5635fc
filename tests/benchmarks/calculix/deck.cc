#include "deck.h"

#include <array>
#include <iomanip>
#include <ostream>
#include <stdexcept>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::benchmarks {
namespace {

/// Edges of the surface further below the pole than this many times the largest depth can never be
/// reached and are left out of the contact search.
constexpr double reach = 1.2;

/// K/2 (ln J)² is the limit for b -> 0 of a pair of *HYPERFOAM terms of modulus K/4b and -K/4b,
/// alpha 2, beta b and -b, which sum to K/4b² (cosh(2b ln J) - 1), plus b² (ln J)²/3 of itself.
constexpr double pair_exponent = 0.02;

/// beta of the term that gives G/2 (I1 - 3 - 2 ln J) in the limit 0.
constexpr double logarithm_exponent = 1e-5;

/// Over the tip's radius: how near to a surface or the axis counts as on it.
constexpr double on_surface = 1e-9;

class Deck {
 public:
  Deck(const MeridianMesh& mesh, const meshes::Geometry& geometry, const meshes::Rubber& rubber,
       Problem problem, const std::vector<double>& depths, const DeckOptions& options,
       std::ostream& out)
      : mesh_(mesh),
        geometry_(geometry),
        rubber_(rubber),
        problem_(problem),
        depths_(depths),
        options_(options),
        out_(out) {}

  void write() {
    nodes();
    rubber();
    plane_and_pair();
    fixed();
    for (std::size_t step = 0; step < depths_.size(); ++step) press(step, "PLANE");
  }

  void write_cylinder(double height) {
    nodes();
    rubber();
    const double tolerance = on_surface * height;
    const auto lower = [&](const MeridianPoint& point) { return point.y() < tolerance; };
    const auto upper = [&](const MeridianPoint& point) { return point.y() > height - tolerance; };
    node_set("BOND", mesh_.nodes_where(lower));
    node_set("HEAD", mesh_.nodes_where(upper));
    node_set("AXIS", mesh_.nodes_where([&](const MeridianPoint& point) {
      return point.x() < tolerance && !lower(point) && !upper(point);
    }));
    out_ << "*BOUNDARY\nBOND, 1, 2\nAXIS, 1\nHEAD, 1\n";
    for (std::size_t step = 0; step < depths_.size(); ++step) press(step, "HEAD");
  }

 private:
  /// CalculiX numbers from 1.
  static std::size_t number(std::size_t index) { return index + 1; }

  void nodes() {
    // Hyperfoam terms cancel each other: all digits count.
    out_ << std::setprecision(15) << "*NODE, NSET=TIPNODES\n";
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
      out_ << number(i) << ", " << mesh_.nodes[i].x() * millimetres << ", "
           << mesh_.nodes[i].y() * millimetres << '\n';
  }

  /// All elements as the set `set` of the material of the same name, whose cards are to follow.
  void body(const char* set) {
    out_ << "*ELEMENT, TYPE=" << name(options_.element) << ", ELSET=" << set << '\n';
    for (const auto& element : mesh_.elements) {
      out_ << number(elements_++);
      for (std::size_t i = 0; i < mesh_.nodes_per_element(); ++i)
        out_ << ", " << number(element[i]);
      out_ << '\n';
    }
    out_ << "*SOLID SECTION, ELSET=" << set << ", MATERIAL=" << set << "\n*MATERIAL, NAME=" << set
         << '\n';
  }

  void rubber() {
    const double G = rubber_.shear_modulus * kilopascals;
    const double lambda = rubber_.lame_lambda() * kilopascals, K = lambda + 2.0 / 3.0 * G;
    // CalculiX asks for nu instead of beta.
    const auto nu = [](double beta) { return beta / (1.0 + 2.0 * beta); };
    const auto pair = [this](double modulus) {
      const double term = modulus / (4.0 * pair_exponent);
      out_ << term << ", 2., " << -term << ", 2., ";
    };
    const auto& shape = rubber_.energy.shape;
    body("TIP");
    switch (problem_) {
      case Problem::small_strain:
        out_ << "*ELASTIC\n"
             << rubber_.youngs_modulus * kilopascals << ", " << rubber_.poissons_ratio() << '\n';
        break;
      case Problem::law_a:
        out_ << "*HYPERFOAM, N=3\n";
        pair(lambda);
        out_ << G << ", 2., " << nu(pair_exponent) << ", " << nu(-pair_exponent) << ",\n"
             << nu(logarithm_exponent) << '\n';
        break;
      case Problem::law_c:
        // A compressibility beyond any leaves the shape; the volume has elements of its own.
        out_ << "*HYPERELASTIC, NEO HOOKE\n" << G / 2.0 << ", 1e20\n";
        body("VOLUME");
        out_ << "*HYPERFOAM, N=2\n";
        pair(K);
        out_ << nu(pair_exponent) << ", " << nu(-pair_exponent) << '\n';
        break;
      case Problem::neo_hooke:
        out_ << "*HYPERELASTIC, NEO HOOKE\n" << G / 2.0 << ", " << 2.0 / K << '\n';
        break;
      // Further volumetric terms are made small; 0 would mean nu = 0.475, 1e20 makes ogden diverge.
      case Problem::yeoh:
        out_ << "*HYPERELASTIC, YEOH\n"
             << G / 2.0 << ", " << shape[0] * G << ", " << shape[1] * G << ", " << 2.0 / K
             << ", 1e20, 1e20\n";
        break;
      case Problem::mooney_rivlin:
        out_ << "*HYPERELASTIC, MOONEY-RIVLIN\n"
             << G / 2.0 * (1.0 - shape[0]) << ", " << G / 2.0 * shape[0] << ", " << 2.0 / K << '\n';
        break;
      case Problem::ogden:
        out_ << "*HYPERELASTIC, OGDEN, N=2\n"
             << shape[0] * G << ", " << shape[1] << ", " << shape[2] * G << ", " << shape[3] << ", "
             << 2.0 / K << ", 1e4\n";
        break;
    }
  }

  /// The plane as the lower face of one prescribed hexahedron, and the contact pair. CalculiX turns
  /// axisymmetric elements into solids within one degree of the plane z = 0; a hexahedron that
  /// reaches further has no edge near the axis, where a sector's face narrows to nothing.
  void plane_and_pair() {
    const double R = geometry_.tip_radius * millimetres, side = 0.3 * R;
    static constexpr std::array<std::array<double, 2>, 4> corners{
        {{-1, 1}, {5, 1}, {5, -1}, {-1, -1}}};
    out_ << "*NODE, NSET=PLANE\n";
    for (std::size_t i = 0; i < 8; ++i)
      out_ << number(mesh_.nodes.size() + i) << ", " << side * corners[i % 4][0] << ", "
           << (i < 4 ? R : 1.5 * R) << ", " << side * corners[i % 4][1] << '\n';
    out_ << "*ELEMENT, TYPE=C3D8, ELSET=PLATE\n" << number(elements_);
    for (std::size_t i = 0; i < 8; ++i) out_ << ", " << number(mesh_.nodes.size() + i);
    out_ << "\n*MATERIAL, NAME=PLATE\n*ELASTIC\n1., 0.3\n"
         << "*SOLID SECTION, ELSET=PLATE, MATERIAL=PLATE\n"
         << "*SURFACE, NAME=PLANEFACE\n"
         << number(elements_) << ", S1\n*SURFACE, NAME=TIPFACE\n";
    const double lowest = geometry_.tip_radius - reach * depths_.back();
    for (const auto& [element, edge] : outer_edges(mesh_, geometry_, lowest))
      out_ << number(element) << ", S" << edge << '\n';
    out_ << "*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=";
    if (options_.stiffness > 0.0)
      out_ << "LINEAR\n"
           << options_.stiffness * rubber_.youngs_modulus * kilopascals / millimetres << ", 1e-6\n";
    else
      out_ << "HARD\n";
    out_ << "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=" << name(options_.contact)
         << "\nTIPFACE, PLANEFACE\n";
  }

  void node_set(const char* set, const std::vector<std::size_t>& nodes) {
    out_ << "*NSET, NSET=" << set << '\n';
    for (const std::size_t index : nodes) out_ << number(index) << ",\n";
  }

  void fixed() {
    const double tolerance = on_surface * geometry_.tip_radius;
    node_set("BOND", mesh_.nodes_where([&](const MeridianPoint& point) {
      return distance_from_core(point) < geometry_.rod_radius + tolerance;
    }));
    node_set("AXIS", mesh_.nodes_where([&](const MeridianPoint& point) {
      return point.x() < tolerance && point.y() > geometry_.rod_radius + tolerance;
    }));
    out_ << "*BOUNDARY\nBOND, 1, 2\nAXIS, 1\nPLANE, 1\nPLANE, 3\n";
  }

  void press(std::size_t step, const char* moved) {
    out_ << "*STEP, INC=1000" << (problem_ == Problem::small_strain ? "" : ", NLGEOM")
         << "\n*STATIC, SOLVER=" << name(options_.solver) << "\n1., 1.\n";
    if (options_.contact_change > 0.0 && step == 0)
      out_ << "*CONTROLS, PARAMETERS=CONTACT\n" << options_.contact_change << ", 0.1, 100, 60\n";
    out_ << "*BOUNDARY\n" << moved << ", 2, 2, " << -depths_[step] * millimetres << '\n';
    if (step == 0) out_ << "*NODE PRINT, NSET=BOND, TOTALS=ONLY, FREQUENCY=1000\nRF\n";
    out_ << "*END STEP\n";
  }

  const MeridianMesh& mesh_;
  const meshes::Geometry geometry_;
  const meshes::Rubber& rubber_;
  Problem problem_;
  const std::vector<double>& depths_;
  const DeckOptions& options_;
  std::ostream& out_;
  std::size_t elements_ = 0;  ///< written so far
};

}  // namespace

meshes::Rubber rubber_of(Problem problem) {
  using meshes::RubberLaw, meshes::VolumetricLaw;
  meshes::Rubber rubber;
  meshes::StrainEnergy& energy = rubber.energy;
  switch (problem) {
    case Problem::small_strain:
    case Problem::law_a: break;
    case Problem::law_c: energy.volumetric = VolumetricLaw::isochoric_logarithmic; break;
    case Problem::neo_hooke: energy.volumetric = VolumetricLaw::quadratic; break;
    case Problem::yeoh: energy = {RubberLaw::yeoh, VolumetricLaw::quadratic, {0.1, 0.02}}; break;
    case Problem::mooney_rivlin:
      energy = {RubberLaw::mooney_rivlin, VolumetricLaw::quadratic, {0.3}};
      break;
    case Problem::ogden:
      energy = {RubberLaw::ogden, VolumetricLaw::quadratic, {0.9, 1.4, 0.1, 6.0}};
      break;
  }
  return rubber;
}

std::string_view name(Problem problem) {
  switch (problem) {
    case Problem::small_strain: return "small strain";
    case Problem::law_a: return "law A";
    case Problem::law_c: return "law C";
    case Problem::neo_hooke: return "NEO HOOKE";
    case Problem::yeoh: return "YEOH";
    case Problem::mooney_rivlin: return "MOONEY-RIVLIN";
    case Problem::ogden: return "OGDEN";
  }
  return "";
}

std::string_view name(Element element) {
  switch (element) {
    case Element::cax4: return "CAX4";
    case Element::cax4r: return "CAX4R";
    case Element::cax8: return "CAX8";
    case Element::cax8r: return "CAX8R";
  }
  return "";
}

std::string_view name(Contact contact) {
  return contact == Contact::node ? "NODE TO SURFACE" : "SURFACE TO SURFACE";
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
  return element == Element::cax8 || element == Element::cax8r;
}

namespace {

void check_degree(const MeridianMesh& mesh, const DeckOptions& options) {
  if (mesh.quadratic != is_quadratic(options.element))
    throw std::invalid_argument("the mesh and the element must be of the same degree");
}

}  // namespace

void write_cylinder_deck(const MeridianMesh& mesh, double height, const meshes::Rubber& rubber,
                         Problem problem, const std::vector<double>& depths,
                         const DeckOptions& options, const std::filesystem::path& file) {
  check_degree(mesh, options);
  meshes::write_atomically(file, [&](std::ostream& out) {
    Deck(mesh, {}, rubber, problem, depths, options, out).write_cylinder(height);
  });
}

void write_deck(const MeridianMesh& mesh, const meshes::Geometry& geometry,
                const meshes::Rubber& rubber, Problem problem, const std::vector<double>& depths,
                const DeckOptions& options, const std::filesystem::path& file) {
  check_degree(mesh, options);
  meshes::write_atomically(file, [&](std::ostream& out) {
    Deck(mesh, geometry, rubber, problem, depths, options, out).write();
  });
}

}  // namespace fingertip::benchmarks
