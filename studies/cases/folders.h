/// Sub-folders of a study's run.
#pragma once

#include <filesystem>
#include <string>

#include "meshes/press_response.h"

namespace fingertip::studies {

/// Letters, digits, '-' and '.'; anything else becomes '_'.
std::string as_folder(std::string text);

/// response.csv of a press; empty when there is none.
meshes::PressResponse response_in(const std::filesystem::path& folder);

}  // namespace fingertip::studies
