#include "butee/config/scene_error.hpp"
#include "butee/core/error.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/watch.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

py::list mistakes_of(const InputError& error) {
  py::list list;
  if (const auto* scene = dynamic_cast<const config::SceneError*>(&error))
    for (const config::Mistake& mistake : scene->mistakes())
      list.append(py::make_tuple(mistake.file, mistake.line, mistake.key, mistake.message));
  return list;
}

/// Raises a class of butee._errors.
void raise(const char* name, const py::tuple& arguments) {
  const py::object type = py::module_::import("butee._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise("InputError", py::make_tuple(error.what(), mistakes_of(error)));
  } catch (const RunError& error) {
    if (take_interrupt()) return PyErr_SetNone(PyExc_KeyboardInterrupt);
    raise("RunError", py::make_tuple(error.what()));
  } catch (const LogicError& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  }
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      translate(thrown);
    } catch (py::error_already_set& error) {
      error.restore();
    }
  });
}

}  // namespace butee::python
