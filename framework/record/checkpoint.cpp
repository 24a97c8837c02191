#include "butee/record/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include <butee/version.hpp>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/target.hpp"
#include "butee/core/text.hpp"
#include "butee/record/file.hpp"

namespace butee::record {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMark = 0x0A747063'65747562U;  // "butecpt\n"
constexpr std::uint32_t kFormat = 4;
constexpr const char* kNewest = "checkpoint.bin";
constexpr const char* kBefore = "checkpoint-before.bin";

/// All counters, in the order in which they are stored.
template <class Counters>
auto all(Counters& c) {
  return std::array{&c.force_evaluations, &c.contact_evaluations, &c.law_evaluations,
                    &c.factorizations,    &c.factor_updates,      &c.solves};
}

/// Throws InputError if the rest of the run would not be bit-identical.
void check_target(const std::string& path, const Checkpoint& checkpoint) {
  const std::string& mine = butee::target();
  const std::string anew = "run the model again";
  if (checkpoint.target != mine) {
    const std::vector<std::string> here = targets();
    const bool is_here = std::find(here.begin(), here.end(), checkpoint.target) != here.end();
    throw InputError(path + ": was written with the instruction set " + checkpoint.target + ", but this run uses " +
                     mine + ", whose results differ in their last digits; " +
                     (is_here
                          ? "set BUTEE_TARGET=" + checkpoint.target + " to resume it, or " + anew
                          : "this processor has no " + checkpoint.target + " (it has " + join(here) + "): " + anew));
  }
  if (checkpoint.compiled_for != compiled_for())
    throw InputError(path + ": was written by a butee compiled for " + checkpoint.compiled_for +
                     ", but this one is compiled for " + compiled_for() +
                     ", whose results differ in their last digits; resume it with that butee, or " + anew);
}

}  // namespace

std::vector<std::byte> to_bytes(const Checkpoint& checkpoint) {
  std::vector<std::byte> content, bytes;
  ByteWriter inner(content);
  inner.put(checkpoint.method);
  inner.put(checkpoint.target);
  inner.put(checkpoint.compiled_for);
  inner.put(checkpoint.model);
  inner.put(checkpoint.history);
  inner.put(checkpoint.setup_seconds);
  for (const std::int64_t* counter : all(checkpoint.counters)) inner.put(*counter);
  write_snapshot(checkpoint.snapshot, inner);
  ByteWriter outer(bytes);
  outer.put(kMark);
  outer.put(kFormat);
  outer.put(std::string(BUTEE_VERSION));
  outer.put(checksum(content));
  outer.put(std::span<const std::byte>(content));
  return bytes;
}

Checkpoint to_checkpoint(std::span<const std::byte> bytes) {
  ByteReader outer(bytes);
  if (outer.take<std::uint64_t>() != kMark) throw RunError("is not a checkpoint of butee");
  if (const auto format = outer.take<std::uint32_t>(); format != kFormat)
    throw InputError("is of format " + std::to_string(format) + "; this butee reads " + std::to_string(kFormat) +
                     "; resume with the version that wrote it, or run the model again");
  std::string version;
  outer.take(version);
  if (version != BUTEE_VERSION)
    throw InputError("was written by butee " + version +
                     "; this is " BUTEE_VERSION
                     ", whose results may differ in the last digits; resume with that version, or run the model again");
  const auto sum = outer.take<std::uint64_t>();
  std::vector<std::byte> content;
  outer.take(content);
  if (!outer.at_end() || checksum(content) != sum) throw RunError("is damaged: its checksum is wrong");
  ByteReader inner(content);
  Checkpoint checkpoint;
  inner.take(checkpoint.method);
  inner.take(checkpoint.target);
  inner.take(checkpoint.compiled_for);
  inner.take(checkpoint.model);
  inner.take(checkpoint.history);
  inner.take(checkpoint.setup_seconds);
  for (std::int64_t* counter : all(checkpoint.counters)) inner.take(*counter);
  checkpoint.snapshot = time::read_snapshot(inner);
  return checkpoint;
}

void CheckpointFolder::write(const Checkpoint& checkpoint) const {
  const std::string newest = folder_.file(kNewest), draft = folder_.file("checkpoint-next.bin");
  write_whole(draft, to_bytes(checkpoint));
  // A kill between the two leaves only the previous checkpoint, which is complete.
  std::error_code error;
  fs::rename(newest, folder_.file(kBefore), error);
  fs::rename(draft, newest, error);
  if (error) throw RunError(newest + ": cannot be written: " + error.message());
}

std::optional<Checkpoint> CheckpointFolder::read(const std::string& name) const {
  const std::string path = folder_.file(name);
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  const std::string text = folder_.read(name);
  const auto drop = [&](const std::string& reason) {
    log::warning(path + ": " + reason + "; it is not used");
    fs::remove(path, error);
    return std::nullopt;
  };
  try {
    Checkpoint checkpoint;
    try {
      checkpoint = to_checkpoint(std::as_bytes(std::span(text)));
    } catch (const InputError& refusal) {
      throw InputError(path + ": " + refusal.what());
    }
    if (checkpoint.model != folder_.checksum_of("model.toml"))
      throw InputError(folder_.file("model.toml") + ": is not the model that " + path +
                       " was written for; put it back as it was, or run the model again");
    check_target(path, checkpoint);
    const auto size = fs::file_size(folder_.file("history.csv"), error);
    if (error || size < checkpoint.history)
      return drop("history.csv has lost rows that belong to it (" + std::to_string(checkpoint.history) +
                  " bytes were written)");
    return checkpoint;
  } catch (const RunError& damage) {
    return drop(damage.what());
  }
}

std::optional<Checkpoint> CheckpointFolder::newest() const {
  auto found = read(kNewest);
  return found ? std::move(found) : read(kBefore);
}

void CheckpointFolder::clear() const {
  std::error_code error;
  for (const char* name : {kNewest, kBefore}) fs::remove(folder_.file(name), error);
}

}  // namespace butee::record
