#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"
#include "butee/record/file.hpp"
#include "butee/study/store.hpp"

namespace butee::study {

namespace fs = std::filesystem;

void Store::keep(std::int64_t chain, std::int64_t run, const Motion& motion) {
  flush();  // Rows first: a sweep that continued after a missing row would never compute it.
  std::vector<std::byte> body, whole;
  ByteWriter to(body);
  to.put(run);
  to.put(motion.x);
  to.put(motion.v);
  to.put(motion.contact);
  ByteWriter sealed(whole);
  sealed.put(checksum(body));
  sealed.put(std::span<const std::byte>(body));
  record::write_whole(file(kSweep + std::to_string(chain) + ".bin"), whole);
}

std::int64_t Store::kept(std::int64_t chain, Motion& motion) const {
  const std::string path = file(kSweep + std::to_string(chain) + ".bin");
  if (!fs::exists(path)) return -1;
  const std::string text = config::read_text(path);
  ByteReader from(std::as_bytes(std::span(text)));
  const auto sum = from.take<std::uint64_t>();
  std::vector<std::byte> body;
  from.take(body);
  if (checksum(body) != sum) throw RunError(path + ": is damaged; delete it to compute its sweep again");
  ByteReader inner(body);
  const auto run = inner.take<std::int64_t>();
  inner.take(motion.x);
  inner.take(motion.v);
  inner.take(motion.contact);
  return run;
}

void Store::forget(std::int64_t chain) {
  flush();
  std::error_code error;
  fs::remove(file(kSweep + std::to_string(chain) + ".bin"), error);
}

}  // namespace butee::study
