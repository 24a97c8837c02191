#include <algorithm>
#include <cmath>

#include "butee/config/number_file.hpp"
#include "butee/model/smooth_motion.hpp"
#include "butee/model/types.hpp"

namespace butee::model {
namespace {

using config::Diagnostics;
using config::number;
using config::numbers;
using config::Parameters;

/// Piecewise linear through (times, values), constant before the first and after the last.
class PiecewiseLinear final : public TimeFunction {
 public:
  PiecewiseLinear(std::vector<double> times, std::vector<double> values)
      : times_(std::move(times)), values_(std::move(values)) {}

  double value(double t) const override {
    const auto after = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
    if (after == 0) return values_.front();
    if (after == std::ssize(times_)) return values_.back();
    const auto i = static_cast<std::size_t>(after);
    const double s = (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return (1.0 - s) * values_[i - 1] + s * values_[i];
  }
  bool taylor(double t, double h, std::span<double> coefficients) const override {
    std::fill(coefficients.begin(), coefficients.end(), 0.0);
    coefficients[0] = value(t);
    const auto after = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
    if (after == 0 || after == std::ssize(times_) || coefficients.size() < 2) return true;
    const auto i = static_cast<std::size_t>(after);
    coefficients[1] = h * (values_[i] - values_[i - 1]) / (times_[i] - times_[i - 1]);
    return true;
  }
  bool vanishes() const override {
    return std::all_of(values_.begin(), values_.end(), [](double v) { return v == 0.0; });
  }
  bool is_piecewise_parabolic() const override { return true; }
  std::vector<double> discontinuities() const override { return times_.size() > 1 ? times_ : std::vector<double>{}; }

 private:
  std::vector<double> times_, values_;
};

LoadType harmonic() {
  return {"harmonic",
          "amplitude cos(angular_frequency t + phase)",
          {number("amplitude", "N", "the amplitude (N m on theta)"),
           number("angular_frequency", "rad/s", "the angular frequency").at_least(0),
           number("phase", "rad", "the phase at t = 0").or_else(0.0)},
          [](const Parameters& p, Diagnostics&) -> std::unique_ptr<TimeFunction> {
            return std::make_unique<Wave>(
                Harmonic{p.number("amplitude"), p.number("angular_frequency"), p.number("phase")});
          }};
}

LoadType unbalance() {
  return {"unbalance",
          "moment speed^2 cos(speed t + phase)",
          {number("moment", "kg m", "mass times eccentricity"),
           number("speed", "rad/s", "the speed of rotation").at_least(0),
           number("phase", "rad", "the phase at t = 0").or_else(0.0)},
          [](const Parameters& p, Diagnostics&) -> std::unique_ptr<TimeFunction> {
            const double speed = p.number("speed");
            return std::make_unique<Wave>(Harmonic{p.number("moment") * speed * speed, speed, p.number("phase")});
          }};
}

LoadType constant() {
  return {"constant",
          "the same value at all times",
          {number("value", "N", "the value (N m on theta)")},
          [](const Parameters& p, Diagnostics&) -> std::unique_ptr<TimeFunction> {
            return std::make_unique<PiecewiseLinear>(std::vector{0.0}, std::vector{p.number("value")});
          }};
}

LoadType ramp() {
  return {"ramp",
          "`from` until start, linear to `to` at end, `to` from then on",
          {number("from", "N", "the value before the ramp (N m on theta)").or_else(0.0),
           number("to", "N", "the value after the ramp (N m on theta)"),
           number("start", "s", "the start of the ramp").or_else(0.0), number("end", "s", "the end of the ramp")},
          [](const Parameters& p, Diagnostics& diagnostics) -> std::unique_ptr<TimeFunction> {
            const double start = p.number("start"), end = p.number("end");
            if (!(end > start)) {
              p.complain(diagnostics, "end", "must be later than start");
              return nullptr;
            }
            return std::make_unique<PiecewiseLinear>(std::vector{start, end},
                                                     std::vector{p.number("from"), p.number("to")});
          }};
}

std::optional<config::NumberTable> inline_table(const Parameters& p, Diagnostics& diagnostics) {
  for (const auto& [key, what] :
       {std::pair("times", "the instants, ascending"), std::pair("values", "the values there")})
    if (!p.has(key)) p.complain(diagnostics, key, std::string("missing; give ") + what + ", or a file with both");
  for (const char* key : {"columns", "skip", "scale", "size", "checksum"})
    if (p.given(key)) p.complain(diagnostics, key, "belongs to file, which is not given");
  if (!p.has("times") || !p.has("values")) return std::nullopt;
  config::NumberTable table{p.numbers("times"), p.numbers("values")};
  if (table.arguments.empty())
    p.complain(diagnostics, "times", "must hold at least one instant");
  else if (table.values.size() != table.arguments.size())
    p.complain(diagnostics, "values",
               "must hold as many values as there are times (" + std::to_string(table.arguments.size()) + ")");
  else if (std::adjacent_find(table.arguments.begin(), table.arguments.end(), std::greater_equal<>()) !=
           table.arguments.end())
    p.complain(diagnostics, "times", "must ascend: every instant later than the one before");
  else
    return table;
  return std::nullopt;
}

LoadType table() {
  std::vector<config::Parameter> parameters = {numbers("times", "s", "the instants, ascending").optional(),
                                               numbers("values", "N", "the values there (N m on theta)").optional()};
  for (const config::Parameter& parameter : config::number_file_parameters()) parameters.push_back(parameter);
  return {"table", "piecewise linear through (times, values) or the rows of a file, constant outside", parameters,
          [](const Parameters& p, Diagnostics& diagnostics) -> std::unique_ptr<TimeFunction> {
            for (const char* key : {"times", "values"})
              if (p.has("file") && p.has(key)) {
                p.complain(diagnostics, key, "conflicts with file; give one of the two");
                return nullptr;
              }
            auto read = p.has("file") ? read_number_file(p, diagnostics) : inline_table(p, diagnostics);
            if (!read) return nullptr;
            return std::make_unique<PiecewiseLinear>(std::move(read->arguments), std::move(read->values));
          }};
}

}  // namespace

std::vector<LoadType> standard_load_types() {
  return {harmonic(), constant(), ramp(), table(), unbalance()};
}

}  // namespace butee::model
