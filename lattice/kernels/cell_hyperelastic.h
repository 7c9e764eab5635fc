/// Laws of large strain beyond `network` for packs of cells: what meshes/rubber/hyperelastic_law.h
/// is for one point, and a bound on the tangent that steps rest on. Formulas:
/// meshes/rubber/LAWS.md.
#pragma once

#include "lattice/kernels/cell_material.h"
#include "lattice/kernels/pack_algebra.h"

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

  /// m/2 h² and its first two derivatives with ln J.
  struct Volume {
    Pack energy, pressure, stiffness;
  };
  [[gnu::always_inline]] static Volume volume(const CellMaterial& material, const Pack& J,
                                              const Pack& log_J) {
    const Pack m = material.volumetric;
    if (material.energy.logarithmic()) return {Pack(0.5) * m * log_J * log_J, m * log_J, m};
    const Pack h = J - Pack(1.0), stress = m * h * J;
    return {Pack(0.5) * m * h * h, stress, m * J * (J + h)};
  }

  /// W/G of a law of invariants, by I1 - 3: with dW/dI1, dW/dI2, d²W/dI1².
  struct Slopes {
    Pack energy, first, second, curvature, margin;
  };
  [[gnu::always_inline]] static Slopes slopes(const meshes::StrainEnergy& law, const Pack& x) {
    const Pack half = 0.5, none = 0.0, one = 1.0;
    switch (law.law) {
      case Law::yeoh: {
        const Pack c2 = law.shape[0], c3 = law.shape[1];
        return {x * (half + x * (c2 + x * c3)), half + x * (Pack(2.0) * c2 + Pack(3.0) * c3 * x),
                none, Pack(2.0) * c2 + Pack(6.0) * c3 * x, one};
      }
      case Law::mooney_rivlin: {
        const double share = law.shape[0];
        return {Pack(0.5 * (1.0 - share)) * x, Pack(0.5 * (1.0 - share)), Pack(0.5 * share), none,
                one};
      }
      case Law::gent: {
        const Pack left = one - x / Pack(law.shape[0]);
        const Pack inverse = one / max(left, Pack(1e-3));
        return {Pack(-0.5 * law.shape[0]) * Algebra::log(left), half * inverse, none,
                half / Pack(law.shape[0]) * inverse * inverse, left};
      }
      default: return {half * x, half, none, none, one};
    }
  }
  /// What laws of full invariants have in ln J, over G.
  [[gnu::always_inline]] static double reaction(const meshes::StrainEnergy& law) {
    if (law.law == Law::mooney_rivlin) return 1.0 + law.shape[0];
    if (law.law != Law::ogden) return 1.0;
    double sum = 0.0;
    for (int i = 0; i < 6; i += 2)
      if (law.shape[i] != 0.0) sum += 2.0 * law.shape[i] / law.shape[i + 1];
    return sum;
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
    const Pack first = Pack(2.0) * G * d.first * a, curvature = Pack(4.0) * G * d.curvature * a * a;
    const Pack second = Pack(2.0) * G * d.second * a * a;
    const bool two = law.law == Law::mooney_rivlin;
    const Symmetric C = right_cauchy_green(F);
    Pack along = first, I2 = 0.0;
    if (two) {
      const Pack trace = C.xx * C.xx + C.yy * C.yy + C.zz * C.zz +
                         Pack(2.0) * (C.yz * C.yz + C.zx * C.zx + C.xy * C.xy);
      I2 = Pack(0.5) * (square * square - trace) + square * excess * third;
      along += second * (square + excess * third);
    }
    Answer answer;
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
      answer.pressure = v.pressure - Pack(2.0 / 3.0) * share - Pack(2.0 / 3.0) * second * I2;
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
      answer.pressure = v.pressure - Pack(reaction(law)) * G;
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

  /// Of an ogden law, over G: sums over its terms of mu, 2 mu/alpha and 2 mu/alpha² times the
  /// powers of stretches free of the volume where the law is, and of mu l^(alpha - 2) for the
  /// modes.
  struct Powers {
    Pack tau[3], gamma[3], energy, power[3], slope[3], secant[3];
  };
  static Powers powers(const meshes::StrainEnergy& law, const Pack (&log_l)[3], const Pack& scale) {
    Powers p;
    p.energy = 0.0;
    Pack inverse[3];
    for (int k = 0; k < 3; ++k) {
      p.tau[k] = p.gamma[k] = p.power[k] = p.slope[k] = p.secant[k] = 0.0;
      inverse[k] = Algebra::exp(Pack(-2.0) * log_l[k]);
    }
    for (int i = 0; i < 6; i += 2) {
      const double mu = law.shape[i], alpha = law.shape[i + 1];
      if (mu == 0.0) continue;
      for (int k = 0; k < 3; ++k) {
        const Pack more = Algebra::expm1(Pack(alpha) * log_l[k]), l = Pack(1.0) + more;
        p.energy += Pack(2.0 * mu / (alpha * alpha)) * more;
        p.tau[k] += Pack(2.0 * mu / alpha) * l;
        p.gamma[k] += Pack(2.0 * mu) * l;
        p.power[k] += Pack(mu / 3.0) * l * inverse[k] * scale;
        p.slope[k] += Pack(mu / 3.0 * (alpha - 2.0)) * l * inverse[k] * scale;
        p.secant[k] += Pack(mu < 0.0 ? -mu : mu) * l * inverse[k] * scale;
      }
    }
    return p;
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
    Powers p = powers(law, log_l, scale);
    const Volume v = volume(m, J, log_J);
    const Pack chi = p.power[0] + p.power[1] + p.power[2];
    Pack tau[3];
    const Pack tau_mean = third * (p.tau[0] + p.tau[1] + p.tau[2]),
               slope_mean = third * (p.slope[0] + p.slope[1] + p.slope[2]);
    const Pack half = Pack(0.5) * excess;
    for (int k = 0; k < 3; ++k) {
      tau[k] = law.isochoric()
                   ? p.tau[k] - tau_mean + half * (p.slope[k] - slope_mean - Pack(2.0 / 3.0) * chi)
                   : p.tau[k] + half * p.slope[k];
    }
    Answer answer;
    answer.margin = 1.0;
    answer.modes = chi;
    answer.pressure = v.pressure - (law.isochoric() ? Pack(0.0) : Pack(reaction(law)) * G);
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
        const Pack secant = G * max(p.secant[k], p.secant[l]), least = -held * product,
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
    return m.energy.law == Law::ogden ? of_stretches(m, F, J, excess)
                                      : of_invariants(m, F, T, J, excess);
  }

  /// Per volume; `margin` as above. `H`: F - 1.
  static Pack energy(const CellMaterial& m, const Rows& H, const Pack& J, const Pack& excess,
                     Pack& margin) {
    const meshes::StrainEnergy& law = m.energy;
    const Pack G = m.shear, log_J = Algebra::log(J), third = Pack(1.0 / 3.0);
    const Pack rest = law.isochoric() ? Pack(0.0) : Pack(reaction(law)) * log_J;
    const Pack volumetric = volume(m, J, log_J).energy;
    if (law.law == Law::ogden) {
      const Spectrum s = spectrum(right_cauchy_green(Algebra::plus_one(H)));
      const Pack square[3] = {s.squares.x, s.squares.y, s.squares.z};
      const Pack mean = law.isochoric() ? third * log_J : Pack(0.0);
      Pack log_l[3];
      for (int k = 0; k < 3; ++k) log_l[k] = Pack(0.5) * Algebra::log(square[k]) - mean;
      const Powers p = powers(law, log_l, Algebra::exp(Pack(-2.0) * mean));
      margin = 1.0;
      return G * (p.energy - rest + Pack(0.5) * excess * (p.power[0] + p.power[1] + p.power[2])) +
             volumetric;
    }
    // By C - 1, which does not cancel at small strain.
    const Symmetric D = strain(H);
    const Pack trace = D.xx + D.yy + D.zz,
               less = law.isochoric() ? Algebra::expm1(Pack(-2.0 / 3.0) * log_J) : Pack(0.0),
               a = Pack(1.0) + less;
    const Slopes d = slopes(law, a * (trace + excess) + Pack(3.0) * less);
    margin = d.margin;
    Pack sum = d.energy - rest;
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
