/// How many threads OpenBLAS takes inside this program. Nothing here has an effect with another
/// BLAS.
#pragma once

namespace fingertip::meshes {

/// One, unless OPENBLAS_NUM_THREADS says otherwise. For programs whose jobs run side by side:
/// OpenBLAS' own threads then wait for each other, and two static presses at a time took twenty
/// times as long.
void keep_blas_to_one_thread();

/// One while it lives, then as many as before. For threads that multiply small matrices: their
/// products must not ask for more.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  int before_ = 0;  ///< 0: nothing to restore
};

}  // namespace fingertip::meshes
