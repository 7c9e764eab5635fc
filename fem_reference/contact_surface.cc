#include "fem_reference/contact_surface.h"

namespace fingertip::fem_reference {

ContactUnknowns contact_unknowns(const std::vector<SurfaceNode>& nodes, bool lateral,
                                 double lowest) {
  ContactUnknowns result;
  for (const SurfaceNode& node : nodes) {
    if (node.position.z() < lowest) continue;
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

}  // namespace fingertip::fem_reference
