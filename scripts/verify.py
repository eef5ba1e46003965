#!/usr/bin/python3
"""Write the report of the checks (scripts/verify.sh runs them), and their summary into doc/verification.md.

    scripts/verify.py FOLDER [DOCUMENT]

FOLDER holds SECTION.tsv of every section and receives report.md and figures/. The numbers of checks in the table of
DOCUMENT that starts with "| section | checks | missed |" are replaced. A line of SECTION.tsv, between tabs:

    row    section  quantity  source  reference  obtained  error  bound  order  verdict
    point  figure   series    x       y

A figure belongs to the section whose table contains the points. FIGURE below sets titles and axes; other figures have
logarithmic axes if the points allow. A series with the prefix "exact" is a line without markers, with the prefix
"published" or "Navier-Stokes" a dashed line, with the prefix "experiment" filled markers without a line. The same tables
give the same files, byte for byte.
"""

import math
import os
import re
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
from shoal._plot_style import LINES, STYLE

from matplotlib import pyplot
from PIL import Image

INTRODUCTION = """\
# Verification report

`make verify` computed every number below. The checks are C programs in tests/verify, one file per section. Each check
runs an ordinary case and compares with an independent result: a closed formula, a number from the literature, a
conservation law, a symmetry, or a refined run. Equation numbers refer to doc/model.md.

*error* is the difference from the reference, relative if marked (rel); *order* is the observed order of convergence,
log2 of the ratio of two errors at a refinement by two, or a slope. A row without a bound is not a check. The column
*reference* gives the reason of an unusual bound. A bound marked (regression) is drawn round the result that the program
had: it shows a change of the program, and only the ratio itself compares the program with nature.
"""

# per section: heading and text above the table
SECTIONS = {
    "theory": ("Linear theory", """\
Other sections compare with the linear theory of thin foils, computed by small solvers in tests/verify/linear_theory.c:
Theodorsen's lift and moment, Garrick's thrust, Wagner's start, Wu's series for plates of any shape, and Galerkin's method
for elastic plates clamped at the nose. These solvers share no code with the program. This section compares the solvers
with published values, with limits in closed form, with each other, and with numbers of another program."""),
    "rod": ("Rod alone", """\
This section tests the elastic body of model.md 1 to 3 without fluid, by large deflections, by vibrations, and by the
conservation laws of an isolated body."""),
    "force": ("Force of the fluid", """\
This section tests the reactive force of model.md 9 in still fluid. A large smoothing of the free vortices makes their
velocity negligible, and bodies have no drag and no damping. A fish must then gain nothing from fluid at rest with any gait,
the energy of body and fluid together must be the work of the muscle, and a reversed wave must return the body. Plates must
agree with analytic results and with Lighthill's thrust."""),
    "sheet": ("Sheet alone", """\
This section tests the bound vortex sheet of model.md 6 on bodies with prescribed motion. It compares the strength with
closed forms, and shows how both choices of control points converge. On bent bodies the smooth curve is compared with the polygon (chebyshev and
midpoint are the control points of the polygon)."""),
    "wake": ("Wake alone", """\
This section tests free vortices without a body (model.md 8): how they translate and rotate, how a perturbed row grows, and
the invariants of an isolated wake."""),
    "plate": ("Plate in a wake", """\
Here sheet and wake act together, on a plate that starts impulsively (Wagner 1925) or heaves harmonically (Theodorsen
1935)."""),
    "school": ("Everything", """\
In a school of three different fish near each other (lengths 1, 0.8 and 0.9, different beats and stiffness), of which one is
15 degrees off its desired heading, all terms of the model act at once. There is no closed solution, so runs are compared with finer
runs, as a norm over all fish, at t = 1.2 s; the *free sheet* is the position, at that time, of the piece of every wake
shed at 0.6 s. This is a fixed Lagrangian label: a vortex released at t_n represents circulation shed around t_n - Dt/2, so
the position is interpolated along the wake. The vortex released at 0.6 s represents different fluid for every Dt.

Some bounds need an explanation. BDF of order p that keeps the error of one step below rtol has a global error of rtol^(p/(p+1)), a slope of
2/3 at order 2 and 5/6 at order 5. The default body has order 3/2 in N at the nose, because the thickness of an edge is the
sum of two radii, which is the trapezoidal rule on a profile that rises like a square root. Mean thicknesses make that error
17 times smaller; the remaining error has an order near 3/2 too, of unknown cause.

The order in N of circulation has no bound: the sequence of this section (N up to 65) is regular, and a finer sequence
does not continue the order. In the limit 3/2 would be expected of a polygon, whose last edge has the direction of the body
half an edge ahead of the tail; this is a conjecture. In M only shed circulation is checked on the default fish: the
changes of nose and wake are smaller and irregular."""),
    "interval": ("Shedding interval of one fish", """\
One soft fish (E = 1e5 Pa, N = 7) swims from rest and from 1 m/s, with a force that depends on its own wake: the pressure of
the bound sheet with *sheet*, the published force with *continuous*. All other keys have defaults. The run ends at 1.5 s, and
vortices decay from an age of 0.8 s to 1 s, so a part of the wake is lost, which Kelvin's theorem retains or drops
(`removed_circulation`). The interval is halved from 0.02 s to 0.00125 s. The sheet points increase with the refinement, M
- 1 as Dt^(-1/2) from 33 to 129, because below U Dt/L = (3.2/(M - 1))^2 the error depends on the spacing of the bound sheet;
*continuous* has 65. Changes and errors are root mean squares over the run, because instantaneous values change sign. The
order is the slope of the changes over the interval; the table also has the error at 0.01 s.

*continuous* is of second order, towards a wake that is too weak at the edge (section Plate in a wake). *sheet* converges
to the correct wake with order 1.0 to 1.4, the order of the spacing of the sheet. The errors at 0.01 s are 4e-5 m in the
positions of a fish with initial speed, and 1.5e-4 to 2e-4 m from rest."""),
    "symmetry": ("Symmetries", """\
The motion must not change if the same school is shifted, rotated, mirrored, put into a moving frame, listed in another order,
computed on two threads, written at other times, or has companions too far away to matter. Rows without a name use the article's model;
*default model* has the free sheet and the reactive force of the defaults. With identical steps of the integrator the
results agree to round-off, otherwise to the tolerance. The first error estimates after a smooth start of the muscle are
round-off, so a change of view changes the first steps; with a sudden start the steps are identical."""),
    "start": ("Start and index", """\
This section tests the consistent start of model.md 10. The algebraic equations determine the algebraic unknowns, and the
start satisfies all equations."""),
    "energy": ("Energy", """\
Over long runs the energy balance of model.md 13, which is the energy of the body less the initial energy less all work on the
body, must stay small. Over one beat of a default fish (with 7 nodes) the work of the muscle must equal damping, drag and wake,
and its speed in the long run must be independent of the initial speed."""),
    "momentum": ("Momentum", """\
Swimmers with `force: pressure` must satisfy the momentum balance of model.md 13. Bodies and wakes have one smoothing for each
other in both directions (model.md 8), so the fluid receives the momentum of the bodies. The remaining errors are those of the
interval, mostly in the first beat, during which a fish from rest swims less than a hundredth of a length per interval.
*Momentum lost* is the balance over the largest momentum of the bodies. A plate with a sudden start across its axis loses
some per cent in the first interval (model.md 13) and nothing after."""),
    "fish": ("The default fish", """\
The numbers of a default fish converge in the nodes, and are independent of the smoothing of the wake, which has no effect
on the reactive force, and of the frequency, with the modulus proportional to the square. The cost of stiff bodies has a
limit: damping acts on the strain, and the power of the muscle follows from the balance of momentum (doc/model.md, sections
3 and 13; doc/numerics.md, section 9)."""),
    "control": ("Control", """\
Heading control with feedforward and course control, on bodies from soft to stiff, must give the same run with the implicit and
with an explicit method. The bound is a little more than twice the effect of the tolerance without control (law none). With the
moving mean of the feedforward there is no algebraic loop, and the bias of the stiffest body changes as smoothly as the bias
of the softest body. A default fish swims through waypoints, another holds a course in the wake of a leader."""),
    "pressure": ("Pressure", """\
This section compares the forces of `force: pressure` (model.md 15) with the linear theory of thin foils, for rigid plates that
heave and pitch, for sudden starts, and for plates that swim by heave. The settings are the defaults with 65 sheet points and 300 events a period.
Other tests show that no run fails: 36 random schools of plates and fish in `make test` (TEST=pressure_cases), 500 in `make
soak`."""),
    "elastic": ("Elastic plates", """\
Plates with `force: pressure` are clamped at the nose in a stream, with rtol 1e-5, U Dt = 0.01 L and the whole wake. *Flutter*:
growth rates and frequencies are the eigenvalues of the linearised equations, from `shoal steady`; secants from the
theoretical threshold give the U* of zero growth; `wake.taper` is 0.8, as the sheet is straight. The errors of N and (N +
1)/2 nodes show the convergence. *Heaving nose*: amplitude 0.002 L, the last of 6 or 10 periods (5 in the figures)."""),
    "steady": ("Steady states", """\
This section compares results of `shoal steady` (doc/steady.md) after twelve to twenty beats with runs of two hundred beats,
and the multiplier with the decay of the run."""),
    "static": ("Equilibria", """\
For bodies without a beat (doc/steady.md) this section has the results of `shoal steady` for a stiff plate; for a flexible plate (thin airfoils and
Galerkin's method, an independent solver); for a plate with the clamp downstream, which the reactive force of slender
bodies buckles as a column (Euler); and for a plate across the stream with drag of the edges alone, an elastica: the drag
over the drag of a stiff plate falls with the Cauchy number, in the limit like U^(4/3) over U^2, with Vogel's exponent -2/3
(Alben, Shelley and Zhang, Nature 420, 2002; Luhar and Nepf, Limnol. Oceanogr. 56, 2011). The theory neglects thickness and
stretching. The last rows compare with converged runs."""),
    "tandem": ("A plate behind another one", """\
Two rigid plates in line heave alike and swim freely along the line; the section computes the equilibrium position of the
second plate. Positions are measured from the tail of the first to the nose of the second plate, in wavelengths, the
distance travelled in a beat, and computed by `shoal steady` with `steady.formation: true` (doc/steady.md,
cases/tandem_plates.yaml). Published findings:

* *Positions are one wavelength apart, near integers, and stable.* Fang, Mavroyiakoumou, Ristroph and Shelley (J. Fluid
  Mech. 2026, arXiv:2505.13149), vortex sheets: separations are "approximately integer multiples of the wavelength traced
  out by each wing", the position depends on the start, and a follower that is too near has less thrust, a follower that is
  too far more. Nitsche, Oza and Siegel (J. Fluid Mech. 2025, arXiv:2410.04626), vortex sheets: "quantized on the flapping
  wavelength". Earlier Ramananarivo, Fang, Oza, Zhang and Ristroph (Phys. Rev. Fluids 1, 2016), in a water tank. The bound
  of 0.15 stands for the word *approximately*.
* *The follower's phase shifts the position linearly.* Two foils in a tank (H19.1 of the fluids meeting of the APS, 2016,
  meetings-archive.aps.org/dfd/2016/h19/1): "shifted to any arbitrary downstream position by varying only the relative
  flapping phase". Li et al. (Nature Communications 11, 2020, doi:10.1038/s41467-020-19086-0), robots and fish: a phase
  that "varies linearly with front-back distance". Heydari, Hang and Kanso (eLife 96129, 2024, reply to the reviews) put
  these, Newbolt, Zhang and Ristroph (PNAS 116, 2019) and simulations on one line.
* *The leader swims as if alone*, except in compact pairs (Arranz, Flores and Garcia-Villalba, J. Fluid Mech. 2022); pairs
  that heave swim with "a slight increase in the swimming speed" (Heydari and Kanso, J. Fluid Mech. 2021,
  arXiv:2009.12715).
* *The relevant wavelength is the wavelength of the wake*, which convects itself (Han et al., arXiv:2410.01932): positions
  are 1.02 U/f apart here; with a smaller amplitude the positions approach linear theory.

Only abstracts and replies of these papers were available, no tables; the reference numbers therefore come from linear
theory: the second plate in the flat far wake of the first, by Theodorsen, Garrick and Sears
(tests/verify/linear_theory.c). The theory gives the thrust of the second plate at every distance, with a stable and an
unstable position in each wavelength, at any amplitude. The plates of Fang et al. have the parameters of the published
program (github.com/FangMath/VortexSheetSchooling, parameter.m): length 2, heave 0.2, mass 2, drag 0.04 U^1.5; the program
lists the speed 13.25 of a single plate, in agreement with Garrick's theory."""),
    "coupled": ("Coupled bodies", """\
This section has free bodies in the moving fluid, with `force: pressure`: the added mass of a plate; the impulse of a sudden stream of 0.1
across a plate, with continuous positions and momenta and a jump of the velocities; and fish that swim by a wave of
curvature 5 (0.2 + 0.8 s) sin(2 pi (t - s)) (mass 0.1 rho L, E I = rho f^2 L^5, friction 0.0133 U^1.5), alone and one behind
the other. The speeds are compared with a prototype of the method, another program with another body (a polygon) and
another solver."""),
    "depth": ("Finite depth", """\
With `pressure.span: finite` (model.md 18) the sheets consist of vortex rings, between Lighthill's slender body and two
dimensions. This section tests the lift of wings, and the added mass, thrust and power of a heaving plate. The fluid must
receive the momentum of fish of one and of two depths, and the wake of a slow slender fish must stay whole."""),
    "encounters": ("Encounters", """\
Here bodies meet an unsteady inflow (model.md 8). *Gusts*: a fixed plate is in a gust that travels with the stream, with full
suction, U Dt = 0.005 to 0.02 L and 65 sheet points. The lift in a sine gust is Sears' function; the pressure of Sears' solution has
the form of an incidence, so the suction, the only force along the plate, is the square of the lift. The lift in a step
gust is Kuessner's function; s is the way of the middle of the step from the nose, in half lengths, and the step rises over
a tenth of the length. *Vortex streets* (`wake.street`): the speed of a street in still fluid is von Karman's; the ends of
a street are an error proportional to 1/N. A plate on the centre line, free along the stream, meets the gusts of all rows at
the odd harmonics of the spacing; the suction of Sears' pressure accelerates the plate against the stream. A plate that is
free in all directions heaves and pitches in a weak street as the equations of a rigid body with Wagner's lift, integrated by
another program."""),
    "skin": ("Pressure on the skin", """\
This section tests the pressure on both sides of a plate at `sensors` (model.md 15). Beside a vortex that passes it is compared
with the complex potential of the vortices of the run outside the circle of the plate, and in an oscillating stream with linear
theory, whose added-mass pressure is elliptic. The friction on both sides by Thwaites' method (model.md 9) is compared with
Blasius and with the Navier-Stokes solutions of the last section."""),
    "growth": ("Growth of a disturbance", """\
The first rows are the modulus below which a flag flutters, as `shoal steady --threshold` finds it at three intervals, between
which it falls at an order of 1.4. Its own bar does not contain what the interval changes.

The multipliers of a steady state come from the responses to changes that last a single beat (doc/steady.md). Here two runs
start from the steady state plus and minus a multiple of the mode of the largest multiplier, and nothing is corrected on the
way. Their difference x_k after beat k grows or decays by the recurrence x_k+1 = a x_k + b x_k-1, whose coefficients are those
of least squares; the larger root is compared with the multiplier. The first beats are left out, because the wake of the steady
state has no disturbance before them. The last rows show an unstable school, five plates of heave 0.12 m: a run that is released
from the steady state oscillates in the last plate, and with the period of the mode. At the end the multiplier of two plates is
computed with other intervals and tolerances."""),
    "walls": ("Walls", """\
For bodies beside straight walls (model.md 17) this section shows that a fish beside a wall moves like a fish beside the mirror image, a plate between
two walls has the circulation of thin-foil theory with all images, and a fish that swims against a wall loses no energy to
the wall. A vortex pair (`wake.vortices`) parts at a wall as in potential flow."""),
    "validation": ("Against experiment and Navier-Stokes", """\
This section compares `force: pressure`, with the limit of suction and the friction of the boundary layer (model.md 9 and 15),
with real fluids. It runs foil_anderson, foil_heave and swimmer_navier_stokes of cases/, with other keys at their defaults. The
references are in tests/verify/data with their sources. *Error* is the ratio of the result to the reference, and it is the validation.
Two foils (school_navier_stokes.csv) are compared by what the other foil changes; side by side the bound is 15 % plus the
error of the source. The differences have these reasons:

* *Foil, thrust.* It is 3 to 13 % too small for St from 0.2 to 0.5, because the sheet has no thickness, which increases the thrust in the
  inviscid theory of the same article (dashed), and the friction of a steady boundary layer takes 3 to 6 %. At psi = 90 that
  theory is below the experiment too: leading-edge vortices join the trailing-edge vortices, in contrast to attached flow.
* *Foil, St = 0.1.* The thrust is the small difference of suction, pressure and friction: with full suction the thrust is
  1.4 times the experiment at psi = 90, and the limit removes half of the excess.
* *Foil, power.* It is up to 16 % too large at St = 0.5. At psi = 75 the flow separates at the nose for a fifth of the period; the
  limit changes the suction, but not the lift and its power. The cause of the 9 % at psi = 90 is not known.
* *Heave, thrust.* The remaining suction is about as large as the friction, and depends on the critical A_0 (0.01 in A_0 is
  0.017 in the coefficient). The two references at Re 4000, with other noses and tails and other grids, differ from each other
  by more than from the program.
* *Heave, lift and power.* They are up to a quarter too large, because the boundary layer displaces the flow at the trailing edge (round, of
  the ellipse), so the Kutta condition holds only in part, and the leading-edge vortex takes circulation.
* *Swimmer, speed.* It is 8 % above the middle of an extrapolation with a range of 12 %. The friction is that of a steady
  boundary layer with factors for wave and thickness (without the factors the swimmer is 22 % too fast), and has no history.
* *Swimmer, power and forces.* The power is 13 % smaller, because the body is a sheet, while in the fluid its thickness of 8 %
  of the length and the boundary layer displace additional water. The lateral force is a sum of forces that nearly cancel along the body, and the vortices of
  the wake balance a smaller friction.
* *Trout.* The gait is a regression over fish of 0.055 to 0.56 m, without the envelope of the body and the shape of its
  depth. The stride of slow trout is less than computed by up to a quarter."""),
}

# figure: title, x axis, y axis, further keys: scale (log, linear, semilog, semilogx), slopes of the triangles, joined
# (True: the points of a series by lines)
FIGURE = {
    "fish_nodes": ("Default fish: steady speed", "nodes N", "speed [m/s]", {"scale": "linear"}),
    "fish_stiffness": ("Default fish from rest: cost of the last of eight beats", "modulus [Pa]", "cost [m/s2]",
                       {"scale": "log"}),
    "elastica": ("Elastica: tip deflection", "nodes N", "error of the deflection over L", {"slopes": [-2]}),
    "frequencies": ("Frequencies of beams", "nodes N", "relative error of beta L", {"slopes": [-2]}),
    "natural shape": ("Chain with natural curvature", "nodes N", "relative error of the chord", {"slopes": [-2]}),
    "conservation": ("Struck free rod: what is conserved", "solver.rtol", "relative change", {"scale": "log"}),
    "energy of body and fluid": ("Energy of body and fluid", "mean step [s]", "change over the energy",
                                 {"slopes": [2]}),
    "sheet_plate": ("Flat plate: strength of the sheet", "sheet points M", "relative error", {"slopes": [-1]}),
    "sheet_arc": ("Circular arc: circulation", "sheet points M", "relative error", {"slopes": [-1]}),
    "sheet_nodes": ("Circulation of bent bodies, 65 sheet points", "nodes N", "relative error",
                    {"slopes": [-1.5, -3.5]}),
    "sheet_points": ("Bent fish of 17 nodes against itself with 129 sheet points", "sheet points M", "relative error",
                     {"scale": "semilog"}),
    "sheet_condition": ("Condition number of the sheet's equations", "sheet points M", "condition number",
                        {"scale": "log"}),
    "wake_order": ("Free vortices: order in Dt", "interval Dt [s]", "error", {"slopes": [2]}),
    "wake_row": ("Perturbed row against an endless one", "periodic images on each side", "relative error of the growth",
                 {"slopes": [-1]}),
    "wagner": ("Impulsively started plate (Wagner)", "s = 2 U t/L", "G(s), shed circulation over its final value",
               {"scale": "linear"}),
    "wagner_interval": ("Impulsive start: interval", "shedding interval Dt [s]", "error of G(2)",
                        {"scale": "log", "slopes": [0.5]}),
    "wagner_sheet": ("Impulsive start: sheet", "sheet points M", "change of G(2) when doubled", {"slopes": [-1]}),
    "wagner_smoothing": ("Impulsive start: smoothing", "wake.smoothing", "error of G(2)",
                         {"scale": "log", "slopes": [0.5]}),
    "heave_amplitude": ("Heaving plate: bound circulation", "k = omega L/(2U)", "amplitude over quasi-steady",
                        {"scale": "linear"}),
    "heave_phase": ("Heaving plate: bound circulation", "k = omega L/(2U)", "phase [degree]", {"scale": "linear"}),
    "momentum_interval": ("Momentum lost by a fish from rest, 6 s", "shedding interval Dt [s]",
                          "balance at the end over its largest term", {"scale": "log", "slopes": [1]}),
    "pressure_interval": ("Lift of a heaving plate, k = 1", "U Dt/L", "relative difference from Theodorsen",
                          {"scale": "log", "slopes": [1]}),
    "pressure_sheet": ("Lift of a heaving plate, k = 1, 400 events a period", "sheet points M - 1",
                       "relative difference from Theodorsen", {"scale": "log", "slopes": [-1]}),
    "heave_interval": ("Heaving plate: order in Dt", "shedding interval Dt [s]", "error",
                       {"scale": "log", "slopes": [1]}),
    "energy balance": ("Energy balance over the work done", "t [s]", "balance over work", {"scale": "linear"}),
    "energy balance, order 2": ("Energy balance, order 2", "mean step [s]", "balance over work", {"slopes": [2]}),
    "energy balance, order 5": ("Energy balance, order 5", "solver.rtol", "balance over work", {"scale": "log"}),
    "condition of the start": ("Condition number of the consistent start", "sheet points M", "condition number",
                               {"scale": "log"}),
    "school_interval": ("School, continuous shedding", "shedding interval Dt [s]", "change when halved [m, m2/s]",
                        {"slopes": [2]}),
    "school_interval_impulsive": ("School, impulsive shedding", "shedding interval Dt [s]",
                                  "change when halved [m, m2/s]", {"slopes": [1]}),
    "school_interval_rate": ("School, continuous shedding, kutta rate", "shedding interval Dt [s]",
                             "change when halved [m, m2/s]", {"slopes": [2]}),
    "school_interval_impulsive_rate": ("School, impulsive shedding, kutta rate", "shedding interval Dt [s]",
                                       "change when halved [m, m2/s]", {"slopes": [1]}),
    "school_interval_fading": ("School, decaying vortices", "shedding interval Dt [s]", "change when halved [m, m2/s]",
                               {"slopes": [2]}),
    "school_nodes": ("One fish: nodes of the body", "edge length, 1/(N - 1)", "change when halved [m, m2/s]",
                     {"slopes": [2, 1.5]}),
    "school_points": ("One fish: points of the sheet", "sheet points M", "shed circulation: change when doubled [m2/s]",
                      {"slopes": [-1, -2]}),
    "school_tolerance": ("School: error against tolerance", "solver.rtol", "error [m, m2/s]",
                         {"slopes": [2 / 3, 5 / 6]}),
    "interval, sheet, retained": ("One fish, sheet, retained", "shedding interval Dt [s]",
                                  "change when halved [m, m2/s]", {"slopes": [1, 1.5]}),
    "interval, sheet, dropped": ("One fish, sheet, dropped", "shedding interval Dt [s]",
                                 "change when halved [m, m2/s]", {"slopes": [1, 1.5]}),
    "interval, continuous, retained": ("One fish, continuous, retained", "shedding interval Dt [s]",
                                       "change when halved [m, m2/s]", {"slopes": [2]}),
    "interval, continuous, dropped": ("One fish, continuous, dropped", "shedding interval Dt [s]",
                                      "change when halved [m, m2/s]", {"slopes": [2]}),
    "flutter": ("Flutter of a plate with a clamped nose", "mass ratio M*", "threshold U*", {"scale": "semilogx"}),
    "steady_default fish": ("The default fish: the way to a steady state", "beats",
                      "speed: relative error", {"scale": "semilog"}),
    "steady_stiff fish": ("A fish of 1e7 Pa: the way to a steady state", "beats",
                      "speed: relative error", {"scale": "semilog"}),
    "steady_fish with pressure": ("A fish with force: pressure: the way to a steady state", "beats",
                      "speed: relative error", {"scale": "semilog"}),
    "steady_fish of finite span": ("A fish of finite span: the way to a steady state", "beats",
                      "speed: relative error", {"scale": "semilog"}),
    "steady_heaving plate": ("A heaving plate: the way to a steady state", "beats",
                      "speed: relative error", {"scale": "semilog"}),
    "reconfiguration": ("A plate across the stream", "Cauchy number", "drag over that of a stiff plate",
                        {"slopes": [-1 / 3]}),
    "tandem_starts": ("A follower: where it settles", "tail to nose at the start [wavelengths]",
                      "tail to nose [wavelengths]", {"scale": "linear", "joined": False}),
    "tandem_places": ("Places of a follower", "n less the follower's lead [beats]", "tail to nose [wavelengths]",
                      {"scale": "linear", "joined": False}),
    "tandem_thrust": ("A follower that is held in place", "tail to nose [wavelengths]", "thrust over the leader's",
                      {"scale": "linear", "joined": False}),
    "stiffness, tail": ("Plate with a heaving nose, k = pi, m = 0.1", "bending stiffness E I", "tail over nose",
                        {"scale": "semilogx"}),
    "stiffness, efficiency": ("Plate with a heaving nose, k = pi, m = 0.1", "bending stiffness E I",
                              "efficiency, thrust times U over power", {"scale": "semilogx"}),
    "foil_thrust_90": ("Foil that pitches 90 degrees ahead of its heave", "Strouhal number", "thrust coefficient",
                       {"scale": "linear"}),
    "foil_thrust_75": ("Foil that pitches 75 degrees ahead of its heave", "Strouhal number", "thrust coefficient",
                       {"scale": "linear"}),
    "foil_power": ("Heaving and pitching foil", "Strouhal number", "power coefficient", {"scale": "linear"}),
    "trout": ("Stride of trout", "beat frequency [Hz]", "stride [lengths]", {"scale": "linear"}),
    "swimmer_speed": ("Swimmer from rest", "beats", "speed over the last beat [L/T]", {"scale": "linear"}),
    "symmetry_far": ("A fish and its far companion", "distance [lengths]", "change of position [m]", {"slopes": [-2]}),
}

# marker and dash distinguish series as well as colour
MARKERS = ["o", "s", "^", "D", "v", "x", "+", "P", "*"]
DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))]

PICTURE = {**STYLE, "legend.fontsize": 7.5, "savefig.dpi": 110}


def read_table(path):
    """Rows as lists of fields, and figures as {figure: {series: [(x, y)]}} in the order of the table."""
    rows, figures = [], {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            fields = line.rstrip("\n").split("\t")
            if fields[0] == "row" and len(fields) == 10:
                rows.append(fields[1:])
            elif fields[0] == "point" and len(fields) == 5:
                points = figures.setdefault(fields[1], {}).setdefault(fields[2], [])
                points.append((float(fields[3]), float(fields[4])))
            else:
                sys.exit(f"verify.py: {path}: neither a row nor a point: {line!r}")
    return rows, figures


def slug(name):
    """The name of a figure as part of a file name."""
    return re.sub("[^a-z0-9]+", "_", name.lower()).strip("_")


def is_logarithmic(figure):
    """All points are positive and spread over a factor of four in x and ten in y."""
    xs = [x for points in figure.values() for x, _ in points]
    ys = [y for points in figure.values() for _, y in points]
    return min(xs) > 0 and min(ys) > 0 and max(xs) >= 4 * min(xs) and max(ys) >= 10 * min(ys)


def draw_triangles(axes, figure, slopes):
    """Draw one triangle per slope below the lowest curve, labelled with the slope."""
    xs = sorted({x for points in figure.values() for x, y in points if y > 0})
    ys = [y for points in figure.values() for _, y in points if y > 0]
    left, right = math.log10(xs[0]), math.log10(xs[-1])
    width = 0.16 * (right - left)
    bottom = math.log10(min(ys)) + 0.03 * math.log10(max(ys) / min(ys))
    for number, slope in enumerate(slopes):
        # rising curves have free space at the lower right, falling curves at the lower left
        x0 = right - (1.3 * number + 1) * width if slope > 0 else left + 1.3 * number * width
        y0 = bottom if slope > 0 else bottom - slope * width
        corner = (x0 + width, y0) if slope > 0 else (x0, y0 + slope * width)
        points = [(x0, y0), corner, (x0 + width, y0 + slope * width), (x0, y0)]
        axes.plot([10**x for x, _ in points], [10**y for _, y in points], color="0.35", lw=0.8)
        text = {2 / 3: "2/3", 5 / 6: "5/6"}.get(slope, f"{abs(slope):.2g}")
        axes.annotate(text, (10 ** (x0 + width / 2), 10 ** (y0 + slope * width / 2)), (-7, 6) if slope > 0 else (6, 4),
                      textcoords="offset points", size=7.5, ha="center", color="0.25")


def draw_figure(name, figure, path):
    """One figure as a PNG."""
    title, x_axis, y_axis, keys = FIGURE.get(name, (name.replace("_", " "), "", "", {}))
    scale = keys.get("scale", "log" if is_logarithmic(figure) else "linear")
    pyplot.rcParams.update(PICTURE)
    window, axes = pyplot.subplots(figsize=(4.8, 3.4))
    markers = 0
    for number, (series, points) in enumerate(figure.items()):
        if scale in ("log", "semilog"):
            points = [(x, y) for x, y in points if y > 0]
        x, y = [point[0] for point in points], [point[1] for point in points]
        if series.startswith(("exact", "published", "Navier-Stokes")):
            axes.plot(x, y, color="black", ls="-" if series.startswith("exact") else "--", lw=1.0, label=series,
                      zorder=1)
            continue
        if series.startswith("experiment"):
            axes.plot(x, y, color="black", ls="none", ms=4.5, marker=MARKERS[number % len(MARKERS)], label=series)
            continue
        filled = MARKERS[number % len(MARKERS)] in "x+"
        dots = len(points) <= 25
        dash = DASHES[markers % len(DASHES)] if keys.get("joined", True) else "none"
        axes.plot(x, y, color=LINES[markers % len(LINES)], ls=dash, lw=0.9, ms=4,
                  marker=MARKERS[number % len(MARKERS)], mfc=None if filled else "white", mew=0.9,
                  markevery=1 if dots else max(1, len(points) // 15), label=series)
        markers += 1
    axes.set_xscale("log" if scale in ("log", "semilogx") else "linear")
    axes.set_yscale("log" if scale in ("log", "semilog") else "linear")
    places = sorted({x for points in figure.values() for x, _ in points})
    if scale in ("log", "semilogx") and len(places) <= 7:
        # ticks at the runs instead of decades
        axes.set_xticks(places, [f"{x:.4g}" for x in places])
        axes.set_xticks([], minor=True)
    if scale == "log":
        draw_triangles(axes, figure, keys.get("slopes", []))
    axes.set(title=title, xlabel=x_axis, ylabel=y_axis)
    axes.title.set_size(9)
    axes.grid(True, which="major", lw=0.3, color="0.85")
    axes.set_axisbelow(True)
    if len(figure) > 1 or name not in FIGURE:
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), handlelength=3)
    window.savefig(path, metadata={"Software": None})
    pyplot.close(window)
    # few colours: a third of the size
    with Image.open(path) as image:
        few = image.convert("RGB").quantize(64)
    few.save(path, optimize=True)
    if os.path.getsize(path) > 60_000:
        sys.exit(f"verify.py: {path} has more than 60 kB")


def cell(text):
    """A text inside a markdown table."""
    return text.replace("|", "\\|")


def table_of(rows):
    """The rows of one section in markdown."""
    lines = ["| quantity | reference (source) | obtained | error | bound | order |", "|---|---|--:|--:|--:|--:|"]
    for _, quantity, source, reference, obtained, error, bound, order, verdict in rows:
        source = source if source != "(null)" else ""
        told = f"{reference} ({source})" if reference and source else reference or source
        if verdict == "MISSED":
            bound = f"**missed**: {bound}"
        lines.append("| " + " | ".join(cell(text) for text in (quantity, told, obtained, error, bound, order)) + " |")
    return "\n".join(lines)


def summary(tables):
    """One line per section: number of checks, number of missed bounds."""
    lines = ["| section | checks | missed |", "|---|--:|--:|"]
    totals = [0, 0]
    for name, (rows, _) in tables.items():
        checks = sum(1 for row in rows if row[8])
        missed = sum(1 for row in rows if row[8] == "MISSED")
        totals = [totals[0] + checks, totals[1] + missed]
        heading = SECTIONS[name][0]
        lines.append(f"| {heading} | {checks} | {missed} |")
    lines.append(f"| all | {totals[0]} | {totals[1]} |")
    return "\n".join(lines)


def replace_summary(document, table):
    """Put the summary into the table of a document; the document's own last column is kept."""
    with open(document, encoding="utf-8") as file:
        text = file.read()
    found = re.findall(r"^\| section \| checks \| missed \|.*\n(?:\|.*\n)*", text, flags=re.MULTILINE)
    if len(found) != 1:
        sys.exit(f"verify.py: {document} has {len(found)} tables that start with '| section | checks | missed |', not one")
    old = [line.split("|") for line in found[0].splitlines()]
    last = {cells[1].strip(): cells[4] for cells in old}
    rows = [line + last.get(line.split("|")[1].strip(), "  ") + "|" for line in table.splitlines()]
    rows[1] = table.splitlines()[1] + "---|"
    with open(document, "w", encoding="utf-8") as file:
        file.write(text.replace(found[0], "\n".join(rows) + "\n"))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = sys.argv[1]
    pictures = os.path.join(folder, "figures")
    tables = {name: read_table(os.path.join(folder, f"{name}.tsv"))
              for name in SECTIONS if os.path.exists(os.path.join(folder, f"{name}.tsv"))}
    if not tables:
        sys.exit(f"verify.py: no table in {folder}: scripts/verify.sh makes them")
    shutil.rmtree(pictures, ignore_errors=True)
    os.makedirs(pictures)
    parts = [INTRODUCTION, summary(tables)]
    for name, (rows, figures) in tables.items():
        heading, text = SECTIONS[name]
        parts += [f"\n## {heading}\n\n{text}\n", table_of(rows)]
        for figure, series in figures.items():
            picture = f"{slug(figure)}.png"
            draw_figure(figure, series, os.path.join(pictures, picture))
            caption = FIGURE[figure][0] if figure in FIGURE else figure.replace("_", " ")
            parts.append(f"\n![{caption}](figures/{picture})")
    with open(os.path.join(folder, "report.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(parts) + "\n")
    if len(sys.argv) == 3:
        replace_summary(sys.argv[2], summary(tables))


if __name__ == "__main__":
    main()
