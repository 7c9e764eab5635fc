#include "studies/cases/folders.h"

#include <cctype>

namespace fingertip::studies {

std::string as_folder(std::string text) {
  for (char& c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  return text;
}

meshes::PressResponse response_in(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "response.csv";
  return std::filesystem::exists(file) ? meshes::PressResponse::read_csv(file)
                                       : meshes::PressResponse();
}

}  // namespace fingertip::studies
