#include "studies/run/file_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <vector>

namespace fingertip::studies {

namespace fs = std::filesystem;

namespace {

int opened(const fs::path& path) {
  const int existing = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  return existing >= 0 ? existing : ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
}

/// Whether the name ends in ".part" and the number of a process that is no more.
bool abandoned(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto at = name.rfind(".part");
  if (at == name.npos) return false;
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + at + 5, end, process);
  return error == std::errc() && rest == end && process > 0 && ::kill(process, 0) != 0 &&
         errno == ESRCH;
}

}  // namespace

FileLock::FileLock(const fs::path& path)
    : descriptor_(opened(path)),
      held_(descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0),
      taken_(descriptor_ >= 0 && !held_ && errno == EWOULDBLOCK) {}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void remove_abandoned_parts(const fs::path& folder, bool deep) {
  std::error_code failed;
  std::vector<fs::path> found;
  for (fs::recursive_directory_iterator item(folder, failed), end; !failed && item != end;
       item.increment(failed)) {
    if (abandoned(item->path())) {
      found.push_back(item->path());
      item.disable_recursion_pending();
    }
    if (!deep) item.disable_recursion_pending();
  }
  for (const fs::path& path : found) fs::remove_all(path, failed);
}

}  // namespace fingertip::studies
