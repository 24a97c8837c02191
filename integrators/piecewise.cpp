#include "integrators/piecewise.hpp"

#include "integrators/methods.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

using time::StepReport;

Piecewise::Piecewise(dynamics::Dynamics& dynamics, double end_time)
    : Integrator(dynamics), motion_(dynamics, end_time) {}

void Piecewise::do_start(time::State& state) {
  state.memory.resize(motion_.memory_size());
  motion_.write_status(state, state.memory);
  motion_.clear();
}

StepReport Piecewise::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const std::int64_t looks = motion_.looks();
  motion_.follow(from, step);
  dynamics().counters().law_evaluations += motion_.looks() - looks;
  motion_.write_end(to);
  StepReport report;
  report.inner_steps = motion_.piece_count();
  return report;
}

std::span<const double> Piecewise::breakpoints(const time::State& from, const time::State& to) const {
  motion_.recall(from, to);
  return motion_.breakpoints();
}

void Piecewise::do_interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                               time::Interpolated out) const {
  do_interpolate_all(from, to, {&t, 1}, dofs, out);
}

void Piecewise::do_interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                                   std::span<const Index> dofs, time::Interpolated out) const {
  motion_.recall(from, to);
  std::size_t place = 0;
  for (const double t : times) {
    const bool is_end = t == from.t || t == to.t;
    const time::State& end = t == from.t ? from : to;
    if (!is_end) motion_.go_to(t);
    for (const Index dof : dofs) {
      const Jet jet = is_end ? Jet{end.x[dof], end.v[dof], end.a[dof], 0.0} : motion_.dof(dof);
      if (!out.x.empty()) out.x[place] = jet[0];
      if (!out.v.empty()) out.v[place] = jet[1];
      if (!out.a.empty()) out.a[place] = jet[2];
      ++place;
    }
  }
}

void Piecewise::departure(const time::State& from, const time::State& to, double begin, double end,
                          std::span<const Index> dofs, time::Interpolated out) const {
  motion_.recall(from, to);
  motion_.go_to(begin);
  const double h = end - begin;
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    const QuinticError error = quintic_error(h, motion_.sixth_derivative(dofs[k], h));
    if (!out.x.empty()) out.x[k] = error.x;
    if (!out.v.empty()) out.v[k] = error.v;
    if (!out.a.empty()) out.a[k] = error.a;
  }
}

time::IntegratorType piecewise_type() {
  return {
      .name = "piecewise",
      .aliases = {"PWL"},
      .summary = "closed form from one change of contact to the next; few DOFs and linear stops; no truncation error",
      .parameters = {config::number("tolerance", "1", "ignored: there is no truncation").above(0).optional()},
      .finds_first_step = true,
      .contacts = time::ContactSupport::without_memory,
      .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        return std::make_unique<Piecewise>(dynamics, p.number("end_time"));
      },
      .check =
          [](const config::Parameters& p, config::Diagnostics& diagnostics) {
            if (p.has("tolerance"))
              diagnostics.warning(p.key("tolerance"), p.value("tolerance").at,
                                  "is ignored by piecewise, which has no truncation error");
          }};
}

}  // namespace butee::integrators
