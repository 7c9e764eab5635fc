#include "lattice/dynamics/integrators/stepper.h"

#include <sstream>

namespace fingertip::lattice::inline dynamics::inline integrators {

void Stepper::accept(double step, bool whole) {
  ++count_.accepted;
  if (whole && !(count_.smallest > 0.0 && count_.smallest <= step)) count_.smallest = step;
}

std::string Stepper::counted() const {
  std::ostringstream text;
  text << count_.accepted << " steps, " << count_.rejected << " rejected";
  if (count_.forced > 0) text << ", " << count_.forced << " of the smallest size beyond the bound";
  return text.str();
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
