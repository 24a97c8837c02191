#include <algorithm>
#include <new>
#include <sstream>

#include <butee/version.hpp>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/embed/butee.h"
#include "butee/embed/structure.hpp"

using butee::embed::Structure;
using butee::embed::StructureOptions;

struct butee_structure {
  Structure structure;
};

struct butee_snapshot {
  Structure::Snapshot snapshot;
};

namespace {

thread_local std::string last_message;

/// Runs `work` and converts any exception to a status and a message.
template <class Work>
int guarded(const Work& work) noexcept {
  try {
    try {
      work();
      return BUTEE_OK;
    } catch (const butee::InputError& error) {
      last_message = error.what();
      return BUTEE_BAD_INPUT;
    } catch (const butee::LogicError& error) {
      last_message = error.what();
      return BUTEE_BAD_CALL;
    } catch (const std::bad_alloc&) {
      last_message = "out of memory";
    } catch (const std::exception& error) {
      last_message = error.what();
    }
  } catch (...) {
    last_message = "unknown error";  // Short enough to need no memory.
  }
  return BUTEE_RUN_FAILED;
}

template <class... Pointers>
void need(const Pointers*... pointers) {
  butee::require((... && (pointers != nullptr)), "a pointer is null");
}

butee::DofKind checked_kind(int kind) {
  using butee::DofKind;
  switch (kind) {
    case BUTEE_UX:
      return DofKind::ux;
    case BUTEE_UY:
      return DofKind::uy;
    case BUTEE_UZ:
      return DofKind::uz;
    case BUTEE_RX:
      return DofKind::rx;
    case BUTEE_RY:
      return DofKind::ry;
    case BUTEE_RZ:
      return DofKind::rz;
    default:
      throw butee::LogicError("the kind " + std::to_string(kind) +
                              " is not one of BUTEE_U, BUTEE_THETA, BUTEE_UX ... BUTEE_RZ");
  }
}

StructureOptions options_of(const char* forced) {
  StructureOptions options;
  std::istringstream words(forced != nullptr ? forced : "");
  for (std::string word; words >> word;) options.forced.push_back(word);
  return options;
}

void put(double* where, double value) {
  if (where != nullptr) *where = value;
}

butee::Index checked(const butee_structure* structure, std::int64_t dof) {
  need(structure);
  if (dof >= 0 && dof < structure->structure.size()) return dof;
  throw butee::LogicError("the degree of freedom " + std::to_string(dof) + " does not exist; there are 0 to " +
                          std::to_string(structure->structure.size() - 1));
}

void check_size(std::int64_t size, const butee_structure* structure) {
  if (size == structure->structure.size()) return;
  throw butee::LogicError("the arrays have " + std::to_string(size) + " numbers; the structure has " +
                          std::to_string(structure->structure.size()) + " degrees of freedom");
}

}  // namespace

extern "C" {

const char* butee_version(void) {
  return BUTEE_VERSION;
}

const char* butee_message(void) {
  return last_message.c_str();
}

int butee_open_file(const char* path, const char* forced, butee_structure** made) {
  return guarded([&] {
    need(path, made);
    *made = nullptr;
    *made = new butee_structure{Structure::from_file(path, options_of(forced))};
  });
}

int butee_open_text(const char* toml, const char* forced, butee_structure** made) {
  return guarded([&] {
    need(toml, made);
    *made = nullptr;
    *made = new butee_structure{Structure::from_toml(toml, options_of(forced))};
  });
}

void butee_close(butee_structure* structure) {
  delete structure;
}

int butee_size(const butee_structure* structure, int64_t* size) {
  return guarded([&] {
    need(structure, size);
    *size = structure->structure.size();
  });
}

int butee_dof(const butee_structure* structure, const char* selector, int kind, int64_t* dof) {
  return guarded([&] {
    need(structure, selector, dof);
    *dof = structure->structure.dof(selector, checked_kind(kind));
  });
}

int butee_time(const butee_structure* structure, double* t) {
  return guarded([&] {
    need(structure, t);
    *t = structure->structure.time();
  });
}

int butee_advance_to(butee_structure* structure, double t) {
  return guarded([&] {
    need(structure);
    structure->structure.advance_to(t);
  });
}

int butee_advance_step(butee_structure* structure, double limit, double* t) {
  return guarded([&] {
    need(structure, t);
    *t = structure->structure.advance_step(limit);
  });
}

int butee_motion(const butee_structure* structure, int64_t dof, double* u, double* v, double* a) {
  return guarded([&] {
    const butee::Index index = checked(structure, dof);
    put(u, structure->structure.displacement(index));
    put(v, structure->structure.velocity(index));
    put(a, structure->structure.acceleration(index));
  });
}

int butee_all_motion(const butee_structure* structure, int64_t size, double* u, double* v, double* a) {
  return guarded([&] {
    need(structure);
    const butee::time::State& state = structure->structure.state();
    check_size(size, structure);
    for (const auto& [to, from] : {std::pair(u, &state.x), std::pair(v, &state.v), std::pair(a, &state.a)})
      if (to != nullptr) Eigen::Map<butee::Vector>(to, size) = *from;
  });
}

int butee_set_motion(butee_structure* structure, int64_t size, const double* u, const double* v) {
  return guarded([&] {
    need(structure, u, v);
    check_size(size, structure);
    structure->structure.set_motion(Eigen::Map<const butee::Vector>(u, size), Eigen::Map<const butee::Vector>(v, size));
  });
}

int butee_set_force(butee_structure* structure, int64_t dof, double value) {
  return guarded([&] {
    const butee::Index index = checked(structure, dof);
    structure->structure.set_force(index, value);
  });
}

int butee_set_force_line(butee_structure* structure, int64_t dof, double from, double to, double until) {
  return guarded([&] {
    const butee::Index index = checked(structure, dof);
    structure->structure.set_force(index, from, to, until);
  });
}

int butee_contact_force(const butee_structure* structure, int64_t dof, double* force) {
  return guarded([&] {
    need(force);
    const butee::Index index = checked(structure, dof);
    *force = structure->structure.contact_force(index);
  });
}

int butee_quantity(const butee_structure* structure, const char* quantity, const char* node, const char* element,
                   double* value) {
  return guarded([&] {
    need(structure, quantity, node, value);
    *value = structure->structure.quantity(quantity, node, element != nullptr ? element : "");
  });
}

int butee_follow_peak(butee_structure* structure, const char* node, const char* quantity) {
  return guarded([&] {
    need(structure, node, quantity);
    structure->structure.follow_peaks(node, {butee::model::quantity_of(quantity)});
  });
}

int butee_peak(const butee_structure* structure, const char* node, const char* quantity, double* peak) {
  return guarded([&] {
    need(structure, node, quantity, peak);
    *peak = structure->structure.peak(node, butee::model::quantity_of(quantity));
  });
}

int butee_energy(const butee_structure* structure, double* kinetic, double* strain, double* contact) {
  return guarded([&] {
    need(structure);
    const butee::record::Energy energy = structure->structure.energy();
    put(kinetic, energy.kinetic);
    put(strain, energy.strain);
    put(contact, energy.contact);
  });
}

int butee_save(const butee_structure* structure, butee_snapshot** made) {
  return guarded([&] {
    need(structure, made);
    *made = nullptr;
    *made = new butee_snapshot{structure->structure.snapshot()};
  });
}

int butee_restore(butee_structure* structure, const butee_snapshot* snapshot) {
  return guarded([&] {
    need(structure, snapshot);
    structure->structure.restore(snapshot->snapshot);
  });
}

void butee_free_snapshot(butee_snapshot* snapshot) {
  delete snapshot;
}

}  // extern "C"
