#include <atomic>
#include <cstdlib>

#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

// Every allocation of this program and of the libraries it loads goes through here. The sanitizers have their own.
#ifndef __SANITIZE_ADDRESS__

namespace {
std::atomic<long> allocations{0};
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
}

namespace butee::test {
namespace {

/// A beam that rattles between its stops, of `elements` elements: dense for few of them, sparse for many.
std::string rattling_beam(const MethodCase& method, int elements, const std::string& damping) {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
         "0.02\n"
         "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements = " +
         std::to_string(elements) +
         "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\nlaw = \"arctan\"\n"
         "regularization = 1e5\n[[load]]\ntype = \"harmonic\"\nnode = \"b:1\"\namplitude = 500.0\nangular_frequency = "
         "60.0\n"
         "[damping]\n" +
         damping +
         "\n[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n"
         "[integrator]\ntype = \"" +
         method.name + "\"\ntime_step = 1e-6\nend_time = 1.0\n" + method.keys;
}

class Allocation : public testing::TestWithParam<MethodCase> {};

TEST_P(Allocation, StepsAllocateNothingAfterTheFirstUseOfAStepSize) {
  // Modal damping of every mode makes the large system dense, that of two modes a sparse one of low rank.
  for (const auto& [elements, damping] :
       {std::pair(6, "mass_proportional = 0.5"), std::pair(100, "mass_proportional = 0.5"),
        std::pair(6, "modal = 0.02"), std::pair(100, "modal = 0.02"), std::pair(100, "modal = [0.02, 0.01]")}) {
    SceneRun run(rattling_beam(GetParam(), elements, damping));
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.simulation().advance());
    const time::State begin = run.simulation().state();
    time::State from, to;
    const auto take_steps = [&] {
      constexpr double kStep = 1e-6;
      from = begin;
      for (int i = 0; i < 100; ++i) {
        run.integrator().step(from, {kStep, from.t + kStep}, to);
        std::swap(from, to);
      }
    };
    // The same way again: caches, such as the pieces of a step with many changes of contact, grow at their first use,
    // and a warning that fifteen steps in a row give rise to comes once.
    take_steps();
    take_steps();
    const long before = allocations;
    take_steps();
    EXPECT_EQ(allocations - before, 0) << elements << " elements, " << damping;
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Allocation, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

TEST(Allocation, IsCounted) {
  const long before = allocations;
  const std::vector<double> something(1000);
  EXPECT_EQ(something.size(), 1000U);
  EXPECT_GT(allocations - before, 0);
}

}  // namespace
}  // namespace butee::test

#endif
