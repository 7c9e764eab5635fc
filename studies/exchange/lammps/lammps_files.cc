#include "studies/exchange/lammps/lammps_files.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <ostream>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::studies::inline exchange::inline lammps {

using lattice::LatticeModel;
using meshes::Vector3;

namespace {

bool cells_store_energy(const LatticeModel& model) {
  const lattice::CellMaterial& material = model.cell_lattice.material;
  return !model.cell_lattice.empty() &&
         (material.kind != lattice::CellLawKind::volume || material.kappa != 0.0);
}

/// Types of bonds: a number per stiffness of a spring of each family, then one for the ligaments.
class BondTypes {
 public:
  explicit BondTypes(const LatticeModel& model) : model_(&model) {
    each_spring([&](std::size_t, std::size_t, lattice::Family family, double k) {
      of_[std::size_t(family)].emplace(k, 0);
      ++springs_;
    });
    for (auto& family : of_) {
      for (auto& [stiffness, number] : family) number = ++count_;
    }
    if (!model.ligaments.empty()) ligament_ = ++count_;
  }

  /// Calls take(grid index, grid index, family, k > 0) for every spring.
  template <class Take>
  void each_spring(const Take& take) const {
    for (const std::size_t i : model_->particles) {
      for (std::size_t s = 0; s < lattice::directions; ++s) {
        const lattice::Family family = lattice::half_stencil[s].family;
        const double k = model_->stiffness[std::size_t(family)] * model_->weight[s][i];
        if (!(k > 0.0)) continue;
        take(i, i + std::size_t(lattice::neighbour_offset(model_->grid.size, int(s))), family, k);
      }
    }
  }

  int number(lattice::Family family, double stiffness) const {
    return of_[std::size_t(family)].at(stiffness);
  }
  int ligament() const { return ligament_; }
  int count() const { return count_; }
  std::size_t springs() const { return springs_; }

  /// E = K (r - r0)², so K is half the spring constant.
  void write_coefficients(std::ostream& out) const {
    for (std::size_t f = 0; f < of_.size(); ++f) {
      const double rest = model_->rest_length(lattice::Family(f));
      for (const auto& [stiffness, number] : of_[f]) {
        out << fmt::format("{} {} {}\n", number, 0.5 * stiffness, rest);
      }
    }
    if (ligament_ > 0) {
      out << fmt::format("{} {} 0\n", ligament_, 0.5 * model_->ligaments.front().stiffness);
    }
  }

 private:
  const LatticeModel* model_;
  std::array<std::map<double, int>, 3> of_;  ///< family, stiffness [N/m]: type
  int ligament_ = 0;                         ///< 0: there are none
  int count_ = 0;
  std::size_t springs_ = 0;
};

/// Writes lattice.data section by section. Numbers are the shortest texts that read back as the
/// same bits.
class DataFile {
 public:
  DataFile(const UndampedBody& body, std::ostream& out)
      : body_(body), model_(body.model), out_(out), types_(model_) {
    id_.resize(model_.points());
    for (std::size_t n = 0; n < model_.particles.size(); ++n) {
      id_[model_.particles[n]] = std::uint32_t(n + 1);
    }
  }

  LammpsCensus write() {
    write_head();
    write_atoms();
    write_velocities();
    write_bonds();
    write_masses();
    return {model_.particles.size(), model_.ligaments.size(), types_.springs(),
            std::size_t(types_.count())};
  }

 private:
  std::size_t anchor(std::size_t ligament) const { return model_.particles.size() + ligament + 1; }

  void write_head() {
    const std::size_t anchors = model_.ligaments.size();
    out_ << fmt::format("mass-spring lattice, SI units ({})\n\n", lattice::name(model_.kind))
         << fmt::format("{} atoms\n{} bonds\n{} atom types\n{} bond types\n\n",
                        model_.particles.size() + anchors, types_.springs() + anchors,
                        anchors > 0 ? 2 : 1, types_.count());
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const std::uint32_t i : model_.particles) {
      low = low.cwiseMin(model_.rest_position(i));
      high = high.cwiseMax(model_.rest_position(i));
    }
    for (int axis = 0; axis < 3; ++axis) {
      out_ << fmt::format("{} {} {}lo {}hi\n", low[axis] - model_.spacing(),
                          high[axis] + model_.spacing(), "xyz"[axis], "xyz"[axis]);
    }
    out_ << "\nBond Coeffs # harmonic\n\n";
    types_.write_coefficients(out_);
  }

  void write_atoms() {
    out_ << "\nAtoms # bond\n\n";
    for (const std::uint32_t i : model_.particles) {
      const Vector3 x = lattice::position(model_, body_.start, i);
      put("{} 1 1 {} {} {}\n", id_[i], x.x(), x.y(), x.z());
    }
    for (std::size_t n = 0; n < model_.ligaments.size(); ++n) {
      const Vector3& x = model_.ligaments[n].rest;
      put("{} 1 2 {} {} {}\n", anchor(n), x.x(), x.y(), x.z());
    }
    flush();
  }

  void write_velocities() {
    out_ << "\nVelocities\n\n";
    const lattice::State start = synchronised(body_, body_.start, 0.0);
    for (const std::uint32_t i : model_.particles) {
      const Vector3 v = model_.grid.axes * start.velocity.at(i);
      put("{} {} {} {}\n", id_[i], v.x(), v.y(), v.z());
    }
    for (std::size_t n = 0; n < model_.ligaments.size(); ++n) put("{} 0 0 0\n", anchor(n));
    flush();
  }

  void write_bonds() {
    out_ << "\nBonds\n\n";
    std::size_t number = 0;
    types_.each_spring([&](std::size_t i, std::size_t j, lattice::Family family, double k) {
      put("{} {} {} {}\n", ++number, types_.number(family, k), id_[i], id_[j]);
    });
    for (std::size_t n = 0; n < model_.ligaments.size(); ++n) {
      put("{} {} {} {}\n", ++number, types_.ligament(), id_[model_.ligaments[n].particle],
          anchor(n));
    }
    flush();
  }

  /// Per atom, whether they differ or not. An anchor never moves and gets the first mass.
  void write_masses() {
    out_ << fmt::format("\n{}\n\n", lammps_masses_section);
    for (const std::uint32_t i : model_.particles) put("{} {}\n", id_[i], model_.mass[i]);
    for (std::size_t n = 0; n < model_.ligaments.size(); ++n) {
      put("{} {}\n", anchor(n), model_.mass[model_.particles.front()]);
    }
    flush();
  }

  template <class... Values>
  void put(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(buffer_), form, std::forward<Values>(values)...);
    constexpr std::size_t enough = 1U << 20U;
    if (buffer_.size() > enough) flush();
  }
  void flush() {
    out_.write(buffer_.data(), std::streamsize(buffer_.size()));
    buffer_.clear();
  }

  const UndampedBody& body_;
  const LatticeModel& model_;
  std::ostream& out_;
  BondTypes types_;
  std::vector<std::uint32_t> id_;  ///< per grid point
  fmt::memory_buffer buffer_;
};

}  // namespace

std::vector<meshes::Violation> beyond_lammps(const LatticeModel& model) {
  std::vector<meshes::Violation> found;
  const std::string kind(lattice::name(model.kind));
  if (cells_store_energy(model)) {
    found.push_back({"lattice.model", kind,
                     "its cells store energy in their volume or mean deformation, a force among "
                     "eight masses at once that no bond of LAMMPS is",
                     "add --set lattice.model=published, or --set lattice.model=central --set "
                     "lattice.kinematics=finite --set exchange.hold=free"});
  } else if (model.kinematics == lattice::Kinematics::small) {
    found.push_back(
        {"lattice.kinematics", "small",
         "the bonds of LAMMPS turn with their masses, springs linearised about the rest "
         "state do not",
         "choose finite"});
  }
  if (!model.bond.empty()) {
    found.push_back({"exchange.hold", "rod",
                     "a " + kind +
                         " tip is bonded to the rod at points of its surface, which lie "
                         "between the masses",
                     "choose exchange.hold = \"free\", or lattice.model = \"published\", which "
                     "hangs on ligaments"});
  }
  return found;
}

LammpsCensus write_lammps(const UndampedBody& body, const LammpsSettings& settings,
                          const std::filesystem::path& folder) {
  const std::vector<meshes::Violation> beyond = beyond_lammps(body.model);
  if (!beyond.empty()) throw meshes::InvalidInput(beyond);
  LammpsCensus census;
  meshes::write_atomically(folder / lammps_data,
                           [&](std::ostream& out) { census = DataFile(body, out).write(); });
  meshes::write_atomically(folder / lammps_script,
                           [&](std::ostream& out) { out << lammps_script_text(body, settings); });
  return census;
}

}  // namespace fingertip::studies::inline exchange::inline lammps
