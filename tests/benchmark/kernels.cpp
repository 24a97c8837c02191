// Compares the kernels of framework/linalg and framework/dynamics with the plain ones, on beam1 (68 DOFs,
// band 3, 33 arctan stops).
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <butee/linalg/band_factor.hpp>
#include <butee/linalg/linear_solver.hpp>

#include "plain/plain_contact.hpp"
#include "suite.hpp"
#include "support/large_scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::benchmarks {
namespace {

constexpr double kStep = 1e-5, kOnVelocity = 0.5 * kStep, kOnDisplacement = 0.25 * kStep * kStep;
constexpr Index kBand = 3;
constexpr double kGap = 0.01, kOpen = 1e-3, kPressed = kGap + 1e-3;
/// A displacement so close to the gap that the arctan must be evaluated.
constexpr double kTouching = kGap + 1e-6;

using Kernel = std::function<void()>;

/// Registers a kernel; `make` creates it with its data when the benchmark starts.
void add(const std::string& name, const std::function<Kernel()>& make) {
  benchmark::RegisterBenchmark(("kernel/" + name).c_str(), [make](benchmark::State& state) {
    const Kernel kernel = make();
    for (auto _ : state) {
      kernel();
      benchmark::ClobberMemory();
    }
  });
}

std::shared_ptr<test::SceneRun> beam1() {
  return std::make_shared<test::SceneRun>(test::SceneRun::of_model("beam1"));
}
std::shared_ptr<test::SceneRun> beam_of_size(int dofs) {
  return dofs == 68 ? beam1() : std::make_shared<test::SceneRun>(test::long_beam(dofs / 2));
}

Vector wave(Index size) {
  Vector x(size);
  for (Index i = 0; i < size; ++i) x[i] = std::cos(1.0 + static_cast<double>(i));
  return x;
}

plain::Vector<double> plain_copy(const Vector& x) {
  plain::Vector<double> copy(static_cast<int>(x.size()));
  for (Index i = 0; i < x.size(); ++i) copy[static_cast<int>(i)] = x[i];
  return copy;
}

plain::Band<double> plain_copy(const SparseMatrix& matrix) {
  plain::Band<double> band(static_cast<int>(matrix.rows()));
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      if (entry.row() >= j) band.add(static_cast<int>(entry.row()), static_cast<int>(j), entry.value());
  return band;
}

/// M + c C + k K with the factors of Newmark's method
SparseMatrix effective_matrix(const model::System& system) {
  return (1.0 + kOnVelocity * system.damping.mass_proportional) * system.mass + kOnDisplacement * system.stiffness;
}

void add_products() {
  for (const int size : {68, 10000}) {
    const std::string name = "product/" + std::to_string(size) + "/";
    add(name + "butee", [size] {
      const auto scene = beam_of_size(size);
      return [scene, x = wave(size), y = Vector(size)]() mutable { scene->dynamics().elastic_force(x, y); };
    });
    add(name + "plain", [size] {
      return [a = plain_copy(beam_of_size(size)->system().stiffness), x = plain_copy(wave(size)),
              y = plain::Vector<double>(size)]() mutable {
        const double* from = x.data();
        double* to = y.data();
        const int n = y.size();
#pragma omp simd
        for (int i = 0; i < n; ++i) to[i] = a.row_times(i, from);
      };
    });
  }
}

/// In both programs every solution starts from a fresh copy of its right-hand side.
void add_solutions() {
  struct Solver {
    explicit Solver(const SparseMatrix& a) : matrix(a), solver(matrix, counters) { (void)solver.factorize(matrix); }
    SparseMatrix matrix;
    linalg::Counters counters;
    linalg::LinearSolver solver;
  };
  add("factorize/68/butee", [] {
    const auto solver = std::make_shared<Solver>(effective_matrix(beam1()->system()));
    return [solver] { benchmark::DoNotOptimize(solver->solver.factorize(solver->matrix)); };
  });
  add("factorize/68/plain", [] {
    return [a = plain_copy(effective_matrix(beam1()->system())), factor = plain::BandFactor<double>()]() mutable {
      factor.compute(a);
    };
  });
  add("solve/68/butee", [] {
    const auto solver = std::make_shared<Solver>(effective_matrix(beam1()->system()));
    return [solver, right = wave(68), b = Vector(68)]() mutable {
      b = right;
      solver->solver.solve(b);
    };
  });
  add("solve/68/plain", [] {
    plain::BandFactor<double> factor;
    factor.compute(plain_copy(effective_matrix(beam1()->system())));
    return [factor, right = plain_copy(wave(68)), b = plain::Vector<double>(68)]() mutable {
      b = right;
      factor.solve(b);
    };
  });
}

/// Displacements with the first stops closed or touching and all others open.
Vector with_closed_stops(const dynamics::ElasticStops& contact, Index closed, double displacement) {
  Vector x = Vector::Constant(contact.system_size(), kOpen);
  for (Index i = 0; i < closed; ++i) x[contact.dof_a(i)] = displacement;
  return x;
}

/// Evaluation of the stops from system displacements, as in a method.
void add_laws() {
  struct Laws {
    explicit Laws(double displacement)
        : scene(beam1()), x(with_closed_stops(scene->dynamics().stops(), 3, displacement)), w(33), f(33), k(33) {}
    std::shared_ptr<test::SceneRun> scene;
    Vector x, w, f, k;
  };
  struct PlainLaws {
    explicit PlainLaws(double displacement)
        : problem(plain::make_problem<double>("beam1", plain::Law::kArctan)),
          contact(problem),
          x(plain_copy(Laws(displacement).x)) {}
    plain::Problem problem;
    plain::Contact contact;
    plain::Vector<double> x;
  };
  for (const auto& [suffix, displacement] : {std::pair("", kPressed), std::pair("-touching", kTouching)}) {
    const double at = displacement;
    add(std::string("force/33") + suffix + "/butee", [at] {
      return [laws = std::make_shared<Laws>(at)] {
        dynamics::ElasticStops& contact = laws->scene->dynamics().stops();
        contact.displacement(laws->x, laws->w);
        contact.force(laws->w, laws->f);
      };
    });
    add(std::string("force/33") + suffix + "/plain",
        [at] { return [laws = std::make_shared<PlainLaws>(at)] { laws->contact.evaluate_force(laws->x); }; });
    add(std::string("tangent/33") + suffix + "/butee", [at] {
      return [laws = std::make_shared<Laws>(at)] {
        dynamics::ElasticStops& contact = laws->scene->dynamics().stops();
        contact.displacement(laws->x, laws->w);
        contact.tangent(laws->w, laws->f, laws->k);
      };
    });
    add(std::string("tangent/33") + suffix + "/plain",
        [at] { return [laws = std::make_shared<PlainLaws>(at)] { laws->contact.evaluate_tangent(laws->x); }; });
  }
}

/// The effective equations with a new stiffness of the stops. The plain side factorizes each time, as its
/// methods do.
void add_effective_solutions() {
  for (const Index closed : {0, 3, 33}) {
    const auto stiffness = [closed](test::SceneRun& scene) {
      dynamics::ElasticStops& contact = scene.dynamics().stops();
      const Vector x = with_closed_stops(contact, closed, kPressed);
      Vector w(33), f(33), kappa(33);
      contact.displacement(x, w);
      contact.tangent(w, f, kappa);
      return kappa;
    };
    const std::string name = "effective/" + std::to_string(closed) + "-closed/";
    add(name + "butee", [stiffness] {
      const auto scene = beam1();
      scene->dynamics().effective().set_factors(kOnVelocity, kOnDisplacement);
      return [scene, kappa = stiffness(*scene), right = wave(68), b = Vector(68)]() mutable {
        b = right;
        benchmark::DoNotOptimize(scene->dynamics().effective().solve(kappa, b));
      };
    });
    add(name + "plain", [stiffness] {
      const auto scene = beam1();
      const auto problem = plain::make_problem<double>("beam1", plain::Law::kArctan);
      const auto base = plain_copy(effective_matrix(scene->system()));
      return [base, stops = problem.stops, kappa = stiffness(*scene), a = base, factor = plain::BandFactor<double>(),
              right = plain_copy(wave(68)), b = plain::Vector<double>(68)]() mutable {
        a = base;
        for (std::size_t i = 0; i < stops.size(); ++i)
          a.lower[0][stops[i]] += kOnDisplacement * kappa[static_cast<Index>(i)];
        factor.compute(a);
        b = right;
        factor.solve(b);
      };
    });
  }
}

}  // namespace

void register_kernels() {
  add_products();
  add_solutions();
  add_laws();
  add_effective_solutions();
}

}  // namespace butee::benchmarks
