#include "meshes/base/blas.h"

#include <dlfcn.h>

#include <cstdlib>

namespace fingertip::meshes::inline base {
namespace {

template <class Function>
Function* symbol(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Looked up by name, since which BLAS serves a program is the system's choice. Empty: another one,
/// or one built for a single processor.
struct OpenBlas {
  void (*set_threads)(int) = symbol<void(int)>("openblas_set_num_threads");
  int (*get_threads)() = symbol<int()>("openblas_get_num_threads");
  char* (*core_name)() = symbol<char*()>("openblas_get_corename");
  /// Forget the kernels, choose them anew: what OpenBLAS does when it is loaded.
  void (*forget_kernels)() = symbol<void()>("gotoblas_dynamic_quit");
  void (*choose_kernels)() = symbol<void()>("gotoblas_dynamic_init");
};

/// Empty where no library of the program uses it.
struct OpenMp {
  void (*set_levels)(int) = symbol<void(int)>("omp_set_max_active_levels");
  int (*get_levels)() = symbol<int()>("omp_get_max_active_levels");
};

const OpenMp& open_mp() {
  static const OpenMp found;
  return found;
}

const OpenBlas& open_blas() {
  static const OpenBlas found;
  return found;
}

/// Whether the running processor has what OpenBLAS's Haswell kernels need.
bool runs_haswell_kernels() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool chosen_by_features = false;

}  // namespace

void keep_blas_to_one_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") == nullptr && open_blas().set_threads != nullptr)
    open_blas().set_threads(1);
}

void leave_oldest_blas_kernels() {
  constexpr const char* choice = "OPENBLAS_CORETYPE";
  const OpenBlas& blas = open_blas();
  if (blas.forget_kernels == nullptr || blas.choose_kernels == nullptr ||
      std::getenv(choice) != nullptr || blas_kernels().name != "Prescott" ||
      !runs_haswell_kernels())
    return;
  ::setenv(choice, "Haswell", 1);
  blas.forget_kernels();
  blas.choose_kernels();
  ::unsetenv(choice);
  chosen_by_features = true;
}

BlasKernels blas_kernels() {
  if (open_blas().core_name == nullptr) return {};
  return {open_blas().core_name(), chosen_by_features};
}

OneBlasThread::OneBlasThread() {
  if (open_blas().set_threads == nullptr || open_blas().get_threads == nullptr) return;
  before_ = open_blas().get_threads();
  open_blas().set_threads(1);
}

OneBlasThread::~OneBlasThread() {
  if (before_ > 0) open_blas().set_threads(before_);
}

OneOpenMpThread::OneOpenMpThread() {
  if (open_mp().set_levels == nullptr || open_mp().get_levels == nullptr) return;
  before_ = open_mp().get_levels();
  open_mp().set_levels(0);
}

OneOpenMpThread::~OneOpenMpThread() {
  if (before_ >= 0) open_mp().set_levels(before_);
}

}  // namespace fingertip::meshes::inline base
