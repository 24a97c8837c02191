#include <benchmark/benchmark.h>

#include "suite.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  butee::benchmarks::register_kernels();
  butee::benchmarks::register_methods();
  butee::benchmarks::register_scale();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
