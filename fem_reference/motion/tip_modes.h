/// Natural frequencies and shapes of the tip bonded to a fixed rod. Free of deal.II.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fem_reference/job/press_state.h"

namespace fingertip::fem_reference::inline motion {

/// What reflection in a plane does to a shape: nothing, or it turns its sign.
enum class Parity { symmetric, antisymmetric };

/// Every shape of the tip can be chosen to have a parity about x = 0 and one about y = 0, so that
/// a quarter tells everything: an antisymmetric shape moves across the plane only, a symmetric one
/// only along it.
struct SymmetryClass {
  Parity x = Parity::symmetric;  ///< about the plane x = 0
  Parity y = Parity::symmetric;  ///< about the plane y = 0
  bool operator==(const SymmetryClass&) const = default;
};

inline constexpr std::array<SymmetryClass, 4> symmetry_classes{{
    {Parity::symmetric, Parity::symmetric},
    {Parity::symmetric, Parity::antisymmetric},
    {Parity::antisymmetric, Parity::symmetric},
    {Parity::antisymmetric, Parity::antisymmetric},
}};

/// SS, SA, AS or AA, x first.
std::string name(SymmetryClass symmetry);

struct NaturalMode {
  double frequency = 0.0;  ///< [Hz]
  SymmetryClass symmetry;
  std::size_t number = 0;  ///< position within its class, from 0
  /// Of the frequency for the body of revolution: 1 when all that moves, moves alike around the
  /// axis (breathing, stretching: SS; torsion: AA), 2 otherwise, for cos(m phi) and sin(m phi). The
  /// partner is AS to SA for odd m and AA to SS for even m. A mesh splits a pair of even m a
  /// little.
  int multiplicity = 1;
};

/// The modes on one mesh. All processes of MPI_COMM_WORLD take part in every call.
class TipModes {
 public:
  /// Reads a mesh of the sector `quarter`, of a solid `full`: its modes are found in the first
  /// class, each alone. Throws InvalidInput for a mesh that cannot be read.
  TipModes(const ReferenceJob& job, const std::filesystem::path& mesh_file);
  ~TipModes();
  TipModes(const TipModes&) = delete;
  TipModes& operator=(const TipModes&) = delete;

  /// The `count` lowest of a class, by frequency. Throws NotConverged.
  std::vector<NaturalMode> solve(SymmetryClass symmetry, int count);

  /// Solver: automatic, there is one only.
  MeshSummary mesh() const;

  /// VTU of a mode found by `solve`: displacement of the whole tip, largest component 1.
  void write_fields(const NaturalMode& mode, const std::filesystem::path& file) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::fem_reference::inline motion
