#include "studies/files/places.h"

#include <dlfcn.h>

#include <cstdlib>
#include <string_view>

namespace fingertip::studies::inline files {

namespace fs = std::filesystem;

fs::path executable_folder() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&executable_folder), &own) == 0 ||
      own.dli_fname == nullptr || !std::string_view(own.dli_fname).ends_with(".so"))
    return fs::read_symlink("/proc/self/exe").parent_path();
  fs::path place = fs::canonical(own.dli_fname).parent_path();
  while (place.has_relative_path() && !fs::exists(place / "bin" / "fingertip"))
    place = place.parent_path();
  return place / "bin";
}

fs::path data_folder(const std::string& name, const fs::path& source) {
  const fs::path installed = executable_folder().parent_path() / "share/fingertip" / name;
  return fs::exists(installed) ? installed : source;
}

fs::path passed_on(const std::string& name) {
  const fs::path built = executable_folder() / name;
  return fs::exists(built)
             ? built
             : executable_folder().parent_path() / FINGERTIP_LIBDIR / "fingertip" / name;
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

}  // namespace fingertip::studies::inline files
