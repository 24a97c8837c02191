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

  title          one line for people
  [material.X]   young_modulus (Pa), density (kg/m3), poisson_ratio or shear_modulus (Pa) where shear or torsion count
  [section.X]    a cross-section: shape and its lengths                          butee help elements
  [[element]]    beams, masses, springs, discs, bearings                         butee help elements
  [[support]]    nodes (selectors) and fix = ["u", "theta"], or of ux ... rz     butee help selectors
  [rotation] [gravity] [base]  what turns, weight, motion of the supports       butee help space
  [[contact]]    stops with a gap, to ground or between two bodies               butee help contact
  [[load]]       forces and moments over time                                    butee help loads
  [damping]      Rayleigh's or modal; dashpots belong to springs                 butee help damping
  [initial]      displacement and velocity; at rest where absent
  [integrator]   type, time_step, end_time and the method's parameters           butee help integrators
  [output]       when rows are written, and of which nodes                       butee help output

  [initial]
  displacement = [{ nodes = "rotor", dof = "u", value = 1.0e-3 }]     # m, rad
  velocity     = [{ nodes = "rotor", dof = "u", value = 0.2 }]        # m/s, rad/s
  # { nodes = "b:all", rotation = -3.8, about = 0.0 } is a rigid rotation of a beam: u = rotation (x - about), theta = rotation
  from      = "other-results"    # the motion at the end of another run of this structure; lists beside it replace parts of it
  at        = 0.5                # s: not at its end but at this instant, one of its [output] states
  keep_time = true               # begin at that instant instead of t = 0: loads go on, end_time counts from the same zero
  # size and checksum of that run's states.bin are what model.toml adds, so that another run there is noticed

The equations are M a + C v + K x = F(t) + F_c(x) with the free u (transverse displacement, m) and theta (rotation, rad)
of all nodes. theta = du/dx: with x along the beam and y along u it turns about z, right-handed (rz), so that it is
positive where u grows along the beam; a positive moment on theta turns the same way. Every key is checked: a mistake gets one message with file, line, key, value and what is allowed, all mistakes
of a file in one go. `butee init KIND` writes a scene to start from, `butee check` shows what one holds.
)";
}

std::string selectors_text(const plugin::Catalogue&) {
  return R"(Nodes are named by selectors, in quotes; where several nodes may stand, a list of selectors may too.

  "rotor"          the node of a lone mass
  "string:first"   the first node of the beam `string`; also last, and middle where the number of nodes is odd
  "string:17"      its node 17, counted from 0
  "string:3..9"    nodes 3 to 9, both included
  "string:all"     all of them
  "string@17.5"    the node at the coordinate 17.5 m; an error that names the two nearest where there is none

`start_node` and `end_node` of a beam take a node of another beam, so that both share it.
)";
}

std::string elements_text(const plugin::Catalogue& catalogue) {
  return "[[element]]: `type` is one of the following, `name` the name by which its nodes are selected.\n" +
         listed(catalogue.types().elements) + "\n[section.X]: `shape` is one of the following.\n" +
         listed(catalogue.types().sections);
}

std::string space_text(const plugin::Catalogue&) {
  return R"(A node has up to six degrees of freedom, right-handed: displacements ux, uy, uz (m) and rotations rx, ry, rz (rad). u is
another name of uy, w of uz, theta of rz; on a beam along x, rz = duy/dx and ry = -duz/dx. A node has only those that an
element uses. Supports, loads, springs, initial values and probes take any of them; stops act on u.

  [[element]] type = "beam"
  motion     "planar" (uy, rz), "lateral" (both planes: uy, rz, uz, ry) or "spatial" (all six)
  theory     "euler", "rayleigh" (with rotary inertia) or "timoshenko" (with shear too)
  points     [[0, 0, 0], [1, 2, 0]]: a beam between two points in place of `length` along x; `up` orients its section
  preload    N, tension positive: stiffens the beam, or softens it (compression); "gravity" takes the axial force of each
             element from the static position under [gravity] (motion = "spatial"). A compression that buckles is refused
             with the critical load, or warned of where stops hold the beam.

  [[element]] type = "matrices": any linear structure by Matrix Market files (symmetric, skew-symmetric or general)
  mass, stiffness, damping, gyroscopic   M, K and, where given, C and G (skew; the force -Omega G v where the part turns)
  dofs       those of each node, ["uy", "rz"], with `nodes` (NAME:0..48 for own ones, others of the scene), row after row
             node by node; or a file with a row "NODE DOF" for each row of the matrices, NODE a number or a selector

  [rotation]
  speed      rad/s about x: a number, { type = "ramp", from = 0.0, to = 300.0, end = 10.0 } or { type = "table", ... }
  parts      the beams, discs and matrices that turn; all along x where not given. They have gyroscopic moments (beams
             with rotary inertia), and a run-up adds the moments of its acceleration.
  [[load]] type = "unbalance" without `speed` turns with [rotation]: moment (kg m), phase (rad, from y)
  [damping] rotating_stiffness_proportional (s), or rotating = true on a bearing or a spring: damping that turns with the
             shaft, which makes it unstable above a threshold

  [gravity] acceleration = [0.0, -9.81, 0.0]; static = true starts at rest in the static position, stops included
  [base] acceleration = { direction = [0, 1, 0], type = "table", file = "quake.csv" }: all supports and the ground move so
             (m/s2), from initial_velocity (0) on; or displacement = {...} (m), a smooth curve through a table. u is
             relative to the base, u_abs, v_abs, a_abs (ux_abs, uz_abs ...) are those in space. Stops to ground move with
             the base; frame = "space" in every [[contact]] to ground keeps them where they are. Several [[base]] add up.
  [[base]] nodes = [...]: supports that move apart, each entry its own. u is then measured in space, and the ground of
             springs and stops stands still; [initial] is the start in space.

Probes of forces, along and about the own axes of a beam: N (with the preload), Vy, Vz, T, My, Mz: the force and the moment
that the side of larger x exerts on the side of smaller x; V = Vy and M = Mz. My = -E I d2w/dx2. reaction_ux ... reaction_rz
of supports, spring_ux ... spring_rz of springs and bearings along the axes of space. von_mises is that of the outer fibre,
with N and T: in space of round sections; bending_stress that of bending along u. All hold the inertia of the element itself,
gyroscopic moments, weight and the motion of the base.

`butee modes SCENE --speed OMEGA` prints damped, whirling modes at a speed (rad/s), `--campbell FROM TO N` the critical
speeds, with -o and --plot the Campbell diagram. `butee plot` draws orbits (uz over uy, in the rings and between the stops
of the node), run-up (the radius over the speed), full-spectrum (forward and backward whirl), frame (the deformed structure in
space), contact-map (which contact was closed when, over time and length) and wear (the powers of wear.csv over the length).
Where shafts turn or bearings have cross terms the matrices are not symmetric. rodas4, dopri5, extrapolation8, exact and all
methods with fixed steps take them, auto chooses among them, exponential refuses them.
)";
}

std::string contact_text(const plugin::Catalogue& catalogue) {
  return R"([[contact]]: what a structure may strike. Contacts against ground have nodes, those between two bodies `between`.

  type       "stop": on one displacement or rotation; "ring", "plane": in the plane (uy, uz); "friction": a support
  nodes      selectors: a contact with ground on each node; or
  between    two selectors of equally many nodes: a contact between each pair, on the difference of their motion
  gap        m, the free play (of a stop on each side); or gaps, a list with one for each contact; or
             gaps_from = { file = "gaps.csv" }, whose second column holds them
  frame      under [base], of a stop to ground: "base" (moves with it, where not given) or "space" (butee help space)
  law        "linear" where not given; the laws and their parameters are below
  damping    dissipation while closed, a table (below)
  friction   Coulomb friction along the tangent, a table (below); not on a stop
  radius     m, of the body where it touches: adds radius x speed of [rotation] to the slip speed

stop: dof ("u" where not given; any of ux ... rz) and sides ("both" where not given, "positive" or "negative"). With the
penetration g (negative while open) and one side s: g = s u - gap, F = -s K_c(g) g. Both sides: the nearer one.
ring: centre = [y, z] and side = "within" (where not given) or "outside"; g = |(uy, uz) - centre| - gap.
plane: normal = [y, z] into the wall; g = normal . (uy, uz) - gap. Rings and planes take dofs = ["ux", "uy"] and the like.
friction: a support that is always pressed, with dof and normal_force (N).

damping = { type = ... }, with the rate of penetration g':
  kelvin_voigt   F = K_c g + c g': coefficient c (N s/m), or restitution with mass (law "linear"). The contact ends where
                 F = 0; with pull = true at g = 0, without friction where it pulls
  hunt_crossley  F = K_c g (1 + a g'): factor a (s/m), or restitution with impact_speed (m/s)
  jankowski      restitution and mass, with law = "hertz": dissipates in approach alone; what comes out is said
A law from a module may dissipate by itself (butee plugins); damping is then refused beside it.
friction = { coefficient, ... }: the force is mu F_n against the slip speed w = t . v + radius (Omega + rx_v) - surface_speed, and
twists a node that has rx by -radius mu F_n, with the tangent t = (-normal_z, normal_y), in a ring the sense of rotation from y to z; one of
  slip_speed       m/s: regularised, smoothing = "sqrt" (where not given), "tanh" or "clip"; it creeps where it should stick
  stick_stiffness  N/m: a stick spring with memory, beside it stick_damping (N s/m); static_coefficient
  stick = "rigid"  no motion while it sticks (not in rings); static_coefficient
and surface_speed (m/s) of the obstacle along the tangent, as of a belt.

rodas4, dopri5, extrapolation8 and exact end their steps where a contact touches, parts, sticks or slips, so that the
regularisation alone is left as an error; rk4 and its kin take rings, planes, dissipation and regularised friction as the
instant has them. exponential takes them with law = "linear" and a constant speed of rotation, but no stick springs. exact takes law = "linear";
piecewise takes linear stops, elastic or with kelvin_voigt, of up to 24 DOFs; rigid stick is for dopri5, extrapolation8 and
exact; jankowski is not for rodas4. auto chooses among them; other methods refuse. A visit that is shorter than an eighth of a step may pass unseen, but not by
piecewise.
)" + listed(catalogue.types().laws) +
         "\nThe linear law is the exact unilateral spring; arctan is smooth, but pulls open stops a little (butee "
         "check "
         "says\nhow much).\n";
}

std::string loads_text(const plugin::Catalogue& catalogue) {
  return R"([[load]]: `node` (a selector of one node), `dof` ("u", where not given: a force, N; or "theta": a moment, N m,
positive as theta = du/dx is; or any of ux ... rz), and `type`, the course in time.
)" + listed(catalogue.types().loads) +
         R"(
The file of a table holds columns of numbers, parted by commas, tabs or spaces, or by semicolons; lines that begin with # or %
are left out, and a first line without numbers may name the columns. A million rows are read in a fraction of a second, while
long arrays in the scene are copied to model.toml.

distributed: a line load on a whole beam, as consistent nodal loads
  beam      its name
  value     N/m
  dof       "u" where not given; or "w", "ux" of a beam that has it
  in_time   a factor in time: { type = "ramp", from = 0.0, to = 1.0, start = 0.0, end = 0.1 }
)";
}

std::string damping_text(const plugin::Catalogue&) {
  return R"([damping]: one of the two; dashpots of springs come on top of either.

  mass_proportional        1/s, C = mass_proportional M + ... (Rayleigh)
  stiffness_proportional   s,   ... + stiffness_proportional K; K holds the springs, never the stops
  modal                    0.02: this ratio of critical damping in every mode with open stops;
                           [0.02, 0.01]: in the lowest modes, none in the others
  rotating_stiffness_proportional   s, of parts that turn, damping that turns with them (butee help space)

Rayleigh damping gives a mode of angular frequency w the ratio (mass_proportional/w + stiffness_proportional w)/2.
`butee modes` prints the ratio of each mode.
)";
}

std::string integrators_text(const plugin::Catalogue& catalogue) {
  std::string text = R"([integrator]: how the scene is taken through time.

  type        a method or its alias; "auto", which looks at the scene, where not given
  time_step   s; the first step of a method that chooses its steps itself, which then may be absent
  end_time    s
  and the parameters of the method (butee plugins NAME). [integrator.NAME] holds those used only with that method.
  A key directly in [integrator] that the method lacks is an error; where --set integrator.type chose the method, it is set aside
  with one line.

)";
  std::size_t width = 0;
  for (const auto& entry : catalogue.integrators()) width = std::max(width, entry.declaration.name.size());
  for (const auto& entry : catalogue.integrators()) {
    const time::IntegratorType& type = entry.declaration;
    text += "  " + type.name + std::string(width - type.name.size() + 2, ' ') + type.summary;
    if (!type.aliases.empty()) text += " (" + join(type.aliases) + ")";
    text += "\n";
  }
  return text + "\n`butee compare MODEL.toml` finds out which is the fastest for an accuracy on your scene.\n";
}

std::string output_text(const plugin::Catalogue&) {
  std::string text = R"([output]: what history.csv holds. Without it: 1000 equal intervals, and u of every loaded node.

  interval         s: rows at t = 0, interval, 2 interval, ..., end_time, by the method's own interpolant
  every            instead of interval: a row at every so manyth accepted step
  energy           true: work, dissipation and the balance are followed            (false)
  impacts          true: impacts.csv, a row for each closing of a stop             (false)
  trust            true: find out how far the answer can be trusted                (false; butee help trust)
  trust_accuracy   the accuracy it is to be trusted to, of the peak                (0.01)
  states           s: instants of which the whole motion is kept, for [initial] from of other scenes
  checkpoint       every so manyth accepted step the run is kept; butee run --resume DIR goes on
  formats          ["csv"] and what modules bring: "hdf5", the fields of all nodes and the probes
  fields           {nodes, quantities, interval} of such fields, where not all of them are wanted

  [[output.probe]]
  label        the name of its columns: label.u, label.v, ...
  node         a selector of one node
  element      of section and spring forces: the beam or spring meant, where there are several; "string:17" is the element
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
Section forces are what the part of the beam at larger x exerts on the part at smaller x, along u and about theta:
V = -dM/dx and M = E I d2u/dx2 where nothing acts in between. Taken are those of the element that ends at the node (at the
first node, that begins there): K u + C v + M a - f with its own matrices, its Rayleigh damping and its share of line
loads. They jump by the forces on the node. Modal damping belongs to no element and counts as a force on the nodes.
A spring force is that on the node (negative where a spring to ground is stretched towards +u), its dashpot and Rayleigh
damping included; a reaction is what the support exerts. Accelerations in them are those of the equation of motion, so
that every node is in balance; each row takes one solution with the mass matrix. bending_stress and von_mises need a section
that knows its outer fibre (`outer_fibre` of the shape "general"): bending_stress = M c/I at distance c from the neutral axis,
on the side of -u, tension positive, and von_mises = |bending_stress|, since the shear stress of V is zero there. On the neutral
axis it is 1.5 V/A in a rectangle, 4/3 V/A in a circle and up to 2 V/A in a tube, sqrt(3) times that as von Mises stress: more than at
the outer fibre only within about a height of the section from where M vanishes. A reaction is that on one node: a support of
several nodes takes a probe for each.
)";
}

}  // namespace butee::app::help
