#include <algorithm>

#include <butee/core/text.hpp>
#include <butee/model/quantity.hpp>

#include "../parameter_table.hpp"
#include "topics.hpp"

namespace butee::app::help {
namespace {

/// "NAME: summary" and the parameters of each type.
template <class Types>
std::string listed(const Types& types) {
  std::string text;
  for (const auto& type : types)
    text += "\n" + type.name + ": " + type.summary + "\n" + parameter_table(type.parameters, false);
  return text;
}

}  // namespace

std::string model_text(const plugin::Catalogue&) {
  return R"(A scene is a TOML file in SI units. Its first key is schema = 1; the rest are these tables.

  title          a one-line description
  [material.X]   young_modulus (Pa), density (kg/m3), poisson_ratio or shear_modulus (Pa) if shear or torsion count
  [section.X]    a cross-section: shape and its lengths                          butee help elements
  [[element]]    beams, masses, springs, discs, bearings                         butee help elements
  [[support]]    nodes (selectors) and fix = ["u", "theta"], or of ux ... rz     butee help selectors
  [rotation] [gravity] [base]  rotating parts, weight, motion of supports      butee help space
  [[contact]]    stops with a gap, to ground or between two bodies               butee help contact
  [[load]]       forces and moments over time                                    butee help loads
  [damping]      Rayleigh's or modal; dashpots belong to springs                 butee help damping
  [initial]      displacement and velocity; default: at rest
  [integrator]   type, time_step, end_time and the method's parameters           butee help integrators
  [output]       when rows are written, and of which nodes                       butee help output

  [initial]
  displacement = [{ nodes = "rotor", dof = "u", value = 1.0e-3 }]     # m, rad
  velocity     = [{ nodes = "rotor", dof = "u", value = 0.2 }]        # m/s, rad/s
  # { nodes = "b:all", rotation = -3.8, about = 0.0 } is a rigid rotation of a beam: u = rotation (x - about), theta = rotation;
  # of a beam by points it turns about an axis along z through the point of that coordinate
  from      = "other-results"    # start from the final motion of another run of this structure; `displacement` and `velocity`
                                 # lists override parts of it
  at        = 0.5                # s: start from this instant instead of the end; it must be one of that run's [output] states
  keep_time = true               # begin at that instant instead of t = 0: loads continue, end_time counts from the same zero
  # model.toml also stores size and checksum of states.bin, so that a changed run is detected

The equations are M a + C v + K x = F(t) + F_c(x) with the free u (transverse displacement, m) and theta (rotation,
rad) of all nodes. theta = du/dx: with x along the beam and y along u it turns about z, right-handed (rz), so that it
is positive if u grows along the beam; a positive moment on theta turns the same way. Every key is checked: each
mistake gets one message with file, line, key, value and the allowed values; all mistakes of a file are reported at
once. `butee init KIND` writes a scene to start from, `butee check` shows the contents of a scene.
)";
}

std::string selectors_text(const plugin::Catalogue&) {
  return R"(Nodes are named by selectors, in quotes; a key that takes several nodes also takes a list of selectors.

  "rotor"          the node of a single mass
  "string:first"   the first node of the beam `string`; also last, and middle if the number of nodes is odd
  "string:17"      its node 17, counted from 0
  "string:3..9"    nodes 3 to 9, both included
  "string:all"     all of them
  "string@17.5"    the node at the coordinate 17.5 m; an error names the two nearest nodes if there is none

`start_node` and `end_node` of a beam take a node of another beam, so that both share it.
)";
}

std::string elements_text(const plugin::Catalogue& catalogue) {
  return "[[element]]: `type` is one of the following, `name` the name by which its own nodes are selected (an element "
         "on nodes of others has none).\n" +
         listed(catalogue.types().elements) + "\n[section.X]: `shape` is one of the following.\n" +
         listed(catalogue.types().sections);
}

std::string space_text(const plugin::Catalogue&) {
  return R"(A node has up to six degrees of freedom, right-handed: displacements ux, uy, uz (m) and rotations rx, ry,
rz (rad). u is another name of uy, w of uz, theta of rz; on a beam along x, rz = duy/dx and ry = -duz/dx. A node has
only those that an element uses. Supports, loads, springs, stops, initial values and probes take any of them.

  [[element]] type = "beam"
  motion     "planar" (uy, rz), "lateral" (both planes: uy, rz, uz, ry) or "spatial" (all six)
  theory     "euler", "rayleigh" (with rotary inertia) or "timoshenko" (with shear too)
  points     [[0, 0, 0], [1, 2, 0]]: a beam between two points in place of `length` along x; `up` orients its section
  preload    N, tension positive: stiffens the beam, or softens it (compression); "gravity" takes the axial force of each
             element from the static position under [gravity] (motion = "spatial"). A compression that buckles is refused
             with the critical load, or a warning is given if stops hold the beam.

  [[element]] type = "matrices": any linear structure by Matrix Market files (symmetric, skew-symmetric or general)
  mass, stiffness, damping, gyroscopic   M, K and, optionally, C and G (skew; force -Omega G v; else it stands still)
  dofs       those of each node, ["uy", "rz"], with `nodes` (NAME:0..48 for own ones, others of the scene), row after row
             node by node; or a file with a row "NODE DOF" for each row of the matrices, NODE a number or a selector

  [rotation]
  speed      rad/s about x: a number, { type = "ramp", from = 0.0, to = 300.0, end = 10.0 } or { type = "table", ... }
  parts      the beams, discs and matrices that turn; default: all along x. They have gyroscopic moments (beams
             with rotary inertia), and a run-up adds the moments of its acceleration about y and z (not the torque on rx).
  [[load]] type = "unbalance" without `speed` turns with [rotation]: moment (kg m), phase (rad, from y)
  [damping] rotating_stiffness_proportional (s), or rotating = true on a bearing or a spring: damping that turns with the
             shaft, which makes it unstable above a threshold

  [gravity] acceleration = [0.0, -9.81, 0.0]; static = true starts at rest in the static position under all loads at
             t = 0 (the inertia forces of an accelerated [base] included), with stops and without friction
  [base] acceleration = { direction = [0, 1, 0], type = "table", file = "quake.csv" }: the acceleration of all supports and
             of the ground (m/s2), from initial_velocity (0) on; or displacement = {...} (m), a smooth curve through a
             table; the length of direction does not matter. u is relative to the base, u_abs, v_abs, a_abs (ux_abs,
             uz_abs ...) are those in space. Stops to ground move with the base; frame = "space" in every [[contact]] to
             ground keeps them where they are. Several [[base]] add up.
  [[base]] nodes = [...]: supports that move independently; each entry defines one motion. u is then measured in space, and
             the ground of springs and stops stands still; [initial] is the start in space. Contacts to ground do
             not act on what a moved support holds, which is warned of.

Probes of forces, along and about the own axes of a beam: N (with a preload in N), Vy, Vz, T, My, Mz are the force and
the moment that the side of larger x exerts on the side of smaller x; V = Vy and M = Mz. My = -E I d2w/dx2.
Along the axes of space: contact_ux ... contact_rz of contacts, reaction_ux ... reaction_rz of supports (with the
preload of beams in N), spring_ux ... spring_rz of springs and bearings.
von_mises is that of the outer fibre, with N and T: in space of round sections; bending_stress that of bending along
u. All include the element's own inertia, gyroscopic moments, weight and base motion.

`butee modes SCENE --speed OMEGA` prints the damped modes at a speed of rotation (rad/s), of shafts their whirl; 0
serves for scenes without shafts. `--campbell FROM TO N` prints the critical speeds and those at which modes begin or
cease to grow, with -o and --plot the Campbell diagram of the -n lowest modes. All modes are examined, or with more
than 160 degrees of freedom the lowest ones, up to frequencies above the largest speed, 160 at most. A mode that
begins and ceases to grow between two of the N + 1 speeds is found if it grows over a quarter of their distance, and
usually if it grows over a hundredth of it. `butee plot` draws orbits (uz over uy, in the rings and between the stops
of the node), run-up (the radius over the speed), full-spectrum (forward and backward whirl), frame (the deformed
structure in space), contact-map (closed contacts over time and length) and wear (the powers of wear.csv over the
length). If shafts turn, or bearings or given matrices have cross terms, the matrices are not symmetric. exponential,
rodas4, dopri5, extrapolation8, exact and all methods with fixed steps take them; auto chooses among them.
)";
}

std::string contact_text(const plugin::Catalogue& catalogue) {
  return R"([[contact]]: obstacles. Contacts with ground have `nodes`, contacts between two bodies `between`.

  type       "stop": on one displacement or rotation; "ring", "plane": in the plane (uy, uz); "friction": a support
  nodes      selectors: a contact with ground on each node; or
  between    two selectors of equally many nodes: a contact between each pair, on the difference of their motion
  gap        m, the free play (of a stop on each side); or gaps, a list with one for each contact; or
             gaps_from = { file = "gaps.csv" }, whose second column holds them
  frame      under [base], of a stop to ground: "base" (default: moves with it) or "space" (butee help space)
  law        default "linear"; the laws and their parameters are below
  damping    dissipation while closed, a table (below)
  friction   Coulomb friction along the tangent, a table (below); not on a stop
  radius     m, of the body at the contact (with `between` of the one that turns, of the first if both or none do, which
             is taken as the inner one of a ring): its rotation about x, that of [rotation] included, adds to the slip
             speed; only for contacts along uy and uz

stop: dof (default "u"; any of ux ... rz) and sides ("both" by default, "positive" or "negative"). With the
penetration g (negative while open) and one side s: g = s u - gap, F = -s K_c(g) g. Both sides: the nearer one.
ring: centre = [y, z] and side = "within" (default) or "outside"; g = |(uy, uz) - centre| - gap.
plane: normal = [y, z] into the wall; g = normal . (uy, uz) - gap. Rings and planes take dofs = ["ux", "uy"] and the like.
friction: a support that is always pressed, with dof and normal_force (N).

damping = { type = ... }, with the rate of penetration g':
  kelvin_voigt   F = K_c g + c g': coefficient c (N s/m), or restitution with mass (law "linear"). The contact ends at
                 F = 0; with pull = true at g = 0, without friction while the force is tensile
  hunt_crossley  F = K_c g (1 + a g'): factor a (s/m), or restitution with impact_speed (m/s)
  jankowski      restitution and mass, with law = "hertz": dissipates only during approach; the resulting restitution
                 is reported
A law from a module may have its own dissipation (butee plugins); damping is then refused.
friction = { coefficient, ... }: the force is mu F_n against the slip speed w = t . v + radius (Omega + rx_v) - surface_speed, and
twists a node that has rx by -radius mu F_n, with the tangent t = (-normal_z, normal_y), in a ring the sense of
rotation from y to z (outside a ring from z to y). With `between` the other node, whose arm is radius + gap (radius -
gap outside a ring), counts likewise, in the opposite sense. One of
  slip_speed       m/s: regularised, smoothing = "sqrt" (default), "tanh" or "clip"; slides slowly instead of sticking
  stick_stiffness  N/m: a stick spring with memory (in a ring at the radius of its gap: friction_force is the force
                   there, and gap/r of it, at most 2, acts on a node at the distance r); also static_coefficient and
                   stick_damping c (N s/m), a dashpot beside the spring; both slip at mu F_n. With c/k longer
                   than an impact the start of a stick is approximate (contact/README.md)
  stick = "rigid"  no motion while it sticks (not in rings); static_coefficient
and surface_speed (m/s) of the obstacle along the tangent, for example of a belt.

exponential, rodas4, dopri5, extrapolation8 and exact end their steps where a contact closes, opens, sticks or slips,
so that only the regularisation causes an error; rk4 and related methods evaluate rings, planes, dissipation and
regularised friction at their stages, without locating contact changes. exponential takes contacts with a law that has
no force while they are apart. exact takes law = "linear" in the plane and with
dissipation; piecewise takes linear stops, elastic or with kelvin_voigt, of up to 24 DOFs; rigid stick is for dopri5,
extrapolation8 and exact; jankowski is not for rodas4. auto chooses among them; other methods refuse. Methods other
than piecewise may miss a contact shorter than an eighth of a step.
)" + listed(catalogue.types().laws) +
         "\nThe linear law is the exact unilateral spring; arctan is smooth, but has a small residual force at open "
         "stops\n"
         "(butee check prints it).\n";
}

std::string loads_text(const plugin::Catalogue& catalogue) {
  return R"([[load]]: `node` (a selector of one node), `dof` (default "u": a force, N; or "theta": a moment, N m,
positive in the sense of theta = du/dx; or any of ux ... rz), and `type`, the time function.
)" + listed(catalogue.types().loads) +
         R"(
The file of a table holds columns of numbers, separated by commas, tabs or spaces, or by semicolons; lines that begin
with # or % are skipped, and a first line without numbers may name the columns. A million rows are read in a fraction
of a second, while long arrays in the scene are copied to model.toml.

distributed: a line load on a whole beam, as consistent nodal loads
  beam      its name
  value     N/m
  dof       default "u"; or "w", "ux" of a beam that has it
  in_time   a factor in time: { type = "ramp", from = 0.0, to = 1.0, start = 0.0, end = 0.1 }
)";
}

std::string damping_text(const plugin::Catalogue&) {
  return R"([damping]: one of the two; dashpots of springs are added to either.

  mass_proportional        1/s, C = mass_proportional M + ... (Rayleigh)
  stiffness_proportional   s,   ... + stiffness_proportional K; K holds the springs, never the stops
  modal                    0.02: this ratio of critical damping in every mode with open stops;
                           [0.02, 0.01]: in the lowest modes, none in the others. With turning parts and cross terms
                           of bearings the modes are those at rest, of the symmetric part of K
  rotating_stiffness_proportional   s, damping that rotates with rotating parts (butee help space)

Rayleigh damping gives a mode of angular frequency w the ratio (mass_proportional/w + stiffness_proportional w)/2.
`butee modes` prints the ratio of each mode.
)";
}

std::string integrators_text(const plugin::Catalogue& catalogue) {
  std::string text = R"([integrator]: the time integration of the scene.

  type        a method or its alias; default "auto", which chooses a method for the scene
  time_step   s; the first step of a method that chooses its own steps; optional for some of these methods
  end_time    s
  and the parameters of the method (butee plugins NAME). [integrator.NAME] holds those used only with that method.
  A key directly in [integrator] that the method lacks is an error; if --set integrator.type chose the method, it is ignored
  and one message is printed.

)";
  std::size_t width = 0;
  for (const auto& entry : catalogue.integrators()) width = std::max(width, entry.declaration.name.size());
  for (const auto& entry : catalogue.integrators()) {
    const time::IntegratorType& type = entry.declaration;
    text += "  " + type.name + std::string(width - type.name.size() + 2, ' ') + type.summary;
    if (!type.aliases.empty()) text += " (" + join(type.aliases) + ")";
    text += "\n";
  }
  return text + "\n`butee compare MODEL.toml` finds the fastest method for a given accuracy on your scene.\n";
}

std::string output_text(const plugin::Catalogue&) {
  std::string text = R"([output]: contents of history.csv. Default: 1000 equal intervals, and u of every loaded node.

  interval         s: rows at t = 0, interval, 2 interval, ..., end_time, from the method's own interpolant
  every            instead of interval: a row at every N-th accepted step
  energy           true: work, dissipation and the balance are followed            (false)
  impacts          true: impacts.csv, a row for each closing of a stop             (false)
  trust            true: estimate the accuracy of the result                       (false; butee help trust)
  trust_accuracy   accuracy required by trust, relative to the peak of each motion (0.01)
  states           s: instants at which the whole motion is saved, for [initial] from of other scenes
  checkpoint       save a checkpoint at every N-th accepted step; butee run --resume DIR continues
  formats          ["csv"] and formats of modules: "hdf5", the fields of all nodes and the probes
  fields           {nodes, quantities, interval} of such fields, if not all of them are needed

  [[output.probe]]
  label        the name of its columns, label.u, label.v, ...                      (the node: string-middle)
  node         a selector of one node
  element      for section and spring forces: the beam or spring, if the node has several; "string:17" is the element
               of `string` between its nodes 17 and 18
  quantities   any of these:

)";
  for (const std::string& name : model::probe_quantities()) {
    const model::Quantity quantity = model::quantity_of(name);
    const std::string unit = model::unit_of(quantity);
    text += "  " + name + std::string(17 - name.size(), ' ') + unit + std::string(8 - unit.size(), ' ') +
            model::summary_of(quantity) + "\n";
  }
  return text + R"(
Section forces are the force and the moment that the part of the beam at larger x exerts on the part at smaller x, along u
and about theta: V = -dM/dx and M = E I d2u/dx2 if nothing acts in between. They belong to the element ending at the node
(at the first node: starting there): K u + C v + M a - f with its own matrices, its Rayleigh damping and its share of line
loads. They jump by the forces on the node. Modal damping belongs to no element and counts as a force on the nodes.
A spring force is that on the node (negative if a spring to ground is stretched towards +u), its dashpot and Rayleigh
damping included; a reaction is the force of the support. Accelerations in them satisfy the equation of motion, so
that every node is in balance; each row costs one solution with the mass matrix. bending_stress and von_mises need the
outer fibre of the section (`outer_fibre` of the shape "general"): bending_stress = M c/I at distance c from the neutral axis,
on the side of -u, tension positive, and von_mises = |bending_stress| + |N|/A, since the shear stress of V is zero there. On the neutral
axis it is 1.5 V/A in a rectangle, 4/3 V/A in a circle and up to 2 V/A in a tube, sqrt(3) times that as von Mises stress: more than at
the outer fibre only within about a section height of a zero of M. A reaction is that on one node: a support of several
nodes needs a probe for each.
)";
}

}  // namespace butee::app::help
