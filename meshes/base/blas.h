/// How OpenBLAS and what stands on it compute inside this program: with which kernels, in how many
/// threads. What is said of OpenBLAS has no effect with another BLAS.
#pragma once

#include <string>

namespace fingertip::meshes::inline base {

/// The kernels of OpenBLAS, named after a processor.
struct BlasKernels {
  std::string name;          ///< empty: another BLAS
  bool by_features = false;  ///< chosen by `leave_oldest_blas_kernels`
};

/// One thread, unless OPENBLAS_NUM_THREADS says otherwise. For programs whose jobs run side by
/// side: OpenBLAS' own threads then wait for each other, and two static presses at a time took
/// twenty times as long.
void keep_blas_to_one_thread();

/// At the start of a program, before other threads. OpenBLAS takes its oldest kernels (Prescott,
/// SSE3) on a processor that it does not know, up to its version 0.3.24 also on one that has AVX2
/// (OpenBLAS issue 4267). There it gets Haswell's, unless OPENBLAS_CORETYPE says otherwise.
void leave_oldest_blas_kernels();

/// Those that are computed with now.
BlasKernels blas_kernels();

/// One thread while it lives, then as many as before. For threads that multiply small matrices:
/// their products must not ask for more.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  int before_ = 0;  ///< 0: nothing to restore
};

/// OpenMP's parallel regions run on the thread that meets them while it lives. For CHOLMOD, which
/// opens four threads for each of its supernodes, however small, beside those of BLAS: they wait
/// for each other, and a press of a solid took 1.3 times as long. A BLAS whose own threads are
/// OpenMP's has one, too.
class OneOpenMpThread {
 public:
  OneOpenMpThread();
  ~OneOpenMpThread();
  OneOpenMpThread(const OneOpenMpThread&) = delete;
  OneOpenMpThread& operator=(const OneOpenMpThread&) = delete;

 private:
  int before_ = -1;  ///< nested levels that may be active; below 0: nothing to restore
};

}  // namespace fingertip::meshes::inline base
