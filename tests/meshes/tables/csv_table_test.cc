#include "meshes/tables/csv_table.h"

#include <gtest/gtest.h>

#include "tests/expectations.h"

using fingertip::meshes::CsvTable;

TEST(CsvTable, IndicesAreWholeNumbersBelowTheCount) {
  const auto indices = [](const std::string& number) {
    return CsvTable{.names = {"cell"}, .rows = {{"0"}, {number}}, .lines = {2, 3}}.indices("cell",
                                                                                           3);
  };
  EXPECT_EQ(indices("2"), (std::vector<std::size_t>{0, 2}));
  for (const char* wrong : {"3", "-1", "1.5", ""})
    EXPECT_TRUE(refuses([&] { indices(wrong); }, {":3, cell", "from 0 to below 3"})) << wrong;
}
