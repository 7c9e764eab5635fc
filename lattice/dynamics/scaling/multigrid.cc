#include "lattice/dynamics/scaling/multigrid.h"

#include <algorithm>

#include "lattice/kernels/by_width.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

namespace {

const sweeps::Loops& loops() {
  static const sweeps::Loops& widest =
      kernel::by_width(0, [](auto w) { return sweeps::loops_at<w()>; })();
  return widest;
}

constexpr std::size_t sweeps_at_once = 64;  // blocks of eight points
constexpr std::size_t contact_grain = 128;
/// Of Jacobi's sweeps, on S alone: where it is small the sweeps are exact.
constexpr Single sweep_damping = 1.3F;
constexpr int last_sweeps = 8;  // on the coarsest grid; even, so that B <= A⁻¹

MultigridFields::Field field(std::size_t points) {
  MultigridFields::Field result;
  for (auto& component : result) component.assign(points, 0.0F);
  return result;
}

void point_to(MultigridFields::Field& field, Single* (&pointers)[3]) {
  for (std::size_t c = 0; c < 3; ++c) pointers[c] = field[c].data();
}

std::array<Single, 3> at(const MultigridFields::Field& field, std::size_t point) {
  return {field[0][point], field[1][point], field[2][point]};
}

void put(MultigridFields::Field& field, std::size_t point, const std::array<Single, 3>& value) {
  for (std::size_t c = 0; c < 3; ++c) field[c][point] = value[c];
}

/// Shares of a level's contact go to the points around.
void share_contact(const GridLevel& fine, const GridLevel& coarse,
                   const std::vector<PointTie>& from, MultigridFields::Level& to) {
  for (const PointTie& tie : to.contact) to.contact_at[tie.point] = -1;
  to.contact.clear();
  for (const PointTie& tie : from) {
    const CoarsePoints points = coarse_points(fine, coarse, tie.point);
    const Single share = 1.0F / Single(points.count);
    for (std::size_t n = 0; n < std::size_t(points.count); ++n) {
      std::int32_t& place = to.contact_at[points.point[n]];
      if (place < 0) {
        place = std::int32_t(to.contact.size());
        to.contact.push_back({points.point[n]});
      }
      to.contact[std::size_t(place)].inertia += share * tie.inertia;
    }
  }
}

/// What a coarse point (or, along its own axis, edge) gets of the fine ones around 2i - 1.
constexpr std::array<Single, 3> of_points{0.5F, 1.0F, 0.5F}, of_edges{0.0F, 1.0F, 1.0F};

/// `axis`: of edges; 3 for what points have.
void coarsen(const GridLevel& fine_grid, const GridLevel& coarse_grid,
             const std::vector<Single>& fine, std::size_t axis, std::vector<Single>& sheet,
             std::vector<Single>& coarse) {
  sweeps::Weights weights{};
  for (std::size_t d = 0; d < 3; ++d) {
    const auto& along = d == axis ? of_edges : of_points;
    std::copy(along.begin(), along.end(), weights.along[d]);
  }
  weights.next[0] = fine_grid.next[1];
  weights.next[1] = fine_grid.next[2];
  weights.all = axis < 3 ? 0.25F : 1.0F;
  loops().share_across(weights, fine.data(), fine_grid.sheet_blocks.data(),
                       fine_grid.sheet_blocks.size(), sheet.data());
  loops().share_along(weights, sheet.data(), fine_grid.coarser_sheets.data(),
                      coarse_grid.blocks.data(), coarse_grid.blocks.size(), coarse.data());
}

}  // namespace

MultigridFields::MultigridFields(const GridHierarchy& hierarchy) {
  for (const GridLevel& level : hierarchy.levels()) {
    const std::size_t points = level.points();
    levels.push_back({field(points),
                      field(points),
                      field(points),
                      field(level.sheet_points),
                      field(level.sheet_points),
                      {},
                      std::vector<std::int32_t>(points, -1)});
    levels.back().contact.reserve(points);
  }
}

Multigrid::Multigrid(std::shared_ptr<const GridHierarchy> hierarchy)
    : hierarchy_(std::move(hierarchy)) {
  for (const GridLevel& level : hierarchy_->levels()) {
    Matrix matrix;
    matrix.edge.fill(field(level.points()));
    matrix.inertia.assign(level.points(), 0.0F);
    matrix.relaxation = field(level.points());
    for (auto& sheet : matrix.sheets) sheet.assign(level.sheet_points, 0.0F);
    matrices_.push_back(std::move(matrix));
  }
}

void Multigrid::set(const std::vector<double>& inertia, Team& team) {
  std::copy(inertia.begin(), inertia.end(), matrices_.front().inertia.begin());
  for (std::size_t level = 0; level < matrices_.size(); ++level) {
    finish(level, team);
    if (level + 1 < matrices_.size()) coarsen(level, team);
  }
}

Single Multigrid::Matrix::diagonal(const GridLevel& grid, std::size_t component,
                                   std::size_t point) const {
  Single sum = 0.0F;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::vector<Single>& along = edge[component][d];
    sum += along[point] + along[point - std::size_t(grid.next[d])];
  }
  return inertia[point] + sweep_damping * sum;
}

void Multigrid::finish(std::size_t level, Team& team) {
  const GridLevel& grid = hierarchy_->levels()[level];
  Matrix& matrix = matrices_[level];
  sweeps::RelaxationArrays a{};
  a.inertia = matrix.inertia.data();
  a.damping = sweep_damping;
  for (std::size_t c = 0; c < 3; ++c) {
    a.relaxation[c] = matrix.relaxation[c].data();
    for (std::size_t d = 0; d < 3; ++d) a.edge[c][d] = matrix.edge[c][d].data();
  }
  std::copy(grid.next.begin(), grid.next.end(), a.next);
  team.split(grid.blocks.size(), sweeps_at_once, [&](std::size_t from, std::size_t to) {
    loops().find_relaxation(a, grid.blocks.data() + from, to - from);
  });
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint32_t p : grid.held[c]) matrix.relaxation[c][p] = 0.0F;
}

/// Of the two points below and above on an axis, which may be the same, each gets half.
void Multigrid::coarsen(std::size_t level, Team& team) {
  const GridLevel &grid = hierarchy_->levels()[level], &coarser = hierarchy_->levels()[level + 1];
  Matrix &fine = matrices_[level], &coarse = matrices_[level + 1];
  team.split(10, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; ++n) {
      const std::size_t c = n / 3, d = n % 3;
      if (n == 9) {
        lattice::coarsen(grid, coarser, fine.inertia, 3, fine.sheets[n], coarse.inertia);
      } else {
        lattice::coarsen(grid, coarser, fine.edge[c][d], d, fine.sheets[n], coarse.edge[c][d]);
      }
    }
  });
}

/// Of one level, for one solve.
class Multigrid::Cycle {
 public:
  Cycle(const Multigrid& grids, Team& team, MultigridFields& fields)
      : grids_(&grids), team_(&team), fields_(&fields) {}

  void run(std::size_t level) {
    const GridLevel& grid = grids_->hierarchy_->levels()[level];
    const Matrix& matrix = grids_->matrices_[level];
    MultigridFields::Level& fields = fields_->levels[level];
    begin(grid, matrix, fields);
    if (level + 1 == grids_->matrices_.size()) {
      for (int n = 1; n < last_sweeps; ++n) smooth(grid, matrix, fields);
      return;
    }
    find_residual(grid, matrix, fields);
    pass_on(level);
    run(level + 1);
    take_back(level);
    smooth(grid, matrix, fields);
  }

 private:
  static sweeps::LevelArrays arrays(const GridLevel& grid, const Matrix& matrix,
                                    MultigridFields::Level& fields) {
    sweeps::LevelArrays a{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) a.edge[c][d] = matrix.edge[c][d].data();
      a.relaxation[c] = matrix.relaxation[c].data();
      a.load[c] = fields.load[c].data();
    }
    point_to(fields.solution, a.solution);
    point_to(fields.residual, a.residual);
    a.inertia = matrix.inertia.data();
    a.next[0] = grid.next[1];
    a.next[1] = grid.next[2];
    return a;
  }

  template <typename Loop>
  void over(std::size_t count, const Loop& loop) {
    team_->split(count, sweeps_at_once, loop);
  }

  /// Points of the contact are all different.
  template <typename Body>
  void over_contact(const MultigridFields::Level& fields, const Body& body) {
    team_->split(fields.contact.size(), contact_grain, [&](std::size_t from, std::size_t to) {
      for (std::size_t n = from; n < to; ++n) body(fields.contact[n]);
    });
  }

  /// A damped Jacobi step at a contact's point, the same for all directions of the rubber, whether
  /// held or not.
  std::array<Single, 3> relaxed(const GridLevel& grid, const Matrix& matrix, const PointTie& tie,
                                const std::array<Single, 3>& residual) const {
    const auto share = at(matrix.relaxation, tie.point);
    Single rubber = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool held = share[c] == 0.0F;
      rubber = std::max(rubber, held ? matrix.diagonal(grid, c, tie.point) : 1.0F / share[c]);
    }
    // What is held has no part in it. Doubles, for ties are stiff in one direction.
    Eigen::Matrix3d inertia = tie.inertia.cast<double>();
    Eigen::Vector3d load(residual[0], residual[1], residual[2]);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = Eigen::Index(c);
      if (share[c] == 0.0F) {
        inertia.row(axis).setZero();
        inertia.col(axis).setZero();
        load[axis] = 0.0;
      }
      inertia(axis, axis) += double(rubber);
    }
    const Eigen::Vector3f step = (inertia.inverse() * load).cast<Single>();
    return {step[0], step[1], step[2]};
  }

  static std::array<Single, 3> product(const PointTie& tie, const std::array<Single, 3>& u) {
    const Eigen::Vector3f taken = tie.inertia * Eigen::Map<const Eigen::Vector3f>(u.data());
    return {taken[0], taken[1], taken[2]};
  }

  void begin(const GridLevel& grid, const Matrix& matrix, MultigridFields::Level& fields) {
    const sweeps::LevelArrays a = arrays(grid, matrix, fields);
    over(grid.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().first_sweep(a, grid.blocks.data() + from, to - from);
    });
    over_contact(fields, [&](const PointTie& tie) {
      put(fields.solution, tie.point, relaxed(grid, matrix, tie, at(fields.load, tie.point)));
    });
  }

  void find_residual(const GridLevel& grid, const Matrix& matrix, MultigridFields::Level& fields) {
    const sweeps::LevelArrays a = arrays(grid, matrix, fields);
    over(grid.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().find_residual(a, grid.blocks.data() + from, to - from);
    });
    over_contact(fields, [&](const PointTie& tie) {
      const auto taken = product(tie, at(fields.solution, tie.point));
      for (std::size_t c = 0; c < 3; ++c) fields.residual[c][tie.point] -= taken[c];
    });
  }

  void smooth(const GridLevel& grid, const Matrix& matrix, MultigridFields::Level& fields) {
    const sweeps::LevelArrays a = arrays(grid, matrix, fields);
    over(grid.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().smooth(a, grid.blocks.data() + from, to - from);
    });
    over_contact(fields, [&](const PointTie& tie) {
      const auto before = at(fields.solution, tie.point), plain = at(fields.residual, tie.point);
      const auto taken = product(tie, before);
      std::array<Single, 3> residual{};
      for (std::size_t c = 0; c < 3; ++c) {
        const Single relaxation = matrix.relaxation[c][tie.point];
        if (relaxation > 0.0F) residual[c] = (plain[c] - before[c]) / relaxation - taken[c];
      }
      const auto step = relaxed(grid, matrix, tie, residual);
      put(fields.residual, tie.point,
          {before[0] + step[0], before[1] + step[1], before[2] + step[2]});
    });
    std::swap(fields.solution, fields.residual);
  }

  sweeps::TransferArrays transfer(std::size_t level, MultigridFields::Field& fine,
                                  MultigridFields::Field& sheet, MultigridFields::Field& coarse) {
    sweeps::TransferArrays t{};
    const GridLevel& grid = grids_->hierarchy_->levels()[level];
    point_to(fine, t.fine);
    point_to(sheet, t.sheet);
    point_to(coarse, t.coarse);
    t.next[0] = grid.next[1];
    t.next[1] = grid.next[2];
    return t;
  }

  void pass_on(std::size_t level) {
    const GridLevel& grid = grids_->hierarchy_->levels()[level];
    const GridLevel& coarse = grids_->hierarchy_->levels()[level + 1];
    MultigridFields::Level &here = fields_->levels[level], &there = fields_->levels[level + 1];
    const sweeps::TransferArrays t = transfer(level, here.residual, here.gathered, there.load);
    over(grid.sheet_blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().gather(t, grid.sheet_blocks.data() + from, to - from);
    });
    over(coarse.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().contract(t, coarse.blocks.data() + from, grid.coarser_sheets.data() + from,
                       to - from);
    });
    share_contact(grid, coarse, here.contact, there);
  }

  void take_back(std::size_t level) {
    const GridLevel& grid = grids_->hierarchy_->levels()[level];
    const GridLevel& coarse = grids_->hierarchy_->levels()[level + 1];
    MultigridFields::Level &here = fields_->levels[level], &there = fields_->levels[level + 1];
    const sweeps::TransferArrays t = transfer(level, here.solution, here.stretched, there.solution);
    over(coarse.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().stretch(t, coarse.blocks.data() + from, grid.coarser_sheets.data() + from, to - from);
    });
    over(grid.blocks.size(), [&](std::size_t from, std::size_t to) {
      loops().spread(t, grid.blocks.data() + from, grid.parents.data() + from, to - from);
    });
  }

  const Multigrid* grids_;
  Team* team_;
  MultigridFields* fields_;
};

void Multigrid::solve(Team& team, MultigridFields& fields) const {
  Cycle(*this, team, fields).run(0);
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling
