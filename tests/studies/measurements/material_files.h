/// Descriptions of material tests beside their data, as a test writes them.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "studies/measurements/material_test_file.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

class MaterialFiles : public testing::Test {
 protected:
  /// The description, its data in data.csv.
  fingertip::studies::MaterialTestFile read(const std::string& description,
                                            const std::string& data) const {
    write_text(folder_ / "data.csv", data);
    write_text(folder_ / "tests.toml", description);
    return fingertip::studies::read_material_tests(folder_ / "tests.toml");
  }
  /// One problem that says all these parts.
  void expect_refused(const std::string& description, const std::string& data,
                      const Parts& parts) const {
    EXPECT_TRUE(refuses([&] { read(description, data); }, parts)) << description;
  }

  const TemporaryFolder folder_;
};
