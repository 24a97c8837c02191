#include "integrators/piecewise.hpp"

#include <string>

#include <butee/core/error.hpp>

#include "integrators/methods.hpp"

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
  motion_.follow(from, step);
  motion_.write_end(to);
  StepReport report;
  report.inner_steps = motion_.piece_count();
  return report;
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
        try {
          return std::make_unique<Piecewise>(dynamics, p.number("end_time"));
        } catch (const RunError& error) {  // the state with all stops open has no modes
          throw InputError("integrator.type: " + std::string(error.what()));
        }
      },
      .check =
          [](const config::Parameters& p, config::Diagnostics& diagnostics) {
            if (p.has("tolerance"))
              diagnostics.warning(p.key("tolerance"), p.value("tolerance").at,
                                  "is ignored by piecewise, which has no truncation error");
          }};
}

}  // namespace butee::integrators
