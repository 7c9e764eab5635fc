// In the place of triangle_tree.cc where CGAL cannot be: a solid is refused as soon as it is made.
#include "meshes/base/errors.h"
#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline shape {

namespace {

[[noreturn]] void refuse() {
  throw InvalidInput({"geometry.shape", "solid", "a browser's lattice has no triangles",
                      "take a dome or a profile, or the program"});
}

}  // namespace

struct TriangleTree::Trees {};

void check_crossings(const TriangleMesh&) {
  refuse();
}

TriangleTree::TriangleTree(const TriangleMesh&, const std::vector<int>&, int) {
  refuse();
}
TriangleTree::~TriangleTree() = default;

std::optional<TriangleTree::Hit> TriangleTree::nearest(const Vector3&, std::optional<int>) const {
  refuse();
}
bool TriangleTree::contains(const Vector3&) const {
  refuse();
}
std::optional<TriangleTree::Hit> TriangleTree::first_on_ray(const Vector3&, const Vector3&,
                                                            std::size_t) const {
  refuse();
}

}  // namespace fingertip::meshes::inline shape
