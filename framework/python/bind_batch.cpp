#include <pybind11/stl.h>

#include "butee/core/error.hpp"
#include "butee/python/batch.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/values.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using namespace std::chrono_literals;

/// Interval between checks for Ctrl-C.
constexpr auto kPatience = 50ms;

/// Joins the threads without the interpreter's lock.
struct Joined {
  void operator()(Batch* batch) const {
    const WithoutInterpreter unlocked;
    delete batch;
  }
};

std::unique_ptr<Batch, Joined> start(const Session& session, std::vector<std::string> keys, const py::list& points,
                                     std::size_t threads) {
  std::vector<Batch::Values> values;
  for (const py::handle point : points) {
    auto& row = values.emplace_back();
    for (const py::handle value : point) row.push_back(value.is_none() ? std::nullopt : std::optional(to_value(value)));
    if (row.size() != keys.size()) throw py::value_error("a point must have one value for each key");
  }
  return std::unique_ptr<Batch, Joined>(new Batch(session, std::move(keys), std::move(values), threads));
}

/// (point, outcome), or (point, exception) for bad input; None at the end.
py::object next(Batch& batch) {
  std::optional<Batch::Done> done;
  while (!done) {
    if (batch.taken() == batch.size()) return py::none();
    {
      const WithoutInterpreter unlocked;
      done = batch.next(kPatience);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  if (done->error == nullptr) return py::make_tuple(done->point, done->outcome);
  std::rethrow_exception(done->error);
}

}  // namespace

void bind_batch(py::module_& module) {
  using Pointer = std::unique_ptr<Batch, Joined>;
  module.def("batch", [](const Session& session, std::vector<std::string> keys, const py::list& points,
                         std::size_t threads) { return start(session, std::move(keys), points, threads); });
  py::class_<Batch, Pointer> batch(module, "Batch");
  batch.def("next", &next);
  seal(batch);
}

}  // namespace butee::python
