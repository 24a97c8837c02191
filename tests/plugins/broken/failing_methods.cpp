#include <limits>
#include <stdexcept>

#include <butee/plugin/entry.hpp>

namespace {

using butee::time::IntegratorType;

enum class Fault { exception, not_a_number, wrong_time, no_exception, wrong_size };

/// A method that fails after five steps.
class Failing final : public butee::time::Integrator {
 public:
  Failing(butee::dynamics::Dynamics& dynamics, Fault fault) : Integrator(dynamics), fault_(fault) {}

 private:
  butee::time::StepReport do_step(const butee::time::State& from, const butee::time::Step&,
                                  butee::time::State& to) override {
    to.x = from.x;
    to.v = from.v;
    to.a = from.a;
    if (++steps_ <= 5) return {};
    if (fault_ == Fault::exception) throw std::runtime_error("the oracle is out");
    if (fault_ == Fault::no_exception) throw 42;
    if (fault_ == Fault::not_a_number) to.v[0] = std::numeric_limits<double>::quiet_NaN();
    if (fault_ == Fault::wrong_time) to.t = from.t - 1.0;
    if (fault_ == Fault::wrong_size) to.v.resize(0);
    return {};
  }

  Fault fault_;
  int steps_ = 0;
};

IntegratorType failing(const char* name, Fault fault) {
  IntegratorType type;
  type.name = name;
  type.make = [fault](const butee::config::Parameters&,
                      butee::dynamics::Dynamics& dynamics) -> std::unique_ptr<butee::time::Integrator> {
    return std::make_unique<Failing>(dynamics, fault);
  };
  return type;
}

}  // namespace

BUTEE_PLUGIN(registrar) {
  registrar.add(failing("throws_in_step", Fault::exception));
  registrar.add(failing("throws_a_number", Fault::no_exception));
  registrar.add(failing("gives_nan", Fault::not_a_number));
  registrar.add(failing("goes_back", Fault::wrong_time));
  registrar.add(failing("loses_a_vector", Fault::wrong_size));
  IntegratorType type;
  type.name = "throws_in_make";
  type.make = [](const butee::config::Parameters&,
                 butee::dynamics::Dynamics&) -> std::unique_ptr<butee::time::Integrator> {
    throw std::runtime_error("no licence for this scene");
  };
  registrar.add(type);
  type.name = "makes_nothing";
  type.make = [](const butee::config::Parameters&, butee::dynamics::Dynamics&) {
    return std::unique_ptr<butee::time::Integrator>();
  };
  registrar.add(type);
}
