/// Laws of large strain beyond `network` for packs of cells: stress, and a bound on the tangent
/// that steps rest on. Formulas: meshes/rubber/LAWS.md.
#pragma once

#include "lattice/kernels/cell_material.h"
#include "lattice/kernels/pack_algebra.h"
#include "meshes/rubber/law_terms.h"

namespace fingertip::lattice::inline kernels::kernel {

template <typename Pack>
struct Hyperelastic : PackAlgebra<Pack> {
  using Algebra = PackAlgebra<Pack>;
  using typename Algebra::Rows;
  using Vector = PackVector<Pack>;
  using Law = meshes::RubberLaw;

  /// Of a symmetric matrix.
  struct Symmetric {
    Pack xx, yy, zz, yz, zx, xy;
  };
  /// P = F S + pressure F⁻ᵀ; the modes cost `modes` times what they cost at rest.
  struct Answer {
    Symmetric S;
    Pack pressure, modes;
    /// Not below the largest eigenvalue of d²W/dF² over plane waves, less G; with 2 lambda g and
    /// `beyond` more not below those over all dF.
    Pack tangent, beyond;
    Pack margin;  ///< 1, or what is left of a gent law's stretch; not positive: beyond it
  };

  [[gnu::always_inline]] static Symmetric right_cauchy_green(const Rows& F) {
    const auto& [x, y, z] = F;
    return {x.x * x.x + y.x * y.x + z.x * z.x, x.y * x.y + y.y * y.y + z.y * z.y,
            x.z * x.z + y.z * y.z + z.z * z.z, x.y * x.z + y.y * y.z + z.y * z.z,
            x.z * x.x + y.z * y.x + z.z * z.x, x.x * x.y + y.x * y.y + z.x * z.y};
  }
  /// H + Hᵀ + HᵀH.
  [[gnu::always_inline]] static Symmetric strain(const Rows& H) {
    Symmetric D = right_cauchy_green(H);
    D.xx += Pack(2.0) * H.x.x, D.yy += Pack(2.0) * H.y.y, D.zz += Pack(2.0) * H.z.z;
    D.yz += H.y.z + H.z.y, D.zx += H.z.x + H.x.z, D.xy += H.x.y + H.y.x;
    return D;
  }
  [[gnu::always_inline]] static Vector times(const Vector& v, const Symmetric& S) {
    return {v.x * S.xx + v.y * S.xy + v.z * S.zx, v.x * S.xy + v.y * S.yy + v.z * S.yz,
            v.x * S.zx + v.y * S.yz + v.z * S.zz};
  }
  [[gnu::always_inline]] static Pack norm(const Rows& A) {
    return dot(A.x, A.x) + dot(A.y, A.y) + dot(A.z, A.z);
  }
  [[gnu::always_inline]] static Rows apart(const Rows& A, const Rows& B) {
    return {A.x - B.x, A.y - B.y, A.z - B.z};
  }

  struct Functions : Algebra {
    [[gnu::always_inline]] static Pack log1p(const Pack& x) { return Algebra::log(Pack(1.0) + x); }
    [[gnu::always_inline]] static Pack quotient(const Pack& more, const Pack& a, const Pack&) {
      return more / a;
    }
    /// Of the margin of a gent law: forces stay finite until the step is refused.
    [[gnu::always_inline]] static Pack reciprocal(const Pack& x) {
      return Pack(1.0) / max(x, Pack(1e-3));
    }
  };
  using Slopes = meshes::InvariantSlopes<Pack>;
  [[gnu::always_inline]] static Slopes slopes(const meshes::StrainEnergy& law, const Pack& x) {
    return meshes::invariant_slopes<Functions>(law.law, law.shape, x);
  }
  using Volume = meshes::VolumetricTerms<Pack>;
  [[gnu::always_inline]] static Volume volume(const CellMaterial& material, const Pack& J,
                                              const Pack& log_J) {
    return meshes::volumetric_terms(material.energy, Pack(material.volumetric), J, log_J);
  }

  /// `excess`: mu_h/G q:Omega:q. `T`: F⁻ᵀ.
  [[gnu::always_inline]] static Answer of_invariants(const CellMaterial& m, const Rows& F,
                                                     const Rows& T, const Pack& J,
                                                     const Pack& excess) {
    const meshes::StrainEnergy& law = m.energy;
    const Pack G = m.shear, log_J = Algebra::log(J), square = norm(F), I1 = square + excess,
               third = Pack(1.0 / 3.0);
    const Pack g = Algebra::gershgorin(T), c = Algebra::gershgorin(F);
    const Pack a = law.isochoric() ? Algebra::exp(Pack(-2.0 / 3.0) * log_J) : Pack(1.0);
    const Slopes d = slopes(law, a * I1 - Pack(3.0));
    const Volume v = volume(m, J, log_J);
    const bool two = law.law == Law::mooney_rivlin;
    const Symmetric C = right_cauchy_green(F);
    Pack I2 = 0.0;
    if (two) {
      const Pack trace = C.xx * C.xx + C.yy * C.yy + C.zz * C.zz +
                         Pack(2.0) * (C.yz * C.yz + C.zx * C.zx + C.xy * C.xy);
      I2 = Pack(0.5) * (square * square - trace) + square * excess * third;
    }
    const auto [first, second, curvature, inverse] = meshes::invariant_terms(law, G, d, a, I1, I2);
    Pack along = first;
    if (two) along += second * (square + excess * third);
    Answer answer;
    answer.pressure = v.pressure - inverse;
    answer.margin = d.margin;
    answer.modes = (first + second * square * third) / G;
    answer.S = {along, along, along, Pack(0.0), Pack(0.0), Pack(0.0)};
    if (two) {
      answer.S = {along - second * C.xx, along - second * C.yy, along - second * C.zz,
                  -second * C.yz,        -second * C.zx,        -second * C.xy};
    }
    // Waves a (x) n; what all dF have beyond them and 2 lambda g comes last.
    const Pack bulk = v.stiffness;
    Pack wave = first + second * min(Pack(2.0) * c, square),
         all = first + second * (Pack(3.0) * square + c);
    Pack normal = bulk, spread = 0.0;
    if (law.isochoric()) {
      const Pack share = Pack(0.5) * first * I1;  // of I1, and of I2 below
      const Pack mixed = Pack(2.0 / 3.0) * first;
      spread = mixed * norm(apart(F, T)) +
               max(curvature, Pack(0.0)) *
                   max(I1 * I1 * norm(T) * Pack(1.0 / 9.0) - square, square * Pack(1e-3));
      normal += Pack(4.0 / 9.0) * share - mixed + max(-curvature, Pack(0.0)) * I1 * I1;
      if (two) {
        const Pack mixed_second = Pack(4.0 / 3.0) * second;
        Rows M;
        for_components([&](auto k) __attribute__((always_inline)) {
          entry<k()>(M) = Pack(0.5) * (square * entry<k()>(F) - times(entry<k()>(F), C));
        });
        spread += Pack(2.0) * mixed_second * norm(apart(M, T));
        normal += Pack(8.0 / 9.0) * second * I2 - Pack(2.0) * mixed_second;
      }
    } else {
      const Pack stiffer = max(curvature, Pack(0.0));
      wave += stiffer * c;
      all += stiffer * I1;
    }
    const Pack common = abs(answer.pressure) * g + spread, positive = max(normal, Pack(0.0)) * g;
    wave += common + positive;
    all += common + Pack(3.0) * positive;
    answer.tangent = wave - G;
    answer.beyond = max(all - wave - Pack(2.0 * m.lambda) * g, Pack(0.0));
    return answer;
  }

  /// V diag(values) Vᵀ of the eigenvectors V that Jacobi's rotations find.
  struct Spectrum {
    Vector squares;  ///< of the stretches
    Rows axes;       ///< columns are eigenvectors
  };
  template <int P, int Q>
  [[gnu::always_inline]] static void rotate(Pack (&a)[3][3], Pack (&v)[3][3]) {
    constexpr int R = 3 - P - Q;
    const Pack difference = a[Q][Q] - a[P][P], twice = Pack(2.0) * a[P][Q];
    const Pack size = sqrt(difference * difference + twice * twice) + Pack(1e-300);
    Pack t = twice / (abs(difference) + size);
    where(difference < Pack(0.0), t) = -t;
    const Pack c = Pack(1.0) / sqrt(t * t + Pack(1.0)), s = t * c;
    a[P][P] = a[P][P] - t * a[P][Q];
    a[Q][Q] = a[Q][Q] + t * a[P][Q];
    a[P][Q] = a[Q][P] = 0.0;
    const Pack p = a[R][P], q = a[R][Q];
    a[R][P] = a[P][R] = c * p - s * q;
    a[R][Q] = a[Q][R] = s * p + c * q;
    for (auto& row : v) {
      const Pack x = row[P], y = row[Q];
      row[P] = c * x - s * y;
      row[Q] = s * x + c * y;
    }
  }
  static Spectrum spectrum(const Symmetric& C) {
    Pack a[3][3] = {{C.xx, C.xy, C.zx}, {C.xy, C.yy, C.yz}, {C.zx, C.yz, C.zz}};
    Pack v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    constexpr int rounds = 5;  // what is left falls with its third power
    for (int i = 0; i < rounds; ++i) {
      rotate<0, 1>(a, v);
      rotate<0, 2>(a, v);
      rotate<1, 2>(a, v);
    }
    return {
        {a[0][0], a[1][1], a[2][2]},
        {{v[0][0], v[0][1], v[0][2]}, {v[1][0], v[1][1], v[1][2]}, {v[2][0], v[2][1], v[2][2]}}};
  }

  /// Of an ogden law; the powers that fluctuations cost are means over the stretches as they are.
  using Sums = meshes::StretchSums<Pack>;
  static Sums sums(const meshes::StrainEnergy& law, const Pack (&log_l)[3], const Pack& scale) {
    Sums s = meshes::stretch_sums<Functions>(law.shape, log_l);
    const Pack third = Pack(1.0 / 3.0) * scale;
    for (int k = 0; k < 3; ++k) {
      s.power[k] *= third;
      s.power_slope[k] *= third;
      s.power_bound[k] *= scale;
    }
    return s;
  }

  static Answer of_stretches(const CellMaterial& m, const Rows& F, const Pack& J,
                             const Pack& excess) {
    const meshes::StrainEnergy& law = m.energy;
    const Pack G = m.shear, log_J = Algebra::log(J), third = Pack(1.0 / 3.0);
    const Spectrum s = spectrum(right_cauchy_green(F));
    const Pack square[3] = {s.squares.x, s.squares.y, s.squares.z};
    const Pack mean = law.isochoric() ? third * log_J : Pack(0.0),
               scale = Algebra::exp(Pack(-2.0) * mean);
    Pack log_l[3], root[3];
    for (int k = 0; k < 3; ++k) {
      log_l[k] = Pack(0.5) * Algebra::log(square[k]) - mean;
      root[k] = Pack(1.0) / square[k];
    }
    const Sums p = sums(law, log_l, scale);
    const Volume v = volume(m, J, log_J);
    const Pack chi = p.power[0] + p.power[1] + p.power[2];
    Pack tau[3];
    const Pack tau_mean = third * (p.tau[0] + p.tau[1] + p.tau[2]),
               slope_mean = third * (p.power_slope[0] + p.power_slope[1] + p.power_slope[2]);
    const Pack half = Pack(0.5) * excess;
    for (int k = 0; k < 3; ++k) {
      tau[k] = law.isochoric() ? p.tau[k] - tau_mean +
                                     half * (p.power_slope[k] - slope_mean - Pack(2.0 / 3.0) * chi)
                               : p.tau[k] + half * p.power_slope[k];
    }
    Answer answer;
    answer.margin = 1.0;
    answer.modes = chi;
    answer.pressure = v.pressure;
    const Pack along[3] = {G * tau[0] * root[0], G * tau[1] * root[1], G * tau[2] * root[2]};
    const auto& [x, y, z] = s.axes;
    const auto sum = [&](const Vector& a, const Vector& b) __attribute__((always_inline)) {
      return along[0] * a.x * b.x + along[1] * a.y * b.y + along[2] * a.z * b.z;
    };
    answer.S = {sum(x, x), sum(y, y), sum(z, z), sum(y, z), sum(z, x), sum(x, y)};
    // Along the principal axes the tangent falls into one block of 3 and three of 2. Secants of
    // powers lie between their slopes.
    const Pack gamma_mean = third * third * (p.gamma[0] + p.gamma[1] + p.gamma[2]);
    Pack stretch = 0.0, shear = 0.0, cross = 0.0, all = 0.0;
    for (int k = 0; k < 3; ++k) {
      Pack row = 0.0;
      for (int l = 0; l < 3; ++l) {
        Pack change = k == l ? G * p.gamma[k] : Pack(0.0);
        if (law.isochoric()) change += G * (gamma_mean - third * (p.gamma[k] + p.gamma[l]));
        const Pack product = sqrt(root[k] * root[l]), straight = (change + v.stiffness) * product,
                   held = G * tau[l] + answer.pressure;
        if (k == l) {
          const Pack own = straight - held * root[k];
          stretch = max(stretch, own);
          row += abs(own);
          continue;
        }
        const Pack secant = G * max(p.power_bound[k], p.power_bound[l]), least = -held * product,
                   most = least + secant * sqrt(square[l] * root[k]);
        row += abs(straight);
        shear = max(shear, secant);
        cross = max(cross, max(abs(straight + least), abs(straight + most)));
        all = max(all, secant + max(abs(least), abs(most)));
      }
      all = max(all, row);
    }
    const Pack wave = max(stretch, shear + cross);
    const Pack g = max(root[0], max(root[1], root[2]));
    // Fluctuations of the modes stiffen a little: as much as excess/2 times their second slopes.
    const Pack fluctuating = half * G * Pack(fluctuation(law)) * chi * g;
    answer.tangent = wave + fluctuating - G;
    answer.beyond = max(all - wave - Pack(2.0 * m.lambda) * g, Pack(0.0));
    return answer;
  }
  /// Bounds the second derivatives of chi with the logarithms of the stretches over chi.
  [[gnu::always_inline]] static double fluctuation(const meshes::StrainEnergy& law) {
    double largest = 0.0;
    for (int i = 0; i < 6; i += 2) {
      const double n = law.shape[i + 1] - 2.0;
      if (law.shape[i] != 0.0 && n * n > largest) largest = n * n;
    }
    return 4.0 * (largest + 4.0);
  }

  [[gnu::always_inline]] static Answer answer(const CellMaterial& m, const Rows& F, const Rows& T,
                                              const Pack& J, const Pack& excess) {
    if (m.energy.law != Law::ogden) return of_invariants(m, F, T, J, excess);
    // What a call is handed lives in memory: not the F of the other laws.
    const Rows own = F;
    const Pack jacobian = J, fluctuation = excess;
    return of_stretches(m, own, jacobian, fluctuation);
  }

  /// Per volume; `margin` as above. `H`: F - 1.
  static Pack energy(const CellMaterial& m, const Rows& H, const Pack& J, const Pack& excess,
                     Pack& margin) {
    const meshes::StrainEnergy& law = m.energy;
    const Pack G = m.shear, log_J = Algebra::log(J), third = Pack(1.0 / 3.0);
    const Pack volumetric = volume(m, J, log_J).energy;
    if (law.law == Law::ogden) {
      const Spectrum s = spectrum(right_cauchy_green(Algebra::plus_one(H)));
      const Pack square[3] = {s.squares.x, s.squares.y, s.squares.z};
      const Pack mean = law.isochoric() ? third * log_J : Pack(0.0);
      Pack log_l[3];
      for (int k = 0; k < 3; ++k) log_l[k] = Pack(0.5) * Algebra::log(square[k]) - mean;
      const Sums p = sums(law, log_l, Algebra::exp(Pack(-2.0) * mean));
      margin = 1.0;
      return G * (p.energy + Pack(0.5) * excess * (p.power[0] + p.power[1] + p.power[2])) +
             volumetric;
    }
    // By C - 1, which does not cancel at small strain.
    const Symmetric D = strain(H);
    const Pack trace = D.xx + D.yy + D.zz,
               less = law.isochoric() ? Algebra::expm1(Pack(-2.0 / 3.0) * log_J) : Pack(0.0),
               a = Pack(1.0) + less;
    const Slopes d = slopes(law, a * (trace + excess) + Pack(3.0) * less);
    margin = d.margin;
    Pack sum = d.energy;
    if (!law.isochoric()) sum -= Pack(meshes::log_share(law)) * log_J;
    if (law.law == Law::mooney_rivlin) {
      const Pack squares = D.xx * D.xx + D.yy * D.yy + D.zz * D.zz +
                           Pack(2.0) * (D.yz * D.yz + D.zx * D.zx + D.xy * D.xy);
      const Pack I2 = Pack(2.0) * trace + Pack(0.5) * (trace * trace - squares) +
                      (trace + Pack(3.0)) * excess * third;  // less 3
      sum += d.second * (a * a * I2 + Pack(3.0) * less * (Pack(2.0) + less));
    }
    return G * sum + volumetric;
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
