#include "lattice/contact/contact_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::lattice {

using Eigen::Matrix2d;

namespace {

constexpr double highest_peak = 2.0;  ///< b

/// Integrals over s of the profile with peak b, times s^n, n = 0, 1, 2: Euler's beta functions.
struct Profile {
  double zeroth, first, second;
  explicit Profile(double peak)
      : zeroth(2.0 / 3.0 + peak * 2.0 / 9.0),
        first(4.0 / 15.0 + peak * 4.0 / 99.0),
        second(16.0 / 105.0 + peak * 16.0 / 1287.0) {}
  double mean() const { return first / zeroth; }
  double kurtosis() const { return second * zeroth / (first * first); }
};

/// b from q = <s²>/<s>², which grows with it on the interval.
double peak_of(double q) {
  double low = 0.0, high = highest_peak;
  if (!(q > Profile(low).kurtosis())) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (Profile(middle).kurtosis() < q ? low : high) = middle;
  }
  return high;
}

/// Moments about the centre of pressure over the force.
class CentralMoments {
 public:
  explicit CentralMoments(const ForceMoments& sums) {
    const auto mean = [&](std::size_t i, std::size_t j) {
      return sums.power[ForceMoments::place(i, j)] / sums.power[0];
    };
    const double x = mean(1, 0), y = mean(0, 1);
    static constexpr double binomial[5][5] = {
        {1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
    for (std::size_t i = 0; i <= 4; ++i)
      for (std::size_t j = 0; i + j <= 4; ++j) {
        double& sum = values_[ForceMoments::place(i, j)];
        for (std::size_t k = 0; k <= i; ++k)
          for (std::size_t l = 0; l <= j; ++l)
            sum += binomial[i][k] * binomial[j][l] * std::pow(-x, double(i - k)) *
                   std::pow(-y, double(j - l)) * mean(k, l);
      }
  }
  double operator()(std::size_t i, std::size_t j) const {
    return values_[ForceMoments::place(i, j)];
  }
  Matrix2d second() const {
    const CentralMoments& c = *this;
    return Matrix2d{{c(2, 0), c(1, 1)}, {c(1, 1), c(0, 2)}};
  }
  /// <t²>/4; 0 if the points lie on a line.
  double kurtosis() const {
    const CentralMoments& c = *this;
    const Matrix2d S = second();
    if (!(S.determinant() > 1e-12 * S.squaredNorm())) return 0.0;
    const Matrix2d M = S.inverse();
    const double a = M(0, 0), b = M(0, 1), d = M(1, 1);
    return (a * a * c(4, 0) + 4.0 * a * b * c(3, 1) + (4.0 * b * b + 2.0 * a * d) * c(2, 2) +
            4.0 * b * d * c(1, 3) + d * d * c(0, 4)) /
           4.0;
  }

 private:
  std::array<double, 15> values_{};
};

/// The whole contact's from those of a sector: what is odd in a mirrored direction cancels.
ForceMoments mirrored(ForceMoments sums, int sectors) {
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t j = 0; i + j <= 4; ++j) {
      const bool odd = (sectors > 1 && j % 2 == 1) || (sectors > 2 && i % 2 == 1);
      sums.power[ForceMoments::place(i, j)] *= odd ? 0.0 : sectors;
    }
  sums.area *= sectors;
  return sums;
}

}  // namespace

void ForceMoments::add(const LoadedPoint& point) {
  double x = point.force;
  for (std::size_t i = 0; i <= 4; ++i, x *= point.place.x()) {
    double both = x;
    for (std::size_t j = 0; i + j <= 4; ++j, both *= point.place.y()) power[place(i, j)] += both;
  }
  area += point.force * point.area;
}

ContactPatch contact_patch(const ForceMoments& moments, int sectors) {
  const ForceMoments sums = mirrored(moments, sectors);
  const double force = sums.power[0];
  if (!(force > 0.0)) return {};
  const CentralMoments central(sums);
  const double peak = peak_of(central.kurtosis());
  const Profile profile(peak);
  const double own = sums.area / force / (4.0 * std::numbers::pi);  // of a disc
  const Matrix2d S = central.second() + own * Matrix2d::Identity();
  const double square = 2.0 * std::sqrt(std::max(S.determinant(), 0.0)) / profile.mean();  // A B
  return {std::sqrt(square), force * (1.0 + peak) / (std::numbers::pi * square * profile.zeroth)};
}

ContactPatch contact_patch(const std::vector<LoadedPoint>& points, int sectors) {
  ForceMoments sums;
  for (const LoadedPoint& point : points) sums.add(point);
  return contact_patch(sums, sectors);
}

}  // namespace fingertip::lattice
