#ifndef BUTEE_H
#define BUTEE_H

/*
 * The C interface of butee: a structure as a part of another program, from C, Fortran 2003 (butee.f90), Python's ctypes
 * and whatever else can call C.
 *
 * Every function returns BUTEE_OK or what went wrong, and then butee_message() says it in words. No exception leaves
 * the library. SI units. A structure and what belongs to it is used by one thread at a time; several structures may
 * live in one process and on several threads. Degrees of freedom are numbered from 0.
 */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define BUTEE_C_EXPORT __attribute__((visibility("default")))
#else
#define BUTEE_C_EXPORT
#endif

enum {
  BUTEE_OK = 0,
  BUTEE_RUN_FAILED = 1, /* a step failed numerically, or something could not be read or loaded */
  BUTEE_BAD_INPUT = 2,  /* the scene or a name in a call has a mistake; all of them are in the message */
  /* A mistake in the calling program, which changes nothing: a null pointer, a wrong length, a time that lies behind or
     is not finite, a force or motion that is not finite or larger than 1e100, a snapshot of another structure. */
  BUTEE_BAD_CALL = 3
};

/* Kinds of degrees of freedom: displacements along x, y and z, rotations about them. u is uy and theta is rz. */
enum {
  BUTEE_U = 0,
  BUTEE_THETA = 1,
  BUTEE_UX = 2,
  BUTEE_UY = BUTEE_U,
  BUTEE_UZ = 3,
  BUTEE_RX = 4,
  BUTEE_RY = 5,
  BUTEE_RZ = BUTEE_THETA
};

typedef struct butee_structure butee_structure;
typedef struct butee_snapshot butee_snapshot;

/* "0.1.0", and what the last call on this thread that failed has to say; both valid until the next call. */
BUTEE_C_EXPORT const char* butee_version(void);
BUTEE_C_EXPORT const char* butee_message(void);

/*
 * Makes a structure of a scene in a file, or in TOML text. `forced` names the nodes on which forces will be set, parted
 * by blanks ("string:middle rotor string:3..9 string:0.theta string:middle.uz"), u where no other degree of freedom
 * (ux to rz) is given; null or "" for none.
 */
BUTEE_C_EXPORT int butee_open_file(const char* path, const char* forced, butee_structure** made);
BUTEE_C_EXPORT int butee_open_text(const char* toml, const char* forced, butee_structure** made);
/* Null is allowed. */
BUTEE_C_EXPORT void butee_close(butee_structure* structure);

/* The number of free degrees of freedom, and that of the one that a selector names. */
BUTEE_C_EXPORT int butee_size(const butee_structure* structure, int64_t* size);
BUTEE_C_EXPORT int butee_dof(const butee_structure* structure, const char* selector, int kind, int64_t* dof);

/*
 * Seconds. butee_advance_step() takes one step of the method's own length, not beyond `limit`. After BUTEE_RUN_FAILED
 * the state is that of the last good step; other forces, another motion or butee_restore() give a way to go on.
 */
BUTEE_C_EXPORT int butee_time(const butee_structure* structure, double* t);
BUTEE_C_EXPORT int butee_advance_to(butee_structure* structure, double t);
BUTEE_C_EXPORT int butee_advance_step(butee_structure* structure, double limit, double* t);

/*
 * Displacement (m, or rad), velocity and acceleration (per s, per s^2) of one degree of freedom; null for those not
 * needed.
 */
BUTEE_C_EXPORT int butee_motion(const butee_structure* structure, int64_t dof, double* u, double* v, double* a);
/* The same of all, `size` numbers each. */
BUTEE_C_EXPORT int butee_all_motion(const butee_structure* structure, int64_t size, double* u, double* v, double* a);
/* Takes other displacements (m, rad) and velocities, `size` numbers each; the method starts anew from them. */
BUTEE_C_EXPORT int butee_set_motion(butee_structure* structure, int64_t size, const double* u, const double* v);

/*
 * A force (N, or N m) on a degree of freedom of `forced`: constant from now on, or in a straight line from `from` now
 * to `to` at time `until`.
 */
BUTEE_C_EXPORT int butee_set_force(butee_structure* structure, int64_t dof, double value);
BUTEE_C_EXPORT int butee_set_force_line(butee_structure* structure, int64_t dof, double from, double to, double until);
/*
 * The force (N, or N m) of all contacts on a degree of freedom: stops, rings, planes and friction.
 */
BUTEE_C_EXPORT int butee_contact_force(const butee_structure* structure, int64_t dof, double* force);

/*
 * A quantity of [[output.probe]] ("M", "V", "von_mises", "spring_force", "reaction", "u", ...) of a node at the present
 * instant. `element` names the beam or spring if the node has several; null or "" if it has one.
 */
BUTEE_C_EXPORT int butee_quantity(const butee_structure* structure, const char* quantity, const char* node,
                                  const char* element, double* value);

/*
 * The largest |value| of a quantity of a node ("u", "v", "a", "theta", "uz", "rx_v", "contact_force", ...) over the
 * whole motion, in the quantity's unit (m, rad, N; per s, per s^2). To be followed before the first step; `node` is a
 * selector that names one.
 */
BUTEE_C_EXPORT int butee_follow_peak(butee_structure* structure, const char* node, const char* quantity);
BUTEE_C_EXPORT int butee_peak(const butee_structure* structure, const char* node, const char* quantity, double* peak);

/* Kinetic, strain and contact energy, J; null for those not needed. */
BUTEE_C_EXPORT int butee_energy(const butee_structure* structure, double* kinetic, double* strain, double* contact);

/*
 * The state to go back to in an iteration. A snapshot is of use for its own structure and others of the same scene, the
 * same `forced` and the same followed peaks, and outlives it.
 */
BUTEE_C_EXPORT int butee_save(const butee_structure* structure, butee_snapshot** made);
BUTEE_C_EXPORT int butee_restore(butee_structure* structure, const butee_snapshot* snapshot);
/* Null is allowed. */
BUTEE_C_EXPORT void butee_free_snapshot(butee_snapshot* snapshot);

#ifdef __cplusplus
}
#endif

#endif
