#include "fem_reference/contact/contact_surface.h"

#include <algorithm>

namespace fingertip::fem_reference::inline contact {

std::vector<SurfaceNode> within_reach(const std::vector<SurfaceNode>& nodes,
                                      const meshes::PressProtocol& protocol, double height,
                                      double reach) {
  // An obstacle is highest at its top: the place of its path where that is nearest counts.
  const auto [low, high] = protocol.lateral_range();
  std::vector<SurfaceNode> result;
  for (const SurfaceNode& node : nodes) {
    meshes::Vector3 at = node.position;
    at.x() -= std::clamp(at.x() - protocol.obstacle.offset, low, high);
    // Where it turns, a flat top may come to any place that an obstacle's top keeps away from.
    const double above = protocol.twists() && !protocol.obstacle.on_axis()
                             ? 0.0
                             : meshes::height(protocol.obstacle, at);
    if (at.z() + above >= height - reach) result.push_back(node);
  }
  return result;
}

ContactUnknowns contact_unknowns(const std::vector<SurfaceNode>& nodes, bool lateral) {
  ContactUnknowns result;
  for (const SurfaceNode& node : nodes) {
    std::array<int, 3> positions{-1, -1, -1};
    for (std::size_t c = lateral ? 0 : 2; c < 3; ++c) {
      if (!node.free[c]) continue;
      positions[c] = int(result.unknowns.size());
      result.unknowns.push_back(node.unknown[c]);
    }
    result.nodes.push_back(node);
    result.of_node.push_back(positions);
  }
  return result;
}

}  // namespace fingertip::fem_reference::inline contact
