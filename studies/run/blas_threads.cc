#include "studies/run/blas_threads.h"

#include <dlfcn.h>

#include <cstdlib>

namespace fingertip::studies {

void keep_blas_to_one_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr) return;
  // Looked up by name: which BLAS serves the program is the system's choice.
  using SetThreads = void (*)(int);
  if (void* set_threads = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<SetThreads>(set_threads)(1);
}

}  // namespace fingertip::studies
