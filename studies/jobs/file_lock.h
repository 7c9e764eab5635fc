/// Keeping other processes out of a file or a folder.
#pragma once

#include <filesystem>

namespace fingertip::studies::inline jobs {

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

/// Removes what is called NAME.part with the number of a process that has ended: it was killed
/// before it could rename it. Only what lies in `folder` itself, in which others may be at work.
void remove_abandoned_parts(const std::filesystem::path& folder);
/// The same of a folder and all in it which `lock` keeps others out of: then a part is abandoned
/// whatever lives now under its number, which the system gives anew, in containers often to the
/// next run. Where the file system knows no locks the number decides.
void remove_abandoned_parts(const std::filesystem::path& folder, const FileLock& lock);

}  // namespace fingertip::studies::inline jobs
