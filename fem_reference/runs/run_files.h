/// The tables of a press's run folder. Free of deal.II.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/job/job.h"
#include "fem_reference/press/mesh_history.h"

namespace fingertip::fem_reference::inline runs {

/// response.csv, contact_field.csv and, of a job with markers, markers.csv of the best samples,
/// with errors that go with those of their forces (meshes::set_marker_errors).
void write_samples(const std::vector<PressState>& states, const ReferenceJob& job,
                   const std::filesystem::path& folder);

/// convergence.csv: one row per mesh and sample.
void write_convergence(const MeshHistory& history, const std::filesystem::path& folder);

/// ParaView's list of files (.pvd), pairs of time and file name.
void write_series(const std::filesystem::path& file,
                  const std::vector<std::pair<std::string, std::string>>& entries);

/// fields/press.pvd over fields/press_NNNN.vtu, with `steps` in the place of ParaView's time: where
/// the samples lie on the press's path [m], or when [s].
void write_field_series(const std::vector<double>& steps, const std::filesystem::path& folder);

/// NAME_NNNN.vtu of the sample or mode `index` (from 0).
std::string field_name(std::size_t index, const char* name = "press");

}  // namespace fingertip::fem_reference::inline runs
