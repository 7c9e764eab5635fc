#include "studies/presses/taxel_record.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/expectations.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

meshes::TaxelRow row_of(int sample, double spacing) {
  meshes::TaxelRow row{.sample = sample, .indentation = 1e-3 * sample, .taxel = 1};
  row.spacing = spacing;
  return row;
}

/// Of the last sample, where a taxel touches.
TEST(FootprintNote, TellsOfAFootprintFinerThanTheField) {
  const std::vector<meshes::TaxelRow> rows = {row_of(1, 2e-3), row_of(2, 0.0), row_of(2, 0.6e-3)};
  EXPECT_EQ(footprint_note(rows, 0.8e-3), "");
  EXPECT_TRUE(says(footprint_note(rows, 0.25e-3),
                   {"sensor.footprint = 0.25 mm", "0.6 mm apart", "wider footprint"}));
  EXPECT_EQ(footprint_note({}, 0.25e-3), "");
  // Below the surface nobody knows.
  EXPECT_EQ(footprint_note({row_of(1, meshes::unknown)}, 0.25e-3), "");
}

}  // namespace
