/// Symplectic Euler at steps that neither stiffness nor damping of the rubber limits.
#pragma once

#include <array>
#include <memory>

#include "lattice/integrators/stepper.h"

namespace fingertip::lattice {

/// Steps of `run.time_step`, or a quarter of a millisecond, with masses scaled to them
/// (scaling/mass_scaling.h), shorter where the change of a cell's volume asks for it; within a span
/// they only get shorter. The scaling is made anew when the length changes and when cells may have
/// stiffened by what it leaves room for: when their extremes have, or the volume of the fastest by
/// a tenth. Throws CrushedCells where a cell is inside out.
class MassScaledStepper : public Stepper {
 public:
  MassScaledStepper(Finger& finger, StepController& steps)
      : finger_(&finger),
        steps_(&steps),
        ground_(std::make_shared<ScalingGround>(finger.model())),
        made_{std::make_shared<MassScaling>(ground_), std::make_shared<MassScaling>(ground_)} {}

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;
  Memory memory() const override { return {changed_}; }
  void recall(const Memory& memory) override { changed_ = memory[0]; }

 private:
  bool stale() const;
  void scale();
  void prepare(double left, bool divides);

  Finger* finger_;
  StepController* steps_;
  std::shared_ptr<ScalingGround> ground_;
  std::array<std::shared_ptr<MassScaling>, 2> made_;  ///< one may be the finger's
  double changed_ = 0.0;  ///< largest change of a cell's volume since the scaling was made
};

}  // namespace fingertip::lattice
