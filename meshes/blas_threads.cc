#include "meshes/blas_threads.h"

#include <dlfcn.h>

#include <cstdlib>

namespace fingertip::meshes {
namespace {

/// Looked up by name, since which BLAS serves a program is the system's choice. Empty: another one.
struct OpenBlas {
  void (*set_threads)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT,
                                                                   "openblas_set_num_threads"));
  int (*get_threads)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT,
                                                           "openblas_get_num_threads"));
};

const OpenBlas& open_blas() {
  static const OpenBlas found;
  return found;
}

}  // namespace

void keep_blas_to_one_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") == nullptr && open_blas().set_threads != nullptr)
    open_blas().set_threads(1);
}

OneBlasThread::OneBlasThread() {
  if (open_blas().set_threads == nullptr || open_blas().get_threads == nullptr) return;
  before_ = open_blas().get_threads();
  open_blas().set_threads(1);
}

OneBlasThread::~OneBlasThread() {
  if (before_ > 0) open_blas().set_threads(before_);
}

}  // namespace fingertip::meshes
