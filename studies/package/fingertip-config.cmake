# find_package(fingertip): fingertip::specimen, lattice, calibration, fem_reference, jobs, presses, fits, ...
# #include "lattice/press/press.h" as the project's own sources do.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(Threads)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
find_dependency(Boost)
find_dependency(Ceres)
find_dependency(spdlog)
find_dependency(OpenSSL)
find_dependency(ZLIB)
include(${CMAKE_CURRENT_LIST_DIR}/fingertip-targets.cmake)
