/// Symplectic Euler at steps that neither stiffness nor damping of the rubber limits.
#pragma once

#include <array>
#include <memory>

#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Steps of `run.time_step`, or a quarter of a millisecond, with masses scaled to them
/// (scaling/mass_scaling.h), shorter where the change of a cell's volume asks for it; within a span
/// they only get shorter. The scaling is made anew when the length changes and before cells stiffen
/// by more than it bears: when their extremes have grown by a fifth, the volume of the fastest has
/// changed by a tenth, or the velocity_gradient has strained or turned by a fifth (S knows the
/// grid's axes). Throws CrushedCells where a cell is inside out.
class MassScaledStepper : public Stepper {
 public:
  MassScaledStepper(Finger& finger, StepController& steps)
      : finger_(&finger),
        steps_(&steps),
        ground_(std::make_shared<ScalingGround>(finger.model())),
        made_{std::make_shared<MassScaling>(ground_), std::make_shared<MassScaling>(ground_)} {}

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;

 private:
  bool stale() const;
  double swiftness() const;
  void scale();
  void prepare(double left, bool divides);

  Finger* finger_;
  StepController* steps_;
  std::shared_ptr<ScalingGround> ground_;
  std::array<std::shared_ptr<MassScaling>, 2> made_;  ///< one may be the finger's
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
