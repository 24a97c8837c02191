#include "tally.hpp"

#include <algorithm>
#include <sstream>

#include <butee/core/text.hpp>

namespace butee::stress {

void Tally::add(const Scene& scene, const Method& method, const Outcome& outcome) {
  Row& row = rows_[method.name];
  ++row.runs;
  ++row.counts[static_cast<std::size_t>(outcome.verdict)];
  row.cut += outcome.was_cut ? 1 : 0;
  row.warned += outcome.has_warned ? 1 : 0;
  row.inaccurate_unwarned += outcome.verdict == Verdict::inaccurate && !outcome.has_warned && !outcome.was_cut ? 1 : 0;
  row.seconds += outcome.seconds;
  row.slowest = std::max(row.slowest, outcome.seconds);
  if (outcome.verdict == Verdict::correct || outcome.verdict == Verdict::wrong)
    row.worst = std::max(row.worst, outcome.excess);
  if (is_failure(outcome.verdict)) failures_.push_back({scene.name, method.name, outcome});
}

std::int64_t Tally::count(Verdict verdict) const {
  std::int64_t sum = 0;
  for (const auto& [name, row] : rows_) sum += row.counts[static_cast<std::size_t>(verdict)];
  return sum;
}

std::string Tally::markdown() const {
  std::ostringstream out;
  out << "| method | runs |";
  for (int i = 0; i < kVerdicts; ++i) out << " " << name_of(static_cast<Verdict>(i)) << " |";
  out << " cut | warned | inaccurate without a warning | worst error / allowed | CPU s | slowest run s |\n|---|";
  for (int i = 0; i < kVerdicts + 7; ++i) out << "---|";
  out << "\n";
  for (const auto& [name, row] : rows_) {
    out << "| `" << name << "` | " << row.runs << " |";
    for (const std::int64_t count : row.counts) out << " " << count << " |";
    out << " " << row.cut << " | " << row.warned << " | " << row.inaccurate_unwarned << " | "
        << to_short_text(row.worst) << " | " << to_short_text(row.seconds) << " | " << to_short_text(row.slowest)
        << " |\n";
  }
  if (failures_.empty()) return out.str();
  out << "\n| scene | method | what | error | allowed | message |\n|---|---|---|---|---|---|\n";
  for (const Failure& f : failures_)
    out << "| " << f.scene << " | `" << f.method << "` | " << name_of(f.outcome.verdict) << " | "
        << to_short_text(f.outcome.error) << " | " << to_short_text(f.outcome.allowed) << " | " << f.outcome.message
        << " |\n";
  return out.str();
}

void run_all(const std::vector<Scene>& scenes, const std::vector<Method>& methods, std::int64_t work, Tally& tally,
             const std::function<void(const Scene&, const Method&, const Outcome&)>& on_run) {
  for (const Scene& scene : scenes) {
    const Reference reference(scene, work);
    ++tally.scenes;
    for (const Method& method : methods) {
      const Outcome outcome = run(scene, method, reference, work);
      tally.add(scene, method, outcome);
      if (on_run) on_run(scene, method, outcome);
    }
  }
}

}  // namespace butee::stress
