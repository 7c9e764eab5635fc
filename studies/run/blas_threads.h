/// How many threads BLAS takes inside this program.
#pragma once

namespace fingertip::studies {

/// One, unless OPENBLAS_NUM_THREADS says otherwise. Jobs run side by side here, and OpenBLAS' own
/// threads then wait for each other: two static presses at a time took twenty times as long. Does
/// nothing with another BLAS.
void keep_blas_to_one_thread();

}  // namespace fingertip::studies
