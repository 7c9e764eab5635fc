#include "tests/verification/axisymmetric/axisymmetric_press.h"

#include <Eigen/Cholesky>
#include <Eigen/CholmodSupport>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshes/base/errors.h"
#include "tests/verification/axisymmetric/meridian_body.h"

namespace fingertip::verification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
using meshes::ContactMode;

constexpr int max_rounds = 200, patient_rounds = 12;
/// Out-of-balance forces over the plane's: at the end, and before contact is looked at with stick.
constexpr double balanced = 1e-9, nearly_balanced = 1e-3;

/// What touches, and where it sticks.
struct Contact {
  std::vector<char> touches;   ///< per candidate, the pole first
  std::vector<double> anchor;  ///< radius of first touch [m]
};

class Press {
 public:
  explicit Press(const AxisymmetricJob& job)
      : job_(job),
        mesh_(mesh_meridian(job.geometry, job.mesh)),
        body_(mesh_, job.rubber, job.finite),
        u_(VectorXd::Zero(2 * Eigen::Index(mesh_.nodes.size()))),
        reaction_(u_),
        tangent_(body_.empty_tangent()) {
    const double reach = job.finite ? 2.0 : 1.2;
    int count = 0;
    while (count <= mesh_.cap &&
           node(count).y() > job.geometry.tip_radius - reach * job.samples.back())
      ++count;
    now_ = {std::vector<char>(std::size_t(count), 0), std::vector<double>(std::size_t(count), 0)};
    if (!job.finite)
      find_compliance();
    else
      solver_.analyzePattern(tangent_);
  }

  std::vector<AxisymmetricSample> run() {
    std::vector<AxisymmetricSample> samples;
    double limit = 1.0;
    for (const double target : job_.samples) {
      while (indentation_ < target) {
        const double step = next_step(target, limit);
        if (march(step)) {
          limit = std::min(1.0, 1.5 * limit);
          continue;
        }
        if ((limit /= 2.0) < 1e-3)
          throw meshes::NotConverged("the axisymmetric press stops at an indentation of " +
                                     std::to_string(indentation_) + " m");
      }
      samples.push_back(sample());
    }
    return samples;
  }

 private:
  const Eigen::Vector2d& node(int i) const { return mesh_.nodes[std::size_t(mesh_.outer(i))]; }
  int candidates() const { return int(now_.touches.size()); }
  bool stick() const { return job_.contact == ContactMode::stick; }
  int z(int i) const { return 2 * mesh_.outer(i) + 1; }
  int r(int i) const { return 2 * mesh_.outer(i); }

  double next_step(double target, double limit) const {
    if (!job_.finite && !stick()) return target;
    const double longest = job_.longest_step * job_.geometry.thickness();
    const double first = 0.1 * std::min(job_.samples.front(), longest);
    const double step = limit * std::min(longest, std::max(first, 0.2 * indentation_));
    const double pieces = std::ceil((target - indentation_) / step - 1e-9);
    return pieces <= 1.0 ? target : indentation_ + (target - indentation_) / pieces;
  }

  /// Columns of K^-1 at the candidates' unknowns.
  void find_compliance() {
    VectorXd force;
    body_.assemble(u_, force, &tangent_);
    VectorXd none = VectorXd::Zero(u_.size());
    hold(body_.fixed(), none, none);
    solver_.compute(tangent_);
    for (int i = 0; i < candidates(); ++i) {
      contact_unknowns_.push_back(r(i));
      contact_unknowns_.push_back(z(i));
    }
    const auto count = Eigen::Index(contact_unknowns_.size());
    compliance_.resize(count, count);
    constexpr Eigen::Index block = 32;
    for (Eigen::Index first = 0; first < count; first += block) {
      const Eigen::Index width = std::min(block, count - first);
      MatrixXd load = MatrixXd::Zero(u_.size(), width);
      for (Eigen::Index k = 0; k < width; ++k)
        load(contact_unknowns_[std::size_t(first + k)], k) = 1.0;
      const MatrixXd field = solver_.solve(load);
      for (Eigen::Index row = 0; row < count; ++row)
        compliance_.block(row, first, 1, width) = field.row(contact_unknowns_[std::size_t(row)]);
    }
  }

  /// Makes held unknowns move by `motion`: unit rows, and what the others feel in `right`.
  void hold(const std::vector<char>& held, const VectorXd& motion, VectorXd& right) {
    for (Eigen::Index column = 0; column < tangent_.outerSize(); ++column)
      for (Matrix::InnerIterator it(tangent_, column); it; ++it) {
        const Eigen::Index row = it.row();
        const bool row_held = held[std::size_t(row)], column_held = held[std::size_t(column)];
        if (!row_held && !column_held) continue;
        if (row == column) {
          it.valueRef() = 1.0;
          continue;
        }
        if (!row_held) right[row] -= it.value() * motion[column];
        if (!column_held) right[column] -= it.value() * motion[row];
        it.valueRef() = 0.0;
      }
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) right[Eigen::Index(i)] = motion[Eigen::Index(i)];
  }

  double gap(const VectorXd& u, double height, int i) const {
    return height - node(i).y() - u[z(i)];
  }

  /// Joins what has crossed the plane, lets go what is pulled; at most `most` nodes. Whether any.
  bool change(Contact& next, const VectorXd& u, double height, int most) const {
    const double before = job_.geometry.tip_radius - indentation_;
    const double noise = 1e-9 * job_.geometry.tip_radius;
    int changed = 0;
    for (int i = 0; i < candidates() && changed < most; ++i) {
      const auto k = std::size_t(i);
      if (next.touches[k]) {
        // A quadratic element's nodal force vanishes on the axis: the pole goes with its neighbour.
        const bool pulled = i > 0 ? reaction_[z(i)] > 0.0 : next.touches[1] == 0;
        if (!pulled || (i == 0 && gap(u, height, 1) < noise)) continue;
        next.touches[k] = 0;
        ++changed;
      } else if (gap(u, height, i) < -noise) {
        const double from = std::max(gap(u_, before, i), 0.0);
        const double share = from / (from - gap(u, height, i));
        next.anchor[k] = node(i).x() + (1.0 - share) * u_[r(i)] + share * u[r(i)];
        next.touches[k] = 1;
        ++changed;
      }
    }
    return changed > 0;
  }

  bool march(double indentation) {
    Contact next = now_;
    VectorXd u = u_;
    const VectorXd reaction_before = reaction_;
    const double height = job_.geometry.tip_radius - indentation;
    if (!(job_.finite ? newton(next, u, height) : settle(next, u, height))) {
      reaction_ = reaction_before;
      return false;
    }
    now_ = std::move(next);
    u_ = std::move(u);
    indentation_ = indentation;
    return true;
  }

  /// Small strain: C_AA lambda = prescribed motion of what touches.
  bool settle(Contact& next, VectorXd& u, double height) {
    for (int round = 0; round < max_rounds; ++round) {
      std::vector<Eigen::Index> held;
      std::vector<double> motion;
      for (int i = 0; i < candidates(); ++i) {
        if (!next.touches[std::size_t(i)]) continue;
        if (stick() && i > 0) {
          held.push_back(2 * i);
          motion.push_back(next.anchor[std::size_t(i)] - node(i).x());
        }
        held.push_back(2 * i + 1);
        motion.push_back(height - node(i).y());
      }
      VectorXd at_candidates = VectorXd::Zero(compliance_.rows());
      reaction_.setZero();
      if (!held.empty()) {
        const VectorXd force = MatrixXd(compliance_(held, held))
                                   .llt()
                                   .solve(Eigen::Map<VectorXd>(motion.data(), long(motion.size())));
        at_candidates = compliance_(Eigen::all, held) * force;
        for (std::size_t k = 0; k < held.size(); ++k)
          reaction_[contact_unknowns_[std::size_t(held[k])]] = force[long(k)];
      }
      for (std::size_t k = 0; k < contact_unknowns_.size(); ++k)
        u[contact_unknowns_[k]] = at_candidates[long(k)];
      const int most = round < patient_rounds ? candidates() : 1;
      if (!change(next, u, height, most)) return true;
    }
    return false;
  }

  /// Finite strain.
  bool newton(Contact& next, VectorXd& u, double height) {
    VectorXd force;
    for (int round = 0; round < max_rounds / 4; ++round) {
      if (!body_.assemble(u, force, &tangent_)) return false;
      std::vector<char> held = body_.fixed();
      VectorXd motion = VectorXd::Zero(u.size());
      hold_touching(next, u, height, held, motion);
      const double norm = residual(force, held, next);
      const double move = motion.norm();
      const bool settled = move < 1e-9 * job_.geometry.tip_radius;
      const bool look = !stick() || (norm < nearly_balanced && settled);
      const int most = round < patient_rounds ? candidates() : 1;
      bool changed = round == 0 && empty(next) && change(next, u, height, most);
      if (round > 0 && look) changed = change(next, u, height, most);
      if (round > 0 && !changed && settled && norm < balanced) return true;
      if (changed) {
        held = body_.fixed();
        motion.setZero();
        hold_touching(next, u, height, held, motion);
      }
      VectorXd right = -force;
      hold(held, motion, right);
      solver_.factorize(tangent_);
      if (solver_.info() != Eigen::Success) return false;
      const VectorXd step = solver_.solve(right);
      double factor = 1.0;
      VectorXd trial = u + step, ignored;
      while (!body_.assemble(trial, ignored, nullptr)) {
        if ((factor /= 2.0) < 0.05) return false;
        trial = u + factor * step;
      }
      u = trial;
    }
    return false;
  }

  static bool empty(const Contact& contact) { return std::ranges::count(contact.touches, 1) == 0; }

  void hold_touching(const Contact& next, const VectorXd& u, double height, std::vector<char>& held,
                     VectorXd& motion) const {
    for (int i = 0; i < candidates(); ++i) {
      if (!next.touches[std::size_t(i)]) continue;
      held[std::size_t(z(i))] = 1;
      motion[z(i)] = gap(u, height, i);
      if (!stick() || i == 0) continue;
      held[std::size_t(r(i))] = 1;
      motion[r(i)] = next.anchor[std::size_t(i)] - node(i).x() - u[r(i)];
    }
  }

  /// Notes the plane's forces; out-of-balance forces over them.
  double residual(const VectorXd& force, const std::vector<char>& held, const Contact& next) {
    double free = 0.0, plane = 0.0;
    reaction_.setZero();
    for (Eigen::Index k = 0; k < force.size(); ++k)
      if (!held[std::size_t(k)]) free += force[k] * force[k];
    for (int i = 0; i < candidates(); ++i) {
      if (!next.touches[std::size_t(i)]) continue;
      for (const int k : {r(i), z(i)})
        if (held[std::size_t(k)] && !body_.fixed()[std::size_t(k)]) {
          reaction_[k] = force[k];
          plane += force[k] * force[k];
        }
    }
    return plane > 0.0 ? std::sqrt(free / plane) : std::numeric_limits<double>::infinity();
  }

  AxisymmetricSample sample() const {
    AxisymmetricSample result;
    result.indentation = indentation_;
    const auto place = [&](int i) -> Eigen::Vector2d {
      return job_.finite ? Eigen::Vector2d(node(i) + u_.segment<2>(r(i))) : node(i);
    };
    std::vector<double> area(std::size_t(mesh_.cap) + 1, 0.0);
    for (int i = 0; i + 2 <= mesh_.cap; i += 2) {
      const std::array<Eigen::Vector2d, 3> x{place(i), place(i + 1), place(i + 2)};
      const std::array<Eigen::Vector2d, 3> slope{-1.5 * x[0] + 2.0 * x[1] - 0.5 * x[2],
                                                 0.5 * (x[2] - x[0]),
                                                 0.5 * x[0] - 2.0 * x[1] + 1.5 * x[2]};
      for (std::size_t k = 0; k < 3; ++k) {
        const double length = job_.finite ? slope[k].x() : slope[k].norm();
        area[std::size_t(i) + k] +=
            2.0 * std::numbers::pi * x[k].x() * length * (k == 1 ? 4.0 : 1.0) / 3.0;
      }
    }
    for (int i = 0; i < candidates(); ++i) {
      if (!now_.touches[std::size_t(i)]) continue;
      result.force -= reaction_[z(i)];
      if (i == 0) continue;
      result.radii.push_back(place(i).x());
      result.pressures.push_back(-reaction_[z(i)] / area[std::size_t(i)]);
      result.max_pressure = std::max(result.max_pressure, result.pressures.back());
    }
    result.contact_radius = edge(result);
    return result;
  }

  /// Where p² vanishes, a parabola in r² through the outer sixth of the nodes.
  static double edge(const AxisymmetricSample& sample) {
    const std::size_t count = sample.radii.size();
    if (count < 12) return count > 0 ? sample.radii.back() : 0.0;
    const double last = sample.radii.back();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = count - std::max<std::size_t>(8, count / 6); i < count; ++i) {
      const double s = std::pow(sample.radii[i] / last, 2);
      const Eigen::Vector3d basis(1.0, s, s * s);
      normal += basis * basis.transpose();
      right += sample.pressures[i] * sample.pressures[i] * basis;
    }
    const Eigen::Vector3d c = normal.ldlt().solve(right);
    const double square = c[1] * c[1] - 4.0 * c[2] * c[0];
    return last * std::sqrt(2.0 * c[0] / (-c[1] + std::sqrt(std::max(square, 0.0))));
  }

  const AxisymmetricJob job_;
  const Meridian mesh_;
  const MeridianBody body_;
  VectorXd u_, reaction_;  ///< of the plane on the tip [N]
  Matrix tangent_;
  Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> solver_;
  Contact now_;
  double indentation_ = 0.0;
  std::vector<int> contact_unknowns_;
  MatrixXd compliance_;
};

}  // namespace

std::vector<AxisymmetricSample> press_axisymmetric(const AxisymmetricJob& job) {
  return Press(job).run();
}

}  // namespace fingertip::verification
