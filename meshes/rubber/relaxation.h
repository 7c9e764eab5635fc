/// How a rubber's stress fades while it is held: a Prony series, one for all moduli or for shear
/// alone.
#pragma once

#include <cstddef>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::meshes::inline rubber {

/// One branch of a generalised Maxwell body.
struct RelaxationBranch {
  double share = 0.0;  ///< g, what it holds of G0, 0 < g < 1
  double time = 0.0;   ///< tau [s], > 0

  bool operator==(const RelaxationBranch&) const = default;
};

/// G(t) = G0 (1 - sum g_i (1 - exp(-t/tau_i))), t the time since a sudden strain (Ferry 1980,
/// chapter 3). The moduli of a Rubber are those after long times, G_inf = G0 (1 - sum g_i); what
/// follows is over G_inf. A branch's stress h obeys dh/dt + h/tau = b ds/dt with s the stress after
/// long times, b = g/(1 - sum g).
struct Relaxation {
  std::vector<RelaxationBranch> branches;  ///< none: the moduli do not change
  bool bulk = true;  ///< whether the bulk modulus fades alike; else shear alone

  bool operator==(const Relaxation&) const = default;
  bool empty() const { return branches.empty(); }

  /// Times positive, shares positive with a sum below 1.
  std::vector<Violation> violations() const;

  /// G0/G_inf = 1/(1 - sum g_i), >= 1.
  double instantaneous_ratio() const;
  /// b of branch i.
  double relative_modulus(std::size_t i) const { return branches[i].share * instantaneous_ratio(); }
  /// G(t)/G_inf, t >= 0 [s].
  double modulus(double time) const;
  /// Storage and loss modulus over G_inf at a circular frequency [rad/s].
  double storage(double frequency) const;
  double loss(double frequency) const;
};

/// A branch over a while during which s changes at a constant rate: h at its end is `decay` times h
/// at its start plus `gain` times b times the change of s. Exact.
struct PronyRecursion {
  double decay = 1.0;  ///< exp(-x), x = duration over tau
  double gain = 1.0;   ///< (1 - exp(-x))/x

  /// duration >= 0 [s], time > 0 [s].
  PronyRecursion(double duration, double time);
};

}  // namespace fingertip::meshes::inline rubber
