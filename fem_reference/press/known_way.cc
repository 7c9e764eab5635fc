#include "fem_reference/press/known_way.h"

#include <iterator>
#include <utility>

namespace fingertip::fem_reference::inline press {

KnownWay::KnownWay(int meshes, Points points, double now, Vector difference)
    : meshes_(meshes), points_(std::move(points)), now_(now), difference_(std::move(difference)) {}

std::vector<double> KnownWay::until(double place) const {
  std::vector<double> places;
  for (auto at = points_.upper_bound(now_); at != points_.end() && at->first < place; ++at)
    places.push_back(at->first);
  return places;
}

Vector KnownWay::known(double place) const {
  const auto uncorrected = [this](const Points::value_type& point) {
    Vector state = point.second;
    if (point.first == now_) state -= difference_;
    return state;
  };
  const auto end = points_.lower_bound(place);
  Vector result = uncorrected(*end);
  if (end->first == place) return result;
  const auto begin = std::prev(end);
  const double share = (place - begin->first) / (end->first - begin->first);
  result.sadd(share, 1.0 - share, uncorrected(*begin));
  return result;
}

void KnownWay::pass(double place, const Vector& displacement) {
  Vector difference = displacement;
  difference -= reaches(place) ? known(place) : displacement;
  for (const double between : until(place)) {
    const double share = (between - now_) / (place - now_);
    points_.at(between).add(1.0 - share, difference_, share, difference);
  }
  difference_ = difference;
  points_[place] = displacement;
  now_ = place;
}

}  // namespace fingertip::fem_reference::inline press
