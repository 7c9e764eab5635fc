/// The page of a `bench` run.
#pragma once

#include <filesystem>

#include "studies/files/folder_reader.h"
#include "studies/report/page/document.h"

namespace fingertip::studies::report::inline chapters::inline bench {

/// Error over speed, of the document: the figure and its tables.
Chapter pace_chapter(const JsonEntry& bench);

/// From bench.json. What is damaged is left out and noted in
/// `reader`.
Page bench_page(const std::filesystem::path& run_folder, FolderReader& reader);

}  // namespace fingertip::studies::report::inline chapters::inline bench
