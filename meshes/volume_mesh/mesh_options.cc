#include "meshes/volume_mesh/mesh_options.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace fingertip::meshes::inline volume_mesh {

TipMeshOptions TipMeshOptions::refined(double factor) const {
  TipMeshOptions result = *this;
  for (int* count : {&result.cap_elements, &result.ring_elements, &result.sleeve_elements,
                     &result.radial_elements})
    *count = std::max(2, int(std::lround(*count * factor)));
  return result;
}

std::vector<Violation> TipMeshOptions::violations() const {
  std::vector<Violation> broken;
  const auto require = [&](bool valid, const char* key, double value, const char* rule,
                           const char* remedy) {
    if (!valid) broken.push_back({std::string("mesh.") + key, std::to_string(value), rule, remedy});
  };
  for (const auto& [key, count] :
       {std::pair{"cap_elements", cap_elements}, std::pair{"ring_elements", ring_elements},
        std::pair{"sleeve_elements", sleeve_elements},
        std::pair{"radial_elements", radial_elements}})
    require(count >= 2 && count <= 500, key, count, "must be between 2 and 500",
            "choose a count in this range");
  for (const auto& [key, ratio] :
       {std::pair{"cap_grading", cap_grading}, std::pair{"radial_grading", radial_grading}})
    require(ratio >= 1.0 && ratio <= 20.0, key, ratio, "must be between 1 and 20",
            "choose 1 for equal elements");
  require(cap_angle >= 0.2 && cap_angle <= 1.2, "cap_angle", cap_angle,
          "must be between 0.2 and 1.2 rad", "keep the cap off the pole and the equator");
  return broken;
}

}  // namespace fingertip::meshes::inline volume_mesh
