#include "studies/control/shared_object_controller.h"

#include <dlfcn.h>

#include <string>

#include "studies/control/c_structs.h"

namespace fingertip::studies::inline control {

using lattice::ControllerFailed;

/// The loaded object and its functions.
class SharedObjectController::Library {
 public:
  explicit Library(const std::filesystem::path& file) : file_(std::filesystem::absolute(file)) {
    if (!std::filesystem::exists(file_)) refuse("there is no such file");
    handle_.reset(::dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!handle_) refuse(::dlerror());
    // Asked first: another version may have other functions, or others of the same name.
    const unsigned version = function<decltype(&fingertip_controller_abi)>("abi")();
    if (version != FINGERTIP_CONTROLLER_ABI) {
      refuse("it was built for version " + std::to_string(version) +
             " of fingertip_controller.h, this program has version " +
             std::to_string(FINGERTIP_CONTROLLER_ABI) + "; build it with that header");
    }
    create = function<decltype(create)>("create");
    command = function<decltype(command)>("command");
    reset = function<decltype(reset)>("reset");
    destroy = function<decltype(destroy)>("destroy");
    error = reinterpret_cast<decltype(error)>(::dlsym(handle_.get(), "fingertip_controller_error"));
  }

  const std::filesystem::path& file() const { return file_; }

  decltype(&fingertip_controller_create) create = nullptr;
  decltype(&fingertip_controller_command) command = nullptr;
  decltype(&fingertip_controller_reset) reset = nullptr;
  decltype(&fingertip_controller_destroy) destroy = nullptr;
  decltype(&fingertip_controller_error) error = nullptr;  // may be missing

 private:
  struct Close {
    void operator()(void* handle) const { ::dlclose(handle); }
  };

  template <typename Function>
  Function function(const std::string& name) const {
    const std::string symbol = "fingertip_controller_" + name;
    void* const address = ::dlsym(handle_.get(), symbol.c_str());
    if (address == nullptr) refuse("it does not export the function " + symbol);
    return reinterpret_cast<Function>(address);
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw ControllerFailed("the controller " + file_.string() + " cannot be loaded: " + why);
  }

  std::filesystem::path file_;
  std::unique_ptr<void, Close> handle_;
};

SharedObjectController::SharedObjectController(const std::filesystem::path& library,
                                               const lattice::ControlTask& task)
    : library_(std::make_unique<Library>(library)), task_(task) {
  const fingertip_task order = c_task(task);
  const int code = library_->create(&order, &self_);
  if (code != FINGERTIP_OK) {
    self_ = nullptr;
    fail("create", code);
  }
}

SharedObjectController::~SharedObjectController() {
  library_->destroy(self_);
}

void SharedObjectController::fail(const char* call, int code) const {
  const char* const why = library_->error ? library_->error(self_) : nullptr;
  throw ControllerFailed("the controller " + library_->file().string() + " failed: " + call +
                         "() returned " + std::to_string(code) +
                         (why ? std::string(" (") + why + ")" : ""));
}

lattice::Command SharedObjectController::command(const lattice::Measurement& measurement) {
  const fingertip_measurement seen = c_measurement(measurement, task_);
  fingertip_command answer = empty_c_command();
  const int code = library_->command(self_, &seen, &answer);
  if (code != FINGERTIP_OK) fail("command", code);
  return command_of(answer);
}

void SharedObjectController::reset() {
  const int code = library_->reset(self_);
  if (code != FINGERTIP_OK) fail("reset", code);
}

}  // namespace fingertip::studies::inline control
