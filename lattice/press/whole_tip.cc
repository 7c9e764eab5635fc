#include "lattice/press/whole_tip.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <functional>
#include <stdexcept>

#include "lattice/model/cut_model.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

namespace {

/// Signs of the mirror images that make the whole tip of one of 1, 2 (y >= 0) or 4 parts.
std::vector<Vector3> mirrors(int sectors) {
  std::vector<Vector3> signs{{1.0, 1.0, 1.0}};
  if (sectors > 1) signs.emplace_back(1.0, -1.0, 1.0);
  if (sectors > 2) {
    signs.emplace_back(-1.0, 1.0, 1.0);
    signs.emplace_back(-1.0, -1.0, 1.0);
  }
  return signs;
}

}  // namespace

std::vector<Vector3> rest_places(const LatticeModel& model) {
  std::vector<Vector3> places;
  for (const std::uint32_t p : model.particles) places.push_back(model.rest_position(p));
  return places;
}

ComputedParticles particles_of(const Finger& finger) {
  const LatticeModel& model = finger.model();
  const std::vector<std::uint8_t> of_boundary = finger.held();
  std::vector<std::uint8_t> of_point(model.points(), 0);
  for (std::size_t b = 0; b < of_boundary.size(); ++b) of_point[model.boundary[b]] = of_boundary[b];
  ComputedParticles result;
  for (const std::uint32_t p : model.particles) {
    result.moved.emplace_back(model.grid.axes * finger.state().displacement.at(p));
    result.held.push_back(of_point[p]);
  }
  return result;
}

WholeTip::WholeTip(const PressSetup& setup, int sectors, const std::vector<Vector3>& rest,
                   const LatticeModel* whole)
    : built_(whole ? std::optional<LatticeModel>()
                   : build_tip(setup.geometry, setup.rubber, setup.lattice)),
      model_(whole ? whole : &*built_),
      state_(*model_),
      view_(*model_, setup.geometry) {
  for (const Vector3& mirror : mirrors(sectors)) {
    for (std::size_t p = 0; p < rest.size(); ++p) {
      const auto [i, j, k] = model_->grid.nearest(mirror.cwiseProduct(rest[p]));
      images_.push_back({p, model_->grid.index(i, j, k), mirror});
    }
  }
}

WholeTip::WholeTip(const PressSetup& setup, const LatticeModel& computed)
    : WholeTip(setup, computed.sector.count(), rest_places(computed),
               computed.sector.count() == 1 ? &computed : nullptr) {}

FingerPicture WholeTip::draw(FingerPicture bare, const ComputedParticles& now,
                             const Vector3& travel) {
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  std::vector<std::uint8_t> of_point(model_->points(), 0), of_boundary;
  for (const auto& [particle, point, mirror] : images_) {
    state_.displacement.set(point, to_grid * (mirror.cwiseProduct(now.moved[particle]) + travel));
    of_point[point] = now.held[particle];
  }
  for (const std::uint32_t point : model_->boundary) of_boundary.push_back(of_point[point]);
  bare.boundary = view_.deformed(state_);
  bare.held = view_.held(of_boundary);
  return bare;
}

FingerPicture WholeTip::picture(const Finger& finger, double indentation) {
  FingerPicture picture = draw(bare_picture(finger, indentation), particles_of(finger));
  picture.contact = finger.contact_now();
  return picture;
}

State WholeTip::state_of(const LatticeModel& part, const State& state) const {
  State whole(*model_);
  for (const auto& [particle, point, mirror] : images_) {
    const std::uint32_t computed = part.particles[particle];
    const auto mirrored = [&, signs = mirror](const VectorField& field) -> Vector3 {
      return model_->grid.axes.transpose() *
             signs.cwiseProduct(part.grid.axes * field.at(computed));
    };
    whole.displacement.set(point, mirrored(state.displacement));
    whole.velocity.set(point, mirrored(state.velocity));
  }
  return whole;
}

namespace {

/// What is linear about a place, from values at others.
class LinearFit {
 public:
  void add(const Vector3& from_here, double weight, const Eigen::Matrix<double, 1, 6>& value) {
    const Eigen::Vector4d basis(1.0, from_here.x(), from_here.y(), from_here.z());
    matrix_ += weight * basis * basis.transpose();
    sums_ += weight * basis * value;
    box_.extend(from_here);
  }
  /// Whether the values are at grid points on more than one plane each way.
  bool is_determined() const { return !box_.isEmpty() && box_.sizes().minCoeff() > 0.5; }
  Eigen::Matrix<double, 1, 6> here() const { return matrix_.ldlt().solve(sums_).row(0); }

 private:
  Eigen::Matrix4d matrix_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 6> sums_ = Eigen::Matrix<double, 4, 6>::Zero();
  Eigen::AlignedBox3d box_;
};

/// Points of a grid whose coordinates differ by at most `reach` from those of a place.
void each_point_near(const meshes::CubicGrid& grid, const Vector3& at, double reach,
                     const std::function<void(std::size_t, const Vector3&)>& visit) {
  std::array<int, 3> first, last;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = std::max(0, int(std::ceil(at[Eigen::Index(d)] - reach)));
    last[d] = std::min(grid.size[d] - 1, int(std::floor(at[Eigen::Index(d)] + reach)));
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) visit(grid.index(i, j, k), Vector3(i, j, k) - at);
}

}  // namespace

State carried_over(const LatticeModel& from, const State& state, const LatticeModel& to) {
  State carried(to);
  const Eigen::Matrix3d turn = to.grid.axes.transpose() * from.grid.axes;
  for (const std::uint32_t point : to.particles) {
    const Vector3 at = from.grid.coordinates(to.rest_position(point));
    LinearFit fit;
    for (double reach = 2.0; !fit.is_determined(); reach += 1.0) {
      if (reach > 2.0 + from.grid.size[2]) throw std::logic_error("lattices of different tips");
      fit = {};
      each_point_near(from.grid, at, reach, [&](std::size_t i, const Vector3& apart) {
        if (!from.is_particle[i]) return;
        const double closeness = 1.0 / (1e-3 + apart.squaredNorm());
        Eigen::Matrix<double, 1, 6> value;
        value << state.displacement.at(i).transpose(), state.velocity.at(i).transpose();
        fit.add(apart, from.mass[i] * closeness * closeness, value);
      });
    }
    const Eigen::Matrix<double, 1, 6> here = fit.here();
    carried.displacement.set(point, turn * here.head<3>().transpose());
    carried.velocity.set(point, turn * here.tail<3>().transpose());
  }
  for (std::size_t d = 0; d < 3; ++d)
    for (const std::uint32_t point : to.held[d])
      carried.displacement.component[d][point] = carried.velocity.component[d][point] = 0.0;
  return carried;
}

}  // namespace fingertip::lattice::inline press
