/// The laws of cells: energy, stress and tangent per volume of rubber, written once for the kernel
/// (packs of cells) and for equilibria (plain doubles). Formulas: README of this folder.
#pragma once

#include "lattice/kernels/cell_material.h"
#include "lattice/kernels/pack_algebra.h"

namespace fingertip::lattice::inline kernels::kernel {

/// `size` multiplies a result: 1, or what makes a cell's force or energy of it. What belongs to the
/// bilinear modes is not counted here.
template <typename Number>
struct Law : PackAlgebra<Number> {
  using Algebra = PackAlgebra<Number>;
  using Algebra::contract, Algebra::times, Algebra::transposed_times;
  using typename Algebra::Rows;
  using typename Algebra::Vector;

  /// C:eps of `cubic`, which is linear: stress of H, tangent along dH.
  [[gnu::always_inline]] static Rows cubic(const CellMaterial& m, const Number& size,
                                           const Rows& H) {
    const Number c12 = size * Number(m.c12), c44 = size * Number(m.c44);
    const Number trace = c12 * (H.x.x + H.y.y + H.z.z), excess = size * Number(m.c11 - m.c12);
    const Number yz = c44 * (H.y.z + H.z.y), zx = c44 * (H.z.x + H.x.z), xy = c44 * (H.x.y + H.y.x);
    return {{excess * H.x.x + trace, xy, zx},
            {xy, excess * H.y.y + trace, yz},
            {zx, yz, excess * H.z.z + trace}};
  }

  /// `volume` has dW/dF = pressure T with T = cof F, `network` G F + pressure T with T = F⁻ᵀ = cof
  /// F / J.
  ///
  /// `excess`: J - 1, and tau dJ/dt where that counts.
  [[gnu::always_inline]] static Number volume_pressure(const CellMaterial& m, const Number& size,
                                                       const Number& excess) {
    return size * Number(m.kappa) * excess;
  }

  [[gnu::always_inline]] static Number network_pressure(const CellMaterial& m, const Number& J) {
    return Number(m.lambda) * Algebra::log(J) - Number(m.shear);
  }

  /// How dW/dF changes with F; `p`: the pressure.
  static Rows volume_tangent(const CellMaterial& m, const Rows& F, const Rows& T, const Number& p,
                             const Rows& dF) {
    const Number rate = Number(m.kappa) * contract(T, dF);
    return {rate * T.x + p * (cross(dF.y, F.z) + cross(F.y, dF.z)),
            rate * T.y + p * (cross(dF.z, F.x) + cross(F.z, dF.x)),
            rate * T.z + p * (cross(dF.x, F.y) + cross(F.x, dF.y))};
  }
  static Rows network_tangent(const CellMaterial& m, const Rows& T, const Number& p,
                              const Rows& dF) {
    const Number shear = m.shear, rate = Number(m.lambda) * contract(T, dF);
    const auto row = [&](const Vector& t, const Vector& df) {  // dT = -T dFᵀ T
      return shear * df + rate * t - p * (transposed_times(T, times(dF, t)));
    };
    return {row(T.x, dF.x), row(T.y, dF.y), row(T.z, dF.z)};
  }

  [[gnu::always_inline]] static Number cubic_energy(const CellMaterial& m, const Number& size,
                                                    const Rows& H) {
    return Number(0.5) * contract(cubic(m, size, H), H);
  }
  [[gnu::always_inline]] static Number volume_energy(const CellMaterial& m, const Number& size,
                                                     const Number& J) {
    const Number excess = J - Number(1.0);
    return Number(0.5) * size * Number(m.kappa) * excess * excess;
  }
  [[gnu::always_inline]] static Number network_energy(const CellMaterial& m, const Number& size,
                                                      const Rows& H, const Number& J) {
    const Number log_J = Algebra::log(J);
    return size * (Number(0.5 * m.shear) * stretch(H) +
                   (Number(0.5 * m.lambda) * log_J - Number(m.shear)) * log_J);
  }
  /// |F|² - 3, written so that it does not cancel at small strain.
  [[gnu::always_inline]] static Number stretch(const Rows& H) {
    return Number(2.0) * (H.x.x + H.y.y + H.z.z) + contract(H, H);
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
