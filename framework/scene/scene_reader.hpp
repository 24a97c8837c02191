#pragma once

#include <map>

#include "butee/scene/element_sums.hpp"
#include "butee/scene/read_model.hpp"

namespace butee::scene {

using namespace model;  // The readers fill the model and use its names throughout.

/// The state shared by the readers of a scene's tables. Private to the framework.
class SceneReader {
 public:
  SceneReader(const config::Value& root, const ModelTypes& types, config::Diagnostics& diagnostics)
      : root_(root), types_(types), diagnostics_(diagnostics) {}

  Model read();

 private:
  friend class ReadingContext;

  struct PendingElement {
    const ElementType* type;
    config::Parameters parameters;
    NodeId own_node;
  };

  void read_header();
  void read_materials();
  void read_sections();
  void read_elements();
  std::optional<PendingElement> read_element(const config::Value& entry, const std::string& path);
  void check_size(const std::vector<double>& coordinates, const std::string& path, const config::Value& entry);
  void excuse_names_of(const config::Value& entry);
  void read_rotation();
  std::unique_ptr<Rotation> read_speed(const config::Value& rotation);
  /// Warns of discs that stand still on shafts that turn.
  void warn_of_standing_discs();
  void choose_turning(const config::Parameters& parameters);
  void read_gravity();
  void read_base();
  void read_base_entry(const config::Value& entry, const std::string& path, bool takes_nodes);
  bool read_base_nodes(const config::Parameters& parameters, BaseMotion& base);
  void integrate_base(const TimeFunction& acceleration, double initial_velocity, BaseMotion& base);
  /// Whether a harmonic acceleration turns so little in the run that its double integral is rounding.
  bool loses_digits(const SmoothMotion& acceleration) const;
  bool differentiate_base(const config::Value& motion, const std::string& path, const TimeFunction& displacement,
                          BaseMotion& base);
  bool can_be_still(const config::Value& given);
  void add_base_loads(const BaseMotion& base);
  void read_preload();
  void find_preload_of_gravity();
  void check_buckling();
  void read_frame(const config::Parameters& parameters);
  void read_supports();
  void read_contacts();
  struct ContactKind;
  struct ContactParts;
  void read_contact(const config::Value& entry, const std::string& path);
  ContactKind contact_kind(const config::Value& entry, const std::string& path);
  /// Nothing after an error, as contact_parts().
  std::optional<std::vector<DofKind>> contact_directions(const config::Parameters& parameters, const ContactKind& kind);
  std::optional<ContactParts> contact_parts(const config::Parameters& parameters, const ContactKind& kind,
                                            const std::string& path, const config::Value& entry);
  /// Warns of a contact none of whose ends can move.
  void warn_of_fixed_ends(const config::Parameters& parameters, const ContactParts& parts);
  /// False after an error, as add_obstacle().
  bool add_contacts(const config::Parameters& parameters, const ContactKind& kind, const ContactParts& parts);
  bool add_obstacle(const config::Parameters& parameters, const ContactKind& kind, const ContactParts& parts,
                    std::size_t gap, Sides side);
  /// The gap of each contact, or one for all.
  std::optional<std::vector<double>> read_gaps(const config::Parameters& parameters, std::size_t count);
  /// False after reporting that an obstacle of this form does not support friction with this kind
  /// of stick.
  bool check_stick(const config::Parameters& p, Friction::Rule rule, const ContactShape::Form& form);
  bool read_ends(const config::Parameters& parameters, const std::vector<DofKind>& directions, std::vector<NodeId>& a,
                 std::vector<NodeId>& b);
  bool read_pairs(const config::Parameters& parameters, const std::vector<DofKind>& directions, std::vector<NodeId>& a,
                  std::vector<NodeId>& b);
  bool check_directions(const config::Parameters& parameters, const char* key, NodeId node,
                        const std::vector<DofKind>& directions);
  void read_loads();
  void read_load(const config::Value& entry, const std::string& path);
  void read_turning_unbalance(const config::Value& entry, const std::string& path);
  void read_distributed(const config::Value& entry, const std::string& path);
  /// `unit`: that of the values.
  std::unique_ptr<TimeFunction> read_in_time(const config::Value& entry, const std::string& path,
                                             const std::vector<std::string>& ignored, const char* unit);
  void read_damping();
  void read_modal_damping(const config::Value& given);
  void read_initial();
  void read_initial_list(const config::Value& given, const std::string& key);
  void read_initial_entry(const config::Value& entry, const std::string& path, const std::string& key);
  /// The values of an entry, node by node; empty after an error.
  std::vector<NodalValue> rigid_rotation(const config::Parameters& parameters, const std::vector<NodeId>& nodes);
  void read_initial_motion(const config::Parameters& parameters);
  void check_dofs();
  /// Reports elements whose matrices are not finite or too stiff to be computed.
  void check_magnitudes();
  /// Reports elements beside which the rounding of a sum of stiffnesses is much of what holds its DOF.
  void check_rounding();
  /// The end_time of the scene, s; 1 if it is missing or wrong, which is reported elsewhere.
  double run_time() const;
  /// Reports a contact that is too stiff for the mass at its nodes; `stiffness` in N/m or N m/rad.
  void check_rate(const config::Parameters& parameters, const std::string& key, double stiffness,
                  const std::vector<NodeId>& nodes, const std::vector<DofKind>& directions);
  /// Reports Rayleigh damping that is too strong to be computed.
  void check_decay(const config::Parameters& parameters);
  void check_free(const config::Parameters& parameters, const std::string& key, NodalDof dof, const char* what);

  /// The entries of an array of tables at the root, each with its path ("contact[0]").
  std::vector<std::pair<const config::Value*, std::string>> entries(const std::string& key);
  /// The value of `type` (or another naming key) if it is one of `known`; otherwise reports an
  /// error.
  std::optional<std::string> type_of(const config::Value& entry, const std::string& path, const std::string& key,
                                     const std::vector<std::string>& known, const char* fallback = nullptr);
  std::optional<std::vector<NodeId>> select(const config::Parameters& parameters, const std::string& key);
  std::optional<NodeId> select_one(const config::Parameters& parameters, const std::string& key);
  /// read_parameters(); if a value is wrong, the selectors of the table are still checked.
  std::optional<config::Parameters> read_table(const config::Value& entry, const std::string& path,
                                               const std::vector<config::Parameter>& declared,
                                               const std::vector<std::string>& ignored = {});

  const config::Value& root_;
  const ModelTypes& types_;
  config::Diagnostics& diagnostics_;
  Model model_;
  std::optional<DofTable> dofs_;
  std::vector<Index> rounded_;               ///< free DOFs whose softest stiffness is much smaller than the sum
  std::optional<ElementSums> sums_;          ///< absent after an error in an element or a support
  std::optional<std::size_t> gravity_load_;  ///< index among the loads
  std::optional<BaseFrame> stop_frame_;      ///< of the stops to ground, if there are any
  std::map<std::string, std::optional<Material>> materials_;
  std::map<std::string, std::optional<Section>> sections_;
  std::vector<std::string> element_names_;
  bool lacks_elements_ = false;  ///< an element has an error of its own, so that its DOFs may be missing
  bool too_large_ = false;       ///< the scene does not fit in memory, so that no further nodes are made
  std::vector<std::pair<std::string, const Element*>> named_elements_;
  std::vector<std::pair<std::string, config::Location>> element_places_;
};

}  // namespace butee::scene
