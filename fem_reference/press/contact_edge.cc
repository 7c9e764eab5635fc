#include "fem_reference/press/contact_edge.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace fingertip::fem_reference::inline press {
namespace {

/// The edge is sought from the points beyond this share of the radius: the second one where the
/// first leaves too few of them to say more than the outermost does. At large strain p² has a peak
/// in the middle that a fit over more of the contact feels: over the outer half it is 2.5 % off at
/// 0.3 cm of law A without friction, 14 % with stick.
struct EdgeShare {
  double inner;
  int fewest_rings;
};
constexpr std::array<EdgeShare, 2> edge_shares = {{{0.7, 5}, {0.5, 3}}};

}  // namespace

double contact_edge(const std::vector<ContactPoint>& contact, double node_spacing,
                    int nodes_per_ring) {
  if (contact.empty()) return 0.0;
  const double outermost = contact.back().radius;
  for (const auto& [inner, fewest_rings] : edge_shares) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int count = 0;
    for (const ContactPoint& point : contact) {
      if (point.radius < inner * outermost) continue;
      const double s = std::pow(point.radius / outermost, 2);
      const Eigen::Vector3d basis(1.0, s, s * s);
      normal += basis * basis.transpose();
      right += point.pressure * point.pressure * basis;
      ++count;
    }
    if (count < fewest_rings * nodes_per_ring) continue;
    const Eigen::Vector3d c = normal.ldlt().solve(right);
    const double discriminant = c[1] * c[1] - 4 * c[2] * c[0];
    if (!(discriminant >= 0.0)) return outermost;
    // The root that a straight line has, too.
    const double root = 2 * c[0] / (-c[1] + std::sqrt(discriminant));
    if (!(root > 0.0)) return outermost;
    return std::clamp(outermost * std::sqrt(root), outermost - node_spacing,
                      outermost + node_spacing);
  }
  return outermost;
}

void measure_contact(PressState& state, int nodes_per_ring) {
  std::ranges::sort(state.contact, {}, &ContactPoint::radius);
  state.contact_radius = contact_edge(state.contact, state.node_spacing, nodes_per_ring);
  state.max_pressure = state.contact.empty()
                           ? 0.0
                           : std::ranges::max(state.contact, {}, &ContactPoint::pressure).pressure;
}

}  // namespace fingertip::fem_reference::inline press
