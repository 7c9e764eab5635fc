#include "lattice/statics/elastic_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "lattice/statics/block_pattern.h"
#include "meshes/base/errors.h"

namespace fingertip::lattice::inline statics {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using meshes::Vector3;

Vector3 shift(const EmbeddedPoint& point, const VectorXd& displacement) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t c = 0; c < 8; ++c)
    sum += point.weights[c] * displacement.segment<3>(3 * Eigen::Index(point.corners[c]));
  return sum;
}

Vector3 position(const EmbeddedPoint& point, const VectorXd& displacement) {
  return point.rest + shift(point, displacement);
}

Matrix3d cell_gradient(const MeanCell& cell, const VectorXd& displacement) {
  Matrix3d H = Matrix3d::Zero();
  for (int c = 0; c < 8; ++c)
    H += displacement.segment<3>(3 * Eigen::Index(cell.corners[std::size_t(c)])) *
         cell.gradients.col(c).transpose();
  return H;
}

namespace {

/// What the cell's modes do to components and corners: D_m = Σ u_c modes_mc.
Eigen::Matrix<double, 3, 4> cell_modes(const MeanCell& cell, const VectorXd& displacement) {
  Eigen::Matrix<double, 3, 4> modes = Eigen::Matrix<double, 3, 4>::Zero();
  for (int c = 0; c < 8; ++c)
    modes += displacement.segment<3>(3 * Eigen::Index(cell.corners[std::size_t(c)])) *
             cell.modes.col(c).transpose();
  return modes;
}

double cell_energy(const LatticeBody& body, const MeanCell& cell, const VectorXd& displacement) {
  const double excess =
      body.law.material.holds_fibres() ? cell_modes(cell, displacement).squaredNorm() : 0.0;
  return cell.volume * body.law.energy(cell_gradient(cell, displacement), excess);
}

/// Particles joined by springs, cells and embedded points.
std::vector<std::vector<std::uint32_t>> groups_of(const LatticeBody& body) {
  std::vector<std::vector<std::uint32_t>> groups;
  for (const auto* springs : {&body.fibres, &body.springs})
    for (const Spring& s : *springs) groups.push_back({s.ends[0], s.ends[1]});
  for (const MeanCell& cell : body.cells)
    groups.emplace_back(cell.corners.begin(), cell.corners.end());
  for (const auto* points : {&body.bond, &body.outer})
    for (const EmbeddedPoint& point : *points)
      groups.emplace_back(point.corners.begin(), point.corners.end());
  return groups;
}

/// The 36 blocks of a cell's 8 corners: (c, d) with the particle of c not before that of d.
struct CellSlots {
  struct Pair {
    std::uint8_t row, column;  ///< corners
    std::uint32_t rank;        ///< of the block; unused on the diagonal
  };
  std::array<Pair, 36> pairs;
};

CellSlots slots_of(const MeanCell& cell, const BlockPattern& pattern) {
  CellSlots slots;
  std::size_t next = 0;
  for (std::uint8_t c = 0; c < 8; ++c) {
    for (std::uint8_t d = 0; d <= c; ++d) {
      const bool swap = cell.corners[c] < cell.corners[d];
      const std::uint8_t row = swap ? d : c, column = swap ? c : d;
      const std::uint32_t rank = c == d ? 0 : pattern.rank(cell.corners[row], cell.corners[column]);
      slots.pairs[next++] = {row, column, rank};
    }
  }
  return slots;
}

}  // namespace

struct ElasticSystem::Implementation {
  explicit Implementation(const LatticeBody& lattice_body);

  void add_spring(const Spring& spring, const Matrix3d& block, double* values) const;
  void add_embedded(const EmbeddedPoint& point, const Matrix3d& block, double* values) const;
  /// `modes`: D of cells that hold their fibres, else nothing.
  void add_cell(std::size_t cell, const CellResponse& response,
                const Eigen::Matrix<double, 3, 4>* modes, double* values) const;
  void assemble_springs(const VectorXd& displacement, VectorXd& force, double* values) const;
  void assemble_cells(const VectorXd& displacement, VectorXd& force, double* values) const;
  bool nonlinear_cells() const { return !body.law.linear(); }
  bool nonlinear_springs() const { return body.finite && !body.springs.empty(); }

  const LatticeBody& body;
  BlockPattern pattern;
  std::vector<CellSlots> slots;  ///< per cell; empty when its law stores nothing
  Tangent linear;                ///< what does not depend on the displacement [N/m]
  VectorXd rest_force;           ///< of the fibres at rest [N]
};

ElasticSystem::Implementation::Implementation(const LatticeBody& lattice_body)
    : body(lattice_body), pattern(body.rest.size(), groups_of(body)), linear(pattern.empty()) {
  double* values = linear.valuePtr();
  rest_force = VectorXd::Zero(body.unknowns());
  for (const Spring& fibre : body.fibres) {
    add_spring(fibre, fibre.stiffness * Matrix3d::Identity(), values);
    if (!body.finite) continue;  // then a fibre is a spring without force at rest
    const Vector3 pull = fibre.stiffness * (body.rest[fibre.ends[1]] - body.rest[fibre.ends[0]]);
    rest_force.segment<3>(3 * fibre.ends[0]) += pull;
    rest_force.segment<3>(3 * fibre.ends[1]) -= pull;
  }
  for (const EmbeddedPoint& point : body.bond)
    add_embedded(point, point.stiffness * Matrix3d::Identity(), values);
  if (!body.finite) {
    for (const Spring& spring : body.springs) {
      const Vector3 d = (body.rest[spring.ends[1]] - body.rest[spring.ends[0]]).normalized();
      add_spring(spring, spring.stiffness * d * d.transpose(), values);
    }
  }
  if (body.law.none()) return;
  for (const MeanCell& cell : body.cells) slots.push_back(slots_of(cell, pattern));
  if (nonlinear_cells()) return;
  const CellResponse response = body.law.evaluate(Matrix3d::Zero());
  for (std::size_t i = 0; i < body.cells.size(); ++i) add_cell(i, response, nullptr, values);
}

void ElasticSystem::Implementation::add_spring(const Spring& spring, const Matrix3d& block,
                                               double* values) const {
  const auto [low, high] = std::minmax(spring.ends[0], spring.ends[1]);
  pattern.add_diagonal(low, block, values);
  pattern.add_diagonal(high, block, values);
  pattern.add(low, pattern.rank(high, low), -block, values);
}

void ElasticSystem::Implementation::add_embedded(const EmbeddedPoint& point, const Matrix3d& block,
                                                 double* values) const {
  for (std::size_t c = 0; c < 8; ++c) {
    if (point.weights[c] == 0.0) continue;
    for (std::size_t d = 0; d < 8; ++d) {
      const std::uint32_t p = point.corners[c], q = point.corners[d];
      const double weight = point.weights[c] * point.weights[d];
      if (p < q || weight == 0.0) continue;
      if (p == q) {
        pattern.add_diagonal(q, weight * block, values);
      } else {
        pattern.add(q, pattern.rank(p, q), weight * block, values);
      }
    }
  }
}

/// With D the modes, e = |D|² and W_e, W_ee, X the response's slope, curvature and mixed part,
/// corners c and d share g_c·A·g_d + 2 W_e m_c·m_d 1 + 4 W_ee (D m_c)(D m_d)ᵀ + 2 (X g_c)(D m_d)ᵀ +
/// 2 (D m_c)(X g_d)ᵀ per volume.
void ElasticSystem::Implementation::add_cell(std::size_t cell, const CellResponse& response,
                                             const Eigen::Matrix<double, 3, 4>* modes,
                                             double* values) const {
  const MeanCell& c = body.cells[cell];
  const auto& tangent = response.tangent;
  Eigen::Matrix<double, 3, 8> along, bent;  // X g_c, 2 D m_c
  if (modes) {
    along = response.mixed * c.gradients;
    bent = 2.0 * *modes * c.modes;
  }
  Eigen::Matrix<double, 9, 24> columns;  // A_iJkL g_L per corner and component k
  for (int d = 0; d < 8; ++d)
    for (int k = 0; k < 3; ++k)
      columns.col(3 * d + k) = tangent.middleCols<3>(3 * k) * (c.volume * c.gradients.col(d));
  for (const auto& pair : slots[cell].pairs) {
    Matrix3d block;
    for (int i = 0; i < 3; ++i)
      block.row(i) =
          c.gradients.col(pair.row).transpose() * columns.block<3, 3>(3 * i, 3 * pair.column);
    if (modes) {
      const Vector3 own = bent.col(pair.row);
      const Eigen::RowVector3d other = bent.col(pair.column).transpose();
      block += c.volume * (response.curvature * own * other + along.col(pair.row) * other +
                           own * along.col(pair.column).transpose());
      block.diagonal().array() +=
          2.0 * c.volume * response.slope * c.modes.col(pair.row).dot(c.modes.col(pair.column));
    }
    const std::uint32_t q = c.corners[pair.column];
    if (pair.row == pair.column) {
      pattern.add_diagonal(q, block, values);
    } else {
      pattern.add(q, pair.rank, block, values);
    }
  }
}

void ElasticSystem::Implementation::assemble_springs(const VectorXd& displacement, VectorXd& force,
                                                     double* values) const {
  for (const Spring& spring : body.springs) {
    const Eigen::Index a = 3 * Eigen::Index(spring.ends[0]), b = 3 * Eigen::Index(spring.ends[1]);
    const Vector3 rest = body.rest[spring.ends[1]] - body.rest[spring.ends[0]];
    const Vector3 d = rest + displacement.segment<3>(b) - displacement.segment<3>(a);
    const double length = d.norm();
    const Vector3 along = d / length;
    const double tension = spring.stiffness * (length - rest.norm());
    force.segment<3>(a) += tension * along;
    force.segment<3>(b) -= tension * along;
    if (!values) continue;
    const Matrix3d block = (tension / length) * Matrix3d::Identity() +
                           (spring.stiffness - tension / length) * along * along.transpose();
    add_spring(spring, block, values);
  }
}

void ElasticSystem::Implementation::assemble_cells(const VectorXd& displacement, VectorXd& force,
                                                   double* values) const {
  for (std::size_t i = 0; i < body.cells.size(); ++i) {
    const MeanCell& cell = body.cells[i];
    const bool with_modes = body.law.material.holds_fibres();
    Eigen::Matrix<double, 3, 4> modes;
    if (with_modes) modes = cell_modes(cell, displacement);
    const CellResponse response = body.law.evaluate(cell_gradient(cell, displacement),
                                                    with_modes ? modes.squaredNorm() : 0.0);
    const Matrix3d transposed = Eigen::Map<const Matrix3d>(response.stress.data());
    Eigen::Matrix<double, 3, 8> pull = transposed.transpose() * cell.gradients;
    if (with_modes) pull += 2.0 * response.slope * modes * cell.modes;
    for (int c = 0; c < 8; ++c)
      force.segment<3>(3 * Eigen::Index(cell.corners[std::size_t(c)])) -= cell.volume * pull.col(c);
    if (values) add_cell(i, response, with_modes ? &modes : nullptr, values);
  }
}

ElasticSystem::ElasticSystem(const LatticeBody& body)
    : implementation_(std::make_unique<Implementation>(body)) {}

ElasticSystem::~ElasticSystem() = default;

double ElasticSystem::energy(const VectorXd& displacement) const {
  const Implementation& own = *implementation_;
  const VectorXd pull = own.linear.selfadjointView<Eigen::Lower>() * displacement;
  double sum = displacement.dot(0.5 * pull - own.rest_force);
  if (own.nonlinear_springs()) {
    for (const Spring& spring : own.body.springs) {
      const Vector3 rest = own.body.rest[spring.ends[1]] - own.body.rest[spring.ends[0]];
      const Vector3 change = displacement.segment<3>(3 * Eigen::Index(spring.ends[1])) -
                             displacement.segment<3>(3 * Eigen::Index(spring.ends[0]));
      const double stretch = (rest + change).norm() - rest.norm();
      sum += 0.5 * spring.stiffness * stretch * stretch;
    }
  }
  if (own.nonlinear_cells())
    for (const MeanCell& cell : own.body.cells) sum += cell_energy(own.body, cell, displacement);
  return sum;
}

void ElasticSystem::assemble(const VectorXd& displacement, VectorXd& force,
                             Tangent* tangent) const {
  const Implementation& own = *implementation_;
  force = own.rest_force;
  force -= own.linear.selfadjointView<Eigen::Lower>() * displacement;
  double* values = nullptr;
  if (tangent) {
    std::copy_n(own.linear.valuePtr(), own.linear.nonZeros(), tangent->valuePtr());
    values = tangent->valuePtr();
  }
  if (own.nonlinear_springs()) own.assemble_springs(displacement, force, values);
  if (!own.nonlinear_cells()) return;
  try {
    own.assemble_cells(displacement, force, values);
  } catch (const std::domain_error& error) {
    throw meshes::NotConverged(error.what());
  }
}

bool ElasticSystem::linear() const {
  return !implementation_->nonlinear_cells() && !implementation_->nonlinear_springs();
}

Tangent ElasticSystem::empty_tangent() const {
  return implementation_->pattern.empty();
}

void ElasticSystem::add_embedded(const EmbeddedPoint& point, const Matrix3d& block,
                                 Tangent& tangent) const {
  implementation_->add_embedded(point, block, tangent.valuePtr());
}

double ElasticSystem::smallest_jacobian(const VectorXd& displacement) const {
  double smallest = 1.0;
  bool first = true;
  for (const MeanCell& cell : body().cells) {
    const double J = (Matrix3d::Identity() + cell_gradient(cell, displacement)).determinant();
    smallest = first ? J : std::min(smallest, J);
    first = false;
  }
  return smallest;
}

const LatticeBody& ElasticSystem::body() const {
  return implementation_->body;
}

}  // namespace fingertip::lattice::inline statics
