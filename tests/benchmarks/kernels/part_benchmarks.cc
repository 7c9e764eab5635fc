#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks.h"
#include "lattice/contact/cut_surfaces.h"
#include "lattice/control/virtual_finger.h"
#include "lattice/dynamics/spectrum_search.h"
#include "lattice/forces/forces.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "probes.h"

namespace kernel_benchmarks {

using namespace fingertip;
using meshes::Vector3;

namespace {

constexpr double scaled_step = 1e-3;  // a control period [s]
constexpr int steps_onward = 20;      // before the press is taken back to its depth

lattice::FingerSetup setup(int per_radius, lattice::Integrator integrator) {
  lattice::FingerSetup s;
  s.lattice.model = lattice::ModelKind::network;
  s.lattice.kinematics = lattice::Kinematics::finite;
  s.lattice.spacing = s.geometry.tip_radius / per_radius;
  s.lattice.constants = lattice::hookean_constants(s.rubber, s.lattice.spacing, 0.0);
  s.plane = {Vector3(0.0, 0.0, s.geometry.tip_radius + 1e-5), -Vector3::UnitZ()};
  s.contact = meshes::ContactMode::stick;
  s.prescribed = true;
  s.integrator = integrator;
  if (integrator == lattice::Integrator::mass_scaled) s.time_step = scaled_step;
  s.threads = 1;
  return s;
}

/// The default finger pressed to `depth` [m] and then to and fro about it, and parts of its own
/// that are evaluated there one by one.
class PressedFinger {
 public:
  PressedFinger(int per_radius, lattice::Integrator integrator, double depth)
      : finger_(setup(per_radius, integrator)),
        model_(finger_.model()),
        internal_(model_, team_),
        surfaces_(model_, finger_.finger().plane(), meshes::ContactMode::stick, team_),
        bond_(model_, team_),
        contact_(model_, finger_.finger().plane(), meshes::ContactMode::stick, team_),
        force_(model_.points()),
        search_(model_) {
    const double speed = integrator == lattice::Integrator::mass_scaled ? 0.01 : 0.05;
    finger_.write([speed](double time) {
      return lattice::RodMotion{Vector3(0.0, 0.0, speed * time), Vector3(0.0, 0.0, speed)};
    });
    finger_.do_step(depth / speed);
    start_ = finger_.save();
    step_ = finger_.finger().step();
    find_forces();  // contact comes near group by group
    for (int n = 0; n < 20; ++n) contact_.add(state(), plane(), step_, force_);
    if (const lattice::MassScaling* scaling = finger_.finger().mass_scaling()) {
      own_scaling_ = *scaling;
      fields_ = std::make_unique<lattice::AccelerationFields>(scaling->fields());
      for (int n = 0; n < 20; ++n) find_forces();
      outer_.plane = surfaces_.plane_hold(step_);
      reactions_ = own_scaling_->accelerate(state(), outer_, force_, team_, *fields_);
      moved_ = state();
    }
  }

  void go_back() { finger_.load(start_); }

  using Part = std::pair<std::string, std::function<void()>>;
  /// A step by its parts; with scaled masses it is a control period, too, whose energies are noted.
  std::vector<Part> parts() {
    std::vector<Part> all;
    const auto add = [&](const char* name, std::function<void()> work) {
      all.emplace_back(name, std::move(work));
    };
    const bool scaled = own_scaling_.has_value();
    double* const stored = scaled ? &energy_ : nullptr;
    add("cells", [this, stored] { internal_.note(state(), 0.0, memory_, force_, stored); });
    add("contact", [this] { contact_.add(state(), plane(), step_, force_); });
    add("bond", [this, stored] {
      bond_.add(state(), finger_.finger().rod(), step_, force_, nullptr, stored);
    });
    if (scaled) {
      add("inertia of the plane", [this] { outer_.plane = surfaces_.plane_hold(step_); });
      add("V-cycle and reactions", [this] {
        reactions_ = own_scaling_->accelerate(state(), outer_, force_, team_, *fields_);
      });
      add("motion", [this] { own_scaling_->move(moved_, outer_, reactions_, team_, *fields_); });
      add("a new scaling (now and then)",
          [this] { own_scaling_->make(state(), surfaces_.bond_inertia(step_), step_, team_); });
    } else {
      add("search for the stable step (now and then)", [this] {
        if (!search_memory_.active) search_.begin(search_memory_, state());
        search_.advance(search_memory_);
      });
      add("energies (once a period)", [this] {
        energy_ = finger_.finger().elastic_energy() + finger_.finger().kinetic_energy();
      });
    }
    add("measurement (once a period)", [this] { energy_ += finger_.read().contact->radius; });
    add("whole step", [this] {
      if (own_scaling_) finger_.finger().note_energy();
      finger_.do_step(finger_.finger().step());
    });
    return all;
  }

 private:
  const lattice::State& state() const { return finger_.finger().state(); }
  const lattice::Plane& plane() const { return finger_.finger().plane(); }
  void find_forces() {
    internal_.accumulate(state(), force_);
    surfaces_.apply(state(), finger_.finger().rod(), plane(), step_, force_, nullptr);
  }

  lattice::VirtualFinger finger_;
  lattice::VirtualFinger::Snapshot start_;
  const lattice::LatticeModel& model_;
  lattice::Team team_{1};
  lattice::InternalForces internal_;
  lattice::CutSurfaces surfaces_;
  lattice::TiedBond bond_;
  lattice::PenaltyContact contact_;
  lattice::VectorField force_;
  lattice::SpectrumSearch search_;
  lattice::SpectrumSearch::Memory search_memory_;
  lattice::RelaxingMemory memory_;  // none
  std::optional<lattice::MassScaling> own_scaling_;
  std::unique_ptr<lattice::AccelerationFields> fields_;
  lattice::OuterLoads outer_;
  lattice::Reactions reactions_;
  lattice::State moved_;
  double step_ = 0.0, energy_ = 0.0;
};

}  // namespace

void register_parts(const Scope& scope) {
  if (scope.widest < lattice::kernel::supported_width()) return;  // they take the widest there are
  const int n = scope.per_radius;
  const auto add = [&](const std::string& group, lattice::Integrator integrator, double depth,
                       const std::vector<std::string>& names) {
    const auto pressed = std::make_shared<std::unique_ptr<PressedFinger>>();
    for (const std::string& name : names) {
      benchmark::RegisterBenchmark(full_name(group + name, scope.widest, "float64", 1, n).c_str(),
                                   [=](benchmark::State& state) {
                                     if (!*pressed)
                                       *pressed =
                                           std::make_unique<PressedFinger>(n, integrator, depth);
                                     for (const auto& [part, work] : (*pressed)->parts()) {
                                       if (part != name) continue;
                                       const std::size_t bytes = kernel_probes::touched_bytes(work);
                                       int steps = 0;
                                       for (auto _ : state) {
                                         if (name == "whole step" && ++steps % steps_onward == 0) {
                                           state.PauseTiming();
                                           (*pressed)->go_back();
                                           state.ResumeTiming();
                                         }
                                         work();
                                       }
                                       state.counters["amount"] = 1;
                                       state.counters["bytes"] = double(bytes);
                                     }
                                   })
          ->MinTime(scope.seconds);
    }
  };
  const std::vector<std::string> plain = {"cells",
                                          "contact",
                                          "bond",
                                          "search for the stable step (now and then)",
                                          "energies (once a period)",
                                          "measurement (once a period)",
                                          "whole step"},
                                 scaled = {"cells",
                                           "contact",
                                           "bond",
                                           "inertia of the plane",
                                           "V-cycle and reactions",
                                           "motion",
                                           "a new scaling (now and then)",
                                           "measurement (once a period)",
                                           "whole step"};
  for (const int tenths : {1, 10, 30}) {
    const std::string at = std::to_string(tenths) + "e-4 m ";
    add("part scaled " + at, lattice::Integrator::mass_scaled, 1e-4 * tenths, scaled);
    add("part plain " + at, lattice::Integrator::symplectic_euler, 1e-4 * tenths, plain);
  }
}

}  // namespace kernel_benchmarks
