/// A calibration from its data to its files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/material/material.h"
#include "studies/config/loader.h"
#include "studies/fits/setup/fit_displacements.h"
#include "studies/fits/setup/fit_setup.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline fits::inline runs {

/// One calibration as stages of jobs, each of which needs the results of those before: the
/// continuum that makes data or judges the lattice, the fit, the surrogate.
///   displacements/ Poisson's ratio, where the data have displacements; forces know it then
///   reference_N/   continuum of curve N
///   fit/           the fit itself (moduli: in the calibration's folder)
///   fit_other_contact/  beside it, where the contact is not known; counts where `fit` has no
///   answer continuum_N/   that answers for curve N, run by the fit at Poisson's ratios bias_N/
///   continuum of curve N at the estimates surrogate/     the calibrated lattice's press, smoothed
/// In the folder itself: calibration.json, material.toml, fit_data.csv, summary.json, surrogate.csv
/// and .json; of displacements their files, alone without those of a fit.
class CalibrationStages {
 public:
  /// What becomes of a fit that failed its own tests: no material.toml, bias and surrogate, or all
  /// the same, the file saying so.
  enum class Failed { refused, kept };

  /// `folder` below the run's, empty for the run's own. Reads measured files. Throws ConfigError
  /// for what cannot be carried out.
  CalibrationStages(LoadedConfig loaded, std::string folder, Failed failed);

  /// The jobs that may run now. None: the files are written, the calibration is complete.
  std::vector<PlannedJob> next(const std::filesystem::path& run);

  /// What the jobs that `next` has not returned yet will weigh.
  double later_weight() const;

  /// Remarks on measured files.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Of a fit that is done.
  calibration::Material material(const std::filesystem::path& run) const;

 private:
  enum class Stage { displacements, data, fit, follow_up, finish, done };

  bool by_moduli() const;
  void set_up();
  std::vector<PlannedJob> displacement_jobs();
  void take_ratio(const std::filesystem::path& run);
  void finish_displacements(const std::filesystem::path& run) const;
  /// Whether its material may be used: the fit passed its tests, or is kept all the same.
  bool usable(const std::filesystem::path& run) const;
  std::string place(const std::string& name) const;
  std::vector<PlannedJob> data_jobs();
  void take_continuum_data(const std::filesystem::path& run);
  std::vector<PlannedJob> fits(const std::filesystem::path& run);
  void choose_contact(const std::filesystem::path& run);
  std::vector<PlannedJob> follow_up_jobs(const std::filesystem::path& run);
  PlannedJob surrogate(const std::filesystem::path& run) const;
  PlannedJob bias(const std::filesystem::path& run, std::size_t curve) const;
  bool measures_bias() const;
  void add_biases(calibration::FitFile& fit, const std::filesystem::path& run) const;
  void keep_rejected(const calibration::FitFile& fit, const std::filesystem::path& card) const;
  void complete_moduli(const std::filesystem::path& file) const;
  void finish(const std::filesystem::path& run) const;

  LoadedConfig loaded_;
  std::string folder_;
  Failed failed_;
  Stage stage_ = Stage::displacements;
  std::optional<DisplacementFitInput> displacements_;
  bool has_forces_ = true;  ///< else displacements alone
  FitSetup setup_;          ///< empty for the moduli and displacements alone
  std::vector<std::string> notes_;
  std::optional<FitSetup> other_contact_;
  std::string fit_name_ = "fit";  ///< folder of the fit that counts
  std::string contact_note_;      ///< for people
};

}  // namespace fingertip::studies::inline fits::inline runs
