#include "meshes/base/text_file.h"

#include <fstream>
#include <sstream>

#include "meshes/base/errors.h"

namespace fingertip::meshes::inline base {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  const auto refuse = [&](const char* rule, const char* remedy) {
    throw InvalidInput({"", "", rule, remedy, file.string()});
  };
  if (!fs::exists(status))
    refuse("there is no such file", "check its name, or run again what writes it");
  if (!fs::is_regular_file(status))
    refuse("is no file", "take away what stands in its place and run again what writes it");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  // An empty file leaves nothing to insert, which the stream calls a failure.
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream && !stream.eof()) refuse("the file cannot be read", "check its permissions");
  return std::move(text).str();
}

}  // namespace fingertip::meshes::inline base
