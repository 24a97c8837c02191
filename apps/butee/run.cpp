#include "run.hpp"

#include <chrono>
#include <exception>
#include <new>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "interruption.hpp"

namespace butee::app {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Run::Run(Session& session, bool with_progress) : Run(session, with_progress, Clock::now()) {}

Run::Run(Session& session, bool with_progress, Clock::time_point begin)
    : session_(session), with_progress_(with_progress), assembly_(session) {
  assembly_.simulation.start();
  summary_.setup_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
}

record::Summary Run::perform(const record::ResultFolder* folder, const record::Checkpoint* from) {
  guarded([&] {
    attach_observers(folder, from);
    integrate();
  });
  // Of a run that broke off too: what was computed is kept.
  if (folder != nullptr) guarded([&] { write_files(*folder); });
  summarize();
  return std::move(summary_);
}

template <class Work>
void Run::guarded(Work work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    fail("out of memory");
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("something was thrown that is no exception of the standard library");
  }
}

void Run::attach_observers(const record::ResultFolder* folder, const record::Checkpoint* from) {
  const record::OutputRequest& output = session_.output;
  const double end_time = session_.integrator.options.end_time;
  if (folder != nullptr) {
    const std::string path = folder->file("history.csv");
    if (from != nullptr)
      writer_.emplace(path);
    else
      writer_.emplace(path, record::HistoryRecorder::columns(output));
  }
  time::Simulation& simulation = assembly_.simulation;
  history_.emplace(output, end_time, assembly_.dynamics, writer_ ? &*writer_ : nullptr);
  simulation.add(*history_);
  if (output.energy) simulation.add(energy_.emplace(assembly_.dynamics));
  if (output.impacts) simulation.add(impacts_.emplace(assembly_.dynamics));
  if (with_progress_) simulation.add(progress_.emplace(end_time));
  if (folder != nullptr && output.checkpoint > 0)
    simulation.add(checkpointer_.emplace(session_, assembly_, *folder, *writer_));
  if (from != nullptr) simulation.restore(from->snapshot);
  if (!checkpointer_) return;
  if (from != nullptr) {
    summary_.setup_seconds += from->setup_seconds;
    checkpointer_->go_on_from(*from);
  }
  checkpointer_->set_setup_seconds(summary_.setup_seconds);
}

void Run::integrate() {
  const char* signal = nullptr;
  summary_.report = assembly_.simulation.run([&] {
    signal = interruption();
    if (checkpointer_ && (signal != nullptr || checkpointer_->is_due())) checkpointer_->write();
    return signal == nullptr;
  });
  if (signal != nullptr)
    fail("interrupted by " + std::string(signal) + " after t = " + to_short_text(summary_.report.t_end) + " s");
}

void Run::fail(const std::string& reason) {
  if (!summary_.report.completed && !summary_.report.message.empty()) return;  // The first reason is the reason.
  summary_.report = assembly_.simulation.report();
  summary_.report.completed = false;
  summary_.report.message = reason;
}

void Run::summarize() {
  summary_.integrator = session_.integrator.name;
  summary_.choice = assembly_.integrator->choice();
  summary_.counters = checkpointer_ ? checkpointer_->counters() : assembly_.dynamics.counters();
  summary_.dofs = assembly_.dynamics.size();
  summary_.contacts = assembly_.dynamics.stop_count();
  if (history_) summary_.peaks = history_->peaks();
  summary_.energy = record::energy_of(assembly_.simulation.state(), assembly_.dynamics);
  if (energy_) summary_.followed = {energy_->work(), energy_->dissipated(), energy_->balance_error()};
}

void Run::write_files(const record::ResultFolder& folder) {
  if (writer_) writer_->close();
  if (!impacts_) return;
  record::CsvWriter writer(folder.file("impacts.csv"), record::ImpactRecorder::columns());
  for (const record::Impact& impact : impacts_->impacts()) writer.line(record::ImpactRecorder::csv_line(impact));
  writer.close();
}

}  // namespace butee::app
