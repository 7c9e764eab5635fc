// The programs as they were built, on processors without AVX, which qemu emulates: every kernel,
// every dispatch in our code and in the libraries (OpenBLAS, libm) is taken as it would be there.
// What the loader resolves by processor (ifuncs) included, for the emulated one is asked.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/studies/workplace.h"

using fingertip::meshes::PressResponse;
using fingertip::meshes::PressSample;

namespace {

constexpr const char* emulator = "/usr/bin/qemu-x86_64";
#ifdef __x86_64__
const bool can_emulate = ::access(emulator, X_OK) == 0;
#else
constexpr bool can_emulate = false;
#endif
constexpr const char* why_not = "needs a program for x86-64 and the Debian package qemu-user";

/// Core 2 without and its successor with SSE 4. (Not qemu64, which no factory made: OpenBLAS takes
/// it for an Opteron and uses 3DNow!, which it lacks.)
constexpr const char* old_processors[] = {"Conroe", "Nehalem"};

/// Equal but for `tolerance` of the largest of its kind. Lateral forces and torques are left out:
/// nothing but round-off, these presses are straight.
void expect_same(const PressResponse& found, const PressResponse& expected, double tolerance) {
  ASSERT_EQ(found.samples().size(), expected.samples().size());
  ASSERT_FALSE(expected.samples().empty());
  for (const auto quantity : {&PressSample::indentation, &PressSample::normal_force,
                              &PressSample::contact_radius, &PressSample::max_pressure}) {
    double largest = 0.0;
    for (const PressSample& sample : expected.samples())
      if (std::isfinite(sample.*quantity)) largest = std::max(largest, std::abs(sample.*quantity));
    for (std::size_t i = 0; i < expected.samples().size(); ++i) {
      const double value = found.samples()[i].*quantity, wanted = expected.samples()[i].*quantity;
      if (std::isfinite(wanted))
        EXPECT_NEAR(value, wanted, tolerance * largest) << "sample " << i;
      else
        EXPECT_FALSE(std::isfinite(value)) << "sample " << i;
    }
  }
  EXPECT_TRUE(std::ranges::any_of(expected.samples(), [](const PressSample& sample) {
    return sample.normal_force > 0.0;
  })) << "no touch, no test";
}

class OldProcessor : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!can_emulate) GTEST_SKIP() << why_not;
    ::unsetenv("OPENBLAS_CORETYPE");  // it would choose kernels for another processor
    ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
  }

  /// Presses a tip of 246 masses, quick enough for an emulator, on both processors, each in a
  /// folder, with a cache, of its own.
  void expect_the_same_press(const Words& settings) const {
    const Words words =
        with_settings({"press", "--out", "run", "--progress", "off"},
                      settings + Words{"lattice.spacing=tip_radius/4", "press.contact=stick"});
    expect_success(run_program(native_.path(), words));
    expect_success(
        run_program(old_.path(), Words{"-cpu", GetParam(), FINGERTIP_PROGRAM} + words, emulator));
    expect_same(old_.response("run"), native_.response("run"), 1e-9);
  }

  const Workplace native_, old_;

 private:
  static void expect_success(const ProgramResult& result) {
    EXPECT_EQ(result.code, 0) << result.out << result.err;
  }
};

}  // namespace

TEST_P(OldProcessor, PressesANetworkAsThisOneDoes) {
  expect_the_same_press(
      {"lattice.model=network", "press.depth=0.003 cm", "press.clearance=0.0005 cm"});
}

TEST_P(OldProcessor, PressesHookeanSpringsAsThisOneDoes) {
  expect_the_same_press(
      {"lattice.model=hookean", "press.depth=0.003 cm", "press.clearance=0.0005 cm"});
}

TEST_P(OldProcessor, PressesWithScaledMassesAsThisOneDoes) {
  expect_the_same_press({"lattice.model=network", "run.integrator=mass-scaled",
                         "run.time_step=250 us", "press.depth=0.01 cm",
                         "press.clearance=0.001 cm"});
}

/// The sparse factorisation is OpenBLAS', which has kernels of its own for every processor.
TEST_P(OldProcessor, FindsTheSameEquilibrium) {
  expect_the_same_press(
      {"lattice.model=network", "press.mode=static", "press.samples=[\"0.05 cm\"]"});
}

/// OpenBLAS falls back to kernels without AVX on a Xeon made after it (family 6, model 207).
TEST(UnknownProcessor, GetsKernelsThatItCanRun) {
  if (!can_emulate) GTEST_SKIP() << why_not;
  ::unsetenv("OPENBLAS_CORETYPE");
  const TemporaryFolder folder;
  const auto doctor = [&](const char* processor) {
    return run_program(folder.path(), {"-cpu", processor, FINGERTIP_PROGRAM, "doctor"}, emulator)
        .out;
  };
  EXPECT_TRUE(
      says(doctor("Haswell,model=207"), "OpenBLAS with kernels for Haswell (it does not know"));
  EXPECT_TRUE(says(doctor("Haswell"), "OpenBLAS with kernels for Haswell\n"));
  ::setenv("OPENBLAS_CORETYPE", "Prescott", 1);
  EXPECT_TRUE(says(doctor("Haswell,model=207"), "OpenBLAS with kernels for Prescott\n"));
}

INSTANTIATE_TEST_SUITE_P(WithoutAvx, OldProcessor, ::testing::ValuesIn(old_processors),
                         [](const auto& processor) { return std::string(processor.param); });
