#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "butee/scene/read_scene.hpp"
#include "butee/study/table.hpp"

namespace butee::study {

/// A result collected from each run of a study: "peak rotor.u", "section rotor.u", "impacts".
struct Item {
  enum class Kind { peak, max, min, mean, rms, end, section, frequency, impacts, wear, lyapunov, trust };

  Kind kind = Kind::peak;
  std::string text;   ///< as written
  std::string probe;  ///< label of a probe, or selector of one node; "" if the kind has none
  model::Quantity quantity = model::Quantity::u;
  std::string place = "study.collect";  ///< "study.toml:7: study.collect"

  bool needs_period() const { return kind == Kind::section || kind == Kind::lyapunov; }
};

/// The kinds that `collect` accepts, with a description: "peak", "largest |value| over the motion
/// that counts".
struct ItemKind {
  Item::Kind kind;
  std::string name, summary;
};
BUTEE_EXPORT const std::vector<ItemKind>& item_kinds();

/// Reads "KIND LABEL.QUANTITY" or "KIND". Throws InputError without the key.
BUTEE_EXPORT Item read_item(const std::string& text);

/// The error of an item that a scene does not allow.
InputError refused(const Item& item, const std::string& complaint);

/// The column of an item; a section has `periods` entries.
BUTEE_EXPORT Column column_of(const Item& item, std::int64_t periods);

/// The probe of the scene that an item names, or a new one on the node that it names. Throws
/// InputError.
BUTEE_EXPORT model::ProbeRequest probe_of(const Item& item, const scene::Scene& scene);

/// The part of a run over which results are collected.
struct Counted {
  double begin = 0.0, end = 0.0;                              ///< s
  double period = 0.0;                                        ///< s; 0 if there is none
  std::int64_t periods = 0;                                   ///< number of periods in it
  double interval = std::numeric_limits<double>::infinity();  ///< s; [output] interval of the scene, if it has one
};

class CollectorPart;

/// Observes the part of a run over which results are collected, and gives all items except
/// "lyapunov" and "trust". Collects after open().
class BUTEE_EXPORT Collector final : public time::Observer {
 public:
  /// `dynamics` must outlive this object. Throws InputError if an item names nothing.
  Collector(const std::vector<Item>& items, const scene::Scene& scene, dynamics::Dynamics& dynamics,
            const Counted& counted);
  ~Collector() override;

  /// Starts collecting at this state, that at the beginning of the next step, over the planned
  /// duration.
  void open(const time::State& state);

  void step(const time::AcceptedStep& step) override;
  double next_instant(double t) const override;

  /// The entries of an item, as many as its column has; not for "lyapunov" and "trust".
  std::vector<double> values(std::size_t item) const;

 private:
  std::vector<std::unique_ptr<CollectorPart>> parts_;
  /// For each item, the part that observes it and its index there; null for "lyapunov" and "trust".
  std::vector<std::pair<const CollectorPart*, std::size_t>> places_;
  Counted counted_;
  bool is_open_ = false;
};

}  // namespace butee::study
