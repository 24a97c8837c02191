#include "followed_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/model/base_motion.hpp>
#include <butee/record/contact_recorder.hpp>
#include <butee/record/impacts.hpp>
#include <butee/record/output_times.hpp>
#include <butee/record/probes.hpp>
#include <butee/record/tracks.hpp>
#include <butee/scene/assembly.hpp>

#include "../interruption.hpp"
#include "../perturb.hpp"

namespace butee::app::trust {
namespace {

constexpr double kSameInstant = 1e-9;
/// The work of tracking a stop's displacement over a step, in operations of a DOF.
constexpr double kWatching = 100.0;
/// With fewer rows, events between rows would be missed.
constexpr double kFewestRows = 1000.0;
/// Rounding of displacements relative to themselves: near grazing, an error of the penetration.
constexpr double kRoundingOfPaths = 1e-14;
/// Most and fewest stored states, and most numbers in all of them.
constexpr double kMostStates = 1000.0, kFewestStates = 100.0, kMostNumbers = 1e6;

/// A displacement or rotation of a probe's node that is followed.
struct Followed {
  std::string label;
  model::NodeId node;
  model::Quantity quantity;
  DofKind kind;
  bool is_in_other_frame;  ///< beside a moving base, not that of the equations of motion
};

/// Those that the quantities of a probe belong to, relative to the base or in space; all that its node has, in the
/// frame of the equations of motion, if it asks for none.
std::vector<Followed> followed_by_probes(const scene::Scene& session, const model::System& system) {
  using model::Quantity;
  constexpr std::array<Quantity, kDofKinds> kRelative = {Quantity::ux, Quantity::u,  Quantity::uz,
                                                         Quantity::rx, Quantity::ry, Quantity::theta},
                                            kInSpace = {Quantity::ux_abs, Quantity::u_abs, Quantity::uz_abs,
                                                        Quantity::rx,     Quantity::ry,    Quantity::theta};
  const bool in_space = session.model.base_frame == model::BaseFrame::still;
  std::vector<Followed> all;
  for (const model::ProbeRequest& probe : session.output.probes) {
    const std::size_t before = all.size();
    const auto follow = [&](DofKind kind, bool absolute) {
      const Quantity quantity = (absolute ? kInSpace : kRelative)[static_cast<std::size_t>(kind)];
      // A rotation is the same in both frames.
      const bool is_known = std::any_of(all.begin() + static_cast<std::ptrdiff_t>(before), all.end(),
                                        [&](const Followed& other) { return other.quantity == quantity; });
      if (!is_known && system.dofs.index({probe.node, kind}) >= 0)
        all.push_back({probe.label, probe.node, quantity, kind,
                       record::Probes::has_base_share(&session.model, system.dofs, probe.node, quantity)});
    };
    const auto is_asked = [&](DofKind kind, bool absolute) {
      return std::any_of(probe.quantities.begin(), probe.quantities.end(), [&](Quantity quantity) {
        const bool is_motion = model::source_of(quantity) == model::Source::motion;
        return model::kind_of(quantity) == kind && (is_motion ? model::is_absolute(quantity) : in_space) == absolute;
      });
    };
    for (const DofKind kind : kAllDofKinds)
      for (const bool absolute : {false, true})
        if (is_asked(kind, absolute)) follow(kind, absolute);
    if (all.size() > before) continue;
    for (const DofKind kind : kAllDofKinds) follow(kind, in_space);
  }
  return all;
}

std::vector<model::ProbeRequest> requests(const std::vector<Followed>& followed) {
  std::vector<model::ProbeRequest> probes;
  for (const Followed& one : followed) probes.push_back({one.label, one.node, {one.quantity}});
  return probes;
}

/// Records the probes at the compared times, and whole states.
class Follower final : public time::Observer {
 public:
  Follower(const scene::Scene& session, const std::vector<Followed>& followed, dynamics::Dynamics& dynamics,
           FollowedRun& to, bool with_states)
      : probes_(requests(followed), dynamics),
        to_(to),
        row_(probes_.columns().size()),
        rows_(session.output.interval, session.output.every, session.integrator.options.end_time) {
    to_.histories.values.resize(row_.size());
    to_.histories.times = compared_times(session);
    for (const Followed& one : followed) to_.histories.kinds.push_back(kind_of(one.kind, one.is_in_other_frame));
    const bool has_other =
        std::any_of(followed.begin(), followed.end(), [](const Followed& one) { return one.is_in_other_frame; });
    const bool in_space = session.model.base_frame == model::BaseFrame::still;
    const model::DofTable& dofs = dynamics.system().dofs;
    for (const model::NodalDof& dof : dofs.free()) {
      kinds_.push_back(kind_of(dof.kind, false));
      if (has_other) to_other_frame_.push_back(base_shares(session.model, dofs, dof, 0, !in_space));
    }
    if (!with_states) return;
    to_.state_times = state_times(session, dynamics.size());
    to_.x.resize(dynamics.size(), static_cast<Index>(to_.state_times.size()));
    to_.v.resizeLike(to_.x);
    dofs_.resize(static_cast<std::size_t>(dynamics.size()));
    std::iota(dofs_.begin(), dofs_.end(), Index{0});
  }

  void start(const time::State& state) override {
    probes_.evaluate(state, row_);
    take_row();
    raise_scales(state.t, state.x);
    if (to_.state_times.empty()) return;
    to_.x.col(0) = state.x;
    to_.v.col(0) = state.v;
    next_state_ = 1;
  }

  void step(const time::AcceptedStep& step) override {
    rows_.visit(step, [](double) {});
    const std::vector<double>& times = to_.histories.times;
    if (next_row_ < times.size() && times[next_row_] <= step.to.t) raise_scales(step.to.t, step.to.x);
    while (next_row_ < times.size() && times[next_row_] <= step.to.t) {
      probes_.evaluate(step, times[next_row_], row_);
      take_row();
    }
    while (next_state_ < to_.state_times.size() && to_.state_times[next_state_] <= step.to.t) {
      const auto column = static_cast<Index>(next_state_);
      const auto span = [&](Eigen::MatrixXd& matrix) {
        return std::span<double>(matrix.col(column).data(), dofs_.size());
      };
      step.motion.interpolate(to_.state_times[next_state_], dofs_, {span(to_.x), span(to_.v), {}});
      ++next_state_;
    }
  }

  /// The rows of history.csv, at which some methods end their steps: the run is then the one of the results.
  double next_instant(double t) const override { return rows_.next_instant(t); }

 private:
  void take_row() {
    for (std::size_t i = 0; i < row_.size(); ++i) to_.histories.values[i].push_back(row_[i]);
    ++next_row_;
  }
  void raise_scales(double t, ConstVectorRef x) {
    const auto raise = [&](record::Histories::Kind kind, double value) {
      double& largest = to_.histories.largest_of_kind[kind];
      largest = std::max(largest, std::abs(value));
    };
    for (std::size_t i = 0; i < kinds_.size(); ++i) raise(kinds_[i], x[static_cast<Index>(i)]);
    for (std::size_t i = 0; i < to_other_frame_.size(); ++i) {
      if (kinds_[i] == record::Histories::rotation) continue;
      double value = x[static_cast<Index>(i)];
      for (const model::BaseShare& share : to_other_frame_[i]) value += share.factor * share.motion->value(t);
      raise(record::Histories::other_displacement, value);
    }
  }
  static record::Histories::Kind kind_of(DofKind kind, bool is_in_other_frame) {
    using Kind = record::Histories::Kind;
    return is_rotation(kind) ? Kind::rotation : is_in_other_frame ? Kind::other_displacement : Kind::displacement;
  }

  record::Probes probes_;
  FollowedRun& to_;
  std::vector<double> row_;
  record::OutputTimes rows_;
  std::vector<Index> dofs_;
  std::vector<record::Histories::Kind> kinds_;  ///< of each DOF
  /// The terms that each DOF has in the other frame; empty if nothing is followed there.
  std::vector<std::vector<model::BaseShare>> to_other_frame_;
  std::size_t next_row_ = 0, next_state_ = 0;
};

/// The smallest and the largest displacement of each probe, in the frame of the equations of motion, followed by those
/// of the stops.
class Displacements final : public time::Observer {
 public:
  Displacements(const std::vector<Followed>& followed, dynamics::Dynamics& dynamics) {
    for (const Followed& one : followed) add(dynamics.system().dofs.index({one.node, one.kind}), -1);
    const dynamics::ElasticStops& stops = dynamics.stops();
    for (Index i = 0; i < stops.size(); ++i) {
      add(stops.dof_a(i), stops.dof_b(i));
      all_.resolve(tracks_.back(), stops.play_of(i));
    }
  }

  void start(const time::State& state) override {
    for (std::size_t i = 0; i < ranges_.size(); ++i) ranges_[i].take(state.t, all_.at(state, i).of[0]);
  }
  void step(const time::AcceptedStep& step) override {
    all_.visit(step, [&] {
      for (std::size_t i = 0; i < ranges_.size(); ++i)
        all_.path(step, i).extend(0, all_.from(i), all_.to(i), ranges_[i]);
    });
  }
  const record::Range& range(std::size_t i) const { return ranges_[tracks_[i]]; }

 private:
  void add(Index a, Index b) {
    tracks_.push_back(all_.add(a, b, 1));
    ranges_.resize(all_.size());
  }

  record::Tracks all_;
  std::vector<std::size_t> tracks_;
  std::vector<record::Range> ranges_;  ///< by track
};

void sum_up(const std::vector<Followed>& followed, dynamics::Dynamics& dynamics, const Displacements& displacements,
            const record::ContactRecorder* contacts, FollowedRun& run) {
  for (std::size_t i = 0; i < followed.size(); ++i) {
    double squares = 0.0;
    for (const double u : run.histories.values[i]) squares += u * u;
    const std::string name = followed[i].label + "." + model::name_of(followed[i].quantity);
    run.numbers.push_back(
        {"rms of " + name, std::sqrt(squares / static_cast<double>(run.histories.times.size())), false});
    if (!followed[i].is_in_other_frame)
      run.numbers.push_back({"peak of " + name, displacements.range(i).size(), false});
  }
  if (dynamics.stop_count() == 0 && contacts == nullptr) return;
  const Vector closed = dynamics.stops().closed_stiffness();
  double largest = 0.0, largest_beyond = 0.0;  // without and with rounding of the penetration
  for (Index i = 0; i < dynamics.stop_count(); ++i) {
    const record::Range& range = displacements.range(followed.size() + static_cast<std::size_t>(i));
    for (const double w : {range.least, range.greatest}) {
      const double force = std::abs(dynamics.stops().force_of(i, w));
      largest = std::max(largest, force);
      largest_beyond = std::max(largest_beyond, force + kRoundingOfPaths * closed[i] * std::abs(w));
    }
  }
  // Friction supports are pressed by a given force.
  for (std::size_t i = 0; contacts != nullptr && i < contacts->wear().size(); ++i)
    if (dynamics.obstacles()->group_of(static_cast<Index>(i)).shape != nullptr)
      largest = std::max(largest, contacts->wear()[i].peak_force);
  largest_beyond = std::max(largest, largest_beyond);
  run.numbers.push_back({"largest contact force", largest, false, largest_beyond - largest});
}

}  // namespace

std::vector<double> compared_times(const scene::Scene& session) {
  const double end = session.integrator.options.end_time, rows = session.output.interval.value_or(end / kFewestRows);
  const double interval = rows / std::max(1.0, std::ceil(kFewestRows * rows / end - kSameInstant));
  std::vector<double> times;
  for (std::size_t i = 0; static_cast<double>(i) * interval < end * (1.0 - kSameInstant); ++i)
    times.push_back(static_cast<double>(i) * interval);
  times.push_back(end);
  return times;
}

std::vector<double> state_times(const scene::Scene& session, Index size) {
  const double count =
      std::floor(std::clamp(kMostNumbers / static_cast<double>(std::max<Index>(size, 1)), kFewestStates, kMostStates));
  std::vector<double> times;
  for (double i = 0.0; i < count; i += 1.0) times.push_back(session.integrator.options.end_time * i / count);
  times.push_back(session.integrator.options.end_time);
  return times;
}

FollowedRun follow(scene::Scene& session, double disturbance, double most, Wanted wanted) {
  const log::WithoutWarnings quiet;
  FollowedRun run;
  scene::Assembly assembly(session, perturbed_by(disturbance));
  dynamics::Dynamics& dynamics = assembly.dynamics;
  run.size = dynamics.size();
  run.choice = assembly.integrator->choice();
  const std::vector<Followed> followed = followed_by_probes(session, dynamics.system());
  Follower follower(session, followed, dynamics, run, wanted.states);
  Displacements displacements(followed, dynamics);
  record::ImpactRecorder impacts(dynamics);
  std::optional<record::ContactRecorder> contacts;
  if (wanted.numbers && dynamics.obstacles() != nullptr) assembly.simulation.add(contacts.emplace(dynamics));
  assembly.simulation.add(follower);
  if (wanted.numbers) assembly.simulation.add(displacements);
  if (wanted.impacts && dynamics.stop_count() > 0) assembly.simulation.add(impacts);
  const auto work = [&] {
    const linalg::Counters& counters = dynamics.counters();
    return static_cast<double>(counters.force_evaluations + counters.solves + counters.contact_evaluations) *
               static_cast<double>(dynamics.size() + dynamics.stop_count()) +
           kWatching * static_cast<double>(assembly.simulation.report().steps) *
               static_cast<double>(dynamics.stop_count());
  };
  const time::RunReport& report = assembly.simulation.run([&] { return interruption() == nullptr && work() < most; });
  if (interruption() != nullptr) throw RunError("interrupted during the accuracy estimate");
  run.completed = report.completed;
  run.message = report.message.empty() ? "it takes too long" : report.message;
  run.work = work();
  if (!run.completed) return run;
  if (wanted.numbers) sum_up(followed, dynamics, displacements, contacts ? &*contacts : nullptr, run);
  if (wanted.impacts && (dynamics.stop_count() > 0 || contacts))
    run.numbers.push_back(
        {"impacts",
         static_cast<double>(impacts.impacts().size() + (contacts ? contacts->impacts().size() : std::size_t{0})),
         true});
  return run;
}

}  // namespace butee::app::trust
