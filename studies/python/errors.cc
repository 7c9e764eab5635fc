#include "studies/python/errors.h"

#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>

#include "lattice/control/controller.h"
#include "meshes/base/cannot_write.h"
#include "meshes/base/errors.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline python {

namespace py = pybind11;

namespace {

/// Raises a class of fingertip/errors.py.
template <typename... Arguments>
void raise(const char* name, Arguments&&... arguments) {
  const py::object type = py::module_::import("fingertip.errors").attr(name);
  const py::object error = type(std::forward<Arguments>(arguments)...);
  PyErr_SetObject(type.ptr(), error.ptr());
}

py::list told(const std::vector<meshes::Violation>& violations) {
  py::list list;
  for (const meshes::Violation& violation : violations)
    list.append(py::make_tuple(violation.place, violation.key, violation.value, violation.rule,
                               violation.remedy));
  return list;
}

}  // namespace

void translate_errors() {
  // The more special ones first.
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const meshes::InvalidInput& error) {
      raise("ConfigError", told(error.violations()));
    } catch (const ProcessLost& error) {
      raise("ProcessLost", error.what());
    } catch (const meshes::NotConverged& error) {
      raise("NotConverged", error.what());
    } catch (const lattice::ControllerFailed& error) {
      raise("ControllerFailed", error.what());
    } catch (const meshes::CannotWrite& error) {
      raise("CannotWrite", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      raise("CannotWrite", error.what());
    } catch (const meshes::Interrupted& error) {
      PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
    }
  });
}

}  // namespace fingertip::studies::inline python
