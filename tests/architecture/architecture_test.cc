#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
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

constexpr Rule rules[] = {{"IncludeArrows", architecture::check_include_arrows},
                          {"LinkArrows", architecture::check_link_arrows},
                          {"Packages", architecture::check_packages},
                          {"HeaderCycles", architecture::check_header_cycles},
                          {"Form", architecture::check_form},
                          {"Readmes", architecture::check_readmes}};

class SourceRules : public testing::TestWithParam<Rule> {};

TEST_P(SourceRules, Obeys) {
  const fs::path source = FINGERTIP_SOURCE_DIR;
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
    for (const char* room :
         {"meshes", "lattice", "lattice/kernels", "lattice/model", "lattice/forces",
          "lattice/contact", "lattice/dynamics", "lattice/control", "lattice/statics",
          "lattice/press", "lattice/grasp", "fem_reference", "calibration", "studies"})
      plant(std::string(room) + "/README.md", "# room\n");
    plant("tests/README.md", "# tests\n");
    plant("meshes/shape.h", header("meshes", ""));
    plant("meshes/volume_mesh.h", header("meshes", ""));
    plant("meshes/volume_mesh.cc", body("meshes", "#include <gmsh.h>\n"));
    plant("lattice/model/model.h", header("lattice", "#include \"meshes/shape.h\"\n"));
    plant("fem_reference/job.h", header("fem_reference", "#include \"meshes/shape.h\"\n"));
    plant("fem_reference/problem.h",
          header("fem_reference",
                 "#include <deal.II/fe/fe_q.h>\n#include \"meshes/volume_mesh.h\"\n"));
    plant("calibration/fit.h", header("calibration", "#include \"lattice/model/model.h\"\n"));
    plant("calibration/fit.cc", body("calibration", "#include <ceres/ceres.h>\n"));
    plant("studies/cli/run.cc", body("studies", "#include \"fem_reference/job.h\"\n"));
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
    return includes + "namespace fingertip::" + room + " {\n}\n";
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
  for (const auto& [from, to] : {std::pair{"meshes", "lattice"},
                                 {"lattice/press", "fem_reference"},
                                 {"lattice/model", "calibration"},
                                 {"lattice/kernels", "lattice/model"},
                                 {"lattice/statics", "lattice/press"},
                                 {"lattice/control", "lattice/press"},
                                 {"fem_reference", "lattice"},
                                 {"calibration", "fem_reference"},
                                 {"calibration", "studies"}}) {
    const std::string file = std::string(from) + "/planted.cc";
    plant(file, body(from, "  #  include \"" + std::string(to) + "/deep/thing.h\"\n"));
    expect_caught(architecture::check_include_arrows, file, "must not include " + std::string(to));
    fs::remove(root_ / file);
  }
  plant("meshes/planted.cc", body("meshes", "#include \"../lattice/model.h\"\n"));
  expect_caught(architecture::check_include_arrows, "meshes/planted.cc", "repository's root");
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
  plant("fem_reference/job.h", header("fem_reference", "#include \"fem_reference/problem.h\"\n"));
  expect_caught(architecture::check_packages, "fem_reference/problem.h", "deal.II");
}

TEST_F(PlantedTree, MisplacedPackagesAreCaught) {
  plant("calibration/fit.h", header("calibration", "#include <ceres/problem.h>\n"));
  expect_caught(architecture::check_packages, "calibration/fit.h", "Ceres");
  plant("calibration/fit.h", header("calibration", ""));
  plant("meshes/shape.h", header("meshes", "#include <gmsh.h>\n"));
  expect_caught(architecture::check_packages, "meshes/shape.h", "gmsh");
  plant("meshes/shape.h", header("meshes", "#include <CGAL/Surface_mesh.h>\n"));
  expect_caught(architecture::check_packages, "meshes/shape.h", "CGAL");
  plant("meshes/shape.h", header("meshes", ""));
  plant("lattice/model/model.h", header("lattice", "#include \"meshes/cad_surface.h\"\n"));
  expect_caught(architecture::check_packages, "lattice/model/model.h", "mesher");
  plant("lattice/model/model.h", header("lattice", "#include \"meshes/volume_mesh.h\"\n"));
  expect_caught(architecture::check_packages, "lattice/model/model.h", "mesher");
}

TEST_F(PlantedTree, HeaderCyclesAreCaught) {
  plant("lattice/model/a.h", header("lattice", "#include \"lattice/model/b.h\"\n"));
  plant("lattice/model/b.h", header("lattice", "#include \"lattice/model/c.h\"\n"));
  plant("lattice/model/c.h", header("lattice", "#include \"lattice/model/a.h\"\n"));
  expect_caught(architecture::check_header_cycles, "lattice/model/a.h",
                "lattice/model/b.h → lattice/model/c.h");
}

TEST_F(PlantedTree, BadFormIsCaught) {
  plant("lattice/model/planted.h", "#pragma once\n" + body("lattice", ""));
  expect_caught(architecture::check_form, "lattice/model/planted.h", "///");
  plant("lattice/model/planted.h", "/// Something.\n" + body("lattice", ""));
  expect_caught(architecture::check_form, "lattice/model/planted.h", "#pragma once");
  plant("lattice/model/planted.h", "/// Something.\n#pragma once\n");
  expect_caught(architecture::check_form, "lattice/model/planted.h", "lacks namespace");
  plant("lattice/model/planted.h", header("lattice", "") + body("meshes", ""));
  expect_caught(architecture::check_form, "lattice/model/planted.h", "room meshes");
  plant("lattice/model/planted.h", header("lattice", "") + std::string(600, '\n'));
  expect_caught(architecture::check_form, "lattice/model/planted.h", "longer than 600");
  fs::remove(root_ / "lattice/model/planted.h");
  plant("lattice/planted.cc", body("lattice", ""));
  expect_caught(architecture::check_form, "lattice/planted.cc", "none of the rooms of lattice");
}

TEST_F(PlantedTree, CHeadersAreInNoNamespace) {
  plant("studies/interface.h", "/// For C.\n#pragma once\nextern \"C\" {\nint answer(void);\n}\n");
  for (const auto& finding : architecture::check_form(root_)) ADD_FAILURE() << to_string(finding);
}

TEST_F(PlantedTree, MissingReadmeIsCaught) {
  fs::remove(root_ / "lattice/README.md");
  expect_caught(architecture::check_readmes, "lattice", "README.md");
}

}  // namespace
