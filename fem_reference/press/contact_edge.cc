#include "fem_reference/press/contact_edge.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace fingertip::fem_reference::inline press {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// The edge is sought from the nodes within so many spacings of the outermost: from as few as tell
/// it. At large strain p² has a peak in the middle that a fit over more of the contact feels: over
/// the outer half it is 2.5 % off at 0.3 cm of law A without friction, 14 % with stick.
constexpr std::array<double, 4> reaches = {5.0, 7.0, 10.0, 15.0};
constexpr int fewest_rings = 4;
constexpr int nodes_per_ring = 16;  ///< all around a solid's contact, at least
constexpr int points_around = 76;   ///< for which the outermost ring is told

Vector2d seen(const meshes::ContactPoint& node) {
  return node.place.head<2>();
}
/// Along the press.
double force(const meshes::ContactPoint& node) {
  return -node.force().z();
}
double seen_area(const meshes::ContactPoint& node) {
  return node.area * -node.normal.z();
}

/// s = (x - centre)ᵀ metric (x - centre).
struct Ellipse {
  Vector2d centre = Vector2d::Zero();
  Matrix2d metric = Matrix2d::Identity();
  double at(const Vector2d& place) const { return (place - centre).dot(metric * (place - centre)); }
  /// sqrt(A B) where s has this value.
  double radius(double s) const { return std::sqrt(s) / std::pow(metric.determinant(), 0.25); }
};

/// Nothing of a line.
std::optional<Ellipse> ellipse_of(const PushedNodes& contact) {
  if (contact.meridian) return Ellipse{};
  double sum = 0.0;
  Vector2d first = Vector2d::Zero();
  Matrix2d second = Matrix2d::Zero();
  for (const meshes::ContactPoint& node : contact.nodes) {
    sum += force(node);
    first += force(node) * seen(node);
    second += force(node) * seen(node) * seen(node).transpose();
  }
  if (!(sum > 0.0)) return {};
  Ellipse ellipse;
  ellipse.centre = first / sum;
  // What is odd in a mirrored direction cancels.
  if (contact.sectors > 1) ellipse.centre.y() = second(0, 1) = second(1, 0) = 0.0;
  if (contact.sectors > 2) ellipse.centre.x() = 0.0;
  const Matrix2d spread = second / sum - ellipse.centre * ellipse.centre.transpose();
  const double area = spread.determinant();
  if (!(area > 1e-6 * spread.squaredNorm())) return {};
  ellipse.metric = std::sqrt(area) * spread.inverse();
  return ellipse;
}

/// s at the zero of p²; nothing where the nodes tell none.
std::optional<double> edge_of(const PushedNodes& contact, const Ellipse& ellipse) {
  double outermost = 0.0;
  for (const meshes::ContactPoint& node : contact.nodes)
    outermost = std::max(outermost, ellipse.at(seen(node)));
  const double step = contact.spacing / ellipse.radius(outermost);
  for (const double reach : reaches) {
    if (!contact.meridian && reach == reaches.front()) continue;  // its outermost nodes scatter
    const double inner = std::max(0.0, 1.0 - reach * step);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int count = 0;
    for (const meshes::ContactPoint& node : contact.nodes) {
      const double s = ellipse.at(seen(node)) / outermost;
      if (!(s >= inner * inner && node.area > 0.0)) continue;
      const Eigen::Vector3d basis(1.0, s, s * s);
      normal += basis * basis.transpose();
      right += node.normal_traction * node.normal_traction * basis;
      ++count;
    }
    const int per_ring = contact.meridian ? 1 : nodes_per_ring / contact.sectors;
    if (count < fewest_rings * per_ring) continue;
    const Eigen::Vector3d c = normal.ldlt().solve(right);
    const double discriminant = c[1] * c[1] - 4 * c[2] * c[0];
    if (!(discriminant >= 0.0)) return {};
    // The root that a straight line has, too.
    const double root = 2 * c[0] / (-c[1] + std::sqrt(discriminant));
    // A spacing beyond the outermost node at most: else pressure does not vanish there.
    if (!(root > 0.0) || std::abs(std::sqrt(root) - 1.0) > step) return {};
    return root * outermost;
  }
  return {};
}

/// Points as far apart on all rings, but on the innermost; as many in each quarter.
int points_on(double share_of_outermost) {
  return share_of_outermost > 0.0 ? 4 * int(std::ceil(0.25 * points_around * share_of_outermost))
                                  : 1;
}

/// A ring of nodes about the axis: where r² has this value the pressure is this.
struct Ring {
  double square, pressure;
};

/// Where r vanishes: p is even in r and smooth, so that p² is linear in r² there, and of Hertz's
/// contact in all of it.
double pressure_at_pole(std::vector<Ring> rings) {
  constexpr std::size_t most = 4;
  std::ranges::sort(rings, {}, &Ring::square);
  rings.resize(std::min(most, rings.size()));
  if (rings.empty()) return 0.0;
  Ring mean{0.0, 0.0};  // of r² and p²
  for (const Ring& ring : rings) {
    mean.square += ring.square / double(rings.size());
    mean.pressure += ring.pressure * ring.pressure / double(rings.size());
  }
  double both = 0.0, spread = 0.0;
  for (const Ring& ring : rings) {
    const double off = ring.square - mean.square;
    both += off * ring.pressure * ring.pressure;
    spread += off * off;
  }
  const double slope = spread > 0.0 ? both / spread : 0.0;
  return std::sqrt(std::max(0.0, mean.pressure - slope * mean.square));
}

/// To the nearest other node; infinite of one alone.
double spacing_at(const meshes::ContactPoint& node,
                  const std::vector<meshes::ContactPoint>& nodes) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const meshes::ContactPoint& other : nodes)
    if (&other != &node) nearest = std::min(nearest, (seen(other) - seen(node)).norm());
  return nearest;
}

}  // namespace

std::vector<meshes::ContactPoint> pushed_nodes(const PlaneContact& contact,
                                               const std::vector<meshes::Vector3>& moved,
                                               const std::vector<double>& seen,
                                               const std::vector<double>& squares) {
  const std::vector<SurfaceNode>& nodes = contact.unknowns().nodes;
  const std::vector<NodeStatus>& status = contact.status();
  std::vector<meshes::Vector3> force(nodes.size(), meshes::Vector3::Zero());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (status[i] != NodeStatus::open) force[contact.leader(i)] += contact.reaction(i);
  std::vector<meshes::ContactPoint> pushed;
  std::vector<Ring> rings;
  std::optional<std::size_t> pole;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (status[i] == NodeStatus::open) continue;
    const bool is_pole = contact.leader(i) != i;
    if (!is_pole && !(seen[i] > 0.0)) continue;
    if (is_pole) pole = pushed.size();
    meshes::ContactPoint& point = pushed.emplace_back();
    point.rest = nodes[i].position;
    point.place = point.rest + moved[i];
    point.normal = contact.normal(i);
    // A pole, which cannot move aside, does what its neighbour does.
    point.state = status[contact.leader(i)] == NodeStatus::stick ? meshes::ContactState::stick
                                                                 : meshes::ContactState::slip;
    if (is_pole) continue;
    point.area = seen[i] / -point.normal.z();
    point.set_force(force[i]);
    if (!squares.empty()) rings.push_back({squares[i], point.normal_traction});
  }
  if (rings.empty() && pole) {  // it touches alone, and no pressure is known
    pushed.clear();
  } else if (pole) {
    pushed[*pole].normal_traction = pressure_at_pole(std::move(rings));
    pushed[*pole].reach = 0.5 * spacing_at(pushed[*pole], pushed);
  }
  return pushed;
}

double contact_radius(const PushedNodes& contact) {
  double area = 0.0;
  for (const meshes::ContactPoint& node : contact.nodes) area += contact.sectors * seen_area(node);
  const double own = std::sqrt(area / std::numbers::pi);
  const auto ellipse = ellipse_of(contact);
  const auto edge = ellipse ? edge_of(contact, *ellipse) : std::nullopt;
  if (!edge) return own;
  return std::clamp(ellipse->radius(*edge), std::max(0.0, own - contact.spacing),
                    own + contact.spacing);
}

void measure_contact(PressState& state, const PushedNodes& contact) {
  state.node_spacing = contact.spacing;
  state.contact.clear();
  if (contact.nodes.empty()) return state.set_contact(0.0, 0.0);
  double outermost = 0.0;
  for (const meshes::ContactPoint& node : contact.nodes)
    outermost = std::max(outermost, seen(node).norm());
  for (const meshes::ContactPoint& node : contact.nodes) {
    if (contact.meridian && node.area > 0.0)
      std::ranges::copy(turned_around(node, points_on(seen(node).norm() / outermost)),
                        std::back_inserter(state.contact));
    else
      state.contact.push_back(node);
  }
  if (!contact.meridian) state.contact = meshes::unfolded(contact.nodes, contact.sectors);
  const auto peak =
      std::ranges::max_element(contact.nodes, {}, &meshes::ContactPoint::normal_traction);
  state.peak_spacing = std::min(spacing_at(*peak, contact.nodes), contact.spacing);
  state.set_contact(contact_radius(contact), peak->normal_traction);
}

}  // namespace fingertip::fem_reference::inline press
