#include "lattice/spectrum_search.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

namespace fingertip::lattice {

namespace {

constexpr Eigen::Index vectors = 10;         // of a search, per quantity
constexpr Eigen::Index most_kept = 3;        // for the next one
constexpr double relative_amplitude = 1e-5;  // of differences, to the spacing
constexpr int searches_at_rest = 5;

/// Eigenvalues of the projected operator, the uppermost first, and coefficients of their vectors.
struct Ritz {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Ritz ritz(const Eigen::MatrixXd& projected, Eigen::Index columns) {
  const Eigen::MatrixXd part = projected.topLeftCorner(columns, columns);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(part);
  return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
}

}  // namespace

SpectrumSearch::SpectrumSearch(const LatticeModel& model)
    : model_(&model), team_(1), forces_(model, team_), force_(model.points()) {
  scale_.resize(Eigen::Index(model.particles.size()));
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    scale_[Eigen::Index(p)] = std::sqrt(model.inverse_mass[model.particles[p]]);
  }
}

void SpectrumSearch::settle(Memory& memory) {
  const State rest(*model_);
  for (int n = 0; n < searches_at_rest; ++n) {
    begin(memory, rest);
    while (memory.active) advance(memory);
  }
}

void SpectrumSearch::begin(Memory& memory, const State& at) {
  memory.active = true;
  memory.based = false;
  memory.quantity = 0;
  memory.count = 0;
  ++memory.searches;
  memory.at = memory.moved = at;
  memory.force = force_;
  memory.basis.resize(3 * scale_.size(), vectors);
  memory.image.resize(3 * scale_.size(), vectors);
  memory.projected.setZero(vectors, vectors);
}

void SpectrumSearch::advance(Memory& memory) {
  if (!memory.based) {
    forces_.accumulate(memory.at, memory.force);
    memory.based = true;
  } else if (memory.count < vectors) {
    propose(memory);
    apply(memory);
    ++memory.count;
  } else {
    finish_quantity(memory);
  }
}

/// The next vector whose image is wanted.
void SpectrumSearch::propose(Memory& memory) {
  const Eigen::MatrixXd& kept = memory.kept[memory.quantity];
  const Eigen::Index next = memory.count;
  auto vector = memory.basis.col(next);
  const auto known = memory.basis.leftCols(next);
  if (next < kept.cols()) {
    vector = kept.col(next);
  } else if (next > kept.cols()) {
    vector = memory.image.col(next - 1);
    vector.noalias() -= known * memory.projected.col(next - 1).head(next);
  } else {
    std::minstd_rand generator(2 * memory.searches + unsigned(memory.quantity));
    for (double& value : vector) value = double(generator()) / double(generator.max()) - 0.5;
    vector.normalize();
    if (next > 0) {
      const Ritz best = ritz(memory.projected, next);
      Eigen::VectorXd lacks = memory.image.leftCols(next) * best.vectors.col(0);
      lacks -= best.values[0] * (known * best.vectors.col(0));
      vector += lacks.normalized();
    }
    vector -= known * (known.transpose() * vector).eval();
  }
  vector.normalize();
}

/// Finds the image of the next column from how forces change with the displacement (velocity).
void SpectrumSearch::apply(Memory& memory) {
  const Eigen::Index count = scale_.size();
  const auto q = memory.basis.col(memory.count).reshaped(count, 3);
  const double longest = (scale_.array() * q.rowwise().norm().array()).maxCoeff();
  const double amplitude = relative_amplitude * model_->spacing() / longest;
  const bool rates = memory.quantity == 1;
  VectorField& moved = rates ? memory.moved.velocity : memory.moved.displacement;
  const VectorField& base = rates ? memory.at.velocity : memory.at.displacement;
  for (std::size_t c = 0; c < 3; ++c) {
    for (Eigen::Index p = 0; p < count; ++p) {
      const std::size_t i = model_->particles[std::size_t(p)];
      moved.component[c][i] = base.component[c][i] + amplitude * scale_[p] * q(p, Eigen::Index(c));
    }
  }
  forces_.accumulate(memory.moved, force_);
  auto image = memory.image.col(memory.count).reshaped(count, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    for (Eigen::Index p = 0; p < count; ++p) {
      const std::size_t i = model_->particles[std::size_t(p)];
      image(p, Eigen::Index(c)) =
          scale_[p] / amplitude * (memory.force.component[c][i] - force_.component[c][i]);
    }
  }
  const Eigen::Index known = memory.count + 1;
  memory.projected.col(memory.count).head(known).noalias() =
      memory.basis.leftCols(known).transpose() * memory.image.col(memory.count);
  memory.projected.row(memory.count).head(known) =
      memory.projected.col(memory.count).head(known).transpose();
}

void SpectrumSearch::finish_quantity(Memory& memory) {
  const Ritz best = ritz(memory.projected, vectors);
  (memory.quantity == 0 ? memory.found.stiffness : memory.found.damping) = best.values[0];
  memory.kept[memory.quantity].noalias() = memory.basis * best.vectors.leftCols(most_kept);
  memory.moved = memory.at;
  memory.count = 0;
  memory.active = memory.quantity == 0;
  memory.quantity = 1 - memory.quantity;
}

}  // namespace fingertip::lattice
