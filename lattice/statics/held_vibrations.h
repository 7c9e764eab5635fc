/// How rubber that hangs on a hand answers when the hand moves.
#pragma once

#include <Eigen/Core>

#include "lattice/model/rod.h"
#include "lattice/statics/lattice_body.h"

namespace fingertip::lattice::inline statics {

/// About rest, the hand's motion being six accelerations a of a point and about it: the rubber's
/// displacement is the hand's own motion plus Σ shape_i q_i with
///   q_i'' + squares_i q_i = -shares_iᵀ a,
/// and its momentum about the point is inertia x the hand's velocity + Σ shares_i q_i'.
struct HeldVibrations {
  Matrix6 inertia = Matrix6::Zero();                ///< of the rubber: [kg], [kg m], [kg m²]
  Eigen::VectorXd squares;                          ///< squared circular frequencies [1/s²]
  Eigen::Matrix<double, 6, Eigen::Dynamic> shares;  ///< momentum per speed of a shape of unit mass
};

/// Inertia of the body's particles about `point`.
Matrix6 rubber_inertia(const LatticeBody& body, const meshes::Vector3& point);

/// Twelve shapes that the hand can excite, made of the static answers to its six accelerations and
/// of the answers to the inertia of these (load-dependent Ritz vectors: Wilson, Yuan & Dickens,
/// 1982): the static answer of all modes together is exact, the lowest frequencies are good to a
/// few per cent, from above. One factorisation; `body` must be whole (sectors = 1) and have a bond,
/// else std::logic_error. Throws NotConverged where rest is not stable or memory does not suffice.
HeldVibrations held_vibrations(const LatticeBody& body, const meshes::Vector3& point);

}  // namespace fingertip::lattice::inline statics
