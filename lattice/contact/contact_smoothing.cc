#include "lattice/contact/contact_smoothing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "meshes/base/dense.h"

namespace fingertip::lattice::inline contact {

using Eigen::Matrix3d;
using meshes::ContactPatch;
using meshes::ContactPoint;
using meshes::Vector3;

namespace {

/// Of the load of a point, what slides along its shear where it slips: of 0.65 to 0.8 the areas are
/// nearest those of the continuum (studies/MEASUREMENTS.md, cases 19 to 21).
constexpr double least_sliding = 0.75;
/// How often a particle's pressure is averaged with its neighbours': once leaves 0.44, twice 0.25
/// of what one particle has alone. Of an ellipse, where what is averaged hardly varies; of points
/// so few that their loads are chance; of a face, at whose edge it would blunt the pressure.
constexpr int ellipse_rounds = 2, coarse_rounds = 8, face_rounds = 0;
/// By how much averaging may carry the shear along with the pressure: at the edge both are small.
constexpr double most_carried = 2.0;
/// Factor of the area of points at the edge; what an ellipse has beyond that all points share.
constexpr double most_beside = 2.0;

Vector3 across(const Vector3& vector, const Vector3& normal) {
  return vector - vector.dot(normal) * normal;
}

double seen(const ContactPoint& point) {
  return point.area * std::abs(point.normal.z());
}

/// A point that touches or lies in the ellipse.
struct SmoothedPoint {
  const TiedPoint* tied;
  double profile;       ///< of the pressure, 1 in the middle of an ellipse or where a face touches
  ContactPoint smooth;  ///< with its part of the contact
  std::array<std::uint32_t, 8> particle{};  ///< its particles' numbers among all that bear
};

/// What acts on a particle [N].
struct Load {
  double pressed = 0.0, profile = 0.0;  ///< by pressures: the ties', those of the profile
  double slides = 0.0;                  ///< by pressures of ties that slide along the shear
  Vector3 sheared = Vector3::Zero();    ///< by the ties' shear
};

/// Points of a contact and the particles that they hang on.
class Smoothing {
 public:
  Smoothing(std::span<const TiedPoint> tied, const ContactPatch& patch, int sectors) {
    const auto in_ellipse = [&](const TiedPoint& point) {
      return patch.profile(point.point.place.head<2>());
    };
    // A contact narrower than the points are apart may miss them all.
    const bool has_profile =
        patch.is_ellipse() && std::ranges::any_of(tied, [&](const TiedPoint& point) {
          return point.touches() && in_ellipse(point) > 0.0;
        });
    for (const TiedPoint& point : tied) {
      const double profile = has_profile ? in_ellipse(point) : double(point.touches());
      if (point.touches() || profile > 0.0) points_.push_back({&point, profile, point.point, {}});
    }
    if (patch.is_ellipse()) fit_areas(patch, has_profile, sectors);
    number_particles();
    add_loads();
    add_sliding();
    average(!has_profile ? face_rounds : patch.is_fine ? ellipse_rounds : coarse_rounds);
  }

  /// Of the part that is computed.
  std::vector<ContactPoint> field() const {
    std::vector<ContactPoint> field;
    for (const SmoothedPoint& point : points_) {
      const Load here = at(point);
      if (!(point.profile > 0.0 && here.pressed > 0.0)) continue;
      double density = 0.0;
      for (std::size_t c = 0; c < 8; ++c)
        density += point.tied->weights[c] * density_[point.particle[c]];
      if (!(density > 0.0)) continue;
      ContactPoint& smooth = field.emplace_back(point.smooth);
      smooth.normal_traction = point.profile * density;
      const double carried = std::clamp(density / here.pressed, 1.0 / most_carried, most_carried);
      smooth.shear = across(carried * point.profile * here.sheared, smooth.normal);
      smooth.state = here.slides >= least_sliding * here.pressed ? meshes::ContactState::slip
                                                                 : meshes::ContactState::stick;
    }
    return field;
  }

 private:
  /// Gives the points the ellipse's area: what its edge leaves of them, and what that misses by to
  /// those at the edge, as far as they can bear it.
  void fit_areas(const ContactPatch& patch, bool has_profile, int sectors) {
    double inside = 0.0, edge = 0.0;
    std::vector<bool> at_edge;
    for (SmoothedPoint& point : points_) {
      at_edge.push_back(has_profile && point.profile > 0.0 && cut(point, patch));
      if (point.profile > 0.0) (at_edge.back() ? edge : inside) += seen(point.smooth);
    }
    const double wanted = std::numbers::pi * patch.radius * patch.radius / sectors;
    const double beside =
        edge > 0.0 ? std::clamp((wanted - inside) / edge, 1.0 / most_beside, most_beside) : 1.0;
    const double rest = wanted / (inside + beside * edge);
    for (std::size_t i = 0; i < points_.size(); ++i)
      points_[i].smooth.area *= rest * (at_edge[i] ? beside : 1.0);
  }

  /// A point inside the ellipse nearer to its edge than it is wide, w, stands for the way to the
  /// edge, where no other point does: d/w + 1/2 of its area if it is d from it. Pressure there goes
  /// with the root of the distance, of which the mean over D = d + w/2 is that at 4/9 D.
  static bool cut(SmoothedPoint& point, const ContactPatch& patch) {
    ContactPoint& smooth = point.smooth;
    const Eigen::Vector2d way = smooth.place.head<2>() - patch.centre, slope = patch.ellipse * way;
    const double root = std::sqrt(way.dot(slope)), width = std::sqrt(seen(smooth)),
                 distance = (1.0 - root) * root / slope.norm();
    if (!(distance < width)) return false;
    Vector3 out = Vector3::Zero();
    out.head<2>() = (5.0 * distance - 2.0 * width) / 9.0 * slope.normalized();
    out.z() = -out.dot(smooth.normal) / smooth.normal.z();
    smooth.place += out;
    smooth.rest += out;
    smooth.area *= distance / width + 0.5;
    point.profile = patch.profile(smooth.place.head<2>());
    return true;
  }

  void number_particles() {
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (SmoothedPoint& point : points_)
      for (std::size_t c = 0; c < 8; ++c)
        point.particle[c] =
            numbers.try_emplace(point.tied->particles[c], std::uint32_t(numbers.size()))
                .first->second;
    loads_.resize(numbers.size());
  }

  void add_loads() {
    for (const SmoothedPoint& point : points_) {
      const ContactPoint& tie = point.tied->point;
      for (std::size_t c = 0; c < 8; ++c) {
        Load& load = loads_[point.particle[c]];
        const double weight = point.tied->weights[c];
        load.pressed += weight * tie.area * tie.normal_traction;
        load.sheared += weight * tie.area * tie.shear;
        load.profile += weight * point.smooth.area * point.profile;
      }
    }
  }

  /// Tells the particles what slides around them, of ties whose shear is along that of the field.
  void add_sliding() {
    for (const SmoothedPoint& point : points_) {
      const ContactPoint& tie = point.tied->point;
      if (!point.tied->touches() || tie.state != meshes::ContactState::slip) continue;
      const Vector3 around = at(point).sheared;
      const double sizes = around.norm() * tie.shear.norm(),
                   along = tie.shear.isZero(0.0) ? 1.0  // without friction
                           : sizes > 0.0         ? around.dot(tie.shear) / sizes
                                                 : 0.0;
      for (std::size_t c = 0; c < 8; ++c)
        loads_[point.particle[c]].slides +=
            point.tied->weights[c] * tie.area * tie.normal_traction * along;
    }
  }

  /// What is borne at a point of profile 1, but for the averaging [Pa].
  Load at(const SmoothedPoint& point) const {
    Load sum;
    for (std::size_t c = 0; c < 8; ++c) {
      const Load& load = loads_[point.particle[c]];
      if (!(load.profile > 0.0)) continue;
      const double share = point.tied->weights[c] / load.profile;
      sum.pressed += share * load.pressed;
      sum.slides += share * load.slides;
      sum.sheared += share * load.sheared;
    }
    return sum;
  }

  /// The particles' pressures over the profile, each averaged with its neighbours' as the points
  /// between them have it, which keeps their sum.
  void average(int rounds) {
    for (const Load& load : loads_)
      density_.push_back(load.profile > 0.0 ? load.pressed / load.profile : 0.0);
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> sums(loads_.size(), 0.0);
      for (const SmoothedPoint& point : points_) {
        double here = 0.0;
        for (std::size_t c = 0; c < 8; ++c)
          here += point.tied->weights[c] * density_[point.particle[c]];
        for (std::size_t c = 0; c < 8; ++c)
          sums[point.particle[c]] +=
              point.tied->weights[c] * point.smooth.area * point.profile * here;
      }
      for (std::size_t p = 0; p < loads_.size(); ++p)
        density_[p] = loads_[p].profile > 0.0 ? sums[p] / loads_[p].profile : 0.0;
    }
  }

  std::vector<SmoothedPoint> points_;
  std::vector<Load> loads_;      ///< per particle
  std::vector<double> density_;  ///< per particle: of the pressure over the profile [Pa]
};

/// The force nearest to one that friction allows, and its derivative with respect to that.
struct Allowed {
  Vector3 force;
  Matrix3d slope;
};

/// Onto Coulomb's cone |shear| <= friction times pressure (Alart & Curnier's projection).
Allowed allowed(const Vector3& force, const Vector3& normal, double friction) {
  if (std::isinf(friction)) return {force, Matrix3d::Identity()};
  const double push = force.dot(normal);
  const Vector3 shear = across(force, normal);
  const double size = shear.norm();
  const Matrix3d along = normal * normal.transpose();
  if (friction > 0.0 && size <= friction * push) return {force, Matrix3d::Identity()};
  if (friction * size <= -push) return {Vector3::Zero(), Matrix3d::Zero()};
  const Vector3 way = size > 0.0 ? Vector3(shear / size) : Vector3::Zero();
  const Vector3 edge = normal + friction * way;
  const double held = (push + friction * size) / (1.0 + friction * friction);
  Matrix3d slope = edge * edge.transpose() / (1.0 + friction * friction);
  if (size > 0.0)
    slope += friction * held / size * (Matrix3d::Identity() - along - way * way.transpose());
  return {held * edge, slope};
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Changes forces on points as little as it takes for them to have given sums and to obey
/// friction: of f = P(f0 + |f0| (a + b × x)), P the projection onto the cone, a and b are found by
/// Newton's method. They are Lagrange's multipliers of the least Σ |f - f0|²/|f0|.
class Restoring {
 public:
  Restoring(std::vector<ContactPoint>& points, double friction)
      : points_(points), friction_(friction), centre_(centre_of_pressure(points)) {
    for (const ContactPoint& point : points_)
      reach_ = std::max(reach_, (point.place - centre_).norm());
  }

  /// Whether there are such forces.
  bool to(const meshes::ContactSums& about_origin, double scale) {
    if (!(reach_ > 0.0)) return true;  // a single point
    Vector6 wanted;
    wanted << about_origin.force,
        (about_origin.torque - centre_.cross(about_origin.force)) / reach_;
    constexpr int most = 40, most_halvings = 6;
    constexpr double round_off = 1e-15, enough = 1e-11;
    Vector6 factors = Vector6::Zero();
    State now = at(factors, wanted);
    for (int n = 0; n < most && now.lacking.norm() > round_off * scale; ++n) {
      // Of normals that go through one point, a ball's, nothing turns: rank 3.
      const Vector6 step = meshes::shortest_least_squares(now.response, now.lacking, 1e-10);
      State next = at(factors + step, wanted);
      double share = 1.0;
      for (int i = 0; i < most_halvings && !(next.lacking.norm() < now.lacking.norm()); ++i)
        next = at(factors + (share *= 0.5) * step, wanted);
      if (!(next.lacking.norm() < now.lacking.norm())) break;
      factors += share * step;
      now = next;
    }
    if (!(now.lacking.norm() <= enough * scale)) return false;
    for (ContactPoint& point : points_) {
      point.set_force(changed(point, factors).force);
      if (friction_ == 0.0) point.shear.setZero();
    }
    return true;
  }

 private:
  struct State {
    Vector6 lacking = Vector6::Zero();  ///< of force and moment over the reach [N]
    Matrix6 response = Matrix6::Zero();
  };

  /// What a and b do to a point's force, and it to the sums.
  Eigen::Matrix<double, 3, 6> lever(const ContactPoint& point) const {
    const Vector3 arm = (point.place - centre_) / reach_;
    Eigen::Matrix<double, 3, 6> change;
    change << Matrix3d::Identity(), Matrix3d::Zero();
    for (int c = 0; c < 3; ++c) change.col(3 + c) = Vector3::Unit(c).cross(arm);
    return change;
  }
  Allowed changed(const ContactPoint& point, const Vector6& factors) const {
    const Vector3 force = point.force();
    return allowed(force + force.norm() * (lever(point) * factors), point.normal, friction_);
  }
  State at(const Vector6& factors, const Vector6& wanted) const {
    State state;
    state.lacking = wanted;
    for (const ContactPoint& point : points_) {
      const auto change = lever(point);
      const Allowed force = changed(point, factors);
      state.lacking -= change.transpose() * force.force;
      state.response += point.force().norm() * change.transpose() * force.slope * change;
    }
    return state;
  }

  std::vector<ContactPoint>& points_;
  double friction_;
  Vector3 centre_;
  double reach_ = 0.0;  ///< of the points from the centre [m]
};

/// Gives `points` the sums of `wanted`: pressures first, which take the shear along, so that what
/// slides goes on to bear mu times its pressure, then both.
void restore(std::vector<ContactPoint> wanted, std::vector<ContactPoint>& points, double friction) {
  const meshes::ContactSums sums = sums_of(wanted, Vector3::Zero());
  for (ContactPoint& point : wanted) point.shear.setZero();
  double scale = 0.0;
  for (const ContactPoint& point : wanted) scale += point.force().norm();
  const std::vector<ContactPoint> before = points;
  for (ContactPoint& point : points) point.shear.setZero();
  Restoring(points, 0.0).to(sums_of(wanted, Vector3::Zero()), scale);
  if (friction == 0.0) return;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].shear = points[i].normal_traction / before[i].normal_traction * before[i].shear;
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (!Restoring(points, friction).to(sums, scale)) Restoring(points, endless).to(sums, scale);
}

double friction_of(const ContactLaw& law) {
  switch (law.mode) {
    case meshes::ContactMode::frictionless: return 0.0;
    case meshes::ContactMode::coulomb: return law.friction;
    default: return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

std::vector<ContactPoint> contact_field(std::span<const TiedPoint> points,
                                        const ContactPatch& patch, int sectors,
                                        const ContactLaw& law) {
  std::vector<ContactPoint> raw;
  for (const TiedPoint& tied : points)
    if (tied.touches()) raw.push_back(tied.point);
  std::vector<ContactPoint> smooth = unfolded(Smoothing(points, patch, sectors).field(), sectors);
  if (!smooth.empty()) restore(unfolded(raw, sectors), smooth, friction_of(law));
  std::erase_if(smooth, [](const ContactPoint& point) { return !(point.normal_traction > 0.0); });
  return smooth;
}

std::vector<ContactPoint> contact_field(std::span<const TiedPoint> points, int sectors,
                                        const ContactLaw& law) {
  return contact_field(points, tied_patch(points, sectors), sectors, law);
}

ContactPatch tied_patch(std::span<const TiedPoint> points, int sectors) {
  meshes::ForceMoments sums;
  for (const TiedPoint& tied : points)
    if (tied.touches())
      sums.add(
          {tied.point.place.head<2>(), std::max(-tied.point.force().z(), 0.0), seen(tied.point)});
  const ContactPatch patch = contact_patch(sums, sectors);
  std::unordered_map<std::uint32_t, meshes::PatchLoad> particles;
  double pushed = 0.0, bare = 0.0;
  for (const TiedPoint& tied : points) {
    const double profile = patch.profile(tied.point.place.head<2>());
    if (!tied.touches() && !(profile > 0.0)) continue;
    if (profile > 0.0) (tied.touches() ? pushed : bare) += seen(tied.point);
    for (std::size_t c = 0; c < 8; ++c) {
      meshes::PatchLoad& load = particles[tied.particles[c]];
      load.borne += tied.weights[c] * std::max(-tied.point.force().z(), 0.0);
      load.expected += tied.weights[c] * seen(tied.point) * patch.max_pressure * profile;
    }
  }
  std::vector<meshes::PatchLoad> loads;
  for (const auto& [particle, load] : particles) loads.push_back(load);
  return patch.judged_by(loads, bare / (pushed + bare));
}

}  // namespace fingertip::lattice::inline contact
