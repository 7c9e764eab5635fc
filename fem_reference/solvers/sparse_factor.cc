#include "fem_reference/solvers/sparse_factor.h"

#include <cholmod.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>
#include <string>

#include "meshes/base/blas.h"
#include "meshes/base/errors.h"

/// LAPACK: inverse from a Cholesky factor, in place.
extern "C" void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace fingertip::fem_reference::inline solvers {
namespace {

using Long = SuiteSparse_long;
static_assert(sizeof(Long) == sizeof(long));

/// A factorisation does this many times as many operations a second as a solution, which waits for
/// the memory.
constexpr double factorisation_speed = 8.0;

/// CHOLMOD's workspace. Its objects are freed through it, so that it must outlive them.
class Workspace {
 public:
  Workspace() {
    cholmod_l_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Workspace() { cholmod_l_finish(&common); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  auto own(cholmod_factor* object) {
    return std::shared_ptr<cholmod_factor>(
        object, [this](cholmod_factor* p) { cholmod_l_free_factor(&p, &common); });
  }
  auto own(cholmod_dense* object) {
    return std::shared_ptr<cholmod_dense>(
        object, [this](cholmod_dense* p) { cholmod_l_free_dense(&p, &common); });
  }

  cholmod_common common{};
};

/// CHOLMOD's view of a matrix that someone else owns.
cholmod_sparse view(const UpperTriangle& matrix, bool values) {
  cholmod_sparse result{};
  result.nrow = result.ncol = std::size_t(matrix.size());
  result.nzmax = matrix.row.size();
  result.p = const_cast<long*>(matrix.start.data());
  result.i = const_cast<long*>(matrix.row.data());
  result.x = values ? const_cast<double*>(matrix.value.data()) : nullptr;
  result.stype = 1;
  result.itype = CHOLMOD_LONG;
  result.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = result.packed = 1;
  return result;
}

/// The groups that hold unknowns before the last ones, and who touches whom among them.
struct GroupGraph {
  std::vector<std::vector<long>> members;
  UpperTriangle pattern;
};

GroupGraph group_graph(const UpperTriangle& matrix, const std::vector<long>& group,
                       const std::vector<char>& is_last) {
  const long groups = group.empty() ? 0 : *std::ranges::max_element(group) + 1;
  std::vector<long> number(std::size_t(groups), -1);
  GroupGraph graph;
  for (long i = 0; i < matrix.size(); ++i) {
    if (is_last[std::size_t(i)]) continue;
    long& k = number[std::size_t(group[std::size_t(i)])];
    if (k < 0) {
      k = long(graph.members.size());
      graph.members.emplace_back();
    }
    graph.members[std::size_t(k)].push_back(i);
  }
  std::vector<std::set<long>> above(graph.members.size());
  for (long column = 0; column < matrix.size(); ++column) {
    if (is_last[std::size_t(column)]) continue;
    const long c = number[std::size_t(group[std::size_t(column)])];
    for (long e = matrix.start[std::size_t(column)]; e < matrix.start[std::size_t(column) + 1];
         ++e) {
      const auto row = std::size_t(matrix.row[std::size_t(e)]);
      if (is_last[row]) continue;
      const long r = number[std::size_t(group[row])];
      above[std::size_t(std::max(r, c))].insert(std::min(r, c));
    }
  }
  graph.pattern.start.push_back(0);
  for (const std::set<long>& rows : above) {
    graph.pattern.row.insert(graph.pattern.row.end(), rows.begin(), rows.end());
    graph.pattern.start.push_back(long(graph.pattern.row.size()));
  }
  return graph;
}

}  // namespace

struct SparseFactor::Implementation {
  Workspace workspace;
  std::shared_ptr<cholmod_factor> factor;
  std::vector<long> last;
  double solves_per_factorisation = 0.0;
};

SparseFactor::SparseFactor(const UpperTriangle& pattern, const std::vector<long>& group,
                           const std::vector<long>& last)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& self = *implementation_;
  cholmod_common& common = self.workspace.common;
  self.last = last;
  std::vector<char> is_last(std::size_t(pattern.size()), 0);
  for (const long i : last) is_last[std::size_t(i)] = 1;

  const GroupGraph graph = group_graph(pattern, group, is_last);
  std::vector<Long> group_order(graph.members.size());
  cholmod_sparse groups = view(graph.pattern, false);
  if (!cholmod_l_metis(&groups, nullptr, 0, 1, group_order.data(), &common))
    throw meshes::NotConverged("the ordering of the stiffness matrix failed");
  std::vector<Long> order;
  for (const Long k : group_order)
    order.insert(order.end(), graph.members[std::size_t(k)].begin(),
                 graph.members[std::size_t(k)].end());
  order.insert(order.end(), last.begin(), last.end());

  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholmod_sparse matrix = view(pattern, false);
  self.factor = self.workspace.own(cholmod_l_analyze_p(&matrix, order.data(), nullptr, 0, &common));
  if (!self.factor) throw meshes::NotConverged("not enough memory for the stiffness matrix");
  self.solves_per_factorisation = common.fl / (4.0 * common.lnz * factorisation_speed);
}

SparseFactor::~SparseFactor() = default;

void SparseFactor::factorise(const UpperTriangle& upper) {
  cholmod_common& common = implementation_->workspace.common;
  cholmod_sparse matrix = view(upper, true);
  const meshes::OneOpenMpThread one_thread;
  if (!cholmod_l_factorize(&matrix, implementation_->factor.get(), &common) ||
      common.status != CHOLMOD_OK)
    throw meshes::NotConverged(
        "the stiffness matrix could not be factorised (CHOLMOD status " +
        std::to_string(common.status) +
        "): too little memory, a degenerate mesh, or a state that is not stable");
}

Eigen::MatrixXd SparseFactor::solve_columns(const Eigen::MatrixXd& b) const {
  Implementation& self = *implementation_;
  cholmod_dense right{};
  right.nrow = right.d = std::size_t(b.rows());
  right.ncol = std::size_t(b.cols());
  right.nzmax = right.nrow * right.ncol;
  right.x = const_cast<double*>(b.data());
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  const meshes::OneBlasThread one_thread;  // others wait for the memory, as this one does
  const auto solution = self.workspace.own(
      cholmod_l_solve(CHOLMOD_A, self.factor.get(), &right, &self.workspace.common));
  return Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(solution->x), b.rows(), b.cols());
}

double SparseFactor::solves_per_factorisation() const {
  return implementation_->solves_per_factorisation;
}

Eigen::MatrixXd SparseFactor::last_block_of_inverse() const {
  const cholmod_factor& factor = *implementation_->factor;
  const auto size = Eigen::Index(implementation_->last.size());
  const auto interior = Long(factor.n) - size;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, size);
  const Long* super = static_cast<Long*>(factor.super);
  const Long* row_start = static_cast<Long*>(factor.pi);
  const Long* value_start = static_cast<Long*>(factor.px);
  const Long* rows = static_cast<Long*>(factor.s);
  const double* values = static_cast<double*>(factor.x);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const Long height = row_start[s + 1] - row_start[s];
    for (Long column = std::max(super[s], interior); column < super[s + 1]; ++column)
      for (Long k = column - super[s]; k < height; ++k)
        lower(rows[row_start[s] + k] - interior, column - interior) =
            values[value_start[s] + (column - super[s]) * height + k];
  }
  const int n = int(size);
  int failed = 0;
  if (n > 0) dpotri_("L", &n, lower.data(), &n, &failed);
  if (failed) throw meshes::NotConverged("the condensed stiffness is singular");
  lower.triangularView<Eigen::StrictlyUpper>() = lower.transpose();
  // CHOLMOD may reorder unknowns further while it keeps every subtree together.
  const Long* permutation = static_cast<Long*>(factor.Perm);
  std::vector<long> place(factor.n, -1);
  for (Eigen::Index i = 0; i < size; ++i) place[std::size_t(permutation[interior + i])] = i;
  std::vector<int> position;
  for (const long unknown : implementation_->last) {
    if (place[std::size_t(unknown)] < 0)
      throw meshes::NotConverged("CHOLMOD moved contact unknowns off the end");
    position.push_back(int(place[std::size_t(unknown)]));
  }
  const bool in_order = std::ranges::is_sorted(position);  // then it is 0, 1, 2, ...
  return in_order ? lower : Eigen::MatrixXd(lower(position, position));
}

}  // namespace fingertip::fem_reference::inline solvers
