/// Tables of rows as columns of NumPy, without a copy.
#pragma once

#include <pybind11/pybind11.h>

namespace fingertip::studies::inline python {

/// Adds ResponseTable and TraceTable, which read response.csv and trace.csv.
void add_tables(pybind11::module_& module);

}  // namespace fingertip::studies::inline python
