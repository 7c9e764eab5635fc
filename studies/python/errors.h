/// What the libraries throw, as Python's exceptions (fingertip/errors.py).
#pragma once

namespace fingertip::studies::inline python {

/// From now on every function of the module raises them.
void translate_errors();

}  // namespace fingertip::studies::inline python
