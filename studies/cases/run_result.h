/// What came of the runs of a case.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "calibration/files/displacement_fit_file.h"
#include "calibration/files/fit_file.h"
#include "calibration/material_tests/law_record.h"
#include "studies/cases/case_file.h"
#include "studies/cases/contact_measures.h"
#include "studies/cases/displacement_measures.h"
#include "studies/cases/force_comparison.h"
#include "studies/files/grasp_summary.h"
#include "studies/files/press_summary.h"
#include "studies/jobs/cache.h"

namespace fingertip::studies::inline cases {

/// Measures by name; NaN, or absent: could not be taken.
using Measures = std::map<std::string, double>;

/// One run of a case: as it is planned and, once its job has ended, what came of it.
struct RunResult {
  const CaseRun* run = nullptr;
  const CaseRun* fit = nullptr;    ///< of a prediction: whose material is pressed
  std::string folder = {};         ///< below the case's; runs that come to the same share it
  std::string against = {};        ///< folder of what its forces are measured against, or empty
  std::size_t beside = 0;          ///< place of the press that it stands beside, else its own
  lattice::PressSetup setup = {};  ///< of a press

  std::string status = {};          ///< of its job
  PressSummary press = {};          ///< its summary.json, where it is a press ...
  GraspSummary grasp = {};          ///< ... or a grasp
  calibration::FitFile found = {};  ///< calibration.json of a fit; one to moduli has no curves
  calibration::DisplacementFitFile ratio = {};  ///< displacements.json of a fit to displacements
  calibration::LawsFile laws = {};  ///< laws.json of a fit of laws
  ForceComparison forces = {};      ///< with what they are measured against
  ContactErrors contact = {};       ///< of a variant whose contact is drawn, likewise
  DisplacementComparison displacements = {};  ///< of a variant that names measured ones
  ForceComparison change = {};      ///< with the press it stands beside, at that one's samples
  Measures measures = {};           ///< of this run alone, see measures.h
  bool ok() const { return status == finished; }
};

using RunResults = std::vector<RunResult>;

/// Of the case's runs before anything is planned: nothing is known but which results there will be.
RunResults blank_results(const Case& study_case);

}  // namespace fingertip::studies::inline cases
