/// How a computation ends whose results find no place.
#pragma once

#include <stdexcept>

namespace fingertip::meshes::inline base {

/// A file could not be written: a full disk, missing rights. What was finished before is kept; the
/// programs exit with 3.
class CannotWrite : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace fingertip::meshes::inline base
