/// The key table for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace fingertip::studies::inline python {

/// Adds keys() and sections().
void add_keys(pybind11::module_& module);

}  // namespace fingertip::studies::inline python
