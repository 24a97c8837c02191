#include "solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace butee::plugins {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string("SUNDIALS: ") + what + " failed with " + std::to_string(flag));
}

void ignore_message(int, const char*, const char*, char*, void*) {}

}  // namespace

time::StepDecision SundialsIntegrator::Controller::decide(double, const time::StepReport&) const {
  return {true, std::numeric_limits<double>::infinity()};
}

SundialsIntegrator::SundialsIntegrator(dynamics::Dynamics& dynamics, Family family, double tolerance,
                                       double absolute_tolerance, int order)
    : Integrator(dynamics),
      family_(family),
      tolerance_(tolerance),
      absolute_tolerance_(absolute_tolerance),
      order_(order),
      solver_(dynamics.effective(), dynamics.obstacles()),
      matrix_t_(kNone),
      matrix_gamma_(kNone) {
  if (SUNContext_Create(nullptr, &context_) != 0) throw std::runtime_error("SUNDIALS: no context");
  y_ = N_VNew_Serial(2 * dynamics.size(), context_);
  derivative_ = N_VNew_Serial(2 * dynamics.size(), context_);
  stop_displacement_ = stop_force_ = tangent_ = stop_work_ = Vector::Zero(dynamics.stop_count());
  work_ = other_ = Vector::Zero(dynamics.size());
}

SundialsIntegrator::~SundialsIntegrator() {
  if (memory_ != nullptr && is_cvode()) CVodeFree(&memory_);
  if (memory_ != nullptr) ARKStepFree(&memory_);
  if (linear_ != nullptr) SUNLinSolFreeEmpty(linear_);
  N_VDestroy(y_);
  N_VDestroy(derivative_);
  SUNContext_Free(&context_);
}

double SundialsIntegrator::first_step(const time::State&) const {
  return std::numeric_limits<double>::infinity();
}

void SundialsIntegrator::create(const time::State& from) {
  if (is_cvode()) {
    memory_ = CVodeCreate(family_ == Family::cvode_bdf ? CV_BDF : CV_ADAMS, context_);
    if (memory_ == nullptr) throw std::runtime_error("SUNDIALS: CVodeCreate failed");
    check(CVodeInit(memory_, right_side, from.t, y_), "CVodeInit");
    check(CVodeSetErrHandlerFn(memory_, ignore_message, nullptr), "CVodeSetErrHandlerFn");
    check(CVodeSetUserData(memory_, this), "CVodeSetUserData");
    check(CVodeSStolerances(memory_, tolerance_, absolute_tolerance_), "CVodeSStolerances");
    if (order_ > 0) check(CVodeSetMaxOrd(memory_, order_), "CVodeSetMaxOrd");
  } else {
    const bool is_explicit = family_ == Family::arkode_erk;
    memory_ =
        ARKStepCreate(is_explicit ? right_side : nullptr, is_explicit ? nullptr : right_side, from.t, y_, context_);
    if (memory_ == nullptr) throw std::runtime_error("SUNDIALS: ARKStepCreate failed");
    check(ARKStepSetErrHandlerFn(memory_, ignore_message, nullptr), "ARKStepSetErrHandlerFn");
    check(ARKStepSetUserData(memory_, this), "ARKStepSetUserData");
    check(ARKStepSStolerances(memory_, tolerance_, absolute_tolerance_), "ARKStepSStolerances");
    if (order_ > 0) check(ARKStepSetOrder(memory_, order_), "ARKStepSetOrder");
  }
  if (family_ != Family::arkode_erk) attach_linear_solver();
}

void SundialsIntegrator::attach_linear_solver() {
  linear_ = SUNLinSolNewEmpty(context_);
  linear_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; };
  linear_->ops->solve = solve_linear;
  linear_->content = this;
  check(
      is_cvode() ? CVodeSetLinearSolver(memory_, linear_, nullptr) : ARKStepSetLinearSolver(memory_, linear_, nullptr),
      "the linear solver");
}

void SundialsIntegrator::begin(const time::State& from) {
  double* y = N_VGetArrayPointer(y_);
  std::copy(from.x.begin(), from.x.end(), y);
  std::copy(from.v.begin(), from.v.end(), y + from.x.size());
  if (memory_ == nullptr)
    create(from);
  else if (is_cvode())
    check(CVodeReInit(memory_, from.t, y_), "CVodeReInit");
  else
    check(ARKStepReset(memory_, from.t, y_), "ARKStepReset");
}

void SundialsIntegrator::do_start(time::State&) {
  last_.t = kNone;
}

void SundialsIntegrator::do_jump(time::State&, ConstVectorRef) {
  last_.t = kNone;
}

time::StepReport SundialsIntegrator::do_step(const time::State& from, const time::Step& step, time::State& to) {
  time::StepReport report;
  const bool continues = memory_ != nullptr && last_.t == from.t && last_.x == from.x && last_.v == from.v;
  if (!continues) {
    begin(from);
    matrix_t_ = kNone;
  }
  double t = from.t;
  int flag = 0;
  if (is_cvode()) {
    check(CVodeSetStopTime(memory_, step.t_end), "CVodeSetStopTime");
    flag = CVode(memory_, step.t_end, y_, &t, CV_ONE_STEP);
    if (flag >= 0) flag = std::min(0, CVodeGetDky(memory_, t, 1, derivative_));
  } else {
    check(ARKStepSetStopTime(memory_, step.t_end), "ARKStepSetStopTime");
    flag = ARKStepEvolve(memory_, step.t_end, y_, &t, ARK_ONE_STEP);
    if (flag >= 0) flag = std::min(0, ARKStepGetDky(memory_, t, 1, derivative_));
  }
  if (thrown_) {
    last_.t = kNone;
    std::rethrow_exception(std::exchange(thrown_, nullptr));
  }
  if (flag < 0 || !(t > from.t)) {
    report.status = time::StepStatus::not_finite;
    last_.t = kNone;  // No valid state.
    return report;
  }
  const Index n = from.x.size();
  const double* y = N_VGetArrayPointer(y_);
  to.t = t;
  to.x = Eigen::Map<const Vector>(y, n);
  to.v = Eigen::Map<const Vector>(y + n, n);
  to.a = Eigen::Map<const Vector>(N_VGetArrayPointer(derivative_) + n, n);
  last_.t = t;
  last_.x = to.x;
  last_.v = to.v;
  return report;
}

int SundialsIntegrator::evaluate(double t, const double* y, double* rate) {
  const Index n = dynamics().size();
  const Eigen::Map<const Vector> x(y, n), v(y + n, n);
  Eigen::Map<Vector> a(rate + n, n);
  std::copy(y + n, y + 2 * n, rate);
  dynamics().acceleration(t, x, v, a);
  return std::isfinite(a.sum()) ? 0 : 1;
}

template <class Function>
int SundialsIntegrator::guarded(Function call) noexcept {
  constexpr int kUnrecoverable = -1;
  try {
    return call();
  } catch (...) {
    thrown_ = std::current_exception();
    return kUnrecoverable;
  }
}

int SundialsIntegrator::right_side(realtype t, N_Vector y, N_Vector rate, void* self) {
  SundialsIntegrator& method = *static_cast<SundialsIntegrator*>(self);
  return method.guarded([&] { return method.evaluate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate)); });
}

int SundialsIntegrator::solve_linear(SUNLinearSolver solver, SUNMatrix, N_Vector z, N_Vector r, realtype) {
  SundialsIntegrator& method = *static_cast<SundialsIntegrator*>(solver->content);
  return method.guarded([&] { return method.solve(N_VGetArrayPointer(z), N_VGetArrayPointer(r)); });
}

int SundialsIntegrator::solve(double* z, const double* r) {
  double t = 0.0, gamma = 0.0, rl1 = 0.0;
  N_Vector predicted = nullptr, now = nullptr, rate = nullptr, history = nullptr;
  void* self = nullptr;
  if (is_cvode())
    CVodeGetNonlinearSystemData(memory_, &t, &predicted, &now, &rate, &gamma, &rl1, &history, &self);
  else
    ARKStepGetNonlinearSystemData(memory_, &t, &predicted, &now, &rate, &gamma, &history, &self);
  const Index n = dynamics().size();
  const double* y = N_VGetArrayPointer(now);
  const Eigen::Map<const Vector> x(y, n), v(y + n, n), r_x(r, n), r_v(r + n, n);
  Eigen::Map<Vector> z_x(z, n), z_v(z + n, n);
  if (!set_matrix(t, gamma, x, v)) return 1;
  // (M + gamma C + gamma^2 K) z_v = M r_v - gamma K r_x,   z_x = r_x + gamma z_v;   C and K with the contacts' tangents
  tangent_force(r_x);
  dynamics().inertia_force(r_v, other_);
  other_ -= gamma * work_;
  if (!solver_.solve(other_)) return 1;
  z_x = r_x + gamma * other_;
  z_v = other_;
  return 0;
}

bool SundialsIntegrator::set_matrix(double t, double gamma, ConstVectorRef x, ConstVectorRef v) {
  if (t == matrix_t_ && gamma == matrix_gamma_) return true;
  matrix_t_ = kNone;
  dynamics().set_time(t);
  if (dynamics().stop_count() > 0) {
    dynamics().stops().displacement(x, stop_displacement_);
    dynamics().stops().tangent(stop_displacement_, stop_force_, tangent_);
  }
  std::span<const dynamics::Obstacles::Tangent> obstacles;
  if (dynamics().obstacles() != nullptr) obstacles = dynamics().obstacles()->tangents(t, x, v);
  if (!solver_.set(gamma, gamma * gamma, tangent_, obstacles)) return false;
  matrix_t_ = t;
  matrix_gamma_ = gamma;
  return true;
}

void SundialsIntegrator::tangent_force(ConstVectorRef y) {
  dynamics().elastic_force(y, work_);
  solver_.add_stiffness(dynamics().stops(), y, stop_work_, work_);
}

}  // namespace butee::plugins
