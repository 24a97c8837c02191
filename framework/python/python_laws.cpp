#include "butee/python/python_laws.hpp"

#include <array>
#include <cmath>
#include <pybind11/stl.h>

#include "butee/core/quadrature.hpp"
#include "butee/plugin/catalogue.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/shared_function.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using Function = std::shared_ptr<py::function>;

/// Step of the force differences, as a fraction of g.
constexpr double kReach = 1e-5;
/// Penetrations at which the closed stiffness is evaluated, m.
constexpr std::array kClosed = {1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
/// Penetration g at which the asymptotic force is evaluated, m.
constexpr double kFar = -1.0;
/// The energy is integrated over intervals, each of which ends at a quarter of the previous end.
constexpr int kIntervals = 24;
constexpr double kShrink = 0.25;

/// F(g), dF/dg and V(g) as Python functions; the last two may be absent.
struct Functions {
  Function force, tangent, energy;
};

class PythonLaw final : public model::BatchedLaw<PythonLaw> {
 public:
  PythonLaw(Functions functions, std::vector<double> parameters)
      : functions_(std::move(functions)), parameters_(std::move(parameters)) {
    for (const double g : kClosed) stiffness_ = std::max(stiffness_, tangent(g));
    asymptotic_force_ = std::abs(force(kFar));
  }

  double force(double g) const { return call(functions_.force, g); }
  double secant(double g) const override { return g != 0.0 ? force(g) / g : tangent(0.0); }
  double tangent(double g) const override {
    if (functions_.tangent != nullptr) return call(functions_.tangent, g);
    const double d = kReach * std::max(std::abs(g), 1e-12);
    return (force(g + d) - force(g - d)) / (2.0 * d);
  }
  double energy(double g) const override {
    if (functions_.energy != nullptr) return call(functions_.energy, g);
    double sum = 0.0, end = g;
    for (int i = 0; i < kIntervals && g != 0.0; ++i) {
      const double begin = i + 1 == kIntervals ? 0.0 : kShrink * end;
      // The two halves of each interval, with five points each.
      const double middle = 0.5 * (begin + end);
      for (const auto& [a, b] : {std::pair(begin, middle), std::pair(middle, end)})
        for (const auto& [at, weight] : gauss_points(a, b)) sum += weight * force(at);
      end = begin;
    }
    return sum;
  }
  double closed_stiffness() const override { return stiffness_; }
  double asymptotic_force() const override { return asymptotic_force_; }

 private:
  double call(const Function& function, double g) const { return call_with(*function, g, parameters_); }

  Functions functions_;
  std::vector<double> parameters_;
  double stiffness_ = 0.0, asymptotic_force_ = 0.0;
};

std::vector<model::LawType>& known_laws() {
  static auto* types = new std::vector<model::LawType>;  // lives as long as the interpreter, which may outlive statics
  return *types;
}

void register_law(const std::string& name, const py::function& force, const py::object& tangent,
                  const py::object& energy, const DeclaredParameters& parameters, const std::string& summary) {
  model::LawType type{name, summary, {}, nullptr};
  const std::vector<std::string> names = declare(parameters, type.parameters);
  const auto shared = [](const py::object& given) {
    return given.is_none() ? Function() : shared_function(given.cast<py::function>());
  };
  const Functions functions{shared_function(force), shared(tangent), shared(energy)};
  type.make = [functions, names](const config::Parameters& given,
                                 config::Diagnostics& diagnostics) -> std::unique_ptr<model::ContactLaw> {
    std::vector<double> values;
    for (const std::string& one : names) values.push_back(given.number(one));
    auto law = std::make_unique<PythonLaw>(functions, std::move(values));
    if (!(law->closed_stiffness() > 0.0) || !std::isfinite(law->closed_stiffness()) || law->force(0.0) != 0.0) {
      given.complain(diagnostics, "law",
                     "the function in Python must return a force that is 0 at a penetration of 0 and grows with it");
      return nullptr;
    }
    return law;
  };
  std::erase_if(known_laws(), [&](const model::LawType& other) { return other.name == name; });
  plugin::Catalogue::with_plugins().add({.laws = {type}}, "Python");  // throws if the name is taken
  known_laws().push_back(std::move(type));
}

}  // namespace

const std::vector<model::LawType>& python_laws() {
  return known_laws();
}

void bind_laws(py::module_& module) {
  module.def("register_law", &register_law);
}

}  // namespace butee::python
