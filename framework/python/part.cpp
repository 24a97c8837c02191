#include "butee/python/part.hpp"

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/embed/forced_dof.hpp"
#include "butee/time/snapshot.hpp"

namespace butee::python {
namespace {

/// The warnings of the scene were given when it was made.
embed::Structure structure_of(const Session& session, const std::vector<std::string>& forced) {
  const log::WithoutWarnings quiet;
  return embed::Structure::from_document(session.document(),
                                         {.forced = forced, .catalogue = session.scene().catalogue});
}

}  // namespace

Part::Part(const Session& session, std::vector<std::string> forced)
    : session_(session), forced_(std::move(forced)), structure_(structure_of(session, forced_)) {
  for (const std::string& selector : forced_) {
    const auto [nodes, kind] = embed::split_forced(selector);
    for (const Index dof : structure_.dofs(nodes, kind)) forced_dofs_.push_back(dof);
  }
}

Part::Locked Part::use() {
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock())
    throw RunError(
        "the structure is in use, by another thread or by the run that calls this function; each thread needs its own "
        "structure");
  return {structure_, std::move(lock)};
}

std::vector<std::byte> to_bytes(const embed::Structure::Snapshot& snapshot) {
  std::vector<std::byte> run, all;
  ByteWriter to_run(run);
  time::write_snapshot(snapshot.run, to_run);
  ByteWriter to(all);
  to.put(std::span<const std::byte>(run));
  to.put(snapshot.origin);
  to.put(static_cast<std::uint64_t>(snapshot.forces.size()));
  for (const auto& line : snapshot.forces)
    for (const double number : {line.value, line.slope, line.begin}) to.put(number);
  to.put(checksum(all));
  return all;
}

embed::Structure::Snapshot to_snapshot(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) throw RunError("the bytes are not a snapshot");
  const auto content = bytes.first(bytes.size() - sizeof sum);
  ByteReader(bytes.last(sizeof sum)).take(sum);
  if (sum != checksum(content)) throw RunError("the bytes are not a snapshot");
  ByteReader from(content);
  std::vector<std::byte> run;
  from.take(run);
  ByteReader from_run(run);
  embed::Structure::Snapshot snapshot{time::read_snapshot(from_run), {}, 0};
  from.take(snapshot.origin);
  snapshot.forces.resize(from.count(3 * sizeof(double)));
  for (auto& line : snapshot.forces)
    for (double* number : {&line.value, &line.slope, &line.begin}) from.take(*number);
  return snapshot;
}

}  // namespace butee::python
