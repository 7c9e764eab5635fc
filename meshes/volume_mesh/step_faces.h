/// Names that faces have in a STEP file, by OpenCASCADE: gmsh keeps those of solids only.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline volume_mesh {

class StepFaces {
 public:
  /// Of a file that cannot be read none has a name.
  explicit StepFaces(const std::filesystem::path& step);
  ~StepFaces();
  StepFaces(const StepFaces&) = delete;
  StepFaces& operator=(const StepFaces&) = delete;

  bool any_named() const;
  /// Of the face that is nearest to a place [mm]; empty where it has none ('' and 'NONE', which
  /// some programs write, are none).
  std::string name_at(const Vector3& place) const;

 private:
  struct Face;
  struct Faces;
  std::unique_ptr<Faces> faces_;
};

}  // namespace fingertip::meshes::inline volume_mesh
