#include "butee/record/summary.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace butee::record {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

std::string to_json(const Summary& summary) {
  const time::RunReport& report = summary.report;
  const solve::Counters& counters = summary.counters;
  Json json;
  json["status"] = report.completed ? "completed" : "failed";
  json["message"] = report.message;
  json["integrator"] = summary.integrator;
  json["t_end"] = number(report.t_end);
  json["steps"] = report.steps;
  json["rejected"] = report.rejected;
  json["newton_iterations"] = report.newton_iterations;
  json["newton_failures"] = report.newton_failures;
  json["force_evaluations"] = counters.force_evaluations;
  json["contact_evaluations"] = counters.contact_evaluations;
  json["law_evaluations"] = counters.law_evaluations;
  json["factorizations"] = counters.factorizations;
  json["factor_updates"] = counters.factor_updates;
  json["solves"] = counters.solves;
  json["setup_seconds"] = number(summary.setup_seconds);
  json["wall_seconds"] = number(report.wall_seconds);
  json["dofs"] = summary.dofs;
  json["contacts"] = summary.contacts;
  json["peak"] = Json::object();
  for (const auto& [column, value] : summary.peaks) json["peak"][column] = number(value);
  Json& energy = json["energy"];
  energy["kinetic"] = number(summary.energy.kinetic);
  energy["strain"] = number(summary.energy.strain);
  energy["contact"] = number(summary.energy.contact);
  energy["work"] = summary.followed ? number(summary.followed->work) : Json(nullptr);
  energy["dissipated"] = summary.followed ? number(summary.followed->dissipated) : Json(nullptr);
  energy["balance_error"] = summary.followed ? number(summary.followed->balance_error) : Json(nullptr);
  return json.dump(2) + "\n";
}

}  // namespace butee::record
