// The two packages, unpacked into an empty folder: programs run, libraries are found and linked.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

void run(const TemporaryFolder& folder, const std::string& command) {
  const std::string all = "cd '" + folder.path().string() + "' && (" + command + ") > words 2>&1";
  ASSERT_EQ(std::system(all.c_str()), 0) << command << "\n" << read_text(folder / "words");
}

}  // namespace

TEST(Install, ProgramsRunAndLibrariesAreFound) {
  const TemporaryFolder folder;
  run(folder, "cpack -G DEB --config '" FINGERTIP_BUILD "/CPackConfig.cmake' -B packages");
  run(folder, "for p in packages/*.deb; do dpkg-deb -x $p unpacked; done; mv unpacked/usr there");
  run(folder,
      "there/bin/fingertip press --set press.mode=static --set lattice.spacing=tip_radius/4 "
      "--out pressed");
  EXPECT_TRUE(std::filesystem::exists(folder / "pressed/response.csv"));
  run(folder, "there/bin/fingertip doctor");
  EXPECT_NE(read_text(folder / "words").find((folder / "there/share/fingertip/cases").string()),
            std::string::npos);
  run(folder, "there/bin/fingertip export --format fmu --out unit");
  run(folder,
      "PYTHONPATH=there/lib/python3/dist-packages /usr/bin/python3 -c 'import fingertip; "
      "print(fingertip.press(press_mode=\"static\", lattice_spacing=\"tip_radius/4\", "
      "out=\"by_python\"))'");
  write_text(folder / "CMakeLists.txt",
             "cmake_minimum_required(VERSION 3.20)\nproject(mine CXX)\nset(CMAKE_CXX_STANDARD 20)\n"
             "find_package(fingertip REQUIRED)\nadd_executable(mine mine.cc)\n"
             "target_link_libraries(mine PRIVATE fingertip::lattice)\n");
  write_text(folder / "mine.cc",
             "#include <cstdio>\n#include \"lattice/press/press_setup.h\"\n"
             "int main() {\n  const fingertip::lattice::PressSetup setup;\n"
             "  for (const auto& rule : setup.violations()) std::puts(rule.key.c_str());\n}\n");
  run(folder,
      "cmake -S . -B build -DCMAKE_PREFIX_PATH=$PWD/there && cmake --build build && build/mine");
  EXPECT_NE(read_text(folder / "words").find("lattice."), std::string::npos);
}
