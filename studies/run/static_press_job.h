/// A press without time, and what it shares with the press of moving lattices.
#pragma once

#include "calibration/moduli.h"
#include "lattice/press/press_setup.h"
#include "studies/files/press_summary.h"
#include "studies/run/job.h"

namespace fingertip::studies {

/// Files: response.csv and summary.json (rewritten after every sample), contact.csv, and shapes
/// (snapshot_files.h).
Job static_press_job(const lattice::PressSetup& setup);

/// What the summary.json of every press begins with.
PressSummary press_summary_head(const lattice::PressSetup& setup, const std::string& status);

GeometryEntry geometry_entry(const meshes::Geometry& geometry);
ConstantsEntry constants_entry(const lattice::SpringConstants& constants);
ModuliEntry moduli_entry(const calibration::ElasticModuli& moduli);

/// Writes `status` into the folder's summary.json, if there is one.
void set_press_status(const std::filesystem::path& folder, const std::string& status);

}  // namespace fingertip::studies
