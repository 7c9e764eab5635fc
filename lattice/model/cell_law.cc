#include "lattice/model/cell_law.h"

#include <limits>
#include <stdexcept>

#include "lattice/kernels/cell_law.h"

namespace fingertip::lattice::inline model {

meshes::HyperelasticLaw hyperelastic_law(const CellMaterial& material) {
  return {material.energy, material.shear, material.volumetric};
}

namespace {

using Law = kernel::Law<double>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Eigen::Matrix3d;

Law::Rows rows_of(const Matrix3d& m) {
  return {{m(0, 0), m(0, 1), m(0, 2)}, {m(1, 0), m(1, 1), m(1, 2)}, {m(2, 0), m(2, 1), m(2, 2)}};
}

/// Entries row by row.
Vector9 flat(const Law::Rows& r) {
  Vector9 entries;
  entries << r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z;
  return entries;
}

/// A unit change of entry 3 i + J.
Law::Rows unit(Eigen::Index n) {
  Matrix3d change = Matrix3d::Zero();
  change(n / 3, n % 3) = 1.0;
  return rows_of(change);
}

/// C:eps of cubic axes that are turned against those of H.
Vector9 cubic_stress(const CellLaw& law, const Matrix3d& H) {
  const Law::Rows P = Law::cubic(law.material, 1.0, rows_of(law.axes.transpose() * H * law.axes));
  const Vector9 entries = flat(P);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> stress(entries.data());
  return flat(rows_of(law.axes * stress * law.axes.transpose()));
}

/// Cells that know F only.
CellResponse deformed_response(const CellMaterial& m, const Law::Rows& F) {
  const bool network = m.kind == CellLawKind::network;
  Law::Rows T = Law::cofactor(F);
  const double J = dot(F.x, T.x), shear = network ? m.shear : 0.0;
  if (network && !(J > 0.0)) throw std::domain_error("a cell is turned inside out");
  if (network) T = Law::multiple(1.0 / J, T);
  const double pressure =
      network ? Law::network_pressure(m, J) : Law::volume_pressure(m, 1.0, J - 1.0);
  CellResponse response;
  response.stress = (shear - m.hourglass_modulus) * flat(F) + pressure * flat(T);
  for (Eigen::Index n = 0; n < 9; ++n) {
    response.tangent.col(n) = flat(network ? Law::network_tangent(m, T, pressure, unit(n))
                                           : Law::volume_tangent(m, F, T, pressure, unit(n)));
  }
  return response;
}

}  // namespace

double CellLaw::energy(const Matrix3d& H, double excess) const {
  const CellMaterial& m = material;
  if (m.holds_fibres()) return hyperelastic_law(m).energy(Matrix3d::Identity() + H, excess);
  const Law::Rows gradient = rows_of(H);
  if (m.kind == CellLawKind::cubic) {
    return Law::cubic_energy(m, 1.0, rows_of(axes.transpose() * H * axes)) -
           0.5 * m.hourglass_modulus * H.squaredNorm();
  }
  const Law::Rows F = Law::plus_one(gradient);
  const double J = dot(F.x, cross(F.y, F.z)),
               fibres = 0.5 * m.hourglass_modulus * Law::stretch(gradient);
  if (m.kind == CellLawKind::volume) return Law::volume_energy(m, 1.0, J) - fibres;
  if (!(J > 0.0)) return std::numeric_limits<double>::infinity();
  return Law::network_energy(m, 1.0, gradient, J) - fibres;
}

CellResponse CellLaw::evaluate(const Matrix3d& H, double excess) const {
  CellResponse response;
  if (material.holds_fibres()) {
    const meshes::FluctuatingResponse point =
        hyperelastic_law(material).fluctuating(Matrix3d::Identity() + H, excess);
    response.energy = point.energy;
    response.stress = flat(rows_of(point.stress));
    response.tangent = point.tangent;
    response.slope = point.slope;
    response.curvature = point.curvature;
    response.mixed = point.mixed;
    return response;
  }
  if (material.kind == CellLawKind::cubic) {
    response.stress = cubic_stress(*this, H) - material.hourglass_modulus * flat(rows_of(H));
    for (Eigen::Index n = 0; n < 9; ++n) {
      Matrix3d change = Matrix3d::Zero();
      change(n / 3, n % 3) = 1.0;
      response.tangent.col(n) = cubic_stress(*this, change);
    }
  } else {
    response = deformed_response(material, Law::plus_one(rows_of(H)));
  }
  response.tangent.diagonal().array() -= material.hourglass_modulus;
  response.energy = energy(H);
  return response;
}

}  // namespace fingertip::lattice::inline model
