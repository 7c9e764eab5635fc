/// What a run of fingertip-fem left in its folder.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "meshes/press/press_response.h"
#include "tests/temporary_folder.h"

inline nlohmann::json summary_of(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_text(folder / "summary.json"));
}

/// None when the file is not there.
inline std::vector<fingertip::meshes::PressSample> samples_of(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "response.csv")) return {};
  return fingertip::meshes::PressResponse::read_csv(folder / "response.csv").samples();
}

/// The second run, complete, found what the first one did, on the same meshes.
inline void expect_same_results(const std::filesystem::path& first,
                                const std::filesystem::path& second) {
  const auto a = samples_of(first), b = samples_of(second);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(b[i].indentation, a[i].indentation);
    EXPECT_NEAR(b[i].normal_force / a[i].normal_force, 1.0, 1e-9);
    EXPECT_NEAR(b[i].force_error / a[i].force_error, 1.0, 1e-5);
    EXPECT_NEAR(b[i].contact_radius / a[i].contact_radius, 1.0, 1e-7);
    EXPECT_NEAR(b[i].max_pressure / a[i].max_pressure, 1.0, 1e-7);
  }
  const auto x = summary_of(first), y = summary_of(second);
  EXPECT_EQ(y.at("status"), "ok");
  ASSERT_EQ(x.at("meshes").size(), y.at("meshes").size());
  for (std::size_t i = 0; i < x.at("meshes").size(); ++i)
    EXPECT_EQ(x.at("meshes")[i].at("dofs"), y.at("meshes")[i].at("dofs"));
  EXPECT_FALSE(std::filesystem::exists(second / "checkpoint"));
}
