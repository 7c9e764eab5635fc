#include "studies/config/shapes/surface_cache.h"

#include <unistd.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "meshes/shape/meridian.h"
#include "meshes/shape/revolved_surface.h"
#include "meshes/shape/stl_file.h"
#include "studies/config/shapes/profile_file.h"
#include "studies/files/places.h"
#include "studies/files/process.h"

namespace fingertip::studies::inline config::inline shapes {
namespace {

namespace fs = std::filesystem;

/// Of how the triangles are made: another one makes those in the cache stale.
constexpr const char* version = "5";

std::string digest_of(const std::string& content) {
  boost::uuids::name_generator_sha1 generator(boost::uuids::ns::oid());
  return to_string(generator(version + content));
}

/// A folder in which files may be made: in the cache, else where temporary files are.
fs::path folder_for_surfaces() {
  std::error_code failed;
  const fs::path folder = cache_folder() / "surfaces";
  fs::create_directories(folder, failed);
  return !failed && ::access(folder.c_str(), W_OK) == 0 ? folder : fs::temp_directory_path();
}

constexpr double mm = 1e-3;

void write_meridian(const fs::path& csv, const fs::path& stl) {
  const meshes::Meridian meridian(read_profile(csv));
  meshes::write_stl(meshes::revolved_surface(meridian), mm, "surface of a meridian", stl);
}

void write_cad(const fs::path& cad, const std::string& up, const fs::path& stl,
               const fs::path& folder) {
  const auto refuse = [&](const std::string& rule, const std::string& remedy) {
    throw meshes::InvalidInput({"geometry.file", cad.filename().string(), rule, remedy});
  };
  const fs::path program = [&] {
    try {
      return built_reference_program();
    } catch (const meshes::InvalidInput& error) {
      refuse(std::string("CAD files need fingertip-fem: ") + error.what(), "or export an STL");
      throw;
    }
  }();
  const std::string own = std::to_string(::getpid());
  const fs::path unfinished = folder / ("." + own + ".stl"), words = folder / ("." + own + ".txt");
  const int code =
      run_process({{program.string(), "--triangles", cad.string(), unfinished.string(), up},
                   {"OMP_NUM_THREADS=1"}},
                  words);
  const std::string said = meshes::read_text(words);
  fs::remove(words);
  if (code != 0) {
    fs::remove(unfinished);
    refuse("no surface could be made of it: " +
               (said.empty() ? "fingertip-fem ended with code " + std::to_string(code)
                             : said.substr(0, said.find_last_not_of('\n') + 1)),
           "mend the solid in the CAD program, or export an STL from it");
  }
  fs::rename(unfinished, stl);
}

}  // namespace

fs::path triangulated(const fs::path& file, const std::string& up) {
  const std::string content = meshes::read_text(file);
  const fs::path folder = folder_for_surfaces();
  const fs::path stl = folder / (digest_of(up + content) + ".stl");
  if (fs::exists(stl)) return stl;
  if (boost::iequals(file.extension().string(), ".csv"))
    write_meridian(file, stl);
  else
    write_cad(file, up, stl, folder);
  return stl;
}

}  // namespace fingertip::studies::inline config::inline shapes
