#include "meshes/rubber/relaxation.h"

#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline rubber {

std::vector<Violation> Relaxation::violations() const {
  std::vector<Violation> found;
  double sum = 0.0;
  for (const RelaxationBranch& branch : branches) {
    if (!(std::isfinite(branch.share) && branch.share > 0.0))
      found.push_back({"rubber.relaxation", to_text(branch.share),
                       "the share g of a branch must be positive",
                       "give pairs of a share and a time, [[0.2, \"0.1 s\"]]"});
    if (!(std::isfinite(branch.time) && branch.time > 0.0))
      found.push_back({"rubber.relaxation", to_text(branch.time) + " s",
                       "the time of a branch must be positive",
                       "give pairs of a share and a time, [[0.2, \"0.1 s\"]]"});
    sum += branch.share;
  }
  if (!(sum < 1.0))
    found.push_back({"rubber.relaxation", to_text(sum),
                     "the shares of all branches must sum to less than 1, or nothing is left after "
                     "long times",
                     "lower the shares; they are those of the modulus at once, G0"});
  return found;
}

double Relaxation::instantaneous_ratio() const {
  double left = 1.0;
  for (const RelaxationBranch& branch : branches) left -= branch.share;
  return 1.0 / left;
}

double Relaxation::modulus(double time) const {
  double sum = 1.0;
  for (std::size_t i = 0; i < branches.size(); ++i)
    sum += relative_modulus(i) * std::exp(-time / branches[i].time);
  return sum;
}

double Relaxation::storage(double frequency) const {
  double sum = 1.0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double x = frequency * branches[i].time;
    sum += relative_modulus(i) * x * x / (1.0 + x * x);
  }
  return sum;
}

double Relaxation::loss(double frequency) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double x = frequency * branches[i].time;
    sum += relative_modulus(i) * x / (1.0 + x * x);
  }
  return sum;
}

PronyRecursion::PronyRecursion(double duration, double time) {
  const double x = duration / time;
  decay = std::exp(-x);
  if (x > 0.0) gain = -std::expm1(-x) / x;
}

}  // namespace fingertip::meshes::inline rubber
