#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "source_rules.h"

namespace {

namespace fs = std::filesystem;
using Check = std::vector<architecture::Finding> (*)(const fs::path&);

struct Rule {
  const char* name;
  Check check;
};
void PrintTo(const Rule& rule, std::ostream* out) {
  *out << rule.name;
}

constexpr Rule rules[] = {{"Table", architecture::check_table},
                          {"IncludeArrows", architecture::check_include_arrows},
                          {"Circles", architecture::check_circles},
                          {"Namespaces", architecture::check_namespaces},
                          {"LinkArrows", architecture::check_link_arrows},
                          {"Packages", architecture::check_packages},
                          {"Form", architecture::check_form}};

const fs::path source = FINGERTIP_SOURCE_DIR;

class SourceRules : public testing::TestWithParam<Rule> {};

TEST_P(SourceRules, AreKept) {
  ASSERT_TRUE(fs::is_directory(source / "meshes")) << source;
  for (const auto& finding : GetParam().check(source)) ADD_FAILURE() << to_string(finding);
}

INSTANTIATE_TEST_SUITE_P(Rules, SourceRules, testing::ValuesIn(rules),
                         [](const auto& rule) { return rule.param.name; });

/// A small tree that obeys every rule, in which tests plant one violation each.
class PlantedTree : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(testing::TempDir()) /
            ("fingertip_architecture_" +
             std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    const fs::path table = "tests/architecture/rooms.txt";
    fs::create_directories((root_ / table).parent_path());
    fs::copy_file(source / table, root_ / table);
    for (const std::string& room : architecture::room_names(source))
      plant(room + "/README.md", "# room\n");
    for (const char* library : {"meshes", "lattice", "calibration", "studies"})
      plant(std::string(library) + "/README.md", "# library of rooms\n");
    plant("tests/README.md", "# tests\n");
    plant("meshes/shape/shape.h", header("meshes/shape", ""));
    plant("meshes/volume_mesh/volume_mesh.h", header("meshes/volume_mesh", ""));
    plant("meshes/volume_mesh/volume_mesh.cc", body("meshes/volume_mesh", "#include <gmsh.h>\n"));
    plant("lattice/model/model.h", header("lattice/model", "#include \"meshes/shape/shape.h\"\n"));
    plant("fem_reference/job/job.h",
          header("fem_reference/job", "#include \"meshes/shape/shape.h\"\n"));
    plant("fem_reference/elements/problem.h",
          header("fem_reference/elements",
                 "#include <deal.II/fe/fe_q.h>\n#include \"meshes/volume_mesh/volume_mesh.h\"\n"));
    plant("calibration/moduli/fit.h",
          header("calibration/moduli", "#include \"lattice/model/model.h\"\n"));
    plant("calibration/moduli/fit.cc", body("calibration/moduli", "#include <ceres/ceres.h>\n"));
    plant("studies/cli/run.cc", body("studies/cli", "#include \"fem_reference/job/job.h\"\n"));
    plant("studies/cli/main.cc", "int main() {}\n");
    plant("calibration/CMakeLists.txt",
          "# not an arrow: fingertip::studies\n"
          "target_link_libraries(calibration PUBLIC fingertip::lattice fingertip::specimen)\n");
  }
  void TearDown() override { fs::remove_all(root_); }

  static std::string header(const std::string& room, const std::string& includes) {
    return "/// Something.\n#pragma once\n" + body(room, includes);
  }
  static std::string body(const std::string& room, const std::string& includes) {
    return includes +
           "namespace fingertip::" + std::regex_replace(room, std::regex("/"), std::string("::")) +
           " {\n}\n";
  }
  void plant(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  /// Exactly one finding, about `file`, and `what` is in it.
  void expect_caught(Check check, const std::string& file, const std::string& what) const {
    const auto findings = check(root_);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].file, file);
    EXPECT_NE(findings[0].what.find(what), std::string::npos) << findings[0].what;
  }

  fs::path root_;
};

TEST_F(PlantedTree, IsCleanBeforePlanting) {
  for (const Rule& rule : rules)
    for (const auto& finding : rule.check(root_)) ADD_FAILURE() << to_string(finding);
}

TEST_F(PlantedTree, ForbiddenArrowsAreCaught) {
  for (const auto& [from, to] : {std::pair{"meshes/base", "lattice/model"},
                                 {"meshes/base", "meshes/shape"},
                                 {"lattice/press", "fem_reference/job"},
                                 {"lattice/model", "calibration/moduli"},
                                 {"lattice/kernels", "lattice/model"},
                                 {"lattice/statics", "lattice/press"},
                                 {"lattice/control", "lattice/press"},
                                 {"fem_reference/elements", "fem_reference/solvers"},
                                 {"calibration/statistics", "calibration/material_tests"},
                                 {"studies/config", "studies/presses"},
                                 {"studies/report/figure", "studies/report/page"},
                                 {"studies/report", "studies/cli"},
                                 {"fem_reference/press", "lattice/press"},
                                 {"calibration/press_fit", "fem_reference/press"},
                                 {"calibration/press_fit", "studies/fits/runs"}}) {
    const std::string file = std::string(from) + "/planted.cc";
    plant(file, body(from, "  #  include \"" + std::string(to) + "/thing.h\"\n"));
    expect_caught(architecture::check_include_arrows, file, "must not include " + std::string(to));
    fs::remove(root_ / file);
  }
  plant("meshes/base/planted.cc", body("meshes/base", "#include \"../lattice/model.h\"\n"));
  expect_caught(architecture::check_include_arrows, "meshes/base/planted.cc", "repository's root");
}

TEST_F(PlantedTree, ForbiddenLinksAreCaught) {
  plant("lattice/CMakeLists.txt",
        "target_link_libraries(lattice\n  PUBLIC fingertip::calibration)\n");
  expect_caught(architecture::check_link_arrows, "lattice/CMakeLists.txt",
                "must not link calibration");
  plant("lattice/CMakeLists.txt", "target_link_libraries(lattice PUBLIC fingertip::volume_mesh)\n");
  expect_caught(architecture::check_link_arrows, "lattice/CMakeLists.txt", "gmsh mesher");
}

TEST_F(PlantedTree, DealIiInAHeaderThatTheApplicationReachesIsCaught) {
  // Indirectly: studies → job.h → problem.h → deal.II.
  plant("fem_reference/job/job.h",
        header("fem_reference/job", "#include \"fem_reference/elements/problem.h\"\n"));
  expect_caught(architecture::check_packages, "fem_reference/elements/problem.h", "deal.II");
}

TEST_F(PlantedTree, MisplacedPackagesAreCaught) {
  plant("calibration/moduli/fit.h", header("calibration/moduli", "#include <ceres/problem.h>\n"));
  expect_caught(architecture::check_packages, "calibration/moduli/fit.h", "Ceres");
  plant("calibration/moduli/fit.h", header("calibration/moduli", ""));
  plant("meshes/shape/shape.h", header("meshes/shape", "#include <gmsh.h>\n"));
  expect_caught(architecture::check_packages, "meshes/shape/shape.h", "gmsh");
  plant("meshes/shape/shape.h", header("meshes/shape", "#include <CGAL/Surface_mesh.h>\n"));
  expect_caught(architecture::check_packages, "meshes/shape/shape.h", "CGAL");
  plant("meshes/shape/shape.h", header("meshes/shape", ""));
  plant("lattice/model/model.h",
        header("lattice", "#include \"meshes/volume_mesh/cad_surface.h\"\n"));
  expect_caught(architecture::check_packages, "lattice/model/model.h", "mesher");
  plant("lattice/model/model.h",
        header("lattice", "#include \"meshes/volume_mesh/volume_mesh.h\"\n"));
  expect_caught(architecture::check_packages, "lattice/model/model.h", "mesher");
}

TEST_F(PlantedTree, CirclesOfUnitsAreCaught) {
  const std::string room = "lattice/model";
  plant("lattice/model/a.h", header(room, "#include \"lattice/model/b.h\"\n"));
  plant("lattice/model/b.h", header(room, ""));
  plant("lattice/model/c.h", header(room, "#include \"lattice/model/model.h\"\n"));
  plant("lattice/model/c.cc", body(room, "#include \"lattice/model/a.h\"\n"));
  EXPECT_TRUE(architecture::check_circles(root_).empty());
  // b is a header with its source: only together do they close the circle.
  plant("lattice/model/b.cc", body(room,
                                   "#include \"lattice/model/b.h\"\n"
                                   "#include \"lattice/model/c.h\"\n"));
  expect_caught(architecture::check_circles, "lattice/model/a",
                "circle with lattice/model/b lattice/model/c");
  // A second circle is a second finding, also of headers alone.
  plant("calibration/moduli/a.h",
        header("calibration/moduli", "#include \"calibration/moduli/fit.h\"\n"));
  plant("calibration/moduli/fit.h",
        header("calibration/moduli", "#include \"calibration/moduli/a.h\"\n"));
  EXPECT_EQ(architecture::check_circles(root_).size(), 2u);
}

TEST_F(PlantedTree, OtherNamespacesThanTheFoldersAreCaught) {
  const std::string file = "lattice/model/planted.h", room = "lattice/model";
  const auto expect_one = [&](const std::string& text, const std::string& where,
                              const std::string& what) {
    plant(file, text);
    expect_caught(architecture::check_namespaces, where, what);
  };
  expect_one(header("lattice", ""), room, "opens fingertip::lattice");
  expect_one(header(room, "") + body("meshes", "") + body("meshes", ""), room,
             "opens fingertip::meshes");
  expect_one(header("lattice/modelled", ""), room, "opens fingertip::lattice::modelled");
  expect_one("namespace fingertip {\nnamespace lattice {\n}\n}\n", room, "opens fingertip");
  expect_one("/// Something.\n#pragma once\n", file, "lacks namespace fingertip::lattice::model");
  plant(file, header(room, "") + body(room + "/details", ""));
  EXPECT_TRUE(architecture::check_namespaces(root_).empty());
}

TEST_F(PlantedTree, CHeadersAreInNoNamespace) {
  plant("studies/cli/interface.h",
        "/// For C.\n#pragma once\nextern \"C\" {\nint answer(void);\n}\n");
  EXPECT_TRUE(architecture::check_namespaces(root_).empty());
}

TEST_F(PlantedTree, BadFormIsCaught) {
  const std::string file = "lattice/model/planted.h";
  plant(file, "#pragma once\n");
  expect_caught(architecture::check_form, file, "///");
  plant(file, "/// Something.\n");
  expect_caught(architecture::check_form, file, "#pragma once");
  plant(file, "/// Something.\n#pragma once\n" + std::string(600, '\n'));
  expect_caught(architecture::check_form, file, "longer than 600");
}

TEST_F(PlantedTree, SourcesOutsideTheRoomsAreCaught) {
  for (const char* file : {"lattice/planted.cc", "meshes/cellar/planted.h"}) {
    plant(file, "");
    expect_caught(architecture::check_table, file, "stands in no room");
    fs::remove(root_ / file);
  }
}

TEST_F(PlantedTree, ArrowsUpwardsInTheTableAreCaught) {
  for (const auto& [table, what] : {std::pair{"meshes: tests\n", "tests is not above meshes"},
                                    {"meshes:\n  .: base\n  base:\n", "base is not above meshes"},
                                    {"meshes:\n  base: base\n", "base is not above meshes/base"}}) {
    plant("meshes/base/README.md", "# room\n");
    plant("tests/architecture/rooms.txt", table);
    const auto findings = architecture::check_table(root_);
    EXPECT_TRUE(std::ranges::any_of(findings, [&](const auto& it) { return it.what == what; }))
        << what;
  }
}

TEST_F(PlantedTree, MissingReadmeIsCaught) {
  for (const char* room : {"lattice", "lattice/model", "tests"}) {
    fs::remove(root_ / room / "README.md");
    expect_caught(architecture::check_table, room, "README.md");
    plant(std::string(room) + "/README.md", "# room\n");
  }
}

}  // namespace
