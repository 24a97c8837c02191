#include "butee/core/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

#include "butee/core/text.hpp"

namespace butee {
namespace {

/// Every process has this much memory; querying its limits takes longer than the computation of a
/// small system.
constexpr double kAlwaysThere = 16e6;

double limit_of(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

/// The limit of a container; a file that contains "max", or does not exist, sets no limit.
double limit_in(const char* path) {
  std::ifstream file(path);
  double bytes = 0.0;
  return file >> bytes ? bytes : std::numeric_limits<double>::infinity();
}

std::string in_gigabytes(double bytes) {
  return to_short_text(bytes * 1e-9) + " GB";
}

}  // namespace

double memory_limit() {
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::min({machine, limit_of(RLIMIT_AS), limit_of(RLIMIT_DATA), limit_in("/sys/fs/cgroup/memory.max"),
                   limit_in("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
}

std::string memory_complaint(double bytes) {
  if (bytes <= kAlwaysThere) return "";
  const double limit = memory_limit();
  if (bytes <= limit) return "";
  return "needs about " + in_gigabytes(bytes) + " of memory, more than the " + in_gigabytes(limit) +
         " that this process may have";
}

}  // namespace butee
