/// The page of a `bench` run.
#pragma once

#include <filesystem>

#include "studies/report/document.h"

namespace fingertip::studies::reporting {

/// From bench.json, and history.json where there is one. Throws InvalidInput for a damaged file.
Page bench_page(const std::filesystem::path& run_folder);

}  // namespace fingertip::studies::reporting
