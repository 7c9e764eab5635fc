/// Symplectic Euler at steps that neither stiffness nor damping of the rubber limits.
#pragma once

#include <array>
#include <memory>

#include "lattice/integrators/stepper.h"

namespace fingertip::lattice {

/// Steps of `run.time_step`, or a quarter of a millisecond, with masses scaled to them
/// (scaling/mass_scaling.h): shorter where the change of a cell's volume asks for it, and half as
/// long while the number of points on the plane changes by more than `contact_change` in a step,
/// since what comes to rest there does so with scaled inertia (within a span steps only get
/// shorter). The scaling is made anew when the
/// length changes and when cells may have stiffened by what it leaves room for: when their extremes
/// have, or the volume of the fastest by a tenth. Throws CrushedCells where a cell is inside out.
class MassScaledStepper : public Stepper {
 public:
  MassScaledStepper(Finger& finger, StepController& steps, double contact_change)
      : finger_(&finger),
        steps_(&steps),
        contact_change_(contact_change),
        ground_(std::make_shared<ScalingGround>(finger.model())) {}

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;
  Memory memory() const override { return {changed_, contact_rate_, halved_ ? 1.0 : 0.0}; }
  void recall(const Memory& memory) override;

 private:
  bool stale() const;
  void watch_contact(int touched_before);
  void scale();
  void prepare(double left, bool divides);

  Finger* finger_;
  StepController* steps_;
  double contact_change_;
  std::shared_ptr<ScalingGround> ground_;
  std::array<std::shared_ptr<MassScaling>, 2> made_;  ///< one may be the finger's
  double changed_ = 0.0;  ///< largest change of a cell's volume since the scaling was made
  /// At which the number of points on the plane changes relative to itself, smoothed [1/s].
  double contact_rate_ = 0.0;
  bool halved_ = false;
};

}  // namespace fingertip::lattice
