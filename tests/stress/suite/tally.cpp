#include "tally.hpp"

#include <algorithm>
#include <ctime>
#include <sstream>

#include <butee/core/text.hpp>

namespace butee::stress {
namespace {

/// Work limit of `exact`, independent of that of the methods; a scene that reaches it is shortened.
constexpr std::int64_t kReferenceWork = 200000;
/// Largest work limit of methods that are only recorded.
constexpr std::int64_t kRecordedWork = 40000;

}  // namespace

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
  out << "\n"
      << uncertain << " references differ before the trust horizon, " << unjudged
      << " scenes have nothing to compare with, " << complaints.size() << " are no scenes; references took "
      << to_short_text(reference_seconds) << " s.\n";
  for (const std::string& complaint : complaints) out << "\n" << complaint << "\n";
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
    const std::clock_t begin = std::clock();
    Reference reference(scene, kReferenceWork);
    tally.reference_seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    ++tally.scenes;
    if (!reference.complaint().empty()) {
      tally.complaints.push_back(scene.name + ": " + reference.complaint());
      continue;
    }
    tally.uncertain += reference.is_uncertain() ? 1 : 0;
    tally.unjudged += reference.exists() ? 0 : 1;
    for (const Method& method : methods) {
      const Outcome outcome = run(scene, method, reference, method.is_judged ? work : std::min(work, kRecordedWork));
      tally.add(scene, method, outcome);
      if (on_run) on_run(scene, method, outcome);
    }
  }
}

}  // namespace butee::stress
