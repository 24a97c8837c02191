#include "butee/record/history.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"

namespace butee::record {
namespace {

using Clock = std::chrono::steady_clock;

/// Number of rows of one step that are interpolated together.
constexpr std::size_t kMostAtOnce = 64;

/// The requested quantities that Peaks records, and u of every probe.
std::vector<model::ProbeRequest> peak_requests(std::vector<model::ProbeRequest> requests, const model::System& system) {
  const model::DofTable& dofs = system.dofs;
  const model::Model* model = system.model;
  for (model::ProbeRequest& request : requests) {
    auto& list = request.quantities;
    std::erase_if(list, [&](model::Quantity quantity) {
      return is_element_force(quantity) || Probes::has_base_share(model, dofs, request.node, quantity);
    });
    const bool has_u = std::find(list.begin(), list.end(), model::Quantity::u) != list.end();
    if (!has_u && dofs.exists({request.node, DofKind::u}) &&
        !Probes::has_base_share(model, dofs, request.node, model::Quantity::u))
      list.push_back(model::Quantity::u);
  }
  return requests;
}

}  // namespace

HistoryRecorder::HistoryRecorder(const model::OutputRequest& request, double end_time, dynamics::Dynamics& dynamics,
                                 CsvWriter* writer)
    : times_(request.interval, request.every, end_time),
      probes_(request.probes, dynamics),
      peaks_(peak_requests(request.probes, dynamics.system()), dynamics),
      contact_peaks_(SampledPeaks::Kind::contacts, request.probes, dynamics),
      framed_peaks_(SampledPeaks::Kind::other_frame, request.probes, dynamics),
      writer_(writer),
      values_(probes_.columns().size()),
      largest_(values_.size(), 0.0) {
  due_.reserve(kMostAtOnce);
}

std::vector<std::string> HistoryRecorder::columns(const model::OutputRequest& request) {
  std::vector<std::string> names;
  for (const model::Field& column : columns_with_units(request, nullptr)) names.push_back(column.name);
  return names;
}

std::vector<model::Field> HistoryRecorder::columns_with_units(const model::OutputRequest& request,
                                                              const model::Model* model) {
  std::vector<model::Field> all = {{"t", "s"}};
  for (const model::ProbeRequest& probe : request.probes)
    for (const model::Quantity quantity : probe.quantities)
      all.push_back({probe.label + "." + name_of(quantity),
                     model != nullptr ? unit_at(*model, probe.node, quantity) : unit_of(quantity)});
  all.push_back({"h", "s"});
  return all;
}

void HistoryRecorder::start(const time::State& state) {
  start_time_ = state.t;
  probes_.evaluate(state, values_);
  first_row_ = values_;
  peaks_.start(state);
  contact_peaks_.start(state);
  framed_peaks_.start(state);
  std::fill(largest_.begin(), largest_.end(), 0.0);
}

void HistoryRecorder::step(const time::AcceptedStep& step) {
  peaks_.step(step);
  contact_peaks_.step(step);
  framed_peaks_.step(step);
  due_.clear();
  times_.visit(step, [&](double t) {
    if (t == step.from.t) {
      values_ = first_row_;
      return write_row(t, step.h);
    }
    due_.push_back(t);
    if (due_.size() == kMostAtOnce) write_due(step);
  });
  write_due(step);
}

void HistoryRecorder::write_due(const time::AcceptedStep& step) {
  if (due_.empty()) return;
  probes_.sample(step, due_);
  for (std::size_t i = 0; i < due_.size(); ++i) {
    probes_.take(i, values_);
    write_row(due_[i], step.h);
  }
  due_.clear();
}

void HistoryRecorder::write_row(double t, double h) {
  take_largest();
  if (writer_ == nullptr && writers_.empty()) return;
  row_.assign(1, t);
  row_.insert(row_.end(), values_.begin(), values_.end());
  row_.push_back(h);
  if (writer_ != nullptr) writer_->row(row_);
  if (writers_.empty()) return;
  const auto begin = Clock::now();
  for (model::FieldWriter* writer : writers_) writer->append_row(row_);
  seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
}

void HistoryRecorder::take_largest() {
  for (std::size_t i = 0; i < values_.size(); ++i) largest_[i] = std::max(largest_[i], std::abs(values_[i]));
}

void HistoryRecorder::finish() {
  if (!times_.begun()) {
    values_ = first_row_;
    write_row(start_time_, 0.0);
  }
  if (writer_ != nullptr) writer_->flush();
}

void HistoryRecorder::save(ByteWriter& to) const {
  times_.save(to);
  to.put(first_row_);
  to.put(largest_);
  peaks_.save(to);
  contact_peaks_.save(to);
  framed_peaks_.save(to);
  to.put(writer_ != nullptr ? writer_->position() : std::uint64_t{0});
}

void HistoryRecorder::restore(ByteReader& from) {
  times_.restore(from);
  from.take(first_row_);
  from.take(largest_);
  require(first_row_.size() == values_.size() && largest_.size() == values_.size(), "a history of these probes");
  peaks_.restore(from);
  contact_peaks_.restore(from);
  framed_peaks_.restore(from);
  const auto position = from.take<std::uint64_t>();
  if (writer_ != nullptr) writer_->go_back(position);
}

std::map<std::string, double> HistoryRecorder::peaks() const {
  std::map<std::string, double> peaks = peaks_.largest();
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    double& peak = peaks[probes_.columns()[i]];
    peak = std::max(peak, largest_[i]);
  }
  contact_peaks_.add_to(peaks);
  framed_peaks_.add_to(peaks);
  return peaks;
}

}  // namespace butee::record
