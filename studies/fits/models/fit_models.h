/// What answers for the curves of a fit, and where its search starts.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "calibration/press_fit/rig_model.h"
#include "studies/fits/models/fit_input.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline models {

/// What the answers for curve `i` depend on, and its data.
nlohmann::ordered_json curve_inputs(const FitInput& input, std::size_t i);

/// Models, and what remembers their answers in the folder's evaluations/. Behind a rig, and where
/// moduli alone are sought, it is the press itself that is remembered; a continuum's are jobs.
/// Repeats share the lattice's press.
class FitModels {
 public:
  /// Jobs are carried out by `context`; `go_on` is asked while a model computes.
  /// The first presses are those of `first`, where it is given.
  FitModels(const FitInput& input, const std::filesystem::path& folder, const JobContext& context,
            const std::function<bool()>& go_on, const FitModels* first = nullptr);

  /// What answers for every curve.
  std::vector<calibration::ForwardModel*> addresses() const;

  /// The press of curve `i` at the travels of `curve` behind `rig`, by so many `parameters`; of a
  /// curve over indentation between its samples. `branches`: of a rubber that relaxes.
  std::unique_ptr<calibration::RigModel> behind_rig(
      const FitInput& input, std::size_t i, const calibration::Rig& rig,
      const calibration::Curve& curve, Eigen::Index parameters,
      const std::vector<calibration::FitBranch>& branches = {}) const;

  /// The press of curve `i` by the rubber's parameters: at the depths of its travel, or at its
  /// values.
  calibration::ForwardModel& press(std::size_t i) const;

  /// What the press of curve `i` answers for the rubber's parameters: at the depths of its travel,
  /// or at its values [N].
  Eigen::VectorXd press_forces(std::size_t i, const Eigen::VectorXd& rubber) const;

  /// Indentations of the values of curve `i` at the parameters, 0 before touch; empty without rig.
  std::vector<double> indentations(std::size_t i, const Eigen::VectorXd& parameters) const;

 private:
  class Press;
  struct Answer {
    std::shared_ptr<Press> press;                ///< of the rubber's parameters
    std::unique_ptr<calibration::RigModel> rig;  ///< of travels
  };
  std::vector<Answer> answers_;  ///< per curve
};

/// Lets the search start from the scale of the data, not from the configuration's rubber: forces
/// over indentation are proportional to the moduli, those over travel are not, so that travels
/// count as the indentations that the start of their rig makes of them.
void start_from_data(FitInput& input, const FitModels& models);

}  // namespace fingertip::studies::inline fits::inline models
