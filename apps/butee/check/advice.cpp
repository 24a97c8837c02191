#include "advice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <system_error>

#include <butee/config/parameters.hpp>
#include <butee/core/text.hpp>
#include <butee/run/load_steps.hpp>
#include <butee/run/run.hpp>

namespace butee::app::check {
namespace {

/// Warn if the residual force of open arctan stops displaces the structure by more than this fraction of the
/// gap.
constexpr double kNoticeablePull = 1e-6;
/// Warn if a stop that is still open by the fraction kNearPart of its gap has more than the fraction
/// kSoftStart of its stiffness.
constexpr double kNearPart = 0.1, kSoftStart = 0.01;
/// Least number of fixed steps in the shortest contact for the contact to be resolved.
constexpr double kStepsInContact = 8.0;
/// Least number of fixed steps in a period of a load, and of beam elements in a bending wave at its
/// frequency.
constexpr double kStepsInPeriod = 20.0, kElementsInWave = 8.0;

class Adviser {
 public:
  Adviser(const scene::Scene& session, const model::System& system, const Facts& facts)
      : session_(session), system_(system), facts_(facts) {}

  std::vector<Advice> all() {
    if (!facts_.cost.failure.empty()) add("trial", facts_.cost.failure);
    judge_stability();
    judge_step();
    judge_laws();
    judge_pull();
    judge_gaps();
    judge_output();
    judge_size();
    judge_mesh();
    judge_joints();
    judge_units();
    judge_names("material");
    judge_names("section");
    return std::move(advice_);
  }

 private:
  void add(const char* about, std::string words) { advice_.push_back({about, std::move(words)}); }

  void judge_stability() {
    if (!facts_.instability) return;
    const auto& [rate, frequency, speed] = *facts_.instability;
    add("unstable", "without contact the motion grows: a mode of " + to_short_text(frequency) + " rad/s" +
                        (speed != 0.0 ? " at the speed of rotation " + to_short_text(speed) + " rad/s" : "") +
                        " grows by a factor of e every " + to_short_text(1.0 / rate) +
                        " s. Cross terms of bearings, damping that turns with a shaft or negative damping feed it; "
                        "`butee modes --speed " +
                        to_short_text(speed) + "` shows the modes that grow");
  }

  void judge_step() {
    const scene::IntegratorChoice& choice = session_.integrator;
    const time::IntegratorType& type = session_.catalogue.find(choice.name)->declaration;
    const double h = choice.options.time_step;
    if (const auto& critical = facts_.of_method; h > 0.0 && critical && h > critical->closed)
      add("critical-step",
          "time_step = " + to_short_text(h) + " s is larger than the critical step of " + choice.name + ", " +
              to_short_text(critical->closed) + " s with all stops closed" +
              (h > critical->open ? " and also with all stops open" : "") +
              (has_damping() ? " (a safe bound, as there is damping): the solution may grow without bound"
                             : ": the solution would grow without bound") +
              "; take a smaller step or an implicit method");
    if (!type.fixed_step || h == 0.0) return;
    const double contact = facts_.mechanics.shortest_contact;
    if (contact > 0.0 && h * kStepsInContact > contact)
      add("contact-step", "time_step = " + to_short_text(h) + " s: an impact can be as short as " +
                              to_short_text(contact) + " s, which makes " + to_short_text(contact / h) +
                              " steps; take " + to_short_text(contact / (2.5 * kStepsInContact)) +
                              " s or less, or a method that chooses its steps itself (type = \"auto\")");
    if (const double period = shortest_period(); h * kStepsInPeriod > period)
      add("load-step", "time_step = " + to_short_text(h) + " s makes only " + to_short_text(period / h) +
                           " steps in the shortest period of a load, " + to_short_text(period) + " s");
    if (std::string complaint = run::complaint_of_loads(system_, h, choice.options.end_time); !complaint.empty())
      add("load-pulse", std::move(complaint));
  }

  bool has_damping() const {
    const auto& damping = system_.damping;
    return system_.dashpots.size() > 0 || damping.is_modal() || damping.mass_proportional != 0.0 ||
           damping.stiffness_proportional != 0.0;
  }

  double shortest_period() const {
    double fastest = 0.0;
    for (const model::FreeLoad& load : system_.loads)
      if (const auto harmonic = load.in_time->harmonic()) fastest = std::max(fastest, harmonic->angular_frequency);
    return fastest > 0.0 ? 2.0 * std::numbers::pi / fastest : std::numeric_limits<double>::infinity();
  }

  void judge_laws() {
    for (const model::FreeStops& stops : system_.stops) {
      if (stops.play.gap <= 0.0) continue;
      const bool turns = acts_on_rotation(system_, stops);
      const double share = stops.law->secant(-kNearPart * stops.play.gap) / stops.law->closed_stiffness();
      if (share > kSoftStart)
        add("regularization",
            "a stop with the gap " + to_short_text(stops.play.gap) + (turns ? " rad has " : " m has ") +
                to_short_text(100.0 * share) +
                " % of its stiffness while it is still open by a tenth of that: the regularization is too small for "
                "the gap; take at least " +
                to_short_text(1.0 / (std::numbers::pi * std::numbers::pi * kNearPart * stops.play.gap * kSoftStart)) +
                (turns ? " 1/rad" : " 1/m") + ", or law = \"linear\"");
    }
  }

  void judge_pull() {
    const auto pull = residual_pull(system_);
    if (!pull) return;
    const double gap = pull->stops->play.gap;
    const auto force_text = [this](double factor, const model::FreeStops& stops) {
      return to_short_text(factor * stops.law->asymptotic_force()) + (acts_on_rotation(system_, stops) ? " N m" : " N");
    };
    if (!pull->displacement || *pull->displacement > kNoticeablePull * gap)
      add("pull",
          "the arctan law has a residual force of up to " + force_text(1.0, *pull->stops) +
              " at every open stop, for any opening" +
              (pull->displacement
                   ? "; together these forces displace the structure at rest by " + to_short_text(*pull->displacement) +
                         (acts_on_rotation(system_, *pull->stops) ? " rad" : " m") +
                         (gap > 0.0 ? ", " + to_short_text(*pull->displacement / gap) + " of the gap" : "")
                   : "") +
              ". A larger regularization reduces it, law = \"linear\" has none");
    for (const auto& stops : system_.stops) {
      if (stops.law->asymptotic_force() == 0.0 || !stops.play.has_both() || !starts_in_the_middle(stops)) continue;
      add("jump", "with the arctan law the force of a stop on both sides jumps by " + force_text(2.0, stops) +
                      " at u = 0, where this scene starts: rounding decides the direction of the force, which limits "
                      "reproducibility. law = \"linear\" has no jump");
      break;
    }
  }

  /// Whether one of the stops has no displacement at the start.
  bool starts_in_the_middle(const model::FreeStops& stops) const {
    const auto displacement = [this](Index i) { return i >= 0 ? system_.initial_displacement[i] : 0.0; };
    for (std::size_t i = 0; i < stops.size(); ++i)
      if (displacement(stops.a[i]) == displacement(stops.b[i])) return true;
    return false;
  }

  void judge_gaps() {
    const Mechanics& mechanics = facts_.mechanics;
    if (mechanics.closed_at_start > 0)
      add("start", std::to_string(mechanics.closed_at_start) +
                       " stops are closed at the start: the initial displacement is beyond their gap");
    if (mechanics.closed_by_constants > 0)
      add("gap", std::to_string(mechanics.closed_by_constants) +
                     " stops have a gap below the static deflection under the sustained part of the loads: they are "
                     "pressed closed, and stay closed unless the rest of the motion opens them");
  }

  void judge_output() {
    const auto interval = session_.output.interval;
    const double contact = facts_.mechanics.shortest_contact;
    if (!interval || session_.output.impacts || contact == 0.0 || *interval * run::kRowsInContact <= contact) return;
    add("output-interval", "a row every " + to_short_text(*interval) + " s, and an impact can be as short as " +
                               to_short_text(contact) +
                               " s: history.csv will not resolve the impact. Take interval = " +
                               to_short_text(contact / (2.5 * run::kRowsInContact)) +
                               " or less, or [output] impacts = true, which lists every impact with its peak force");
  }

  void judge_size() {
    std::error_code error;
    const std::filesystem::space_info disk = std::filesystem::space(".", error);
    if (error || disk.capacity == 0 || !facts_.cost.bytes || *facts_.cost.bytes < static_cast<double>(disk.available))
      return;
    add("size", "the results need about " + to_short_text(1e-9 * *facts_.cost.bytes) + " GB, but " +
                    to_short_text(1e-9 * static_cast<double>(disk.available)) +
                    " GB are free in this folder; take a larger [output] interval, or fewer probes");
  }

  /// The length of a bending wave of angular frequency w is 2 pi (E I/(rho A w^2))^(1/4).
  void judge_mesh() {
    const double period = shortest_period();
    if (std::isinf(period)) return;
    const double omega = 2.0 * std::numbers::pi / period;
    double fewest = std::numeric_limits<double>::infinity();
    const Stretch* worst = nullptr;
    for (const Stretch& stretch : facts_.survey.stretches) {
      const double wave =
          2.0 * std::numbers::pi * std::pow(stretch.bending / (stretch.mass_per_length * omega * omega), 0.25);
      if (wave / stretch.length >= fewest) continue;
      fewest = wave / stretch.length;
      worst = &stretch;
    }
    if (fewest >= kElementsInWave) return;
    add("mesh",
        "the element from " + session_.model.nodes.name(worst->a) + " to " + session_.model.nodes.name(worst->b) +
            " is " + to_short_text(worst->length) + " m long, and a bending wave at the fastest load's frequency " +
            to_short_text(worst->length * fewest) + " m, " + to_short_text(fewest) + " elements; take elements of " +
            to_short_text(worst->length * fewest / kElementsInWave) + " m or less");
  }

  /// Beams that are placed in space and share a node have it at one place.
  void judge_joints() {
    constexpr double kApart = 1e-6;  // of a beam's length
    const model::NodeTable& nodes = session_.model.nodes;
    std::map<model::NodeId, std::pair<model::NodeId, std::array<double, 3>>> places;
    for (const std::string& name : nodes.group_names()) {
      const model::NodeGroup& group = *nodes.find(name);
      const bool is_placed = group.origin != std::array{0.0, 0.0, 0.0} || group.direction != std::array{1.0, 0.0, 0.0};
      for (model::NodeId i = 0; is_placed && !group.lone() && i < group.size(); ++i) {
        const double along = group.coordinates[static_cast<std::size_t>(i)];
        std::array<double, 3> place = group.origin;
        for (std::size_t k = 0; k < 3; ++k) place[k] += along * group.direction[k];
        const auto& [first, there] =
            places.try_emplace(nodes.canonical(group.first + i), group.first + i, place).first->second;
        const double apart = std::hypot(place[0] - there[0], place[1] - there[1], place[2] - there[2]);
        if (apart > kApart * (group.coordinates.back() - group.coordinates.front()))
          add("joint", nodes.name(first) + " and " + nodes.name(group.first + i) + " are one node, but " +
                           to_short_text(apart) + " m apart by the points of their beams");
      }
    }
  }

  /// Young's modulus and density in different units give waves far from those of any structural material.
  void judge_units() {
    constexpr double kSlowest = 50.0, kFastest = 2e4;
    const config::Value* materials = session_.document.root.table()->find("material");
    if (materials == nullptr || materials->table() == nullptr) return;
    for (const auto& [name, value] : materials->table()->entries) {
      const auto number = [&](const char* key) {
        const config::Value* given = value.table() != nullptr ? value.table()->find(key) : nullptr;
        return given != nullptr ? config::as_number(*given).value_or(0.0) : 0.0;
      };
      const double modulus = number("young_modulus"), density = number("density");
      if (!(modulus > 0.0) || !(density > 0.0)) continue;
      const double speed = std::sqrt(modulus / density);
      if (speed >= kSlowest && speed <= kFastest) continue;
      add("units", config::describe(session_.document, value.at) + ": [material." + name +
                       "] has longitudinal waves of " + to_short_text(speed) +
                       " m/s (those of steel have 5100, of rubber 50 or more); is young_modulus = " +
                       to_short_text(modulus) + " in Pa and density = " + to_short_text(density) + " in kg/m3?");
    }
  }

  /// Warns of each [material.X] or [section.X] that no element uses.
  void judge_names(const std::string& kind) {
    const config::Table& root = *session_.document.root.table();
    const config::Value* tables = root.find(kind);
    const config::Value* elements = root.find("element");
    if (tables == nullptr || tables->table() == nullptr) return;
    std::set<std::string> used;
    if (elements != nullptr && elements->array() != nullptr)
      for (const config::Value& element : *elements->array())
        if (const config::Value* name = element.table() != nullptr ? element.table()->find(kind) : nullptr;
            name != nullptr && name->text() != nullptr)
          used.insert(*name->text());
    for (const auto& [name, value] : tables->table()->entries)
      if (!used.contains(name))
        add("unused",
            config::describe(session_.document, value.at) + ": [" + kind + "." + name + "] is not used by any element");
  }

  const scene::Scene& session_;
  const model::System& system_;
  const Facts& facts_;
  std::vector<Advice> advice_;
};

}  // namespace

std::vector<Advice> advise(const scene::Scene& session, const model::System& system, const Facts& facts) {
  return Adviser(session, system, facts).all();
}

}  // namespace butee::app::check
