#include "studies/files/places.h"

#include <cstdlib>

namespace fingertip::studies {

namespace fs = std::filesystem;

fs::path executable_folder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

fs::path reference_program() {
  return executable_folder() / "fingertip-fem";
}

fs::path cache_folder() {
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && *xdg != '\0') return fs::path(xdg) / "fingertip";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "fingertip";
  std::error_code none;
  return fs::temp_directory_path(none) / "fingertip-cache";
}

}  // namespace fingertip::studies
