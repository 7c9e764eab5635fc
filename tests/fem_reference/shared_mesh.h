/// The mesh file of a tip in an empty folder of its own, for tests on any number of processes.
#pragma once

#include <mpi.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "meshes/volume_mesh/volume_mesh.h"
#include "tests/temporary_folder.h"

/// A temporary folder that all processes know; the first one makes it and takes it away.
class SharedFolder {
 public:
  SharedFolder() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    std::array<char, 1024> name{};
    if (rank == 0) {
      own_ = std::make_unique<TemporaryFolder>();
      own_->path().string().copy(name.data(), name.size() - 1);
    }
    MPI_Bcast(name.data(), int(name.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
    path_ = name.data();
  }
  /// Nobody may still be reading when the folder goes.
  ~SharedFolder() { MPI_Barrier(MPI_COMM_WORLD); }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  bool first() const { return own_ != nullptr; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::unique_ptr<TemporaryFolder> own_;
  std::filesystem::path path_;
};

/// A tip's mesh of the default block structure, its element counts times `refinement`.
class SharedMesh {
 public:
  explicit SharedMesh(double refinement,
                      fingertip::meshes::Sector sector = fingertip::meshes::Sector::quarter,
                      const fingertip::meshes::Geometry& geometry = {}) {
    if (folder_.first()) {
      auto options = fingertip::meshes::TipMeshOptions{}.refined(refinement);
      options.sector = sector;
      fingertip::meshes::write_tip_mesh(geometry, options, file());
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }

  std::filesystem::path file() const { return folder_ / "tip.msh"; }
  /// Where a test may leave other files.
  const SharedFolder& folder() const { return folder_; }

 private:
  SharedFolder folder_;
};
