#include "studies/presses/taxel_record.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "meshes/press/markers.h"
#include "meshes/tables/table_rows.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

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

TEST(MarkerWords, TellOfTheLastSample) {
  const TemporaryFolder folder;
  EXPECT_EQ(marker_words(folder.path()), "");
  std::vector<meshes::MarkerRow> rows;
  for (const int sample : {1, 2}) {
    auto markers = meshes::marker_rows({{0.0, 0.0, 9e-3}, {1e-3, 0.0, 8e-3}},
                                       {{0.0, 0.0, -0.7e-3 * sample}, {0.0, 3e-4, -4e-4}});
    if (sample == 2) markers[0].error = markers[1].error = 2e-5;
    add_sample(markers, sample, 1e-3 * sample, rows);
  }
  write_rows(rows, folder / "markers.csv");
  EXPECT_TRUE(says(marker_words(folder.path()),
                   {"2 markers at 2 mm", "1.4 mm at most (marker 1)", "off by up to 0.02 mm"}));
}

}  // namespace
