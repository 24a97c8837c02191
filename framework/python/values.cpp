#include "butee/python/values.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

/// The depth limit of a scene, more than any needs; conversion of a list that contains itself ends
/// here.
constexpr int kDeepest = 60;

config::Value convert(py::handle from, int depth);

config::Value table_of(py::handle from, int depth) {
  config::Table table;
  for (const py::handle key : py::reinterpret_borrow<py::object>(from)) {
    if (!py::isinstance<py::str>(key))
      throw py::type_error("the keys of a scene must be strings, not " + py::repr(key).cast<std::string>());
    table[key.cast<std::string>()] = convert(from[key], depth + 1);
  }
  return {std::move(table)};
}

config::Value array_of(py::handle from, int depth) {
  config::Array array;
  for (const py::handle item : from) array.push_back(convert(item, depth + 1));
  return {std::move(array)};
}

config::Value number_of(py::handle from) {
  if (PyIndex_Check(from.ptr()) != 0) {
    const auto integer = py::reinterpret_steal<py::object>(PyNumber_Index(from.ptr()));
    if (!integer) throw py::error_already_set();
    const long long number = PyLong_AsLongLong(integer.ptr());
    if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
    return {static_cast<std::int64_t>(number)};
  }
  const double number = PyFloat_AsDouble(from.ptr());
  if (number == -1.0 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return {number};
}

config::Value convert(py::handle from, int depth) {
  if (depth > kDeepest) throw py::value_error("the tables of a scene are nested too deeply");
  if (PyBool_Check(from.ptr())) return {from.ptr() == Py_True};
  if (PyFloat_Check(from.ptr())) return {PyFloat_AS_DOUBLE(from.ptr())};
  if (py::isinstance<py::str>(from)) return {from.cast<std::string>()};
  if (PyDict_Check(from.ptr())) return table_of(from, depth);
  if (PyList_Check(from.ptr()) || PyTuple_Check(from.ptr())) return array_of(from, depth);
  if (py::hasattr(from, "__fspath__")) return {py::str(from.attr("__fspath__")()).cast<std::string>()};
  // Arrays, scalars and series of numpy and others.
  if (py::hasattr(from, "tolist")) return convert(from.attr("tolist")(), depth + 1);
  if (PyNumber_Check(from.ptr()) != 0) return number_of(from);
  if (py::hasattr(from, "keys")) return table_of(from, depth);
  if (py::hasattr(from, "__iter__")) return array_of(from, depth);
  throw py::type_error("a scene contains numbers, strings, booleans, lists and dicts, not " +
                       py::repr(from).cast<std::string>());
}

}  // namespace

config::Value to_value(py::handle from) {
  return convert(from, 0);
}

py::object to_python(const config::Value& value) {
  if (const bool* flag = std::get_if<bool>(&value.data)) return py::bool_(*flag);
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return py::int_(*integer);
  if (const double* number = std::get_if<double>(&value.data)) return py::float_(*number);
  if (const std::string* text = value.text()) return py::str(*text);
  if (const config::Array* array = value.array()) {
    py::list list;
    for (const config::Value& item : *array) list.append(to_python(item));
    return list;
  }
  py::dict dict;
  for (const auto& [key, item] : value.table()->entries) dict[py::str(key)] = to_python(item);
  return dict;
}

}  // namespace butee::python
