#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "butee/python/outcome.hpp"

/// The parts of the extension module butee._butee. The public interface and its documentation are
/// in butee/*.py.
namespace butee::python {

void bind_errors(pybind11::module_& module);
void bind_loads(pybind11::module_& module);
void bind_laws(pybind11::module_& module);
void bind_conformance(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_outcome(pybind11::module_& module);
void bind_batch(pybind11::module_& module);
void bind_study(pybind11::module_& module);
void bind_equations(pybind11::module_& module);
void bind_structure(pybind11::module_& module);

/// Allows objects to be made only by functions of the module: pybind11 would accept the result of
/// __new__ without __init__.
inline void seal(const pybind11::handle& type) {
  reinterpret_cast<PyTypeObject*>(type.ptr())->tp_new = nullptr;
}

/// Makes numpy refuse assignments to the elements of an array, which would change nothing but the array.
inline void make_read_only(const pybind11::array& array) {
  pybind11::detail::array_proxy(array.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
}

/// A read-only array view of `values` without a copy; `owner` keeps them alive.
inline pybind11::array view(const std::vector<double>& values, pybind11::handle owner) {
  pybind11::array_t<double> array(static_cast<pybind11::ssize_t>(values.size()), values.data(), owner);
  make_read_only(array);
  return array;
}

}  // namespace butee::python
