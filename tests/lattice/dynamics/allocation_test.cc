// No step allocates: malloc counts while fingers are pressed, contact grows and the spectrum is
// searched anew. Operator new calls it; Eigen does, too, without that operator.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <set>

#include "tests/lattice/finger_scenes.h"

namespace {

std::atomic<long> allocations{0};

}  // namespace

// These replace the C library's, under whose other names it offers the same.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}

using namespace fingertip;
using namespace fixtures;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::ModelKind;
using meshes::ContactMode;

namespace {

/// Allocations in steps until `end` [s]. Two scalings of masses are made anew in turn.
long allocations_until(lattice::VirtualFinger& finger, double end) {
  const double period = 1e-3;  // [s]
  finger.do_step(period);
  long found = 0, before = 0;
  std::set<const lattice::MassScaling*> known{finger.finger().mass_scaling()};
  const auto after_step = [&] {
    found += allocations - before;
    known.insert(finger.finger().mass_scaling());
    before = allocations;
    return true;
  };
  const lattice::VirtualFinger::StepObserver observer = after_step;
  while (finger.time() < end) {
    before = allocations;
    finger.do_step(period, observer);
  }
  EXPECT_LE(known.size(), 2u);
  return found;
}

/// While the finger is pressed by `depth` [m].
void expect_none(const PressCase& c, double depth) {
  constexpr double speed = 0.1;  // [m/s]
  for (const int threads : {1, 2}) {
    lattice::VirtualFinger finger(prescribed_finger(c, threads));
    finger.write(advancing(speed));
    const long force_evaluations = finger.finger().force_evaluations();
    EXPECT_EQ(allocations_until(finger, depth / speed), 0)
        << label(c.model, c.kinematics) << ", " << name(c.integrator) << ", " << threads
        << " threads";
    EXPECT_GT(finger.finger().touching(), 0);
    EXPECT_GT(finger.finger().force_evaluations(), force_evaluations + 20);
  }
}

}  // namespace

TEST(Allocation, IsCounted) {
  const auto counts = [](const auto& allocate) {
    const long before = allocations;
    allocate();
    return allocations - before;
  };
  EXPECT_EQ(counts([] {
              int* volatile number = new int(1);  // volatile: not optimised away
              delete number;
            }),
            1);
  EXPECT_EQ(counts([] { EXPECT_EQ(Eigen::VectorXd::Zero(50).eval().size(), 50); }), 1);
}

TEST(Allocation, NoneInStepsOfSymplecticEuler) {
  for (const auto contact : {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb}) {
    expect_none({ModelKind::hookean, Kinematics::small, contact, Integrator::symplectic_euler},
                1e-3);
  }
  expect_none(
      {ModelKind::published, Kinematics::finite, ContactMode::stick, Integrator::symplectic_euler},
      1e-3);
  expect_none(
      {ModelKind::hookean, Kinematics::finite, ContactMode::stick, Integrator::symplectic_euler},
      1e-3);
  // Deep enough for several searches of the spectrum.
  expect_none(
      {ModelKind::network, Kinematics::finite, ContactMode::stick, Integrator::symplectic_euler},
      2.5e-3);
}

TEST(Allocation, NoneInStepsOfExplicitEuler) {
  expect_none(
      {ModelKind::published, Kinematics::finite, ContactMode::stick, Integrator::explicit_euler},
      1e-3);
}

TEST(Allocation, NoneInStepsWithScaledMasses) {
  for (const auto contact : {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb}) {
    expect_none({ModelKind::network, Kinematics::finite, contact, Integrator::mass_scaled}, 2.5e-3);
  }
}

TEST(Allocation, NoneInStepsOfAFreeRodThatCarriesItsRubber) {
  for (const int sectors : {1, 4}) {
    for (const int threads : {1, 2}) {
      lattice::FingerSetup setup = pushed_finger(
          {ModelKind::network, Kinematics::finite, ContactMode::stick, Integrator::mass_scaled},
          threads);
      setup.sectors = sectors;
      lattice::VirtualFinger finger(setup);
      finger.write(lattice::Wrench{Vector3(2e-3, 1e-3, 0.04), Vector3(0.0, 1e-5, 0.0)});
      EXPECT_EQ(allocations_until(finger, 0.05), 0) << sectors << " parts, " << threads;
      EXPECT_GT(finger.finger().touching(), 0);
    }
  }
}
