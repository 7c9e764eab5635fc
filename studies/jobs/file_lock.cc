#include "studies/jobs/file_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <vector>

namespace fingertip::studies::inline jobs {

namespace fs = std::filesystem;

namespace {

int opened(const fs::path& path) {
  const int existing = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  return existing >= 0 ? existing : ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
}

/// The process whose number stands behind ".part" at the end of the name; 0: none.
pid_t writer_of(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto at = name.rfind(".part");
  if (at == name.npos) return 0;
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + at + 5, end, process);
  return error == std::errc() && rest == end && process > 0 ? process : 0;
}

bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

void remove_parts(const fs::path& folder, bool deep, bool of_the_living) {
  std::error_code failed;
  std::vector<fs::path> found;
  for (fs::recursive_directory_iterator item(folder, failed), end; !failed && item != end;
       item.increment(failed)) {
    const pid_t writer = writer_of(item->path());
    if (writer != 0 && (of_the_living || has_ended(writer))) {
      found.push_back(item->path());
      item.disable_recursion_pending();
    }
    if (!deep) item.disable_recursion_pending();
  }
  for (const fs::path& path : found) fs::remove_all(path, failed);
}

}  // namespace

FileLock::FileLock(const fs::path& path)
    : descriptor_(opened(path)),
      held_(descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0),
      taken_(descriptor_ >= 0 && !held_ && errno == EWOULDBLOCK) {}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void remove_abandoned_parts(const fs::path& folder) {
  remove_parts(folder, false, false);
}

void remove_abandoned_parts(const fs::path& folder, const FileLock& lock) {
  remove_parts(folder, true, lock.held());
}

}  // namespace fingertip::studies::inline jobs
