#include "butee/time/snapshot.hpp"

#include "butee/core/error.hpp"

namespace butee::time {

Snapshot Simulation::snapshot() {
  Snapshot snapshot;
  take_snapshot(snapshot);
  return snapshot;
}

void Simulation::take_snapshot(Snapshot& into) {
  start();
  into.state = state_;
  into.next_h = next_h_;
  into.origin = origin_;
  into.accepted = accepted_;
  into.report = report_;
  into.over = over_;
  ByteWriter writer(into.watchers);
  growth_.save(writer);
  for (const Observer* observer : observers_) observer->save(writer);
}

void Simulation::restore(const Snapshot& snapshot) {
  const Index n = dynamics_.size();
  require(snapshot.state.x.size() == n && snapshot.state.v.size() == n && snapshot.state.a.size() == n,
          "a snapshot of a system of this size");
  start();
  ByteReader reader(snapshot.watchers);
  growth_.restore(reader);
  for (Observer* observer : observers_) observer->restore(reader);
  require(reader.at_end(), "a snapshot of a simulation with the same observers");
  state_ = snapshot.state;
  next_h_ = snapshot.next_h;
  origin_ = snapshot.origin;
  accepted_ = snapshot.accepted;
  report_ = snapshot.report;
  over_ = snapshot.over;
  integrator_.go_back(state_);
}

void write_snapshot(const Snapshot& snapshot, ByteWriter& to) {
  to.put(snapshot.state.t);
  for (const Vector* vector :
       {&snapshot.state.x, &snapshot.state.v, &snapshot.state.a, &snapshot.state.memory, &snapshot.state.contact})
    to.put(*vector);
  to.put(snapshot.next_h);
  to.put(snapshot.origin);
  to.put(snapshot.accepted);
  const RunReport& report = snapshot.report;
  to.put(report.completed);
  to.put(report.message);
  to.put(report.t_end);
  for (const std::int64_t count : {report.steps, report.rejected, report.newton_iterations, report.newton_failures})
    to.put(count);
  to.put(report.wall_seconds);
  to.put(snapshot.over);
  to.put(std::span<const std::byte>(snapshot.watchers));
}

Snapshot read_snapshot(ByteReader& from) {
  Snapshot snapshot;
  from.take(snapshot.state.t);
  for (Vector* vector :
       {&snapshot.state.x, &snapshot.state.v, &snapshot.state.a, &snapshot.state.memory, &snapshot.state.contact})
    from.take(*vector);
  from.take(snapshot.next_h);
  from.take(snapshot.origin);
  from.take(snapshot.accepted);
  RunReport& report = snapshot.report;
  from.take(report.completed);
  from.take(report.message);
  from.take(report.t_end);
  for (std::int64_t* count : {&report.steps, &report.rejected, &report.newton_iterations, &report.newton_failures})
    from.take(*count);
  from.take(report.wall_seconds);
  from.take(snapshot.over);
  from.take(snapshot.watchers);
  return snapshot;
}

}  // namespace butee::time
