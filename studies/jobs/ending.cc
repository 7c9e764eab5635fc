#include "studies/jobs/ending.h"

#include <filesystem>

#include "lattice/control/controller.h"
#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline jobs {

namespace {

template <typename Error>
bool is(const std::exception& error) {
  return dynamic_cast<const Error*>(&error) != nullptr;
}

}  // namespace

Ending ending_of(const std::exception& error) {
  // A lost process is a special case of what did not converge.
  if (is<ProcessLost>(error)) return {"process lost", 3};
  if (is<lattice::ControllerFailed>(error)) return {"controller failed", 3};
  if (is<meshes::NotConverged>(error)) return {"not converged", 3};
  if (is<meshes::Interrupted>(error)) return {"interrupted", 130};
  if (is<meshes::InvalidInput>(error)) return {"bad input", 2};
  if (is<meshes::CannotWrite>(error) || is<std::filesystem::filesystem_error>(error))
    return {"could not write", 3};
  return {"failed", 1};
}

}  // namespace fingertip::studies::inline jobs
