#include "meshes/press/contact_map.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "meshes/base/dense.h"
#include "meshes/press/contact_patch.h"

namespace fingertip::meshes::inline press {

using Eigen::Vector2d;

namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Places = bg::index::rtree<std::pair<Point, std::size_t>, bg::index::rstar<16>>;

/// Farther than so many widths from every point there is no contact: between pads, in a ring.
constexpr double gap = 1.5;

struct Tractions {
  double pressure = 0.0;
  Vector2d shear = Vector2d::Zero();
};

/// The field of a sample, at any place.
class Interpolation {
 public:
  explicit Interpolation(std::span<const ContactPoint> field)
      : field_(field), patch_(contact_patch(field)) {
    bg::model::multi_point<Point> all;
    std::vector<Places::value_type> places;
    for (std::size_t i = 0; i < field.size(); ++i) {
      all.emplace_back(field[i].place.x(), field[i].place.y());
      places.emplace_back(all.back(), i);
    }
    places_ = Places(places);
    bg::convex_hull(all, hull_);
    const double length = bg::perimeter(hull_);
    is_area_ = std::abs(bg::area(hull_)) > 1e-9 * length * length;
    if (is_area_) list_planes(0.25 * length);
  }

  Tractions at(const Vector2d& place) const {
    const double profile = this->profile(place);
    if (!is_area_ || !(profile > 0.0)) return {};
    const Point here(place.x(), place.y());
    const std::size_t nearest = places_.qbegin(bg::index::nearest(here, 1))->second;
    const Vector2d way = place - field_[nearest].place.head<2>();
    const bool beside = way.norm() > gap * field_[nearest].width();
    if (!patch_.is_ellipse() && (beside || !bg::covered_by(here, hull_))) return {};
    const Eigen::Vector3d found = planes_[nearest] * Eigen::Vector3d(1.0, way.x(), way.y());
    if (!(found[0] > 0.0)) return {};
    return {profile * found[0], found.tail<2>()};
  }

 private:
  double profile(const Vector2d& place) const {
    return patch_.is_ellipse() ? patch_.profile(place) : 1.0;
  }

  /// Per point, of the pressure over the profile and of both shears: value there and slopes.
  void list_planes(double size) {
    const std::vector<std::vector<std::size_t>> around = neighbours(size);
    for (std::size_t i = 0; i < field_.size(); ++i) {
      std::set<std::size_t> near{i};
      for (const std::size_t j : around[i]) {
        near.insert(j);
        near.insert(around[j].begin(), around[j].end());
      }
      // Not those beyond a gap.
      if (!patch_.is_ellipse())
        std::erase_if(near, [&](std::size_t j) {
          const Vector2d way = (field_[j].place - field_[i].place).head<2>();
          return way.norm() > 2.0 * gap * field_[i].width();
        });
      planes_.push_back(plane_through(i, near));
    }
  }

  /// Those whose Voronoi cells meet, of places within about `size` [m], told in integers.
  std::vector<std::vector<std::size_t>> neighbours(double size) const {
    std::vector<boost::polygon::point_data<std::int32_t>> sites;
    const double units = double(1 << 29) / size;
    const Vector3 middle = centre_of_pressure(field_);
    for (const ContactPoint& point : field_) {
      const Vector3 way = units * (point.place - middle);
      sites.emplace_back(std::int32_t(std::lround(way.x())), std::int32_t(std::lround(way.y())));
    }
    boost::polygon::voronoi_diagram<double> diagram;
    construct_voronoi(sites.begin(), sites.end(), &diagram);
    std::vector<std::vector<std::size_t>> around(field_.size());
    for (const auto& edge : diagram.edges())
      around[edge.cell()->source_index()].push_back(edge.twin()->cell()->source_index());
    return around;
  }

  Eigen::Matrix3d plane_through(std::size_t i, const std::set<std::size_t>& near) const {
    Eigen::MatrixX3d basis(near.size(), 3), values(near.size(), 3);
    Eigen::Index row = 0;
    for (const std::size_t j : near) {
      const ContactPoint& point = field_[j];
      const Vector2d way = (point.place - field_[i].place).head<2>();
      // At the very edge a ratio tells nothing.
      const double at = profile(point.place.head<2>()), weight = std::max(at, 1e-3);
      basis.row(row) << 1.0, way.x(), way.y();
      values.row(row) << point.normal_traction / std::max(at, 1e-3), point.shear.x(),
          point.shear.y();
      basis.row(row) *= weight;
      values.row(row++) *= weight;
    }
    return least_squares(basis, values).transpose();
  }

  std::span<const ContactPoint> field_;
  ContactPatch patch_;
  Places places_;
  bg::model::polygon<Point> hull_;
  bool is_area_ = false;  ///< not a point alone, or points in a line
  std::vector<Eigen::Matrix3d> planes_;
};

/// Area [m²], force [N] and centre of pressure [m] of a map.
struct Sums {
  double area = 0.0, force = 0.0, spread = 0.0;
  Vector2d centre = Vector2d::Zero();

  explicit Sums(const ContactMap& map) {
    const Raster& raster = map.raster;
    const double cell = raster.step * raster.step;
    const auto add = [&](const auto& take) {
      for (Eigen::Index i = 0; i < raster.count; ++i)
        for (Eigen::Index j = 0; j < raster.count; ++j)
          take(map.pressure(i, j) * cell, Vector2d(raster.x(i), raster.y(j)));
    };
    area = cell * map.touches.sum();
    add([&](double push, const Vector2d& place) {
      force += push;
      centre += push * place;
    });
    centre /= force;
    add([&](double push, const Vector2d& place) {
      spread += push * (place - centre).squaredNorm();
    });
    spread = std::sqrt(spread / force);
  }
};

}  // namespace

Raster raster_around(std::span<const std::span<const ContactPoint>> fields, Eigen::Index count) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Vector2d lowest(far, far), highest(-far, -far);
  for (const auto& field : fields)
    for (const ContactPoint& point : field) {
      lowest = lowest.cwiseMin(point.place.head<2>());
      highest = highest.cwiseMax(point.place.head<2>());
    }
  const double side = 1.2 * (highest - lowest).maxCoeff();
  const Vector2d middle = 0.5 * (lowest + highest);
  return {middle - Vector2d::Constant(0.5 * side), side / double(count - 1), count};
}

ContactMap contact_map(std::span<const ContactPoint> field, const Raster& raster) {
  const Eigen::ArrayXXd none = Eigen::ArrayXXd::Zero(raster.count, raster.count);
  ContactMap map{raster, none, none, none, none};
  const Interpolation interpolation(field);
  for (Eigen::Index i = 0; i < raster.count; ++i)
    for (Eigen::Index j = 0; j < raster.count; ++j) {
      const Tractions here = interpolation.at({raster.x(i), raster.y(j)});
      map.pressure(i, j) = here.pressure;
      map.shear_x(i, j) = here.shear.x();
      map.shear_y(i, j) = here.shear.y();
      map.touches(i, j) = here.pressure > 0.0 ? 1.0 : 0.0;
    }
  return map;
}

ContactDifference difference_of(const ContactMap& map, const ContactMap& first) {
  const Sums own(map), other(first);
  ContactDifference difference;
  if (!(own.force > 0.0 && other.force > 0.0)) return difference;
  const double cell = map.raster.step * map.raster.step, peak = first.pressure.maxCoeff();
  const auto l2 = [&](double squares) { return std::sqrt(squares * cell / other.area) / peak; };
  difference.pressure_l2 = l2((map.pressure - first.pressure).square().sum());
  difference.shear_l2 = l2((map.shear_x - first.shear_x).square().sum() +
                           (map.shear_y - first.shear_y).square().sum());
  difference.peak = map.pressure.maxCoeff() / peak - 1.0;
  difference.radius = std::sqrt(own.area / other.area) - 1.0;
  difference.spread = own.spread / other.spread - 1.0;
  difference.centre = (own.centre - other.centre).norm();
  return difference;
}

}  // namespace fingertip::meshes::inline press
