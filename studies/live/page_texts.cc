#include "studies/live/page_texts.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "meshes/base/errors.h"
#include "studies/files/places.h"
#include "studies/live/page_files.h"

namespace fingertip::studies::inline live {

namespace {

std::string file_content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw meshes::InvalidInput({"three.js", file.string(), "the file cannot be read",
                                "install the Debian package libjs-three"});
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::map<std::string, std::string> page_texts() {
  std::map<std::string, std::string> texts(page_files().begin(), page_files().end());
  const std::filesystem::path three = data_folder("three", "/usr/share/javascript/three");
  for (const char* script : {"three.min.js", "examples/js/controls/OrbitControls.js"})
    texts[std::filesystem::path(script).filename()] = file_content(three / script);
  return texts;
}

}  // namespace fingertip::studies::inline live
