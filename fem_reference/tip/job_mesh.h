/// What of the tip a job asks to be meshed. Free of deal.II; MPI inside.
#pragma once

#include <filesystem>

#include "fem_reference/job/job.h"
#include "meshes/volume_mesh/volume_mesh.h"

namespace fingertip::fem_reference::inline tip {

/// What has to be meshed for a job.
meshes::Sector sector(const ReferenceJob& job);
/// How many such sectors make the tip.
double copies(meshes::Sector sector);
/// The first mesh of a job, its counts times `refinement`.
meshes::TipMeshOptions mesh_options(const ReferenceJob& job, double refinement);

/// The first process writes the mesh; NotConverged on it becomes NotConverged on all.
meshes::MeshQuality write_mesh_once(const meshes::Geometry& geometry,
                                    const meshes::TipMeshOptions& options,
                                    const std::filesystem::path& file);

}  // namespace fingertip::fem_reference::inline tip
