#include "butee/run/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <numbers>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/record/field_layout.hpp"
#include "butee/run/load_steps.hpp"

namespace butee::run {
namespace {

using Clock = std::chrono::steady_clock;

/// The ratio of a stop's force to the residual force of open stops above which the stop counts as
/// closed.
constexpr double kMoreThanPull = 1.1;

/// More rows would make a run deaf to interruptions for longer than a tenth of a second.
constexpr double kMostRowsInStep = 65536.0;

/// The largest residual force of an open stop, N; nonzero for the arctan law.
double largest_pull(const dynamics::ElasticStops& contact) {
  double largest = 0.0;
  for (Index i = 0; i < contact.size(); ++i) largest = std::max(largest, contact.law_of(i).asymptotic_force());
  return largest;
}

}  // namespace

Run::Run(scene::Scene& scene, bool with_progress) : Run(scene, with_progress, Clock::now()) {}

Run::Run(scene::Scene& scene, bool with_progress, Clock::time_point begin)
    : scene_(scene), with_progress_(with_progress), assembly_(scene) {
  assembly_.simulation.start();
  summary_.setup_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
}

record::Summary Run::perform(const record::ResultFolder* folder, const record::Checkpoint* from) {
  guarded([&] {
    attach_observers(folder, from);
    integrate();
  });
  // Also for a run that ended early: computed results are kept.
  if (folder != nullptr) write_files(*folder);
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
    fail("an exception that is not a std::exception was thrown");
  }
}

void Run::attach_observers(const record::ResultFolder* folder, const record::Checkpoint* from) {
  const model::OutputRequest& output = scene_.output;
  const double end_time = scene_.integrator.options.end_time;
  const auto open = [&](std::optional<record::CsvWriter>& writer, const char* name, std::vector<std::string> columns) {
    if (from != nullptr)
      writer.emplace(folder->file(name));
    else
      writer.emplace(folder->file(name), columns);
  };
  if (folder != nullptr && output.csv) open(writer_, "history.csv", record::HistoryRecorder::columns(output));
  time::Simulation& simulation = assembly_.simulation;
  if (output.interval) simulation.limit_steps(kMostRowsInStep * *output.interval);
  history_.emplace(output, end_time, assembly_.dynamics, writer_ ? &*writer_ : nullptr);
  if (other_history_ != nullptr) history_->also_to(*other_history_);
  simulation.add(*history_);
  if (output.energy) {
    if (folder != nullptr) open(energy_writer_, "energy.csv", record::EnergyRecorder::columns());
    const record::OutputTimes times(output.interval, output.every, end_time);
    energy_.emplace(assembly_.dynamics, energy_writer_ ? &*energy_writer_ : nullptr, times);
    if (other_energy_ != nullptr) energy_->also_to(*other_energy_);
    simulation.add(*energy_);
  }
  if (output.impacts) simulation.add(impacts_.emplace(assembly_.dynamics));
  if (assembly_.dynamics.obstacles() != nullptr) simulation.add(contacts_.emplace(assembly_.dynamics));
  if (contacts_ && tolerance_of(scene_.integrator, scene_.integrator.name))
    simulation.add(slips_.emplace(assembly_.dynamics));
  if (with_progress_) simulation.add(progress_.emplace(assembly_.dynamics, end_time));
  if (folder != nullptr && !output.fields.formats.empty()) add_fields(*folder);
  states_.emplace(output.states, assembly_.dynamics);
  if (!output.states.empty()) simulation.add(*states_);
  if (folder != nullptr && writer_ && output.checkpoint > 0)
    simulation.add(checkpointer_.emplace(scene_, assembly_, *folder, *writer_));
  if (checkpointer_ && energy_writer_) checkpointer_->also_sync(*energy_writer_);
  if (from != nullptr) simulation.restore(from->snapshot);
  if (!checkpointer_) return;
  if (from != nullptr) {
    summary_.setup_seconds += from->setup_seconds;
    checkpointer_->go_on_from(*from);
  }
  checkpointer_->set_setup_seconds(summary_.setup_seconds);
}

void Run::add_fields(const record::ResultFolder& folder) {
  const model::OutputRequest& output = scene_.output;
  model::FieldLayout layout = record::make_layout(scene_.model, assembly_.system, output.fields);
  layout.columns = record::HistoryRecorder::columns_with_units(output, &scene_.model);
  std::vector<std::unique_ptr<model::FieldWriter>> writers;
  for (const std::string& name : output.fields.formats)
    writers.push_back(find_type(scene_.catalogue.types().formats, name)->make(folder.path(), layout));
  for (const auto& writer : writers) history_->also_to(*writer);
  assembly_.simulation.add(
      fields_.emplace(output, scene_.integrator.options.end_time, assembly_.dynamics, std::move(writers)));
}

std::vector<record::Impact> Run::impacts() const {
  if (!impacts_) return {};
  std::vector<record::Impact> impacts = impacts_->impacts();
  if (contacts_) {
    const std::vector<record::Impact> more = contacts_->impacts();
    impacts.insert(impacts.end(), more.begin(), more.end());
    std::stable_sort(impacts.begin(), impacts.end(), [](const auto& a, const auto& b) { return a.t_in < b.t_in; });
  }
  return impacts;
}

void Run::integrate() {
  const char* signal = nullptr;
  summary_.report = assembly_.simulation.run([&] {
    signal = interruption_ ? interruption_() : nullptr;
    if (checkpointer_ && (signal != nullptr || checkpointer_->is_due())) checkpointer_->write();
    return signal == nullptr && !(is_enough_ && is_enough_());
  });
  if (signal != nullptr)
    fail("interrupted by " + std::string(signal) + " after t = " + to_short_text(summary_.report.t_end) + " s");
}

void Run::fail(const std::string& reason) {
  if (!summary_.report.completed && !summary_.report.message.empty()) return;  // The first reason is kept.
  summary_.report = assembly_.simulation.report();
  summary_.report.completed = false;
  summary_.report.message = reason;
}

void Run::summarize() {
  summary_.integrator = scene_.integrator.name;
  summary_.choice = assembly_.integrator->choice();
  summary_.counters = checkpointer_ ? checkpointer_->counters() : assembly_.dynamics.counters();
  summary_.dofs = assembly_.dynamics.size();
  summary_.contacts = assembly_.dynamics.contact_count();
  if (history_) summary_.peaks = history_->peaks();
  summary_.energy = record::energy_of(assembly_.simulation.state(), assembly_.dynamics);
  if (energy_) summary_.followed = {energy_->work(), energy_->dissipated(), energy_->balance_error()};
  look_at_slips();
  look_at_balance();
  look_at_loads();
  look_at_stability();
  look_at_rows();
}

void Run::look_at_slips() {
  if (!slips_) return;
  const std::string complaint = slips_->complaint(*tolerance_of(scene_.integrator, scene_.integrator.name));
  if (!complaint.empty()) summary_.report.warnings.push_back(complaint);
}

void Run::look_at_loads() {
  if (assembly_.integrator->controller() != nullptr) return;
  const auto& options = scene_.integrator.options;
  const std::string complaint = complaint_of_loads(assembly_.system, options.time_step, options.end_time);
  if (!complaint.empty()) summary_.report.warnings.push_back(complaint);
}

void Run::look_at_balance() {
  constexpr double kOutOfBalance = 1e-2;  // of the largest energy (chosen)
  if (!summary_.followed || !summary_.report.completed) return;
  const double error = summary_.followed->balance_error;
  if (std::abs(error) > kOutOfBalance)
    summary_.report.warnings.push_back(
        "the energy balance is wrong by " + to_short_text(std::abs(error)) +
        " times the largest energy, and so are the work and the dissipated energy: steps of " + scene_.integrator.name +
        " do not resolve all motion with power. Take shorter steps, or a method with error control, such as auto");
}

void Run::look_at_stability() {
  // The eigenvalues of larger systems may take longer than the run.
  constexpr Index kSmall = 100;
  if (assembly_.integrator->controller() != nullptr || assembly_.dynamics.size() > kSmall || !summary_.report.completed)
    return;
  const auto& [h, end_time, of_type] = scene_.integrator.options;
  time::MethodLimits limits = of_type;
  limits.stability = std::min(limits.stability, assembly_.integrator->traits().stability_limit);
  const auto critical = time::critical_steps(assembly_.dynamics, limits);
  if (critical && h > critical->closed)
    summary_.report.warnings.push_back(time::describe_remedy(assembly_.dynamics, limits, h));
}

void Run::look_at_rows() {
  const model::OutputRequest& output = scene_.output;
  if (!output.interval || output.impacts) return;
  const double pull = largest_pull(assembly_.dynamics.stops());
  const bool has_struck = std::any_of(summary_.peaks.begin(), summary_.peaks.end(), [&](const auto& peak) {
    return peak.first.ends_with(".contact_force") && peak.second > kMoreThanPull * pull;
  });
  if (!has_struck) return;
  const double contact = dynamics::shortest_impact(assembly_.system);
  if (*output.interval * kRowsInContact <= contact) return;
  summary_.report.warnings.push_back("an impact can be as short as " + to_short_text(contact) +
                                     " s and history.csv has a row every " + to_short_text(*output.interval) +
                                     " s, too few to resolve its force. Take interval = " +
                                     to_short_text(contact / (2.5 * kRowsInContact)) + ", or impacts = true");
}

void Run::write_files(const record::ResultFolder& folder) {
  // One file that cannot be written leaves the others whole.
  guarded([&] {
    if (writer_) writer_->close();
  });
  guarded([&] {
    if (energy_writer_) energy_writer_->close();
  });
  guarded([&] {
    if (!impacts_) return;
    record::CsvWriter writer(folder.file("impacts.csv"), record::ImpactRecorder::columns());
    for (const record::Impact& impact : impacts()) writer.line(record::ImpactRecorder::csv_line(impact));
    writer.close();
  });
  guarded([&] {
    if (!contacts_) return;
    record::CsvWriter writer(folder.file("wear.csv"), record::ContactRecorder::wear_columns());
    for (const record::ContactWear& wear : contacts_->wear()) writer.line(contacts_->wear_line(wear));
    writer.close();
  });
  guarded([&] {
    if (fields_) fields_->finish();
  });
  guarded([&] {
    if (assembly_.simulation.report().completed)
      states_->write(folder.file(model::SavedMotions::kFile), assembly_.simulation.state());
  });
}

}  // namespace butee::run
