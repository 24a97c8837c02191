#pragma once

#include <array>
#include <memory>

#include "butee/model/field_format.hpp"
#include "butee/model/output_request.hpp"
#include "butee/record/accelerations.hpp"
#include "butee/record/contacts_on.hpp"
#include "butee/record/output_times.hpp"

namespace butee::record {

/// Samples fields at the output times, by the method's own interpolant, and passes the records to
/// writers.
///
/// A fixed or absent degree of freedom counts as zero. Memory holds one record and the numbers of
/// the nodes' degrees of freedom, for any length of the run.
class BUTEE_EXPORT FieldRecorder final : public time::Observer {
 public:
  /// `output.fields` gives the request; `dynamics` must outlive this object.
  FieldRecorder(const model::OutputRequest& output, double end_time, dynamics::Dynamics& dynamics,
                std::vector<std::unique_ptr<model::FieldWriter>> writers);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void finish() override;
  /// Throws RunError, since written records cannot be removed.
  void restore(ByteReader& from) override;
  double next_instant(double t) const override { return times_.next_instant(t); }
  bool watches_every_step() const override { return times_.counts_steps(); }
  double file_seconds() const override { return seconds_; }

 private:
  /// One stop on a recorded node: the indices of its ends among the sampled degrees of freedom.
  struct KeptStop {
    Index stop;
    std::int32_t a, b;
  };

  /// For a quantity of a node measured in another frame than x: the term added at its place in the
  /// record.
  struct BaseTerm {
    std::size_t place;
    model::BaseShare share;
  };

  void find_dofs(const std::vector<model::NodeId>& nodes);
  void find_base_terms(const std::vector<model::NodeId>& nodes);
  void find_stops();
  void evaluate_stops(std::span<const double> x);
  /// For contacts with dissipation or friction or in the plane, and stops on other DOFs than u: the contacts of each
  /// node, and the DOFs on which they depend.
  void find_contacts(const std::vector<model::NodeId>& nodes);
  /// Fills force_ and state_, one entry for each node.
  void evaluate_contacts(double t, const time::Interpolated& samples);
  /// Fills a record from x, v, a at dofs_ at an instant.
  void fill(double t, const time::Interpolated& samples);
  void fill(const time::State& state);
  void write(double t);

  dynamics::Dynamics& dynamics_;
  Accelerations accelerations_;
  OutputTimes times_;
  std::vector<model::Quantity> quantities_;
  std::vector<std::unique_ptr<model::FieldWriter>> writers_;
  std::vector<Index> dofs_;                                  ///< sampled DOFs
  std::array<std::vector<std::int32_t>, kDofKinds> places_;  ///< by kind and recorded node: the index in dofs_, or -1
  std::vector<BaseTerm> base_;
  std::vector<KeptStop> stops_;
  std::vector<ContactsOn> contacts_;  ///< of each recorded node; empty if stops_ are all that is needed
  Vector all_x_, all_v_;              ///< motion of the DOFs of contacts_
  std::vector<dynamics::ContactForces> forces_;
  std::vector<double> x_, v_, a_, force_, state_, record_;
  bool needs_v_ = false, needs_a_ = false, needs_stops_ = false;
  bool finished_ = false;
  double start_time_ = 0.0, seconds_ = 0.0;
};

}  // namespace butee::record
