/// A controller from a shared object with the C interface of fingertip_controller.h.
#pragma once

#include <filesystem>
#include <memory>

#include "lattice/control/controller.h"
#include "lattice/control/task.h"

namespace fingertip::studies::inline control {

/// The object runs within the program: what it returns is checked, but if it crashes the program
/// does, and the run waits as long as it takes (a SocketController can die and hang on its own).
class SharedObjectController final : public lattice::Controller {
 public:
  /// Loads `library` and creates its controller. Throws ControllerFailed for a file that is
  /// missing or no shared object, a missing function, another version, and a failed create().
  SharedObjectController(const std::filesystem::path& library, const lattice::ControlTask& task);
  ~SharedObjectController() override;

  /// Throws ControllerFailed for a return code other than 0 and for what `checked` refuses.
  lattice::Command command(const lattice::Measurement& measurement) override;
  void reset() override;

 private:
  class Library;
  [[noreturn]] void fail(const char* call, int code) const;

  std::unique_ptr<Library> library_;
  lattice::ControlTask task_;
  void* self_ = nullptr;
};

}  // namespace fingertip::studies::inline control
