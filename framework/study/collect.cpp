#include "butee/study/collect.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "butee/record/impacts.hpp"
#include "butee/record/peaks.hpp"
#include "butee/record/probes.hpp"
#include "butee/record/quadrature.hpp"

namespace butee::study {
namespace {

using Kind = Item::Kind;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// Samples of a spectrum: for each period, at least and at most.
constexpr double kSamplesPerPeriod = 64.0, kFewestSamples = 4096.0, kMostSamples = 262144.0;
/// An instant of a section that a step misses by this part of a period is its end.
constexpr double kSameInstant = 1e-12;

/// The frequency of the largest line, between lines by a parabola through the logarithms of three (Hann's window).
double dominant_frequency(std::vector<double> signal, double dt) {
  const auto n = static_cast<double>(signal.size());
  double mean = 0.0;
  for (const double value : signal) mean += value / n;
  for (std::size_t i = 0; i < signal.size(); ++i)
    signal[i] = (signal[i] - mean) * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / n));
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, signal);
  std::size_t best = 1;
  for (std::size_t k = 2; k + 1 <= signal.size() / 2; ++k)
    if (std::norm(lines[k]) > std::norm(lines[best])) best = k;
  const double a = std::abs(lines[best - 1]), b = std::abs(lines[best]), c = std::abs(lines[best + 1]);
  if (!(b > 0.0)) return kNothing;
  double offset = 0.0;
  if (best > 1 && a > 0.0 && c > 0.0) offset = 0.5 * std::log(a / c) / std::log(a * c / (b * b));
  return (static_cast<double>(best) + offset) / (n * dt);
}

}  // namespace

/// Observes one kind of results, for all items that ask for it.
class Collector::Part : public time::Observer {
 public:
  virtual std::vector<double> values(std::size_t item) const = 0;
};

class Collector::PeakPart final : public Part {
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

/// Largest and smallest values of motion.
class Collector::RangePart final : public Part {
 public:
  RangePart(const std::vector<model::ProbeRequest>& probes, const std::vector<bool>& is_max,
            dynamics::Dynamics& dynamics)
      : is_max_(is_max), ranges_(probes.size()) {
    for (const model::ProbeRequest& probe : probes) {
      const Index dof = dynamics.system().dofs.index({probe.node, kind_of(probe.quantities[0])});
      tracks_.push_back(all_.add(dof >= 0 ? dof : -1, -1));
      orders_.push_back(static_cast<std::size_t>(order_of(probe.quantities[0])));
    }
  }
  void start(const time::State& state) override {
    for (std::size_t i = 0; i < ranges_.size(); ++i)
      ranges_[i].take(state.t, all_.at(state, tracks_[i]).of[orders_[i]]);
  }
  void step(const time::AcceptedStep& step) override {
    all_.visit(step, [&] {
      for (std::size_t i = 0; i < ranges_.size(); ++i)
        all_.course(step, tracks_[i]).extend(orders_[i], all_.from(tracks_[i]), all_.to(tracks_[i]), ranges_[i]);
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

/// Means, by Gauss' rule between the knots of each step, values at the end, and the largest values of forces of
/// elements, at the same instants.
class Collector::MeanPart final : public Part {
 public:
  MeanPart(const std::vector<model::ProbeRequest>& probes, const std::vector<Kind>& kinds, dynamics::Dynamics& dynamics,
           const Counted& counted)
      : probes_(probes, dynamics), kinds_(kinds), span_(counted.end - counted.begin), row_(probes.size()) {
    sums_ = squares_ = largest_ = last_ = std::vector<double>(probes.size(), 0.0);
  }
  void start(const time::State& state) override {
    probes_.evaluate(state, row_);
    last_ = row_;
    for (std::size_t i = 0; i < row_.size(); ++i) largest_[i] = std::abs(row_[i]);
  }
  void step(const time::AcceptedStep& step) override {
    times_.clear();
    weights_.clear();
    double begin = step.from.t;
    const auto piece = [&](double end) {
      for (const auto& [t, weight] : record::gauss_points(begin, end)) {
        times_.push_back(t);
        weights_.push_back(weight);
      }
      begin = end;
    };
    for (const double knot : step.integrator.knots(step.from, step.to)) piece(knot);
    piece(step.to.t);
    times_.push_back(step.to.t);
    weights_.push_back(0.0);
    probes_.sample(step, times_);
    for (std::size_t k = 0; k < times_.size(); ++k) {
      probes_.take(k, row_);
      for (std::size_t i = 0; i < row_.size(); ++i) {
        sums_[i] += weights_[k] * row_[i];
        squares_[i] += weights_[k] * row_[i] * row_[i];
        largest_[i] = std::max(largest_[i], std::abs(row_[i]));
      }
    }
    last_ = row_;
  }
  std::vector<double> values(std::size_t item) const override {
    switch (kinds_[item]) {
      case Kind::mean:
        return {sums_[item] / span_};
      case Kind::rms:
        return {std::sqrt(squares_[item] / span_)};
      case Kind::peak:
        return {largest_[item]};
      default:
        return {last_[item]};
    }
  }

 private:
  record::Probes probes_;
  std::vector<Kind> kinds_;
  double span_;
  std::vector<double> row_, sums_, squares_, largest_, last_, times_, weights_;
};

class Collector::SectionPart final : public Part {
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
    all.resize(static_cast<std::size_t>(counted_.periods), kNothing);
    return all;
  }

 private:
  double instant(std::int64_t i) const {
    return i + 1 == counted_.periods ? std::min(counted_.end, after(i)) : after(i);
  }
  double after(std::int64_t i) const { return counted_.begin + static_cast<double>(i + 1) * counted_.period; }

  record::Probes probes_;
  Counted counted_;
  std::int64_t taken_ = 0;
  std::vector<double> row_;
  std::vector<std::vector<double>> values_;
};

class Collector::FrequencyPart final : public Part {
 public:
  FrequencyPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics, const Counted& counted)
      : probes_(probes, dynamics), counted_(counted), row_(probes.size()), values_(probes.size()) {
    const double wanted =
        std::clamp(kSamplesPerPeriod * static_cast<double>(counted.periods), kFewestSamples, kMostSamples);
    count_ = std::int64_t{1} << static_cast<int>(std::ceil(std::log2(wanted)));
    dt_ = (counted.end - counted.begin) / static_cast<double>(count_);
  }
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
  std::vector<double> values(std::size_t item) const override {
    if (taken_ < count_) return {kNothing};
    return {dominant_frequency(values_[item], dt_)};
  }

 private:
  double instant() const { return counted_.begin + (static_cast<double>(taken_) + 0.5) * dt_; }

  record::Probes probes_;
  Counted counted_;
  std::int64_t count_ = 0, taken_ = 0;
  double dt_ = 0.0;
  std::vector<double> row_, times_;
  std::vector<std::vector<double>> values_;
};

class Collector::ImpactPart final : public Part {
 public:
  ImpactPart(dynamics::Dynamics& dynamics, const Counted& counted) : impacts_(dynamics), begin_(counted.begin) {}
  void start(const time::State& state) override { impacts_.start(state); }
  void step(const time::AcceptedStep& step) override { impacts_.step(step); }
  std::vector<double> values(std::size_t) const override {
    const auto all = impacts_.impacts();
    return {static_cast<double>(
        std::count_if(all.begin(), all.end(), [&](const record::Impact& impact) { return impact.t_in > begin_; }))};
  }

 private:
  record::ImpactRecorder impacts_;
  double begin_;
};

Collector::Collector(const std::vector<Item>& items, const scene::Scene& scene, dynamics::Dynamics& dynamics,
                     const Counted& counted)
    : places_(items.size(), {nullptr, 0}) {
  const auto add = [&](const std::vector<std::size_t>& chosen, std::unique_ptr<Part> part) {
    for (std::size_t i = 0; i < chosen.size(); ++i) places_[chosen[i]] = {part.get(), i};
    parts_.push_back(std::move(part));
  };
  const auto chosen_by = [&](auto is_chosen) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < items.size(); ++i)
      if (is_chosen(items[i])) chosen.push_back(i);
    return chosen;
  };
  const auto probes_of = [&](const std::vector<std::size_t>& chosen) {
    std::vector<model::ProbeRequest> probes;
    for (const std::size_t i : chosen) probes.push_back(probe_of(items[i], scene));
    return probes;
  };
  const auto is_rough_peak = [](const Item& item) {
    return item.kind == Kind::peak && is_element_force(item.quantity);
  };

  if (const auto chosen = chosen_by([&](const Item& i) { return i.kind == Kind::peak && !is_rough_peak(i); });
      !chosen.empty())
    add(chosen, std::make_unique<PeakPart>(probes_of(chosen), dynamics));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::max || i.kind == Kind::min; });
      !chosen.empty()) {
    std::vector<bool> is_max;
    for (const std::size_t i : chosen) is_max.push_back(items[i].kind == Kind::max);
    add(chosen, std::make_unique<RangePart>(probes_of(chosen), is_max, dynamics));
  }
  if (const auto chosen = chosen_by([&](const Item& i) {
        return i.kind == Kind::mean || i.kind == Kind::rms || i.kind == Kind::end || is_rough_peak(i);
      });
      !chosen.empty()) {
    std::vector<Kind> kinds;
    for (const std::size_t i : chosen) kinds.push_back(items[i].kind);
    add(chosen, std::make_unique<MeanPart>(probes_of(chosen), kinds, dynamics, counted));
  }
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::section; }); !chosen.empty())
    add(chosen, std::make_unique<SectionPart>(probes_of(chosen), dynamics, counted));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::frequency; }); !chosen.empty())
    add(chosen, std::make_unique<FrequencyPart>(probes_of(chosen), dynamics, counted));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::impacts; }); !chosen.empty()) {
    add({chosen.front()}, std::make_unique<ImpactPart>(dynamics, counted));
    for (const std::size_t i : chosen) places_[i] = places_[chosen.front()];
  }
}

Collector::~Collector() = default;

void Collector::open(const time::State& state) {
  is_open_ = true;
  for (const auto& part : parts_) part->start(state);
}

void Collector::step(const time::AcceptedStep& step) {
  if (!is_open_) return;
  for (const auto& part : parts_) part->step(step);
}

double Collector::next_instant(double t) const {
  double next = std::numeric_limits<double>::infinity();
  if (is_open_)
    for (const auto& part : parts_) next = std::min(next, part->next_instant(t));
  return next;
}

std::vector<double> Collector::values(std::size_t item) const {
  const auto [part, place] = places_[item];
  return part != nullptr ? part->values(place) : std::vector<double>{};
}

}  // namespace butee::study
