#include "fem_reference/tip/curved_sides.h"

#include <deal.II/base/polynomial.h>
#include <deal.II/base/tensor_product_polynomials.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/manifold.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fem_reference/elements/kinematics.h"
#include "meshes/volume_mesh/boundary_parts.h"

namespace fingertip::fem_reference::inline tip {
namespace {

using meshes::PhysicalTag;

/// Distance of a corner from its part, over the side's size, that is more than round-off.
constexpr double off_part = 1e-6;
/// Smallest Jacobian of a cell that is not turned, over the lengths of its tangents: at hidden
/// edges, and elsewhere, where a cell with straight sides may have 0.03.
constexpr double min_at_edges = 0.05, min_jacobian = 0.01;
/// Where a line on an edge of the body is further than this from a parabola, over the face's size,
/// the face is only spanned by its lines: small elements beside it would be turned.
constexpr double off_parabola = 1e-3;
/// Newton's method for a place on parabolas, whose coordinates run from 0 to 1.
constexpr int max_steps = 20;
constexpr double small_step = 1e-13;

/// The parts of a finger that is turned about y by -`tilt`.
template <int dim>
class TurnedParts {
 public:
  TurnedParts(const meshes::Geometry& geometry, double tilt)
      : parts_(meshes::boundary_parts(geometry)),
        turn_(Eigen::AngleAxisd(-tilt, Eigen::Vector3d::UnitY())) {}

  int part_at(PhysicalTag tag, const dealii::Point<dim>& point) const {
    return parts_->part_at(tag, upright(point));
  }
  bool hides_edges(int part) const { return parts_->hides_edges(part); }

  dealii::Point<dim> on(const std::vector<int>& parts, const dealii::Point<dim>& point) const {
    const Eigen::Vector3d found = turn_ * parts_->on(parts, upright(point));
    dealii::Point<dim> result;
    for (unsigned c = 0; c < dim; ++c) result[c] = found[Kinematics<dim>::axis[c]];
    return result;
  }

 private:
  Eigen::Vector3d upright(const dealii::Point<dim>& point) const {
    return turn_.conjugate() * in_space<dim>(point);
  }

  std::shared_ptr<const meshes::BoundaryParts> parts_;
  Eigen::Quaterniond turn_;
};

/// Keeps new points on parts of the boundary.
template <int dim>
class PartsManifold : public dealii::Manifold<dim> {
 public:
  PartsManifold(TurnedParts<dim> boundary, std::vector<int> parts)
      : boundary_(std::move(boundary)), parts_(std::move(parts)) {}

  std::unique_ptr<dealii::Manifold<dim>> clone() const override {
    return std::make_unique<PartsManifold>(*this);
  }

  dealii::Point<dim> get_new_point(const dealii::ArrayView<const dealii::Point<dim>>& points,
                                   const dealii::ArrayView<const double>& weights) const override {
    dealii::Point<dim> mean;
    for (unsigned i = 0; i < points.size(); ++i) mean += weights[i] * points[i];
    return boundary_.on(parts_, mean);
  }

 private:
  TurnedParts<dim> boundary_;
  std::vector<int> parts_;
};

/// Keeps new points on a line (`own` = 1) or face (2) of parabolas through 3 or 9 nodes, the first
/// coordinate running fastest.
template <int own>
class ParabolaManifold : public dealii::ChartManifold<3, 3, own> {
 public:
  explicit ParabolaManifold(std::vector<dealii::Point<3>> nodes)
      : nodes_(std::move(nodes)),
        shapes_(dealii::Polynomials::generate_complete_Lagrange_basis(
            {dealii::Point<1>(0.0), dealii::Point<1>(0.5), dealii::Point<1>(1.0)})) {}

  std::unique_ptr<dealii::Manifold<3>> clone() const override {
    return std::make_unique<ParabolaManifold>(*this);
  }

  dealii::Point<3> push_forward(const dealii::Point<own>& chart) const override {
    dealii::Point<3> place;
    for (unsigned i = 0; i < nodes_.size(); ++i)
      place += shapes_.compute_value(i, chart) * nodes_[i];
    return place;
  }

  /// Of the nearest place, by Gauss and Newton.
  dealii::Point<own> pull_back(const dealii::Point<3>& place) const override {
    dealii::Point<own> chart;
    for (unsigned c = 0; c < own; ++c) chart[c] = 0.5;
    for (int step = 0; step < max_steps; ++step) {
      const dealii::Tensor<1, 3> missing = place - push_forward(chart);
      Eigen::Matrix<double, 3, own> slope = Eigen::Matrix<double, 3, own>::Zero();
      for (unsigned i = 0; i < nodes_.size(); ++i) {
        const dealii::Tensor<1, own> gradient = shapes_.compute_grad(i, chart);
        for (unsigned c = 0; c < own; ++c)
          slope.col(c) += gradient[c] * Eigen::Vector3d(nodes_[i][0], nodes_[i][1], nodes_[i][2]);
      }
      const Eigen::Matrix<double, own, 1> change =
          slope.colPivHouseholderQr().solve(Eigen::Vector3d(missing[0], missing[1], missing[2]));
      for (unsigned c = 0; c < own; ++c) chart[c] += change[c];
      if (change.norm() < small_step) break;
    }
    return chart;
  }

 private:
  std::vector<dealii::Point<3>> nodes_;
  dealii::TensorProductPolynomials<own> shapes_;
};

/// Sides of the first mesh that follow the boundary, by their numbers: on their parts, or where the
/// mesh hides an edge, on parabolas.
class BoundarySides {
  using Line = Triangulation<3>::line_iterator;
  using Face = Triangulation<3>::face_iterator;

 public:
  BoundarySides(Body<3>& body, TurnedParts<3> boundary, dealii::types::manifold_id first_free)
      : triangulation_(body.triangulation),
        mapping_(unsigned(body.degree())),
        boundary_(std::move(boundary)),
        next_(first_free) {}

  /// `hidden`: the part where the side hides an edge of it; none where it has its manifold already.
  void add(const Face& face, std::optional<int> hidden) {
    faces_.try_emplace(face->index(), face, hidden);
  }
  void add(const Line& line, std::optional<int> hidden) {
    lines_.try_emplace(line->index(), line, hidden);
  }

  /// Fewer sides bend in every round, until no cell is turned inside out.
  void bend() {
    const std::set<int> at_edges =
        cells_at([](const auto& side) { return side.hidden.has_value(); });
    std::set<int> cells = cells_at([](const auto&) { return true; }), turned;
    do {
      for (auto& [number, line] : lines_) bend(line);
      for (auto& [number, face] : faces_) bend(face);
      turned = turned_among(cells, at_edges);
      ++round_;
      for (const auto& cell : triangulation_.cell_iterators())
        if (turned.contains(cell->index())) flatten(cell);
      // The others are as they were.
      cells = cells_at([this](const auto& side) { return side.flat_since == round_; });
      for (const int cell : turned) cells.erase(cell);
    } while (!turned.empty());
  }

 private:
  template <typename Side>
  struct Bent {
    Side side;
    std::optional<int> hidden;
    int flat_since = -1;  ///< round; -1: it is bent
    dealii::types::manifold_id number = dealii::numbers::flat_manifold_id;

    Bent(const Side& own, std::optional<int> part) : side(own), hidden(part) {}
    void flatten(int round) {
      if (flat_since < 0) flat_since = round;
      side->set_manifold_id(dealii::numbers::flat_manifold_id);
    }
  };

  /// Those with a side that is `wanted`.
  std::set<int> cells_at(const auto& wanted) const {
    std::set<int> cells;
    const auto look = [&](const auto& cell, const auto& side, const auto& all) {
      const auto found = all.find(side->index());
      if (found != all.end() && wanted(found->second)) cells.insert(cell->index());
    };
    for (const auto& cell : triangulation_.cell_iterators()) {
      for (const unsigned l : cell->line_indices()) look(cell, cell->line(l), lines_);
      for (const auto& face : cell->face_iterators()) look(cell, face, faces_);
    }
    return cells;
  }

  void bend(Bent<Line>& own) {
    const Line& line = own.side;
    if (!own.hidden || own.flat_since >= 0) return;
    set<1>(own, {line->vertex(0), boundary_.on({*own.hidden}, line->center()), line->vertex(1)});
  }

  void bend(Bent<Face>& own) {
    const Face& face = own.side;
    if (!own.hidden || own.flat_since >= 0) return;
    for (unsigned i = 0; i < 4; ++i)
      if (bends_otherwise(face->line(i), off_parabola * face->diameter()))
        return own.flatten(round_);
    std::array<dealii::Point<3>, 4> corners, middles;
    dealii::Point<3> within;  // the sides' transfinite interpolation
    for (unsigned i = 0; i < 4; ++i) {
      corners[i] = face->vertex(i);
      middles[i] = face->line(i)->center(true);
      within += 0.5 * middles[i] - 0.25 * corners[i];
    }
    set<2>(own,
           {corners[0], middles[2], corners[1], middles[0], boundary_.on({*own.hidden}, within),
            middles[1], corners[2], middles[3], corners[3]});
  }

  static bool bends_otherwise(const Line& line, double tolerance) {
    const dealii::Point<3> middle = line->center(true);
    for (const unsigned end : {0, 1}) {
      const std::array<dealii::Point<3>, 2> half = {line->vertex(end), middle};
      const std::array<double, 2> weights = {0.5, 0.5};
      const dealii::Point<3> quarter = line->get_manifold().get_new_point(
          dealii::make_array_view(half.begin(), half.end()),
          dealii::make_array_view(weights.begin(), weights.end()));
      const dealii::Tensor<1, 3> of_parabola =
          0.375 * half[0] + 0.75 * middle - 0.125 * line->vertex(1 - end);
      if ((quarter - of_parabola).norm() > tolerance) return true;
    }
    return false;
  }

  template <int dim, typename Side>
  void set(Bent<Side>& own, std::vector<dealii::Point<3>> nodes) {
    if (std::ranges::any_of(own.side->vertex_indices(), [&](unsigned v) {
          const dealii::Point<3> corner = own.side->vertex(v);
          return boundary_.on({*own.hidden}, corner).distance(corner) >
                 off_part * own.side->diameter();
        }))
      return own.flatten(round_);
    if (own.number == dealii::numbers::flat_manifold_id) own.number = next_++;
    triangulation_.set_manifold(own.number, ParabolaManifold<dim>(std::move(nodes)));
    own.side->set_manifold_id(own.number);
  }

  /// Those that are turned, or nearly so, or would be when they are divided.
  std::set<int> turned_among(const std::set<int>& cells, const std::set<int>& at_edges) const {
    if (cells.empty()) return {};
    dealii::Triangulation<3> divided;
    divided.copy_triangulation(triangulation_);
    for (const auto& cell : divided.cell_iterators())
      if (cells.contains(cell->index())) cell->set_refine_flag();
    divided.execute_coarsening_and_refinement();
    const dealii::FE_Nothing<3> no_element;
    dealii::FEValues<3> values(mapping_, no_element,
                               dealii::QGaussLobatto<3>(mapping_.get_degree() + 1),
                               dealii::update_jacobians);
    const auto is_turned = [&](const auto& cell, double least) {
      values.reinit(cell);
      return std::ranges::any_of(values.get_jacobians(), [least](const auto& jacobian) {
        const dealii::Tensor<2, 3> columns = transpose(dealii::Tensor<2, 3>(jacobian));
        const double cube = columns[0].norm() * columns[1].norm() * columns[2].norm();
        return !(determinant(columns) > least * cube);
      });
    };
    std::set<int> turned;
    for (const auto& cell : divided.cell_iterators_on_level(0)) {
      if (!cells.contains(cell->index())) continue;
      const double least = at_edges.contains(cell->index()) ? min_at_edges : min_jacobian;
      bool any = is_turned(cell, least);
      for (unsigned c = 0; c < cell->n_children(); ++c) any |= is_turned(cell->child(c), least);
      if (any) turned.insert(cell->index());
    }
    return turned;
  }

  template <typename Cell>
  void flatten(const Cell& cell) {
    for (const unsigned l : cell->line_indices())
      if (const auto line = lines_.find(cell->line(l)->index()); line != lines_.end())
        line->second.flatten(round_);
    for (const unsigned f : cell->face_indices())
      if (const auto face = faces_.find(cell->face(f)->index()); face != faces_.end())
        face->second.flatten(round_);
  }

  Triangulation<3>& triangulation_;
  const dealii::MappingQ<3> mapping_;
  TurnedParts<3> boundary_;
  dealii::types::manifold_id next_;
  int round_ = 0;
  std::map<int, Bent<Line>> lines_;
  std::map<int, Bent<Face>> faces_;
};

}  // namespace

template <int dim>
void follow_boundary(Body<dim>& body, const meshes::Geometry& geometry, double tilt) {
  Triangulation<dim>& triangulation = body.triangulation;
  const TurnedParts<dim> boundary(geometry, tilt);
  using PartSet = std::set<int>;
  std::map<PartSet, dealii::types::manifold_id> numbers;
  std::map<int, PartSet> at_face, at_line;  // by the side's number
  for (const auto& cell : triangulation.cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const int part = boundary.part_at(PhysicalTag(face->boundary_id()), face->center());
      if (part < 0) continue;
      at_face[face->index()] = {part};
      if constexpr (dim == 3)
        for (const unsigned l : face->line_indices()) at_line[face->line(l)->index()].insert(part);
    }
  const auto hides_edges = [&](const PartSet& parts) {
    return parts.size() == 1 && boundary.hides_edges(*parts.begin());
  };
  const auto follow = [&](const auto& side, const std::map<int, PartSet>& all) {
    const auto found = all.find(side->index());
    if (found == all.end() || hides_edges(found->second)) return;
    side->set_manifold_id(
        numbers.try_emplace(found->second, dealii::types::manifold_id(numbers.size()))
            .first->second);
  };
  for (const auto& cell : triangulation.cell_iterators()) {
    for (const auto& face : cell->face_iterators()) follow(face, at_face);
    if constexpr (dim == 3)
      for (const unsigned l : cell->line_indices()) follow(cell->line(l), at_line);
  }
  for (const auto& [parts, number] : numbers)
    triangulation.set_manifold(number, PartsManifold<dim>(boundary, {parts.begin(), parts.end()}));
  if constexpr (dim == 3) {
    BoundarySides sides(body, boundary, dealii::types::manifold_id(numbers.size()));
    const auto add = [&](const auto& side, const std::map<int, PartSet>& all) {
      const auto found = all.find(side->index());
      if (found == all.end()) return;
      sides.add(side,
                hides_edges(found->second) ? std::optional(*found->second.begin()) : std::nullopt);
    };
    for (const auto& cell : triangulation.cell_iterators()) {
      for (const auto& face : cell->face_iterators()) add(face, at_face);
      for (const unsigned l : cell->line_indices()) add(cell->line(l), at_line);
    }
    sides.bend();
  }
}

template void follow_boundary(Body<2>&, const meshes::Geometry&, double);
template void follow_boundary(Body<3>&, const meshes::Geometry&, double);

}  // namespace fingertip::fem_reference::inline tip
