#include "fem_reference/tip/job_mesh.h"

#include <mpi.h>

#include <exception>
#include <string>

#include "fem_reference/job/processes.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline tip {

meshes::Sector sector(const ReferenceJob& job) {
  using meshes::Sector;
  if (job.axisymmetric()) return Sector::meridian;
  const bool modes = job.analysis == Analysis::modes;
  if (!job.geometry.mirrored(1) || (modes && job.geometry.solid)) return Sector::full;
  if (!modes && !job.protocol.mirrored(1)) return Sector::full;
  const bool mirrored = job.geometry.mirrored(0) && job.protocol.mirrored(0);
  return mirrored || modes ? Sector::quarter : Sector::half;
}

double copies(meshes::Sector sector) {
  switch (sector) {
    case meshes::Sector::quarter: return 4.0;
    case meshes::Sector::half: return 2.0;
    case meshes::Sector::full:
    case meshes::Sector::meridian: return 1.0;
  }
  return 1.0;
}

meshes::TipMeshOptions mesh_options(const ReferenceJob& job, double refinement) {
  meshes::TipMeshOptions options = meshes::TipMeshOptions{}.refined(refinement);
  options.sector = sector(job);
  if (!job.geometry.is_dome() && job.analysis != Analysis::modes)
    options.touch = meshes::touched_first(job.geometry, job.protocol.tilt, job.protocol.obstacle);
  return options;
}

meshes::MeshQuality write_mesh_once(const meshes::Geometry& geometry,
                                    const meshes::TipMeshOptions& options,
                                    const std::filesystem::path& file) {
  meshes::MeshQuality quality;
  std::string failure;
  int failed = 0;
  if (first_process()) {
    try {
      quality = meshes::write_tip_mesh(geometry, options, file);
    } catch (const std::exception& error) {
      failure = error.what();
      failed = 1;
    }
  }
  MPI_Bcast(&failed, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (failed != 0)
    throw meshes::NotConverged(failure.empty() ? "the first process could not mesh the tip"
                                               : failure);
  return quality;
}

}  // namespace fingertip::fem_reference::inline tip
