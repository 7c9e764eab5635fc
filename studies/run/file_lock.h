/// Keeping other processes out of a file or a folder.
#pragma once

#include <filesystem>

namespace fingertip::studies {

/// Held by at most one process; the system releases it when that one ends, however it ends. `path`
/// is a folder, or a file, which is made when it is not there.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool held() const { return held_; }
  /// Whether another process holds it; false also where the file system knows no locks.
  bool taken() const { return taken_; }

 private:
  int descriptor_;
  bool held_, taken_;
};

/// Removes from `folder` (and, if `deep`, from folders in it) what is called NAME.part with the
/// number of a process that has ended: it was killed before it could rename it.
void remove_abandoned_parts(const std::filesystem::path& folder, bool deep);

}  // namespace fingertip::studies
