#include <cstdint>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <butee/core/bytes.hpp>
#include <butee/dynamics/tangent_solver.hpp>
#include <butee/plugin/entry.hpp>
#include <butee/time/simulation.hpp>
#include <butee/version.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::interface_layout_test {
namespace {

namespace fs = std::filesystem;

/// The digest of layout() for each BUTEE_INTERFACE_VERSION recorded by this test, for 64-bit libstdc++.
const std::map<int, std::uint64_t> kDigests = {
    {9, 0xbefe495462ff291b},  {10, 0xd8555c349d44de36}, {11, 0x6e3a3920419a9a1e}, {12, 0xd26b3f2cbf556dcd},
    {13, 0x57900ce29727d513}, {14, 0xba7a2c3fd23afaf8}, {15, 0xe938d542d056cba8}, {16, 0x4e376cfa5df14448},
    {17, 0x648831418307f413}, {18, 0x5758c22ce0d02310}, {19, 0x29faed57087dbb1e}, {20, 0x757e537388de2409},
    {21, 0xc84b0764f221c814},
    {22, 0xa3cfcb813d848504},
};

/// The folders whose types modules derive from, store or pass. Types of scenes, records and embedding do not
/// cross this interface.
constexpr const char* kRooms[] = {"core", "config", "model", "linalg", "dynamics", "time", "plugin"};

template <class Type>
std::string line_of(const char* name) {
  return std::string(name) + " " + std::to_string(sizeof(Type)) + " " + std::to_string(alignof(Type)) + "\n";
}

/// The offset of a member in its struct.
template <class Struct, class Member>
std::string place_of(const char* name, Member Struct::*member) {
  const Struct whole{};
  const auto* begin = reinterpret_cast<const char*>(&whole);
  return std::string(name) + " at " + std::to_string(reinterpret_cast<const char*>(&(whole.*member)) - begin) + "\n";
}

/// The value of the last enumerator, which changes if another one is inserted.
template <class Enumeration>
std::string last_of(const char* name, Enumeration last) {
  return std::string(name) + " = " + std::to_string(static_cast<int>(last)) + "\n";
}

/// All virtual functions of the installed headers in order of declaration, which is their order in the
/// virtual function table.
std::string virtual_functions() {
  const std::regex declaration(R"(\n\s*virtual\s[^;{]*)"), space(R"(\s+)");
  std::string all;
  for (const char* room : kRooms) {
    std::set<fs::path> headers;
    for (const auto& entry : fs::directory_iterator(fs::path(BUTEE_TEST_SOURCE) / "framework" / room))
      if (entry.path().extension() == ".hpp") headers.insert(entry.path());
    for (const fs::path& header : headers) {
      const std::string text = read_file(header.string());
      for (std::sregex_iterator found(text.begin(), text.end(), declaration), end; found != end; ++found)
        all += header.filename().string() + ":" + std::regex_replace(found->str(), space, " ") + "\n";
    }
  }
  return all;
}

std::string layout() {
  using namespace time;
  std::string text;
  text += line_of<State>("State") + place_of("t", &State::t) + place_of("x", &State::x) + place_of("v", &State::v) +
          place_of("a", &State::a) + place_of("memory", &State::memory);
  text += line_of<Step>("Step") + place_of("h", &Step::h) + place_of("t_end", &Step::t_end) +
          place_of("single", &Step::single);
  text += line_of<StepReport>("StepReport") + place_of("status", &StepReport::status) +
          place_of("error", &StepReport::error) + place_of("proposal", &StepReport::proposal) +
          place_of("newton_iterations", &StepReport::newton_iterations) +
          place_of("kept_failure", &StepReport::kept_failure) + place_of("inner_steps", &StepReport::inner_steps) +
          place_of("inner_rejected", &StepReport::inner_rejected) + place_of("worst_dof", &StepReport::worst_dof);
  text += line_of<StepDecision>("StepDecision") + line_of<Interpolated>("Interpolated") +
          line_of<EnergyAt>("EnergyAt") + line_of<AcceptedStep>("AcceptedStep") + line_of<DenseOutput>("DenseOutput") +
          line_of<Interpolant>("Interpolant");
  text += line_of<Traits>("Traits") + place_of("lands_on_outputs", &Traits::lands_on_outputs) +
          place_of("starts_as_published", &Traits::starts_as_published) +
          place_of("event_precision", &Traits::event_precision) + place_of("stability_limit", &Traits::stability_limit);
  text += line_of<Integrator>("Integrator") + line_of<IntegratorType>("IntegratorType") +
          line_of<StepController>("StepController") + line_of<MethodLimits>("MethodLimits");
  text +=
      last_of("power", Detail::power) + last_of("other", Interpolation::other) + last_of("all", ContactSupport::all);
  text += line_of<dynamics::Dynamics>("Dynamics") + line_of<dynamics::ElasticStops>("ElasticStops") +
          line_of<dynamics::EffectiveSolver>("EffectiveSolver") + line_of<dynamics::ModalSystem>("ModalSystem") +
          line_of<dynamics::ModalPropagator>("ModalPropagator") +
          line_of<dynamics::ContactPropagator>("ContactPropagator") + line_of<dynamics::StopShapes>("StopShapes");
  text += line_of<dynamics::Obstacles>("Obstacles") + line_of<dynamics::TangentSolver>("TangentSolver");
  text += line_of<linalg::Counters>("Counters") + line_of<linalg::ForceBalance>("ForceBalance") +
          line_of<linalg::DenseProduct>("DenseProduct");
  text += line_of<model::System>("System") + line_of<model::Model>("Model") + line_of<model::Damping>("Damping") +
          line_of<model::Load>("Load") + line_of<model::StopGroup>("StopGroup") + line_of<model::DofTable>("DofTable") +
          line_of<model::NodeTable>("NodeTable") + line_of<model::NodalDof>("NodalDof");
  text += line_of<model::Element>("Element") + line_of<model::ElementMatrices>("ElementMatrices") +
          line_of<model::SectionCut>("SectionCut") + line_of<model::ElementContext>("ElementContext") +
          line_of<model::Section>("Section") + line_of<model::Material>("Material");
  text += line_of<model::ContactLaw>("ContactLaw") + line_of<model::ForceSeries>("ForceSeries") +
          line_of<model::TimeFunction>("TimeFunction") + line_of<model::Harmonic>("Harmonic");
  text += line_of<model::FieldLayout>("FieldLayout") + line_of<model::FieldWriter>("FieldWriter") +
          line_of<model::FieldReader>("FieldReader");
  text += line_of<model::ElementType>("ElementType") + line_of<model::LawType>("LawType") +
          line_of<model::LoadType>("LoadType") + line_of<model::FieldFormat>("FieldFormat");
  text += line_of<config::Parameter>("Parameter") + line_of<config::Parameters>("Parameters");
  text += line_of<plugin::ModuleTypes>("ModuleTypes") + line_of<plugin::Registrar>("Registrar") +
          line_of<butee_abi_tag>("butee_abi_tag");
  return text + virtual_functions();
}

TEST(InterfaceLayout, ChangesOnlyWithTheVersionOfTheInterface) {
#if !defined(__GLIBCXX__) || defined(_GLIBCXX_DEBUG)
  GTEST_SKIP() << "the digests are those of libstdc++ without its debug mode";
#endif
  if (sizeof(void*) != 8) GTEST_SKIP() << "the digests are those of 64 bits";
  const std::string text = layout();
  const std::uint64_t digest = checksum(std::as_bytes(std::span(text)));
  std::ostringstream advice;
  advice << "The layout of what modules share with the library is not that of interface version "
         << BUTEE_INTERFACE_VERSION
         << ". Count BUTEE_INTERFACE_VERSION up in framework/CMakeLists.txt, unless only the "
         << "name of a parameter of a virtual function changed, and add {version, 0x" << std::hex << digest
         << "} here. The layout is:\n"
         << text;
  const auto known = kDigests.find(BUTEE_INTERFACE_VERSION);
  ASSERT_NE(known, kDigests.end()) << advice.str();
  EXPECT_EQ(known->second, digest) << advice.str();
}

TEST(InterfaceLayout, EveryVersionHasItsOwn) {
  std::set<std::uint64_t> digests;
  for (const auto& [version, digest] : kDigests) EXPECT_TRUE(digests.insert(digest).second) << version;
  EXPECT_EQ(kDigests.rbegin()->first, BUTEE_INTERFACE_VERSION);
}

}  // namespace
}  // namespace butee::test::interface_layout_test
