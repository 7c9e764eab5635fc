#include "fem_reference/solvers/sparse_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <filesystem>
#include <random>

#include "fem_reference/contact/growing_cholesky.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using fem_reference::GrowingCholesky;
using fem_reference::SparseFactor;
using fem_reference::UpperTriangle;

namespace {

constexpr long side = 7, per_node = 3, unknowns = side * side * per_node;

/// Symmetric positive definite, with the pattern of a grid of nodes with three unknowns each that
/// meet their neighbours: diagonally dominant, entries at random.
Eigen::MatrixXd grid_matrix(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (long i = 0; i < unknowns; ++i)
    for (long j = 0; j < i; ++j) {
      const long a = i / per_node, b = j / per_node;
      if (std::abs(a % side - b % side) <= 1 && std::abs(a / side - b / side) <= 1)
        matrix(i, j) = matrix(j, i) = uniform(generator);
    }
  for (long i = 0; i < unknowns; ++i) matrix(i, i) = matrix.row(i).cwiseAbs().sum() + 0.1;
  return matrix;
}

/// Entries of the grid's pattern, zero or not.
UpperTriangle upper_triangle(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd pattern = grid_matrix(1);
  UpperTriangle upper;
  upper.start.push_back(0);
  for (long column = 0; column < unknowns; ++column) {
    for (long row = 0; row <= column; ++row)
      if (pattern(row, column) != 0.0) {
        upper.row.push_back(row);
        upper.value.push_back(matrix(row, column));
      }
    upper.start.push_back(long(upper.row.size()));
  }
  return upper;
}

std::vector<long> groups() {
  std::vector<long> result(unknowns);
  for (long i = 0; i < unknowns; ++i) result[std::size_t(i)] = i / per_node;
  return result;
}

/// Some unknowns, of complete and of broken groups, in no order.
std::vector<long> some_unknowns() {
  return {70, 3, 4, 5, 146, 0, 22, 71, 100};
}

/// All unknowns at the rim of the grid, shuffled: more than inside.
std::vector<long> rim() {
  std::vector<long> result;
  for (long i = 0; i < unknowns; ++i) {
    const long column = i / per_node % side, row = i / per_node / side;
    if (column == 0 || row == 0 || column == side - 1 || row == side - 1) result.push_back(i);
  }
  std::shuffle(result.begin(), result.end(), std::mt19937(5));
  return result;
}

TEST(SparseFactor, SolvesLikeADenseOne) {
  const Eigen::MatrixXd matrix = grid_matrix(1);
  SparseFactor factor(upper_triangle(matrix), groups(), some_unknowns());
  factor.factorise(upper_triangle(matrix));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(unknowns, -1.0, 2.0);
  const Eigen::VectorXd exact = matrix.llt().solve(b);
  EXPECT_LT((factor.solve(b) - exact).norm(), 1e-12 * exact.norm());
}

TEST(SparseFactor, KnowsTheLastBlockOfTheInverse) {
  const Eigen::MatrixXd matrix = grid_matrix(2), inverse = matrix.inverse();
  for (const auto& last : {some_unknowns(), std::vector<long>{17}, rim(), std::vector<long>{}}) {
    SparseFactor factor(upper_triangle(matrix), groups(), last);
    factor.factorise(upper_triangle(matrix));
    const Eigen::MatrixXd expected = inverse(last, last);
    const Eigen::MatrixXd block = factor.last_block_of_inverse();
    ASSERT_EQ(block.rows(), Eigen::Index(last.size()));
    EXPECT_LE((block - expected).norm(), 1e-12 * expected.norm()) << last.size();
  }
}

TEST(SparseFactor, TakesNewValuesOfTheSamePattern) {
  SparseFactor factor(upper_triangle(grid_matrix(1)), groups(), some_unknowns());
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(unknowns);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Eigen::MatrixXd matrix = grid_matrix(seed);
    factor.factorise(upper_triangle(matrix));
    EXPECT_LT((matrix * factor.solve(b) - b).norm(), 1e-12 * b.norm());
    const Eigen::MatrixXd expected = matrix.inverse()(some_unknowns(), some_unknowns());
    EXPECT_LT((factor.last_block_of_inverse() - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(SparseFactor, RefusesAMatrixThatIsNotPositiveDefiniteAndGoesOn) {
  const Eigen::MatrixXd good = grid_matrix(1);
  SparseFactor factor(upper_triangle(good), groups(), some_unknowns());
  for (const long place : {0L, 50L, unknowns - 1}) {
    Eigen::MatrixXd bad = good;
    bad(place, place) = -1.0;
    EXPECT_THROW(factor.factorise(upper_triangle(bad)), meshes::NotConverged) << place;
  }
  factor.factorise(upper_triangle(good));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(unknowns);
  EXPECT_LT((good * factor.solve(b) - b).norm(), 1e-12 * b.norm());
}

/// Threads of CHOLMOD's own would wait for those of BLAS.
TEST(SparseFactor, FactorisesOnTheThreadThatAsks) {
  const auto threads = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
  };
  const auto before = threads();
  constexpr long size = 300;
  UpperTriangle full;
  std::vector<long> group;
  full.start.push_back(0);
  for (long column = 0; column < size; ++column) {
    group.push_back(column);
    for (long row = 0; row <= column; ++row) {
      full.row.push_back(row);
      full.value.push_back(row == column ? 1.0 + size : 1.0);
    }
    full.start.push_back(long(full.row.size()));
  }
  SparseFactor factor(full, group, {0, size / 2});
  factor.factorise(full);
  EXPECT_NEAR(factor.solve(Eigen::VectorXd::Ones(size))[7], 1.0 / (2 * size), 1e-15);
  EXPECT_EQ(threads(), before);
}

Eigen::MatrixXd random_positive_definite(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [&](auto, auto) { return normal(generator); });
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

TEST(GrowingCholesky, FollowsAnyChangeOfTheIndexSet) {
  const int n = 90;
  const Eigen::MatrixXd matrix = random_positive_definite(n, 1);
  GrowingCholesky factor(matrix);
  std::mt19937 generator(2);
  std::vector<char> chosen(n, 0);
  for (int round = 0; round < 30; ++round) {
    for (int flips = 0; flips < 12; ++flips) {
      char& flag = chosen[generator() % n];
      flag = !flag;
    }
    factor.choose(chosen);
    const std::vector<int>& indices = factor.indices();
    EXPECT_EQ(std::ranges::count(chosen, 1), std::ptrdiff_t(indices.size()));
    for (const int i : indices) EXPECT_TRUE(chosen[std::size_t(i)]);
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(Eigen::Index(indices.size()));
    const Eigen::MatrixXd block = matrix(indices, indices);
    EXPECT_LT((block * factor.solve(b) - b).norm(), 1e-9 * b.norm());
  }
}

TEST(GrowingCholesky, RefusesAnIndefiniteMatrix) {
  const Eigen::MatrixXd matrix = Eigen::Vector2d(1.0, -1.0).asDiagonal();
  GrowingCholesky factor(matrix);
  EXPECT_THROW(factor.choose({1, 1}), meshes::NotConverged);
}

}  // namespace
