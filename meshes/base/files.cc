#include "meshes/base/files.h"

#include <charconv>
#include <cmath>
#include <fstream>

#include <unistd.h>

#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"

namespace fingertip::meshes::inline base {

void write_atomically(const std::filesystem::path& file,
                      const std::function<void(std::ostream&)>& write) {
  if (std::filesystem::is_directory(file)) {
    throw InvalidInput({file.string(), "", "cannot be written: a folder stands in its place",
                        "take the folder away"});
  }
  std::filesystem::path temporary = file;
  temporary += ".part" + std::to_string(::getpid());
  try {
    std::ofstream out(temporary, std::ios::binary);
    if (out) write(out);
    out.close();
    if (!out) {
      throw CannotWrite("cannot write " + file.string() +
                        ": check that the folder exists, is writable and has space left");
    }
    std::filesystem::rename(temporary, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

std::string to_text(double value) {
  if (std::isnan(value)) return {};
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

}  // namespace fingertip::meshes::inline base
