#include "meshes/press/contact_patch.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/press/press_response.h"

namespace fingertip::meshes::inline press {

using Eigen::Matrix2d;

namespace {

constexpr double highest_peak = 2.0;  ///< b
/// Of an ellipse at most: its misfit; and at least: what of its surface is not pushed.
constexpr double largest_misfit = 0.11, least_bare = 0.01;
/// Where the points that are pushed have less than this share of the ellipse's area, as of a narrow
/// line, they miss much of their own, and a worse ellipse is still nearer. A ring has more misfit.
constexpr double known_share = 0.55, largest_misfit_of_few = 0.5;
/// Second moment of a point's own patch over that of the pressure, along the narrower axis, where
/// points are enough: three spacings of three points over the radius. Of fewer, loads are chance.
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
  /// Mean t², t = x S^-1 x.
  double fourth() const {
    const CentralMoments& c = *this;
    const Matrix2d T = second().inverse();
    const double xx = T(0, 0), xy = 2.0 * T(0, 1), yy = T(1, 1);
    return xx * xx * c(4, 0) + 2.0 * xx * xy * c(3, 1) + (xy * xy + 2.0 * xx * yy) * c(2, 2) +
           2.0 * xy * yy * c(1, 3) + yy * yy * c(0, 4);
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
  const double peak = is_line ? 0.0 : peak_of(central.fourth() / 4.0);
  const Profile profile(peak);
  const double square = 2.0 * std::sqrt(std::max(S.determinant(), 0.0)) / profile.mean();  // A B
  const double area = std::numbers::pi * square;
  ContactPatch patch{std::sqrt(square), force * (1.0 + peak) / (area * profile.zeroth)};
  if (S.determinant() > 0.0) patch.ellipse = 0.5 * profile.mean() * S.inverse();
  patch.centre = central.centre();
  patch.peak = peak;
  patch.touched = sums.touched;
  patch.is_fine =
      !is_line && own < fine_enough * spread.selfadjointView<Eigen::Lower>().eigenvalues()[0];
  return patch;
}

ContactPatch ContactPatch::judged_by(std::span<const PatchLoad> loads, double bare) const {
  if (!is_fine || !is_ellipse()) return *this;
  double borne = 0.0, lacking = 0.0, misfit = 0.0;
  for (const PatchLoad& load : loads) {
    borne += load.borne;
    lacking += load.borne - load.expected;
    misfit += std::abs(load.borne - load.expected);
  }
  const bool few = touched < known_share * std::numbers::pi * radius * radius;
  const double largest = few ? largest_misfit_of_few : largest_misfit;
  if (misfit + std::abs(lacking) < largest * borne && bare > least_bare) return *this;
  ContactPatch without{std::sqrt(touched / std::numbers::pi), unknown};
  without.centre = centre;
  without.touched = touched;
  without.is_fine = true;
  return without;
}

double ContactPatch::profile(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d way = place - centre;
  const double inside = 1.0 - way.dot(ellipse * way);
  if (!(inside > 0.0)) return 0.0;
  return (std::sqrt(inside) + peak * std::pow(inside, 3.5)) / (1.0 + peak);
}

ContactPatch contact_patch(std::span<const ContactPoint> field, int sectors) {
  ForceMoments sums;
  const auto seen = [](const ContactPoint& point) {
    return LoadedPoint{point.place.head<2>(), std::max(-point.force().z(), 0.0),
                       point.area * std::abs(point.normal.z())};
  };
  for (const ContactPoint& point : field) sums.add(seen(point));
  const ContactPatch patch = contact_patch(sums, sectors);
  std::vector<PatchLoad> loads;
  for (const ContactPoint& point : field) {
    const LoadedPoint here = seen(point);
    loads.push_back({here.force, here.area * patch.max_pressure * patch.profile(here.place)});
  }
  return patch.judged_by(loads);
}

double largest_pressure(std::span<const ContactPoint> field) {
  double largest = 0.0;
  for (const ContactPoint& point : field) largest = std::max(largest, point.normal_traction);
  const ContactPatch patch = contact_patch(field);
  if (!patch.is_ellipse()) return largest;
  const auto away = [&](const ContactPoint& point) {
    return (point.place.head<2>() - patch.centre).squaredNorm();
  };
  const ContactPoint& middle = *std::ranges::min_element(field, {}, away);
  const double share = patch.profile(middle.place.head<2>());
  return share > 0.5 ? std::max(largest, middle.normal_traction / share) : largest;
}

}  // namespace fingertip::meshes::inline press
