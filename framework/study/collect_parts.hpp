#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "butee/record/contact_recorder.hpp"
#include "butee/record/history.hpp"
#include "butee/record/peaks.hpp"
#include "butee/record/probes.hpp"
#include "butee/study/collect.hpp"

// Private to this folder: the observers of single kinds of results. Counted must outlive them; its
// beginning is known from the first step on.
namespace butee::study {

/// Observes one kind of results for all items that request it.
class CollectorPart : public time::Observer {
 public:
  virtual std::vector<double> values(std::size_t item) const = 0;
};

class PeakPart final : public CollectorPart {
 public:
  PeakPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics) : peaks_(probes, dynamics) {
    for (const model::ProbeRequest& probe : probes) names_.push_back(probe.label + "." + name_of(probe.quantities[0]));
  }
  void start(const time::State& state) override { peaks_.start(state); }
  void step(const time::AcceptedStep& step) override { peaks_.step(step); }
  std::vector<double> values(std::size_t item) const override { return {peaks_.largest().at(names_[item])}; }

 private:
  record::Peaks peaks_;
  std::vector<std::string> names_;
};

/// Peaks of forces of elements and contacts, and of motion measured in another frame, computed as
/// in a run with 64 rows a period.
class SampledPeakPart final : public CollectorPart {
 public:
  SampledPeakPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics, const Counted& counted);
  void start(const time::State& state) override { history_.start(state); }
  void step(const time::AcceptedStep& step) override { history_.step(step); }
  std::vector<double> values(std::size_t item) const override { return {history_.peaks().at(names_[item])}; }

 private:
  record::HistoryRecorder history_;
  std::vector<std::string> names_;
};

/// Largest and smallest values of motion.
class RangePart final : public CollectorPart {
 public:
  RangePart(const std::vector<model::ProbeRequest>& probes, const std::vector<bool>& is_max,
            dynamics::Dynamics& dynamics)
      : is_max_(is_max), ranges_(probes.size()) {
    for (const model::ProbeRequest& probe : probes) {
      const Index dof = dynamics.system().dofs.index({probe.node, kind_of(probe.quantities[0])});
      orders_.push_back(static_cast<std::size_t>(order_of(probe.quantities[0])));
      tracks_.push_back(all_.add(dof >= 0 ? dof : -1, -1, orders_.back()));
    }
  }
  void start(const time::State& state) override {
    for (std::size_t i = 0; i < ranges_.size(); ++i)
      ranges_[i].take(state.t, all_.at(state, tracks_[i]).of[orders_[i]]);
  }
  void step(const time::AcceptedStep& step) override {
    all_.visit(step, [&] {
      for (std::size_t i = 0; i < ranges_.size(); ++i)
        all_.path(step, tracks_[i]).extend(orders_[i], all_.from(tracks_[i]), all_.to(tracks_[i]), ranges_[i]);
    });
  }
  std::vector<double> values(std::size_t item) const override {
    return {is_max_[item] ? ranges_[item].greatest : ranges_[item].least};
  }

 private:
  record::Tracks all_;
  std::vector<bool> is_max_;
  std::vector<std::size_t> tracks_, orders_;
  std::vector<record::Range> ranges_;
};

/// Means, by Gauss' rule with five points between the breakpoints of each step, and values at the
/// end. If the dense output is not a polynomial, intervals are halved until the rule gives the same
/// over both halves as over the whole.
class MeanPart final : public CollectorPart {
 public:
  MeanPart(const std::vector<model::ProbeRequest>& probes, const std::vector<Item::Kind>& kinds,
           dynamics::Dynamics& dynamics, const Counted& counted)
      : probes_(probes, dynamics),
        kinds_(kinds),
        span_(counted.end - counted.begin),
        longest_(counted.period > 0.0 ? 0.5 * counted.period : span_),
        row_(probes.size()) {
    total_.sums = total_.squares = last_ = std::vector<double>(probes.size(), 0.0);
  }
  void start(const time::State& state) override {
    probes_.evaluate(state, row_);
    last_ = row_;
  }
  void step(const time::AcceptedStep& step) override;
  std::vector<double> values(std::size_t item) const override {
    switch (kinds_[item]) {
      case Item::Kind::mean:
        return {total_.sums[item] / span_};
      case Item::Kind::rms:
        return {std::sqrt(total_.squares[item] / span_)};
      default:
        return {last_[item]};
    }
  }

 private:
  /// Integrals of values and of their squares over an interval.
  struct Integral {
    std::vector<double> sums, squares;
  };
  Integral integrate(const time::AcceptedStep& step, double begin, double end);
  void add(const time::AcceptedStep& step, double begin, double end, const Integral& whole, int halvings);
  bool are_same(const Integral& a, const Integral& b, double length) const;

  record::Probes probes_;
  std::vector<Item::Kind> kinds_;
  double span_, longest_;
  Integral total_;
  std::vector<double> row_, last_;
};

class SectionPart final : public CollectorPart {
  /// An instant of a section within this fraction of a period after the end of a step is taken at
  /// that end.
  static constexpr double kSameInstant = 1e-12;

 public:
  SectionPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics, const Counted& counted)
      : probes_(probes, dynamics), counted_(counted), row_(probes.size()), values_(probes.size()) {}
  void step(const time::AcceptedStep& step) override {
    const double slack = kSameInstant * counted_.period;
    while (taken_ < counted_.periods && instant(taken_) <= step.to.t + slack) {
      probes_.evaluate(step, std::min(instant(taken_), step.to.t), row_);
      for (std::size_t i = 0; i < row_.size(); ++i) values_[i].push_back(row_[i]);
      ++taken_;
    }
  }
  double next_instant(double) const override {
    return taken_ < counted_.periods ? instant(taken_) : std::numeric_limits<double>::infinity();
  }
  std::vector<double> values(std::size_t item) const override {
    std::vector<double> all = values_[item];
    all.resize(static_cast<std::size_t>(counted_.periods), std::numeric_limits<double>::quiet_NaN());
    return all;
  }

 private:
  double instant(std::int64_t i) const {
    return i + 1 == counted_.periods ? std::min(counted_.end, after(i)) : after(i);
  }
  double after(std::int64_t i) const { return counted_.begin + static_cast<double>(i + 1) * counted_.period; }

  record::Probes probes_;
  const Counted& counted_;
  std::int64_t taken_ = 0;
  std::vector<double> row_;
  std::vector<std::vector<double>> values_;
};

class FrequencyPart final : public CollectorPart {
 public:
  FrequencyPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics, const Counted& counted);
  void step(const time::AcceptedStep& step) override {
    times_.clear();
    while (taken_ < count_ && instant() <= step.to.t) {
      times_.push_back(instant());
      ++taken_;
    }
    if (times_.empty()) return;
    probes_.sample(step, times_);
    for (std::size_t k = 0; k < times_.size(); ++k) {
      probes_.take(k, row_);
      for (std::size_t i = 0; i < row_.size(); ++i) values_[i].push_back(row_[i]);
    }
  }
  std::vector<double> values(std::size_t item) const override;

 private:
  double instant() const { return counted_.begin + (static_cast<double>(taken_) + 0.5) * dt_; }

  record::Probes probes_;
  const Counted& counted_;
  std::int64_t count_ = 0, taken_ = 0;
  double dt_ = 0.0;
  std::vector<double> row_, times_;
  std::vector<std::vector<double>> values_;
};

/// Counts closings of stops and of contacts in the plane with dissipation or friction; adds up the
/// friction work of the latter.
class ContactPart final : public CollectorPart {
 public:
  ContactPart(const std::vector<Item::Kind>& kinds, dynamics::Dynamics& dynamics, const Counted& counted)
      : kinds_(kinds), impacts_(dynamics), counted_(counted) {
    if (dynamics.obstacles() != nullptr) contacts_.emplace(dynamics);
  }
  void start(const time::State& state) override {
    impacts_.start(state);
    if (contacts_) contacts_->start(state);
  }
  void step(const time::AcceptedStep& step) override {
    impacts_.step(step);
    if (contacts_) contacts_->step(step);
  }
  std::vector<double> values(std::size_t item) const override {
    if (kinds_[item] == Item::Kind::wear) {
      double work = 0.0;
      for (const record::ContactWear& wear : contacts_->wear()) work += wear.work;
      return {work};
    }
    const auto count = [&](const std::vector<record::Impact>& all) {
      return std::count_if(all.begin(), all.end(),
                           [&](const record::Impact& impact) { return impact.t_in > counted_.begin; });
    };
    return {static_cast<double>(count(impacts_.impacts()) + (contacts_ ? count(contacts_->impacts()) : 0))};
  }

 private:
  std::vector<Item::Kind> kinds_;
  record::ImpactRecorder impacts_;
  std::optional<record::ContactRecorder> contacts_;
  const Counted& counted_;
};

}  // namespace butee::study
