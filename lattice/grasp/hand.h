/// Two soft fingers and a rigid block between them, as one mechanical system.
#pragma once

#include <array>
#include <memory>

#include "lattice/control/virtual_finger.h"
#include "lattice/grasp/block.h"

namespace fingertip::lattice::inline grasp {

/// Both fingers are alike; `finger.plane` and `finger.gravity` are the hand's matter. World axes: x
/// from the first finger to the second, z up; the block's centre starts at the origin.
struct HandSetup {
  FingerSetup finger;
  BlockSettings block;
  double clearance = 0.5e-3;  ///< between tips and block at the start [m], > 0
  double gravity = 9.80665;   ///< along -z [m/s²], >= 0
  bool supported = true;      ///< whether the block starts on its support
};

/// One communication step, co-simulation of the fingers with the block: both fingers are told pose
/// and twist of their faces, go on for a step while the faces move at that twist, and the impulses
/// that the faces gave the tips act reversed on the block. The block moves as the fingers were told
/// and is kicked afterwards (symplectic Euler, position first): the fingers' ties are evaluated at
/// the end of the step, and so no plane ever jumps. Momentum balances to round-off, and angular
/// momentum as far as the lattice's own does.
///
/// The support is a jig that the block stands in: it takes every force, but cannot hold it down.
/// Once the fingers pull harder than the block weighs the block is free, and stays so.
class Hand {
 public:
  /// Throws InvalidInput for a block too light for the step (coupling() >= max_coupling) and for
  /// what VirtualFinger refuses. `period` [s] is a multiple of step().
  Hand(const HandSetup& setup, double period);

  /// One communication step. Throws CrushedCells.
  void advance();

  double time() const { return fingers_[0]->time(); }
  double step() const { return step_; }  ///< of the communication [s]
  const HandSetup& setup() const { return setup_; }
  VirtualFinger& finger(std::size_t side) { return *fingers_[side]; }
  const VirtualFinger& finger(std::size_t side) const { return *fingers_[side]; }
  /// Where a finger's frame stands: its axis (z) points at the block, its x axis up.
  const Pose& base(std::size_t side) const { return bases_[side]; }

  const RodState& block() const { return block_; }
  RodState& block() { return block_; }
  bool supported() const { return supported_; }
  /// Of the support on the block over the last step, upward [N].
  double support_force() const { return support_force_; }
  /// Mean force of a finger on the block over the last step, world axes, and its moment about the
  /// world's origin.
  const Wrench& on_block(std::size_t side) const { return on_block_[side]; }

  /// Momentum of both tips and the block, world axes [N s], summed afresh; the rods are told how to
  /// move or pull from outside.
  meshes::Vector3 momentum() const;
  /// What rods, gravity and support have given them so far [N s]: momentum() changes by as much.
  const meshes::Vector3& impulse() const { return impulse_; }

  /// rho(M⁻¹ M_c), M the 6 x 6 mass matrix of the block and M_c that of the particles that may
  /// touch it (README: light blocks). Fingers and block are stable together below 1.
  double coupling() const { return coupling_; }
  static constexpr double max_coupling = 1.0;

 private:
  double find_coupling() const;

  HandSetup setup_;
  std::array<Pose, 2> bases_;
  std::array<std::unique_ptr<VirtualFinger>, 2> fingers_;
  RodState block_;
  bool supported_;
  double step_ = 0.0;
  double coupling_ = 0.0;
  std::array<Wrench, 2> on_block_;
  double support_force_ = 0.0;
  meshes::Vector3 impulse_ = meshes::Vector3::Zero();
};

}  // namespace fingertip::lattice::inline grasp
