#include "studies/files/mode_table.h"

namespace fingertip::studies {

std::vector<std::string> mode_motions(const meshes::CsvTable& modes) {
  if (modes.has("motion")) return modes.texts("motion");
  std::vector<std::string> motions = modes.texts("symmetry");
  const std::vector<double> multiplicity = modes.numbers_if_any("multiplicity");
  for (std::size_t i = 0; i < motions.size(); ++i) {
    std::string& motion = motions[i];
    if (multiplicity[i] == 1.0)
      motion = motion == "AA" ? "torsion" : "along the axis, breathing";
    else if (motion == "SA" || motion == "AS")
      motion = "sideways (an odd number of waves)";
    else if (!motion.empty())
      motion = "an even number of waves";
  }
  return motions;
}

}  // namespace fingertip::studies
