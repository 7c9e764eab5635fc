#include "meshes/press/contact_patch.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "meshes/press/press_response.h"

namespace fingertip::meshes::inline press {

using Eigen::Matrix2d;

namespace {

constexpr double highest_peak = 2.0;  ///< b
/// Of one ellipse, known by enough points: q, and |<z^4>| + |<z^3 z'>|, which is 0 of the pressure.
/// Measured on domes, hollow and oval fingers under planes, balls, edges and cylinders: 1.31
/// to 1.49, at most 1.0. A line contact has 2.4, a rectangle, too, two of them 3.8; a ring or three
/// spots have q below 1.2.
constexpr double min_q = 1.25, max_q = 1.75, max_uneven = 3.0;
/// Where the points that bear have most of the ellipse's area, they miss none of their own: the
/// least q and the largest of the other are stricter there. A flat disc has 4/3 and 0.80 of the
/// area, a rectangle 7/5 and 0.76.
constexpr double bearing_share = 0.75, min_q_there = 1.36, max_uneven_there = 1.5;
/// Second moment of a point's own patch over that of the pressure, along the narrower axis, where
/// points are enough: on a flat disc 200. Of fewer the moments are chance: on round fingers from
/// 0.007 on they looked like no ellipse.
constexpr double fine_enough = 0.005;

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
    centre_ = {x, y};
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
  const Eigen::Vector2d& centre() const { return centre_; }
  Matrix2d second() const {
    const CentralMoments& c = *this;
    return Matrix2d{{c(2, 0), c(1, 1)}, {c(1, 1), c(0, 2)}};
  }
  /// Of z = u + i v, u and v places along axes in which S is 1: <z^(4 - n) z'^n>, z' conjugate.
  std::complex<double> fourth(int conjugate) const {
    const Matrix2d W = second().llt().matrixL().solve(Matrix2d::Identity());
    const std::complex<double> x(W(0, 0), W(1, 0)), y(W(0, 1), W(1, 1));
    std::array<std::complex<double>, 5> product{1.0};  // of x^(4 - j) y^j
    for (int factor = 0; factor < 4; ++factor)
      for (std::size_t j = 5; j-- > 0;)
        product[j] = product[j] * (factor < conjugate ? std::conj(x) : x) +
                     (j > 0 ? product[j - 1] * (factor < conjugate ? std::conj(y) : y) : 0.0);
    std::complex<double> sum = 0.0;
    for (std::size_t j = 0; j < 5; ++j) sum += product[j] * (*this)(4 - j, j);
    return sum;
  }

 private:
  std::array<double, 15> values_{};
  Eigen::Vector2d centre_;
};

/// The whole contact's from those of a sector: what is odd in a mirrored direction cancels.
ForceMoments mirrored(ForceMoments sums, int sectors) {
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t j = 0; i + j <= 4; ++j) {
      const bool odd = (sectors > 1 && j % 2 == 1) || (sectors > 2 && i % 2 == 1);
      sums.power[ForceMoments::place(i, j)] *= odd ? 0.0 : sectors;
    }
  sums.area *= sectors;
  sums.touched *= sectors;
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
  if (point.force > 0.0) touched += point.area;
}

ContactPatch contact_patch(const ForceMoments& moments, int sectors) {
  const ForceMoments sums = mirrored(moments, sectors);
  const double force = sums.power[0];
  if (!(force > 0.0)) return {};
  const CentralMoments central(sums);
  const double own = sums.area / force / (4.0 * std::numbers::pi);  // of a disc
  const Matrix2d spread = central.second(), S = spread + own * Matrix2d::Identity();
  const bool is_line = !(spread.determinant() > 1e-12 * spread.squaredNorm());
  const double q = is_line ? 0.0 : central.fourth(2).real() / 4.0;
  const double peak = peak_of(q);
  const Profile profile(peak);
  const double square = 2.0 * std::sqrt(std::max(S.determinant(), 0.0)) / profile.mean();  // A B
  const double area = std::numbers::pi * square;
  if (!is_line && own < fine_enough * spread.selfadjointView<Eigen::Lower>().eigenvalues()[0]) {
    const double uneven = std::abs(central.fourth(0)) + std::abs(central.fourth(1));
    const bool flat = sums.touched > bearing_share * area;
    if (q < (flat ? min_q_there : min_q) || q > max_q ||
        uneven > (flat ? max_uneven_there : max_uneven))
      return {std::sqrt(sums.touched / std::numbers::pi), unknown};
  }
  ContactPatch patch{std::sqrt(square), force * (1.0 + peak) / (area * profile.zeroth)};
  if (S.determinant() > 0.0) patch.ellipse = 0.5 * profile.mean() * S.inverse();
  patch.centre = central.centre();
  patch.peak = peak;
  return patch;
}

double ContactPatch::profile(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d way = place - centre;
  const double inside = 1.0 - way.dot(ellipse * way);
  if (!(inside > 0.0)) return 0.0;
  return (std::sqrt(inside) + peak * std::pow(inside, 3.5)) / (1.0 + peak);
}

ContactPatch contact_patch(const std::vector<LoadedPoint>& points, int sectors) {
  ForceMoments sums;
  for (const LoadedPoint& point : points) sums.add(point);
  return contact_patch(sums, sectors);
}

ContactPatch contact_patch(std::span<const ContactPoint> field, int sectors) {
  ForceMoments sums;
  for (const ContactPoint& point : field)
    if (const double push = -point.force().z(); push > 0.0)
      sums.add({point.place.head<2>(), push, point.area * std::abs(point.normal.z())});
  return contact_patch(sums, sectors);
}

}  // namespace fingertip::meshes::inline press
