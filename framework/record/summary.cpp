#include "butee/record/summary.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace butee::record {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json to_json(const Trust& trust) {
  Json json;
  json["accuracy"] = number(trust.accuracy);
  json["horizon"] = number(trust.horizon);
  json["to_the_end"] = trust.to_the_end;
  json["difference"] = number(trust.difference);
  json["bound"] = number(trust.bound);
  json["end_bound"] = number(trust.end_bound);
  json["growth_rate"] = number(trust.growth_rate);
  json["growth_until"] = number(trust.growth_until);
  json["amplification"] = number(trust.amplification);
  json["chaotic"] = trust.chaotic;
  json["tightened"] = trust.tightened;
  json["other_method"] = trust.other;
  json["statistics"] = Json::object();
  for (const Trust::Statistic& s : trust.statistics)
    json["statistics"][s.name] = {
        {"value", number(s.value)}, {"least", number(s.least)}, {"greatest", number(s.greatest)}};
  return json;
}

}  // namespace

std::string to_json(const Summary& summary) {
  const time::RunReport& report = summary.report;
  const linalg::Counters& counters = summary.counters;
  Json json;
  json["status"] = report.completed ? "completed" : "failed";
  json["message"] = report.message;
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  json["integrator"] = summary.integrator;
  if (!summary.choice.empty()) json["choice"] = summary.choice;
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
  if (summary.trust) json["trust"] = to_json(*summary.trust);
  return json.dump(2) + "\n";
}

bool is_completed(const std::string& json) {
  const Json summary = Json::parse(json, nullptr, false);
  return summary.is_object() && summary.contains("status") && summary["status"] == "completed";
}

}  // namespace butee::record
