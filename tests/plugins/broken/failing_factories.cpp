#include <stdexcept>

#include <butee/plugin/entry.hpp>

namespace {

using butee::config::Diagnostics;
using butee::config::Parameters;

butee::model::LawType law(const char* name, void (*fail)()) {
  return {.name = name,
          .summary = "a law that cannot be made",
          .parameters = {},
          .make = [fail](const Parameters&, Diagnostics&) -> std::unique_ptr<butee::model::ContactLaw> {
            fail();
            return nullptr;
          }};
}

/// A circle that does not say so.
class Curved final : public butee::model::ContactShape {
 public:
  explicit Curved(double gap) : gap_(gap) {}
  butee::model::Approach at(const Eigen::Vector2d& d) const override {
    const double r = d.norm();
    if (r == 0.0) return {-gap_, {1.0, 0.0}, 0.0};
    return {r - gap_, d / r, 1.0 / r};
  }

 private:
  double gap_;
};

}  // namespace

BUTEE_PLUGIN(registrar) {
  registrar.add(law("no_law", [] {}));
  registrar.add(law("law_with_an_error", [] { throw std::runtime_error("no licence for this law"); }));
  registrar.add(law("law_with_a_number", [] { throw 5; }));
  registrar.add(butee::model::FieldFormat{.name = "no_writer",
                                          .summary = "a format without a writer",
                                          .parameters = {},
                                          .make = [](const std::string&, const butee::model::FieldLayout&)
                                              -> std::unique_ptr<butee::model::FieldWriter> { return nullptr; },
                                          .open = {}});
  registrar.add(butee::model::ContactType{
      .name = "curved",
      .summary = "a circle",
      .parameters = {},
      .make = [](const Parameters&, double gap, Diagnostics&) -> std::unique_ptr<butee::model::ContactShape> {
        return std::make_unique<Curved>(gap);
      }});
}
