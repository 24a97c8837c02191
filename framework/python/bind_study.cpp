#include <pybind11/stl.h>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/memory_rows.hpp"
#include "butee/python/session.hpp"
#include "butee/python/values.hpp"
#include "butee/study/perform.hpp"
#include "butee/study/store.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using Bytes = std::vector<std::byte>;

/// Checks for Ctrl-C and calls `progress(done, runs)`, while threads continue without the
/// interpreter's lock.
class StudyWatch {
 public:
  explicit StudyWatch(py::object progress) : progress_(std::move(progress)) {}

  void report(const study::Progress& now) {
    with_interpreter([&] {
      if (error_) return;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!progress_.is_none()) call(progress_, py::make_tuple(now.done, now.total));
      } catch (py::error_already_set& error) {
        error_.emplace(error);
      }
    });
  }
  bool goes_on() const { return !error_; }
  void rethrow() {
    if (!error_) return;
    py::error_already_set error = *error_;
    error_.reset();
    throw error;
  }

 private:
  py::object progress_;
  std::optional<py::error_already_set> error_;
};

Bytes in_memory(const study::Study& study, const study::Layout& layout, const study::PerformOptions& options) {
  MemoryRows rows(study.plan.run_count(), layout);
  (void)study::perform(study, layout, rows, options);
  return rows.take();
}

/// Destination of the rows.
struct Kept {
  std::string folder{};  ///< empty: in memory only
  std::string format{};  ///< empty: hdf5 if available
  bool fresh = false;
};

/// Like `butee study -o FOLDER`.
Bytes in_folder(const study::Study& study, const study::Layout& layout, const study::PerformOptions& options,
                const Kept& kept) {
  const std::string& folder = kept.folder;
  const auto format = study::row_format(kept.format);
  study::Store store(folder, study, layout, *format);
  store.open(kept.fresh);
  if (!store.is_complete() && store.done_count() < study.plan.run_count()) {
    store.begin(store.next_session(), 0);
    if (!study::perform(study, layout, store, options)) return {};
  }
  std::int64_t missing = 0;
  if (!store.merge(missing)) throw RunError(folder + ": run " + std::to_string(missing) + " is missing");
  MemoryRows rows(study.plan.run_count(), layout);
  store.visit([&](const study::Row& row) { rows.append(row); });
  return rows.take();
}

/// (name, unit, format, offset) of each column, with numpy's format.
py::list columns_of(const study::Layout& layout) {
  using Type = study::Column::Type;
  py::list columns;
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    const study::Column& column = layout.columns()[i];
    const std::string length = std::to_string(column.length);
    const std::string format = column.type == Type::text      ? "S" + length
                               : column.type == Type::integer ? "<i8"
                               : column.length == 1           ? "<f8"
                                                              : "(" + length + ",)<f8";
    columns.append(py::make_tuple(column.name, column.unit, format, layout.offset(i)));
  }
  return columns;
}

/// The columns, the bytes of a row, and rows in the order of the plan.
py::tuple table_of(const study::Layout& layout, const Bytes& rows) {
  return py::make_tuple(columns_of(layout), layout.row_bytes(),
                        py::bytes(reinterpret_cast<const char*>(rows.data()), rows.size()));
}

/// For the result "trust": calls a Python function with a scene, from any thread.
std::optional<double> horizon_of(const scene::Scene& scene, const Session& session, const py::function& horizon) {
  const Session judged(scene.document, session.plugins(), scene.catalogue);
  return with_interpreter([&] {
    try {
      return call(horizon, py::make_tuple(judged)).cast<double>();
    } catch (py::error_already_set& error) {
      throw RunError(error.what());
    }
  });
}

py::tuple run_study(const Session& session, py::handle tables, int threads, const Kept& kept,
                    const py::function& horizon, py::object progress) {
  const config::Document document{{"study"}, to_value(tables)};
  const auto scene = session.shared();
  const config::Document scene_document = session.document();
  StudyWatch watch(std::move(progress));
  study::PerformOptions options;
  options.threads = threads;
  options.report = [&](const study::Progress& now) { watch.report(now); };
  options.goes_on = [&] { return watch.goes_on(); };
  std::optional<study::Layout> layout;
  Bytes rows;
  {
    const WithoutInterpreter unlocked;
    study::StudyOptions study_options;
    study_options.horizon = [&](scene::Scene& judged) { return horizon_of(judged, session, horizon); };
    study::Study study = study::read_study(document, scene_document, study_options);
    study.catalogue = scene->catalogue;
    study::check_points(study);
    layout.emplace(layout_of(study));
    rows = kept.folder.empty() ? in_memory(study, *layout, options) : in_folder(study, *layout, options, kept);
  }
  watch.rethrow();
  return table_of(*layout, rows);
}

/// The same for the rows that are in a folder so far.
py::tuple study_rows(const std::string& folder) {
  std::optional<study::Layout> layout;
  Bytes rows;
  {
    const WithoutInterpreter unlocked;
    const study::Study study = study::Store::read(folder);
    layout.emplace(layout_of(study));
    const auto format = study::row_format(study::Store::extension_in(folder) == ".csv" ? "csv" : "hdf5");
    study::Store store(folder, study, *layout, *format);
    store.adopt_identity();
    store.look();
    store.visit([&](const study::Row& row) { rows.insert(rows.end(), row.bytes().begin(), row.bytes().end()); });
  }
  return table_of(*layout, rows);
}

}  // namespace

void bind_study(py::module_& module) {
  module.def("study", [](const Session& session, py::handle tables, int threads, const std::string& folder,
                         const std::string& format, bool fresh, const py::function& horizon, py::object progress) {
    return run_study(session, tables, threads, {folder, format, fresh}, horizon, std::move(progress));
  });
  module.def("study_rows", &study_rows);
  py::list kinds;
  for (const study::ItemKind& kind : study::item_kinds()) kinds.append(py::make_tuple(kind.name, kind.summary));
  module.attr("study_results") = kinds;
}

}  // namespace butee::python
