// Prints the ratios of times, butee to plain, from the benchmarks' output with --benchmark_out_format=json.
// For several builds, named NAME=FILE, it also prints times relative to the fastest build.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace {

/// Rounding determines the steps of this method on the beams, so it is compared by the time of an attempted
/// step.
constexpr const char* kComparedByTheStep = "RK4-3";

struct Pair {
  double butee = std::numeric_limits<double>::infinity(), plain = butee;
  double ratio() const { return butee / plain; }
};

/// Keeps keys in the order of their first use.
struct Table {
  /// Keeps the smallest time, because disturbances only lengthen times.
  void see(const std::string& key, const std::string& side, double time) {
    if (!pairs.contains(key)) order.push_back(key);
    double& best = side == "butee" ? pairs[key].butee : pairs[key].plain;
    best = std::min(best, time);
  }
  std::vector<std::string> order;
  std::map<std::string, Pair> pairs;
};

std::vector<std::string> split(const std::string& name) {
  std::vector<std::string> parts;
  std::istringstream stream(name);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  return parts;
}

double seconds(const nlohmann::json& run) {
  const std::map<std::string, double> units = {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
  return run.at("cpu_time").get<double>() * units.at(run.at("time_unit").get<std::string>());
}

/// The runs in the order of registration; random interleaving shuffles them in the file.
std::vector<nlohmann::json> runs_of(const nlohmann::json& all) {
  std::vector<nlohmann::json> runs;
  for (const auto& run : all.at("benchmarks"))
    if (run.at("run_type") == "iteration" && !run.value("error_occurred", false)) runs.push_back(run);
  std::stable_sort(runs.begin(), runs.end(),
                   [](const auto& a, const auto& b) { return a.at("family_index") < b.at("family_index"); });
  return runs;
}

void read(const nlohmann::json& all, Table& kernels, Table& methods) {
  for (const auto& run : runs_of(all)) {
    const auto name = split(run.at("run_name"));
    if (name.at(0) == "kernel") {
      kernels.see(name.at(1) + "/" + name.at(2), name.at(3), seconds(run));
    } else if (name.at(0) == "method") {
      const double steps = name.at(2) == kComparedByTheStep ? run.at("attempts").get<double>() : 1.0;
      methods.see(name.at(1) + "/" + name.at(2), name.at(3), seconds(run) / steps);
    }
  }
}

void print_kernels(const Table& table) {
  if (table.order.empty()) return;
  std::puts("| kernel | butee/plain |\n|---|---|");
  for (const std::string& key : table.order) std::printf("| %s | %.2f |\n", key.c_str(), table.pairs.at(key).ratio());
  std::puts("");
}

void add_new(std::vector<std::string>& list, const std::string& entry) {
  if (std::find(list.begin(), list.end(), entry) == list.end()) list.push_back(entry);
}

void print_head(const std::vector<std::string>& columns) {
  std::string head = "| |", rule = "|---|";
  for (const std::string& column : columns) {
    head += " " + column + " |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
}

void print_methods(const Table& table) {
  std::vector<std::string> rows, columns;
  for (const std::string& key : table.order) {
    add_new(rows, split(key).at(0));
    add_new(columns, split(key).at(1));
  }
  if (rows.empty()) return;
  print_head(columns);
  for (const std::string& row : rows) {
    std::printf("| %s |", row.c_str());
    for (const std::string& column : columns) {
      const auto found = table.pairs.find(row + "/" + column);
      found == table.pairs.end() ? std::printf(" |") : std::printf(" %.2f |", found->second.ratio());
    }
    std::puts("");
  }
}

struct Build {
  std::string name;
  Table methods;
};

/// For each method, geometric means over its cases of two ratios: to the time of the fastest build, and to
/// the time of the plain program compiled with the same flags.
void print_builds(const std::vector<Build>& builds) {
  std::vector<std::string> columns;
  std::map<std::string, double> least;
  for (const Build& build : builds)
    for (const std::string& key : build.methods.order) {
      add_new(columns, split(key).at(1));
      const double time = build.methods.pairs.at(key).butee;
      double& known = least.try_emplace(key, time).first->second;
      known = std::min(known, time);
    }
  print_head(columns);
  for (const Build& build : builds) {
    std::printf("| %s |", build.name.c_str());
    for (const std::string& column : columns) {
      double beside_best = 0.0, beside_plain = 0.0, cases = 0.0;
      for (const auto& [key, pair] : build.methods.pairs) {
        if (split(key).at(1) != column) continue;
        beside_best += std::log(pair.butee / least.at(key));
        beside_plain += std::log(pair.ratio());
        ++cases;
      }
      std::printf(" %.2f (%.2f) |", std::exp(beside_best / cases), std::exp(beside_plain / cases));
    }
    std::puts("");
  }
}

/// Several files of one build are repeated measurements.
void read_build(const std::string& argument, std::vector<Build>& builds) {
  const auto end = argument.find('=');
  const std::string name = argument.substr(0, end);
  auto build = std::find_if(builds.begin(), builds.end(), [&](const Build& known) { return known.name == name; });
  if (build == builds.end()) build = builds.insert(build, {name, {}});
  std::ifstream file(argument.substr(end + 1));
  Table kernels;
  read(nlohmann::json::parse(file), kernels, build->methods);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool are_builds = !arguments.empty() && arguments.front().find('=') != std::string::npos;
  if (arguments.empty() || (arguments.size() > 1 && !are_builds)) {
    std::fputs("usage: ratio-table FILE.json | NAME=FILE.json..., written by benchmarks --benchmark_out_format=json\n",
               stderr);
    return 2;
  }
  try {
    if (are_builds) {
      std::vector<Build> builds;
      for (const std::string& argument : arguments) read_build(argument, builds);
      print_builds(builds);
      return 0;
    }
    std::ifstream file(argv[1]);
    Table kernels, methods;
    read(nlohmann::json::parse(file), kernels, methods);
    print_kernels(kernels);
    print_methods(methods);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ratio-table: %s: %s\n", argv[1], error.what());
    return 1;
  }
  return 0;
}
