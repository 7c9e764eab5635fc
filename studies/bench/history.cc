#include "studies/bench/history.h"

#include <fstream>
#include <stdexcept>

#include "studies/files/places.h"

namespace fingertip::studies::inline bench {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

fs::path history_file(const fs::path& folder) {
  return (folder.empty() ? cache_folder() / "bench" : folder) / "history.jsonl";
}

void append_history(const ordered_json& bench, const fs::path& file) {
  ordered_json line = bench;
  line.erase("ratio_rounds");
  for (const char* list : {"kernels", "peers"})
    for (ordered_json& entry : line[list]) entry.erase("rounds");
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::app);
  // One write per line: two runs at once do not mix.
  out << line.dump() + "\n" << std::flush;
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace fingertip::studies::inline bench
