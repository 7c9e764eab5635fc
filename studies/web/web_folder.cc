#include "studies/web/web_folder.h"

#include <fmt/format.h>

#include <ostream>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/base/text_file.h"
#include "studies/files/places.h"
#include "studies/live/page_texts.h"
#include "studies/web/web_files.h"

namespace fingertip::studies::inline web {

namespace {

/// What stands behind page/connection.js. Scripts may be read from a folder, nothing else may: so
/// the module is a function, whose text the page gives to its worker.
std::string lattice_text(const std::vector<WebFinger>& fingers) {
  return fmt::format(
      "const fingers = {};\nfunction latticeModule() {{\n{}\nreturn makeLattice;\n}}\n",
      meshes::json_of(fingers).dump(), meshes::read_text(module_file()));
}

}  // namespace

std::filesystem::path module_file() {
  return data_folder("web", FINGERTIP_WEB_MODULE) / "web_lattice.js";
}

void write_page(const std::filesystem::path& folder, const std::vector<WebFinger>& fingers) {
  std::map<std::string, std::string> texts = page_texts();
  texts["connection.js"] = std::string(web_files().at("connection.js")) + lattice_text(fingers);
  for (const auto& [name, text] : texts)
    meshes::write_atomically(folder / name, [&](std::ostream& out) { out << text; });
}

}  // namespace fingertip::studies::inline web
