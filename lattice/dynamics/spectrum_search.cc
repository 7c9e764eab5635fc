#include "lattice/dynamics/spectrum_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

namespace fingertip::lattice::inline dynamics {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr double relative_amplitude = 1e-5;  // of differences, to the spacing
constexpr int searches_at_rest = 5;
constexpr Index rows_per_sum = 2048;  // rows per partial sum: the same for any number of threads

}  // namespace

SpectrumSearch::Ritz SpectrumSearch::ritz(const Projection& projected, Index columns) {
  const Projection part = projected.topLeftCorner(columns, columns);
  const Eigen::SelfAdjointEigenSolver<Projection> solver(part);
  return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
}

SpectrumSearch::SpectrumSearch(const LatticeModel& model, const Team& team)
    : model_(&model),
      team_(team),
      forces_(model, team_),
      force_(model.points()),
      scale_(mobility(model)) {
  partial_.setZero(vectors, (rows() + rows_per_sum - 1) / rows_per_sum);
}

void SpectrumSearch::finish(Memory& memory) {
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
  memory.basis.resize(rows(), vectors);
  memory.image.resize(rows(), vectors);
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

/// Calls body(number, first, rows) for portions of the rows.
template <typename Body>
void SpectrumSearch::in_portions(Index rows, const Body& body) {
  const Index portions = (rows + rows_per_sum - 1) / rows_per_sum;
  team_.split(std::size_t(portions), 1, [&](std::size_t begin, std::size_t end) {
    for (Index n = Index(begin); n < Index(end); ++n) {
      body(n, n * rows_per_sum, std::min(rows_per_sum, rows - n * rows_per_sum));
    }
  });
}

/// Products of the first `count` columns with a column of another matrix.
SpectrumSearch::Coefficients SpectrumSearch::project(const MatrixXd& columns, Index count,
                                                     const MatrixXd& of, Index column) {
  in_portions(rows(), [&](Index n, Index first, Index size) {
    partial_.col(n).head(count).noalias() =
        columns.block(first, 0, size, count).transpose() * of.col(column).segment(first, size);
  });
  Coefficients sum = Coefficients::Zero(count);
  for (Index n = 0; n < partial_.cols(); ++n) sum += partial_.col(n).head(count);
  return sum;
}

double SpectrumSearch::sum_of_partials() const {
  double sum = 0.0;
  for (Index n = 0; n < partial_.cols(); ++n) sum += partial_(0, n);
  return sum;
}

/// Scales the next vector to unit length, `partial_` holding its portions' squares; one of zeros,
/// as without damping, remains.
void SpectrumSearch::normalize(Memory& memory) {
  const double square = sum_of_partials();
  if (!(square > 0.0)) return;
  in_portions(rows(), [&](Index, Index first, Index size) {
    memory.basis.col(memory.count).segment(first, size) /= std::sqrt(square);
  });
}

/// The next vector whose image is wanted.
void SpectrumSearch::propose(Memory& memory) {
  const MatrixXd& kept = memory.kept[memory.quantity];
  const Index next = memory.count;
  if (next < kept.cols()) {
    memory.basis.col(next) = kept.col(next);
  } else if (next > kept.cols()) {
    continue_chain(memory);
  } else {
    start_chain(memory);
  }
}

/// The last image, orthogonal to what is known.
void SpectrumSearch::continue_chain(Memory& memory) {
  const Index next = memory.count;
  const Coefficients known = memory.projected.col(next - 1).head(next);
  in_portions(rows(), [&](Index n, Index first, Index size) {
    auto vector = memory.basis.col(next).segment(first, size);
    vector = memory.image.col(next - 1).segment(first, size);
    vector.noalias() -= memory.basis.block(first, 0, size, next) * known;
    partial_(0, n) = vector.squaredNorm();
  });
  normalize(memory);
}

/// Noise and, as long, what the uppermost vector lacks to be an eigenvector, orthogonal to what is
/// known.
void SpectrumSearch::start_chain(Memory& memory) {
  const Index next = memory.count;
  std::minstd_rand generator(2 * memory.searches + unsigned(memory.quantity));
  auto vector = memory.basis.col(next);
  for (double& value : vector) value = double(generator()) / double(generator.max()) - 0.5;
  vector.normalize();
  if (next > 0) {
    const Ritz best = ritz(memory.projected, next);
    const Coefficients uppermost = best.vectors.col(0), scaled = best.values[0] * uppermost;
    in_portions(rows(), [&](Index n, Index first, Index size) {
      auto lacks = memory.image.col(next).segment(first, size);  // scratch: not known yet
      lacks.noalias() = memory.image.block(first, 0, size, next) * uppermost;
      lacks.noalias() -= memory.basis.block(first, 0, size, next) * scaled;
      partial_(0, n) = lacks.squaredNorm();
    });
    const double square = sum_of_partials();
    if (square > 0.0) vector += memory.image.col(next) / std::sqrt(square);
  }
  const Coefficients along = project(memory.basis, next, memory.basis, next);
  in_portions(rows(), [&](Index n, Index first, Index size) {
    auto part = memory.basis.col(next).segment(first, size);
    part.noalias() -= memory.basis.block(first, 0, size, next) * along;
    partial_(0, n) = part.squaredNorm();
  });
  normalize(memory);
}

/// Moves the state (its velocity) along the next column, by so much that differences of forces are
/// meaningful; returns how far.
double SpectrumSearch::move_along(Memory& memory) {
  const Index count = scale_.rows();
  const auto q = memory.basis.col(memory.count).reshaped(count, 3);
  in_portions(count, [&](Index n, Index first, Index size) {
    double longest = 0.0;
    for (Index p = first; p < first + size; ++p) {
      longest = std::max(longest, scale_.row(p).maxCoeff() * q.row(p).norm());
    }
    partial_(0, n) = longest;
  });
  const double longest = partial_.row(0).head((count + rows_per_sum - 1) / rows_per_sum).maxCoeff();
  const double amplitude = relative_amplitude * model_->spacing() / longest;
  const bool rates = memory.quantity == 1;
  VectorField& moved = rates ? memory.moved.velocity : memory.moved.displacement;
  const VectorField& base = rates ? memory.at.velocity : memory.at.displacement;
  in_portions(count, [&](Index, Index first, Index size) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (Index p = first; p < first + size; ++p) {
        const std::size_t i = model_->particles[std::size_t(p)];
        moved.component[c][i] =
            base.component[c][i] + amplitude * scale_(p, Index(c)) * q(p, Index(c));
      }
    }
  });
  return amplitude;
}

/// Finds the image of the next column from how forces change with the displacement (velocity).
void SpectrumSearch::apply(Memory& memory) {
  const Index count = scale_.rows(), column = memory.count;
  const double amplitude = move_along(memory);
  forces_.accumulate(memory.moved, force_);
  auto image = memory.image.col(column).reshaped(count, 3);
  in_portions(count, [&](Index, Index first, Index size) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (Index p = first; p < first + size; ++p) {
        const std::size_t i = model_->particles[std::size_t(p)];
        image(p, Index(c)) = scale_(p, Index(c)) / amplitude *
                             (memory.force.component[c][i] - force_.component[c][i]);
      }
    }
  });
  const Index known = column + 1;
  memory.projected.col(column).head(known) = project(memory.basis, known, memory.image, column);
  memory.projected.row(column).head(known) = memory.projected.col(column).head(known).transpose();
}

void SpectrumSearch::finish_quantity(Memory& memory) {
  const Ritz best = ritz(memory.projected, vectors);
  if (memory.quantity == 0) {
    memory.found.stiffness = model_->relaxation.instantaneous_ratio() * best.values[0];
  } else {
    memory.found.damping = best.values[0];
  }
  MatrixXd& kept = memory.kept[memory.quantity];
  kept.resize(rows(), max_kept);
  in_portions(rows(), [&](Index, Index first, Index size) {
    for (Index k = 0; k < max_kept; ++k) {
      kept.col(k).segment(first, size).noalias() =
          memory.basis.middleRows(first, size) * best.vectors.col(k);
    }
  });
  memory.moved = memory.at;
  memory.count = 0;
  memory.active = memory.quantity == 0;
  memory.quantity = 1 - memory.quantity;
}

}  // namespace fingertip::lattice::inline dynamics
