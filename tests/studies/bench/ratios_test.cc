#include "studies/bench/ratios.h"

#include <gtest/gtest.h>

#include "studies/bench/lammps.h"
#include "studies/exchange/lammps/lammps_files.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;

namespace {

void put(KernelRound& round, const std::string& name, const std::string& isa, int threads, int size,
         double cost, double operations = 0.0) {
  KernelSample s;
  s.name = name;
  s.isa = isa;
  s.precision = "float64";
  s.threads = threads;
  s.size = size;
  s.masses = s.springs = 1.0;
  s.operations = operations;
  s.cost = s.wall_cost = cost;
  round[name + "/" + isa + "/float64/" + std::to_string(threads) + "/" + std::to_string(size)] = s;
}

KernelRound round_with(double slower) {
  KernelRound round;
  put(round, "arithmetic", "avx2", 1, 0, 0.01 * slower);
  for (const char* model : {"published", "network"}) {
    put(round, std::string(model) + "_step", "avx2", 1, 12, 0.5 * slower, 17.0);
    put(round, std::string(model) + "_step", "avx2", 2, 12, 0.25 * slower, 17.0);
  }
  for (const int size : {20, 48}) {
    put(round, "lammps_harmonic", "as packaged", 1, size, 5.0 * slower);
    put(round, "lammps_harmonic", "as packaged", 2, size, 3.0 * slower);
  }
  return round;
}

}  // namespace

TEST(Parts, AreMediansTheDearestFirstAndNoKernels) {
  KernelRounds rounds;
  for (const double slower : {1.0, 5.0, 2.0}) {
    KernelRound round;
    put(round, "part scaled 30e-4 m V-cycle and reactions", "avx512", 1, 12, 100.0 * slower);
    put(round, "part scaled 30e-4 m whole step", "avx512", 1, 12, 300.0 * slower);
    for (auto& [key, sample] : round) sample.bytes = sample.cost < 200.0 ? 0.0 : 4096.0;
    rounds.rounds.push_back(round);
  }
  const auto parts = parts_of(rounds);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].at("part"), "whole step");
  EXPECT_DOUBLE_EQ(parts[0].at("seconds").get<double>(), 600e-9);
  EXPECT_EQ(parts[0].at("bytes"), 4096.0);
  EXPECT_EQ(parts[1].at("part"), "V-cycle and reactions");
  EXPECT_DOUBLE_EQ(parts[1].at("indentation").get<double>(), 3e-3);
  EXPECT_TRUE(parts[1].at("scaled_masses").get<bool>());
  EXPECT_TRUE(parts[1].at("bytes").is_null());
  EXPECT_TRUE(kernels_of(rounds, false).empty());
}

TEST(Ratios, AreFormedWithinARoundSoThatABusyMachineCancels) {
  KernelRounds rounds;
  for (const double slower : {1.0, 5.0, 2.0}) rounds.rounds.push_back(round_with(slower));
  const Ratios ratios = ratios_of(rounds);
  const std::map<std::string, double> expected = {
      {"lammps_48_1t", 10.0}, {"lammps_20_1t", 10.0},     {"lammps_48_2t", 12.0},
      {"lammps_20_2t", 12.0}, {"threads_published", 2.0}, {"threads_network", 2.0}};
  ASSERT_EQ(ratios.values.size(), expected.size());
  for (const auto& [name, value] : expected)
    EXPECT_NEAR(ratios.values.at(name).get<double>(), value, 1e-12) << name;
  EXPECT_TRUE(ratios.missing.empty());
}

TEST(Ratios, TwoRanksThatWaitForEachOtherCountAsOne) {
  KernelRounds rounds;
  rounds.rounds.push_back(round_with(1.0));
  put(rounds.rounds[0], "lammps_harmonic", "as packaged", 2, 48, 90.0);
  EXPECT_NEAR(ratios_of(rounds).values.at("lammps_48_2t").get<double>(), 20.0, 1e-12);
}

TEST(Kernels, NoFractionOfTheRoofIsAboveOneHoweverSlowTheProbe) {
  for (double probe = 1e-3; probe < 10.0; probe *= 2.0) {
    KernelRounds rounds;
    for (const double slower : {1.0, 3.0, 2.0}) {
      rounds.rounds.push_back(round_with(slower));
      put(rounds.rounds.back(), "arithmetic", "avx2", 1, 0, probe);
    }
    const double best = 0.5 / 17.0;  // of one thread in the undisturbed round
    int seen = 0;
    for (const auto& kernel : kernels_of(rounds, false)) {
      const double fraction = kernel.at("roofline_fraction");
      EXPECT_LE(fraction, 1.0);
      EXPECT_NEAR(fraction, std::min(1.0, probe / (2.0 * best)), 1e-12) << probe;
      EXPECT_EQ(kernel.contains("remark"), probe >= best) << probe;
      ++seen;
    }
    EXPECT_EQ(seen, 4);
  }
}

TEST(Ratios, WithoutTheWidestRegistersAllAreNullAndSayWhy) {
  KernelRounds rounds;
  rounds.rounds.emplace_back();
  put(rounds.rounds[0], "arithmetic", "sse2", 1, 0, 0.02);
  put(rounds.rounds[0], "published_forces", "sse2", 1, 12, 1.0, 17.0);
  const Ratios ratios = ratios_of(rounds);
  EXPECT_EQ(ratios.values.size(), 6u);
  for (const auto& [name, value] : ratios.values.items()) {
    EXPECT_TRUE(value.is_null()) << name;
    EXPECT_NE(ratios.missing.at(name).get<std::string>().find("widest registers"),
              std::string::npos);
  }
}

TEST(Ratios, AMissingPeerCostsItsRatiosOnly) {
  KernelRounds rounds;
  rounds.rounds.push_back(round_with(1.0));
  std::erase_if(rounds.rounds[0],
                [](const auto& time) { return time.first.starts_with("lammps"); });
  rounds.missing["lammps"] = "lmp is not on the PATH";
  const Ratios ratios = ratios_of(rounds);
  EXPECT_TRUE(ratios.values.at("lammps_48_1t").is_null());
  EXPECT_EQ(ratios.missing.at("lammps_48_1t"), "lmp is not on the PATH");
  EXPECT_TRUE(ratios.values.at("threads_network").is_number());
}

TEST(Lammps, CubeIsTheExportersWithTheBondsOfTheHalfStencil) {
  // n³ points: 3 n²(n-1) along axes, 6 n (n-1)² face and 4 (n-1)³ body diagonals.
  for (const int n : {2, 3, 20}) {
    const TemporaryFolder folder;
    const std::size_t expected = std::size_t(3 * n * n * (n - 1) + 6 * n * (n - 1) * (n - 1) +
                                             4 * (n - 1) * (n - 1) * (n - 1));
    EXPECT_EQ(write_lammps_cube(folder.path(), n, 10), expected);
    const std::string data = read_text(folder / lammps_data);
    EXPECT_NE(
        data.find(std::to_string(n * n * n) + " atoms\n" + std::to_string(expected) + " bonds\n"),
        std::string::npos);
    const std::string script = read_text(folder / lammps_script);
    EXPECT_NE(script.find("steps index 10\n"), std::string::npos);
    EXPECT_NE(script.find("every index 0\n"), std::string::npos);
  }
}
