/// A finger to step in one's own loop.
#pragma once

#include <pybind11/pybind11.h>

namespace fingertip::studies::inline python {

/// Adds Finger, Measurement, Contact, Wrench and Target.
void add_finger(pybind11::module_& module);

}  // namespace fingertip::studies::inline python
