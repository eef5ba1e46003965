/* case_table.c: the table of keys. Whatever reads, checks, prints or documents a case loops over it, so a new key is a
 * new row. */
#include "case/case_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "fish/fish_school.h"
#include "fish/fish_sheet.h"

#define AT(field) offsetof(struct case_values, field)
#define IN_FISH(field) offsetof(struct fish_parameters, field)
#define ANY \
    { -INFINITY, INFINITY, false, false }
#define FROM(min) \
    { min, INFINITY, false, false }
#define ABOVE(min) \
    { min, INFINITY, true, false }
#define FROM_TO(min, max) \
    { min, max, false, false }
#define FROM_BELOW(min, max) \
    { min, max, false, true }
#define ABOVE_UP_TO(min, max) \
    { min, max, true, false }
#define BETWEEN(min, max) \
    { min, max, true, true }
// up to 1e6 degrees a double resolves angles to 1e-9 degrees
#define ANGLE FROM_TO(-1e6, 1e6)
#define WORDS(...)          \
    (const char *const[]) { \
        __VA_ARGS__, NULL   \
    }

enum { NAME_BYTES = 200, FILE_BYTES = 4000, MAX_NODES = 10000, MAX_THREADS = 1024, MAX_STEPS = 1000000000 };

// ---- derived defaults, in the order of the table

// a product or quotient of decimals is the decimal, without the rounding of the operation: 0.3, not 3 * 0.1
static bool derive_number(const struct key_place *at, double number) {
    *(double *)at->field = text_round(number);
    return true;
}

static bool derive_word(const struct key_place *at, int word) {
    *(int *)at->field = word;
    return true;
}

static bool derive_case_name(const struct key_place *at) {
    const char *const slash = strrchr(at->origin, '/'), *const from = slash ? slash + 1 : at->origin;
    const char *const dot = strrchr(from, '.');
    const size_t length = dot && dot > from ? (size_t)(dot - from) : strlen(from);
    *(char **)at->field = length > 0 ? arena_text(at->values->arena, "%.*s", (int)length, from) : "case";
    return true;
}

static bool derive_gust_speed(const struct key_place *at) {
    const struct fluid_parameters *const fluid = &at->values->school.fluid;
    if (fluid->gust_profile == GUST_UNIFORM) return false;
    return derive_number(at, hypot(fluid->velocity[0], fluid->velocity[1]));
}

static bool derive_gradient_distance(const struct key_place *at) {
    const struct school_parameters *const school = &at->values->school;
    double length = 0;
    for (int f = 0; f < school->n_fish; f++) length = fmax(length, school->fish[f].length);
    return school->fluid.gust_profile == GUST_STEP && derive_number(at, length / 5);
}

static bool derive_lifetime(const struct key_place *at) {
    const struct key *const lifetime = case_table_row("wake.lifetime");
    const double period = case_table_beat(at->values, lifetime, 0);
    if (!(period > 0)) return derive_number(at, 2);
    case_table_add_beats(at->values, (struct case_beats){lifetime, 0, 8, true});
    return derive_number(at, 8 * period);
}

static bool derive_decay(const struct key_place *at) {
    struct case_values *const values = at->values;
    const struct key *const lifetime = case_table_row("wake.lifetime"), *const decay = case_table_row("wake.decay");
    const double period = case_table_beat(values, lifetime, 0);

    // to the modes of a school that does not beat a wake seems to end abruptly, unless it decays over most of its life
    const double part = period > 0 ? 0.25 : 0.75;
    const struct case_beats *const in_beats = period > 0 ? case_table_in_beats(values, lifetime, 0) : NULL;
    if (!in_beats) return derive_number(at, part * values->school.wake.lifetime);
    const double n = text_round(part * in_beats->n);
    case_table_add_beats(values, (struct case_beats){decay, 0, n, true});
    return derive_number(at, n * period);
}

// the ratio of a street without linear growth of disturbances: cosh^2(pi h/a) = 2
static bool derive_row_distance(const struct key_place *at) {
    const struct street_parameters *const street = &at->values->school.wake.street;
    return street->n > 0 && derive_number(at, acosh(sqrt(2)) / M_PI * street->spacing);
}

char *case_table_fish_name(struct arena *arena, int f) {
    return arena_text(arena, "fish%d", f + 1);
}

static bool derive_fish_name(const struct key_place *at) {
    *(char **)at->field = case_table_fish_name(at->values->arena, at->number);
    return true;
}

static bool derive_force(const struct key_place *at) {
    const struct school_parameters *const school = &at->values->school;
    const bool is_possible = school->wake.shedding == SHEDDING_SHEET && school->sheet.curve == BODY_LINE_SMOOTH;
    return derive_word(at, is_possible ? FORCE_PRESSURE : FORCE_REACTIVE);
}

static bool derive_span(const struct key_place *at) {
    return derive_word(at, at->fish->force == FORCE_PRESSURE ? SPAN_FINITE : SPAN_INFINITE);
}

static bool derive_sheet_points(const struct key_place *at) {
    const int nodes = at->fish->nodes, usual = nodes > 17 ? 2 * nodes - 1 : 33, of_depth = fish_sheet_least(at->fish);
    *(int *)at->field = usual > of_depth ? usual : of_depth;
    return true;
}

static bool derive_relaxation_time(const struct key_place *at) {
    const double beat = fish_parameters_frequency(at->fish);
    return derive_number(at, beat > 0 ? 0.02 / beat : 0);
}

static double wave_period(const struct key_place *at) {
    return at->fish->wave.frequency > 0 ? 1 / at->fish->wave.frequency : 0;
}

static bool derive_period(const struct key_place *at) {
    return derive_number(at, wave_period(at));
}

static bool derive_quarter_period(const struct key_place *at) {
    return derive_number(at, wave_period(at) / 4);
}

static bool derive_control_ramp(const struct key_place *at) {
    const double period = wave_period(at);
    return derive_number(at, period > 0 ? period / 2 : 1);
}

// cross-flow separates from a free body; the flow of a held plate and of two dimensions is attached
static bool derive_normal_drag(const struct key_place *at) {
    const bool is_held = at->fish->motion.prescribed != PRESCRIBED_NONE;
    return derive_number(at, at->fish->force != FORCE_PRESSURE || (fish_is_strip(at->fish) && !is_held));
}

static bool derive_control_law(const struct key_place *at) {
    return derive_word(at, at->fish->control.waypoints.n > 0 ? CONTROL_COURSE : CONTROL_NONE);
}

static bool derive_desired_heading(const struct key_place *at) {
    struct number_list *const heading = at->field;
    NEW(at->values->arena, heading->value, 2);
    heading->value[1] = at->fish->start_heading;
    heading->n = 1;
    return true;
}

// ---- the table

const struct key case_table[] = {
    {"format", INTEGER, AT(format), NULL, FROM_TO(1, 1), "", .meaning = "version of the case file format: 1"},
    {"name", STRING, AT(name), NULL, FROM_TO(1, NAME_BYTES), "", .meaning = "name of the case",
     .derived = "the name of the file without the ending", .derive = derive_case_name, .synonyms = "title case"},
    {"include", FILES, 0, "[]", FROM_TO(1, FILE_BYTES), "",
     .meaning = "case files to read first, relative to this file", .synonyms = "import includes"},
    {"preset", CHOICE, AT(preset), "none", ANY, "", .meaning = "published: defaults of the published scheme",
     .words = WORDS("none", "published"), .synonyms = "variant"},

    {"time.end", DURATION, AT(time.end), NULL, ABOVE(0), "s",
     .meaning = "end of the simulation, which starts at time 0",
     .synonyms = "duration t_end tend final_time stop t_final"},
    {"time.shedding_interval", DURATION, AT(school.shedding_interval), NULL, ABOVE(0), "s",
     .meaning = "time between two events; at each event every fish sheds a vortex",
     .derived = "1/100 of the period of the fastest beat or prescribed motion, 0.01 s without a beat; time.end and the "
                "output intervals are then rounded to events",
     .cause = "fish.wave.frequency", .synonyms = "dt delta_t timestep time_step", .published = "0.01"},
    {"time.output_interval", DURATION, AT(time.output_interval), NULL, ABOVE(0), "s",
     .meaning = "time between two rows of output, an integer multiple of shedding_interval",
     .derived = "ten shedding intervals", .multiple = {10, "time.shedding_interval"}, .cause = "time.shedding_interval",
     .synonyms = "output_every save_interval dt_out"},
    {"time.checkpoint_interval", DURATION, AT(time.checkpoint_interval), "0", FROM(0), "s",
     .meaning = "time between two checkpoints for `shoal resume`, an integer multiple of shedding_interval; 0: only "
                "when the run is stopped",
     .synonyms = "checkpoint restart_interval checkpoint_every save_every"},
    {"time.checkpoint_wall", REAL, AT(time.checkpoint_wall), "60", FROM(0), "s",
     .meaning = "wall time between two checkpoints from which a killed run continues; they change no bit of the run, "
                "and are removed at its end; 0: none",
     .synonyms = "autosave checkpoint_seconds checkpoint_minutes backup"},

    {"fluid.density", REAL, AT(school.fluid.density), "1000", FROM(0), "kg m-3",
     .meaning = "density of the fluid; 0: no fluid forces", .synonyms = "rho rho_f"},
    {"fluid.viscosity", REAL, AT(school.fluid.viscosity), "1e-6", FROM(0), "m2 s-1",
     .meaning = "kinematic viscosity, for drag.skin laminar and boundary_layer", .synonyms = "nu"},
    {"fluid.velocity", PAIR, AT(school.fluid.velocity), "[0, 0]", ANY, "m s-1", .meaning = "uniform background flow",
     .synonyms = "current stream flow wind u_inf"},
    {"fluid.shear", REAL, AT(school.fluid.shear), "0", ANY, "s-1",
     .meaning = "adds shear * y to the x component of the background flow"},
    {"fluid.gust.profile", CHOICE, AT(school.fluid.gust_profile), "uniform", ANY, "",
     .meaning = "uniform: oscillates in time; sine, step: a wave or a step that travels along the stream",
     .words = WORDS("uniform", "sine", "step"), .synonyms = "kuessner sears sharp_edged"},
    {"fluid.gust.amplitude", REAL, AT(school.fluid.gust_amplitude), "0", ANY, "m s-1",
     .meaning = "amplitude of the gust, a flow to the left of the stream, in y without a stream"},
    {"fluid.gust.frequency", REAL, AT(school.fluid.gust_frequency), "0", FROM(0), "Hz",
     .meaning = "profile uniform: frequency of the gust"},
    {"fluid.gust.wavelength", REAL, AT(school.fluid.gust_wavelength), "0", FROM(0), "m",
     .meaning = "profile sine: wavelength of the gust"},
    {"fluid.gust.speed", REAL, AT(school.fluid.gust_speed), NULL, ANY, "m s-1",
     .meaning = "profile sine, step: speed of the gust along the stream", .derived = "the speed of the stream",
     .derive = derive_gust_speed},
    {"fluid.gust.position", REAL, AT(school.fluid.gust_position), "0", ANY, "m",
     .meaning = "profile sine, step: place along the stream of a zero, or of the middle of the step, at the start"},
    {"fluid.gust.gradient_distance", REAL, AT(school.fluid.gust_gradient_distance), NULL, ABOVE(0), "m",
     .meaning = "profile step: distance over which the gust rises to the amplitude",
     .derived = "a fifth of the length of the longest fish", .derive = derive_gradient_distance,
     .cause = "fish.length"},
    {"fluid.walls", NUMBERS, AT(school.fluid.walls), "[]", ANY, "m",
     .meaning = "straight walls along x: y of one wall, or of both walls of a channel",
     .synonyms = "wall channel boundary tank ground bottom"},

    {"wake.smoothing", REAL, AT(school.wake.smoothing), "0.1", ABOVE(0), "",
     .meaning = "smoothing radius of a free vortex, in body lengths", .synonyms = "delta core blob epsilon",
     .published = "0.2"},
    {"wake.taper", REAL, AT(school.wake.taper), NULL, FROM(0), "",
     .meaning = "shedding sheet: distance from the tail, in body lengths, over which the smoothing of the wake at the "
                "body grows from 0; 0: no taper",
     .derived = "0.6 with shedding sheet, else 0", .choice = {"wake.shedding", "sheet", 0.6, 0},
     .follows = WORDS("wake.shedding")},
    {"wake.taper_beside", REAL, AT(school.wake.taper_beside), NULL, FROM(0), "",
     .meaning = "shedding sheet: the same for vortices beside the body", .derived = "0.07 with shedding sheet, else 0",
     .choice = {"wake.shedding", "sheet", 0.07, 0}, .follows = WORDS("wake.shedding")},
    {"wake.leg_length", REAL, AT(school.wake.leg_length), "1", FROM(0), "",
     .meaning = "pressure.span finite: factor of the length s(d) of the legs of the vortex rings in the wake "
                "(doc/model.md, section 18), a choice of the model"},
    {"wake.lifetime", DURATION, AT(school.wake.lifetime), NULL, ABOVE(0), "s",
     .meaning = "age at which a vortex is removed", .derived = "8 beats; 2 s if no fish beats",
     .derive = derive_lifetime, .cause = "fish.wave.frequency", .published = "2", .synonyms = "life max_age age"},
    {"wake.decay", DURATION, AT(school.wake.decay), NULL, FROM(0), "s",
     .meaning = "last part of the lifetime, in which the circulation decays to 0",
     .derived = "1/4 of the lifetime; 3/4 if no fish beats", .derive = derive_decay, .cause = "wake.lifetime",
     .published = "0"},
    {"wake.shedding", CHOICE, AT(school.wake.shedding), "sheet", ANY, "",
     .meaning = "sheet: a vortex sheet grows from the tail; continuous: a vortex grows between events; impulsive: a "
                "vortex appears at each event",
     .words = WORDS("continuous", "impulsive", "sheet"), .published = "impulsive"},
    {"wake.removed_circulation", CHOICE, AT(school.wake.removed_circulation), "retained", ANY, "",
     .meaning = "circulation of removed vortices in Kelvin's theorem", .words = WORDS("retained", "dropped")},
    {"wake.tolerance", REAL, AT(school.wake.tolerance), NULL, FROM_TO(0, 0.01), "",
     .meaning = "estimated error allowed in the velocity that far vortices induce at the bodies, in body lengths per "
                "beat; 0: direct summation",
     .derived = "solver.rtol/10", .multiple = {0.1, "solver.rtol"}, .cause = "solver.rtol",
     .synonyms = "accuracy theta"},
    {"wake.spare_vortices", INTEGER, AT(school.wake.spare), "0", FROM_TO(0, 1000000), "",
     .meaning = "number of vortices that a program can add to each wake: doc/python.md, section 2",
     .synonyms = "extra_vortices added_vortices"},

    {"wake.vortices", ROWS, AT(school.wake.vortices), "[]", ANY, "",
     .meaning = "vortices at the start, in the wake of the first fish: rows of x and y in m, circulation in m2 s-1",
     .synonyms = "dipole encounter"},
    {"wake.street.vortices", INTEGER, AT(school.wake.street.n), "0", FROM_TO(0, 10000), "",
     .meaning =
         "number of vortices of a vortex street at the start: two staggered rows along the stream, in the wake of "
         "the first fish",
     .synonyms = "karman"},
    {"wake.street.spacing", REAL, AT(school.wake.street.spacing), "0", FROM(0), "m",
     .meaning = "distance of neighbouring vortices of a row"},
    {"wake.street.row_distance", REAL, AT(school.wake.street.row_distance), NULL, FROM(0), "m",
     .meaning = "distance of the two rows", .derived = "0.2805 spacing, the stable street of von Karman",
     .derive = derive_row_distance, .cause = "wake.street.spacing", .synonyms = "width"},
    {"wake.street.circulation", REAL, AT(school.wake.street.circulation), "0", ANY, "m2 s-1",
     .meaning = "circulation of a vortex to the right of the stream; the row to the left has the opposite: positive "
                "behind a body with drag, negative behind a swimmer"},
    {"wake.street.position", PAIR, AT(school.wake.street.position), "[0, 0]", ANY, "m",
     .meaning = "middle of the street"},

    {"sheet.smoothing", REAL, AT(school.sheet.smoothing), "0.05", ABOVE(0), "",
     .meaning = "smoothing radius of a bound vortex at wakes and other fish, in body lengths", .published = "0.01"},
    {"sheet.curve", CHOICE, AT(school.sheet.curve), "smooth", ANY, "",
     .meaning = "line of the bound sheet through the nodes: a smooth interpolant, or straight edges",
     .words = WORDS("smooth", "polygon"), .synonyms = "line spline interpolation", .published = "polygon"},
    {"sheet.collocation", CHOICE, AT(school.sheet.collocation), "chebyshev", ANY, "",
     .meaning = "control points: Chebyshev points, or midpoints between the bound vortices", .published = "midpoint",
     .words = WORDS("chebyshev", "midpoint")},
    {"sheet.kutta", CHOICE, AT(school.sheet.kutta), "edge", ANY, "",
     .meaning = "Kutta condition; edge: the sheet strength at the tail vanishes; rate: the slip velocity at the tail "
                "sets the shedding rate",
     .published = "rate", .words = WORDS("edge", "rate"), .synonyms = "kutta_condition"},

    {"contact.action", CHOICE, AT(school.contact.action), "repel", ANY, "",
     .meaning = "bodies closer than contact.range; repel: a repulsive force; warn: a warning in the result; stop: the "
                "run ends with exit code 3",
     .words = WORDS("repel", "warn", "stop"), .synonyms = "law mode collision"},
    {"contact.range", REAL, AT(school.contact.range), "0.02", ABOVE(0), "",
     .meaning = "distance of outlines below which two bodies are in contact, in lengths of the longest fish",
     .synonyms = "distance gap"},

    {"solver.method", METHOD, AT(solver.method), "ida", ANY, "", .meaning = "integration method: see below",
     .synonyms = "integrator scheme"},
    {"solver.rtol", REAL, AT(solver.rtol), "3e-5", FROM_TO(1e-14, 0.1), "",
     .meaning = "error allowed per step, over the scale of each unknown (doc/numerics.md, section 3)",
     .synonyms = "tolerance tol reltol relative_tolerance"},
    {"solver.order", INTEGER, AT(solver.order), NULL, FROM_TO(1, 5), "",
     .meaning = "highest order of ida (doc/numerics.md, section 3)",
     .derived = "3; 5 if the slowest bending mode of every fish is below 0.6 of the beat frequency; 2 if a fish has a "
                "relaxation_time below 1/1000 of the beat period"},
    {"solver.error_test", CHOICE, AT(solver.error_test), "positions", ANY, "",
     .meaning = "unknowns in the error test of ida; all: also accelerations and sheets, whose errors make the steps "
                "four times as small (doc/numerics.md, section 3)",
     .words = WORDS("positions", "all"), .synonyms = "error_control"},
    {"solver.coupling_distance", REAL, AT(school.coupling_distance), "0.5", FROM(0), "",
     .meaning = "distance of two fish up to which the Jacobian couples them, in lengths of the longest fish"},
    {"solver.linear", CHOICE, AT(school.linear), "blocks", ANY, "",
     .meaning = "solution of linear systems; blocks: fish by fish, with GMRES for their couplings; klu: one sparse "
                "matrix of all unknowns, factored by KLU",
     .words = WORDS("blocks", "klu"), .synonyms = "linear_solver direct preconditioner"},
    {"solver.threads", INTEGER, AT(school.threads), "1", FROM_TO(1, MAX_THREADS), "", .meaning = "number of threads",
     .synonyms = "n_threads cores processes"},
    {"solver.step", DURATION, AT(solver.step), "0", FROM(0), "s", .meaning = "fixed step; 0: adaptive steps",
     .synonyms = "step_size"},
    {"solver.max_steps", INTEGER, AT(solver.max_steps), "10000", FROM_TO(1, MAX_STEPS), "",
     .meaning = "the integration fails after this many steps between two events", .synonyms = "mxstep"},

    {"output.file", STRING, AT(output.file), NULL, FROM_TO(1, FILE_BYTES), "", .meaning = "NetCDF file to write",
     .derived = "the name of the case with .nc", .synonyms = "path filename"},
    {"output.precision", CHOICE, AT(output.precision), "double", ANY, "",
     .meaning = "floating-point precision of the variables in the file", .words = WORDS("double", "single")},
    {"output.forces", CHOICE, AT(output.forces), "totals", ANY, "",
     .meaning = "forces in the file; totals: per fish; edges: also per edge; sides: also the laminar friction on each "
                "side of a fish with force pressure",
     .words = WORDS("totals", "edges", "sides")},
    {"output.wake_interval", DURATION, AT(output.wake_interval), NULL, ABOVE(0), "s",
     .meaning = "time between two records of the wake, an integer multiple of output_interval",
     .derived = "time.output_interval", .multiple = {1, "time.output_interval"}, .cause = "time.output_interval"},

    {"steady.tolerance", REAL, AT(steady.tolerance), "1e-5", FROM_TO(1e-12, 0.1), "",
     .meaning = "maximum change per beat of a steady state: of the speed in body lengths per beat, and of other "
                "quantities (doc/steady.md)",
     .synonyms = "residual accuracy"},
    {"steady.beats", INTEGER, AT(steady.beats), "200", FROM_TO(3, MAX_STEPS), "",
     .meaning = "the search fails after this many beats", .synonyms = "max_beats limit"},
    {"steady.output_beats", INTEGER, AT(steady.output_beats), "2", FROM_TO(0, MAX_STEPS), "",
     .meaning = "number of beats in the result, from the steady state on", .synonyms = "last_beats"},
    {"steady.formation", CHOICE, AT(steady.formation), "false", ANY, "",
     .meaning = "true: also find steady positions of the other fish relative to the first one",
     .words = WORDS("false", "true"), .synonyms = "places school"},
    {"steady.multipliers", CHOICE, AT(steady.multipliers), "true", ANY, "",
     .meaning = "true: compute the Floquet multipliers; without a beat, the modes of the bodies",
     .words = WORDS("false", "true"), .synonyms = "floquet stability"},

    {"defaults", DEFAULTS, 0, "{}", ANY, "",
     .meaning = "defaults: {fish: {...}}: values for every fish without the key", .synonyms = "default common shared"},

    {"fish.name", STRING, IN_FISH(name), NULL, FROM_TO(1, NAME_BYTES), "",
     .meaning = "name of the fish, unique in the school", .derived = "fish1, fish2, ...", .derive = derive_fish_name},
    {"fish.length", REAL, IN_FISH(length), "1", ABOVE(0), "m", .meaning = "body length L", .synonyms = "size chord"},

    {"fish.force", CHOICE, IN_FISH(force), NULL, ANY, "",
     .meaning =
         "force of the fluid besides drag; pressure: pressure jump across the bound sheet; reactive: "
         "accelerated fluid of a slender body, with the flux at the tail; published: added mass across each edge",
     .words = WORDS("reactive", "published", "pressure"), .published = "published",
     .derived = "pressure with wake.shedding sheet and sheet.curve smooth, else reactive", .derive = derive_force,
     .follows = WORDS("wake.shedding", "sheet.curve")},
    {"fish.pressure.span", CHOICE, IN_FISH(span), NULL, ANY, "",
     .meaning = "force pressure: span of the sheets; finite: the depth of the body, with vortex rings; infinite: "
                "two-dimensional flow",
     .words = WORDS("finite", "infinite"), .derived = "finite with force pressure", .derive = derive_span,
     .follows = WORDS("fish.force")},
    {"fish.pressure.suction", REAL, IN_FISH(suction), "1", FROM_TO(0, 1), "",
     .meaning = "force pressure: fraction of the leading-edge suction that acts on the body"},
    {"fish.pressure.suction_limit", REAL, IN_FISH(suction_limit), "0.18", FROM(0), "",
     .meaning = "force pressure: A_0 above which the flow at the nose separates, 0.11 (sharp nose, low Reynolds "
                "number) to 0.25 (round nose, high); 0: no limit",
     .synonyms = "lesp critical a0 leading_edge"},
    {"fish.sensors", NUMBERS, IN_FISH(sensors), "[]", FROM_TO(0, 1), "",
     .meaning =
         "force pressure: places of a lateral line, as fractions of the length from the nose; the result has the "
         "pressure on both sides of the body there",
     .synonyms = "lateral_line sensor probes"},

    {"fish.nodes", INTEGER, IN_FISH(nodes), "25", FROM_TO(4, MAX_NODES), "", .meaning = "number of nodes of the body",
     .synonyms = "n_nodes segments points resolution", .published = "7"},
    {"fish.reference_nodes", INTEGER, IN_FISH(reference_nodes), "7", FROM_TO(2, MAX_NODES), "",
     .meaning = "number of nodes for which wave.amplitude and the damping coefficients are given"},
    {"fish.sheet_points", INTEGER, IN_FISH(sheet_points), NULL, FROM_TO(5, MAX_NODES), "",
     .meaning = "number of vortices of the bound sheet", .synonyms = "vortices panels bound_vortices",
     .published = "21", .derived = "2 nodes - 1, at least 33; with pressure.span finite at least 1 + 5 L/w",
     .derive = derive_sheet_points, .cause = "fish.body.depth"},
    {"fish.wake_lifetime", REAL, IN_FISH(wake_lifetime), "1", ABOVE_UP_TO(0, 1), "",
     .meaning = "lifetime of the wake of this fish over wake.lifetime: lets the wakes of a line end at one place "
                "(doc/steady.md)"},

    {"fish.body.profile", CHOICE, IN_FISH(body.profile), "joukowski", ANY, "",
     .meaning = "thickness along the body: a Joukowski foil, uniform, or the lists thickness_table and depth_table",
     .words = WORDS("joukowski", "uniform", "table"), .synonyms = "shape"},
    {"fish.body.thickness", REAL, IN_FISH(body.thickness), "0.1", BETWEEN(0, 1), "",
     .meaning = "joukowski: parameter d of the foil; uniform: thickness over length", .published = "0.2"},
    {"fish.body.tail_thickness", REAL, IN_FISH(body.tail_thickness), NULL, FROM_BELOW(0, 1), "",
     .meaning = "joukowski: thickness at the tail over length; 0: a cusp, without convergence in the nodes",
     .derived = "0.04 with profile joukowski, else 0", .choice = {"fish.body.profile", "joukowski", 0.04, 0},
     .published = "0"},
    {"fish.body.depth", REAL, IN_FISH(body.depth), "0.2", ABOVE(0), "",
     .meaning = "depth of the body (its span, out of the plane of motion) over length", .published = "0.25"},
    {"fish.body.thickness_table", PROFILE, IN_FISH(body.thickness_table), "[]", ABOVE(0), "m",
     .meaning = "profile table: thickness at distances from the nose, which are fractions of the length from 0 to 1, "
                "for any number of nodes; or one thickness for every edge",
     .synonyms = "height heights"},
    {"fish.body.depth_table", PROFILE, IN_FISH(body.depth_table), "[]", ABOVE(0), "m",
     .meaning = "profile table: depth, in one of the forms of thickness_table", .synonyms = "widths"},
    {"fish.body.section", CHOICE, IN_FISH(body.section), "mean", ANY, "",
     .meaning = "section of an edge; mean: means over the edge; nodes: from the thickness at both nodes",
     .words = WORDS("mean", "nodes"), .published = "nodes"},
    {"fish.body.density", REAL, IN_FISH(body.density), "1000", ABOVE(0), "kg m-3", .meaning = "density of the body",
     .synonyms = "rho rho_b", .published = "2000"},
    {"fish.body.modulus", REAL, IN_FISH(body.modulus), "1.5e6", ABOVE(0), "Pa",
     .meaning = "Young's modulus of the body", .published = "1e6",
     .synonyms = "stiffness young youngs_modulus young_modulus elasticity rigidity e"},
    {"fish.body.second_moment", CHOICE, IN_FISH(body.second_moment), "ellipse", ANY, "",
     .meaning = "second moment of area; ellipse: of the elliptic cross-section; published: the formula of the article",
     .published = "published", .words = WORDS("ellipse", "published")},
    {"fish.body.bending_damping", REAL, IN_FISH(body.bending_damping), "0", FROM(0), "N m s",
     .meaning = "internal damping of bending, per joint of a body with reference_nodes nodes",
     .synonyms = "d_b damping", .published = "0.5"},
    {"fish.body.stretching_damping", REAL, IN_FISH(body.stretching_damping), "0", FROM(0), "N s m-1",
     .meaning = "internal damping of stretching, per edge of a body with reference_nodes nodes", .synonyms = "d_s",
     .published = "1"},
    {"fish.body.relaxation_time", DURATION, IN_FISH(body.relaxation_time), NULL, FROM(0), "s",
     .meaning = "Kelvin-Voigt damping: ratio of damping to stiffness", .published = "0",
     .derived = "1/50 of the period of the beat or of the prescribed motion (0 without a beat)",
     .derive = derive_relaxation_time, .cause = "fish.wave.frequency",
     .follows = WORDS("fish.wave.frequency", "fish.motion.frequency")},
    {"fish.body.damping", CHOICE, IN_FISH(body.damping), "strain", ANY, "",
     .meaning = "internal damping of bending; strain: of the curvature minus the natural curvature; curvature: of the "
                "total curvature",
     .words = WORDS("strain", "curvature"), .published = "curvature"},

    {"fish.wave.amplitude", REAL, IN_FISH(wave.amplitude), "0.4", ANY, "rad",
     .meaning = "A of the turning angle A (constant + linear q + quadratic q^2) sin(number q + 2 pi frequency t + "
                "phase), q = s/L"},
    {"fish.wave.constant", REAL, IN_FISH(wave.constant), "0", ANY, "", .meaning = "envelope of the wave at the nose",
     .synonyms = "c0"},
    {"fish.wave.linear", REAL, IN_FISH(wave.linear), "1", ANY, "",
     .meaning = "coefficient of q in the envelope of the wave", .synonyms = "c1"},
    {"fish.wave.quadratic", REAL, IN_FISH(wave.quadratic), "0.2", ANY, "",
     .meaning = "coefficient of q^2 in the envelope of the wave", .synonyms = "c2"},
    {"fish.wave.number", REAL, IN_FISH(wave.number), "-6", ANGLE, "rad",
     .meaning = "wavenumber: phase difference over one body length; negative: the wave travels from head to tail",
     .synonyms = "beta wavenumber wave_number k"},
    {"fish.wave.wavelength", REAL, IN_FISH(wave.wavelength), NULL, FROM(1e-5), "",
     .meaning = "wavelength in body lengths of a wave from head to tail; sets number to -2 pi/wavelength",
     .derived = "from wave.number", .synonyms = "lambda"},
    {"fish.wave.table", ROWS, IN_FISH(wave.table), "[]", ANY, "",
     .meaning = "natural curvature times body length in place of the wave: rows at equal distances from nose to tail, "
                "of values at equal phases of one period",
     .synonyms = "curvature profile"},
    {"fish.wave.frequency", REAL, IN_FISH(wave.frequency), "1", FROM(0), "Hz", .meaning = "beat frequency",
     .synonyms = "omega freq f beat period"},
    {"fish.wave.phase", REAL, IN_FISH(wave.phase), "0", ANGLE, "degree", .meaning = "phase at time 0"},
    {"fish.wave.ramp", DURATION, IN_FISH(wave.ramp), NULL, FROM(0), "s",
     .meaning = "time over which the amplitude is ramped up", .derived = "one period, 1/frequency (0 for frequency 0)",
     .derive = derive_period, .cause = "fish.wave.frequency"},

    {"fish.drag.tangential", REAL, IN_FISH(drag.tangential), "4e-3", FROM(0), "",
     .meaning = "tangential drag coefficient (friction)", .synonyms = "friction c_f cf", .published = "1e-3"},
    {"fish.drag.skin", CHOICE, IN_FISH(drag.friction), NULL, ANY, "",
     .meaning = "law of the tangential drag; quadratic: drag.law with drag.tangential; laminar: laminar boundary layer "
                "of a plate; boundary_layer: the same with transition, and factors for waving and thickness",
     .words = WORDS("quadratic", "laminar", "boundary_layer"),
     .derived = "boundary_layer with force pressure, else quadratic",
     .choice = {"fish.force", "pressure", FRICTION_BOUNDARY_LAYER, FRICTION_QUADRATIC}, .follows = WORDS("fish.force")},
    {"fish.drag.transition", REAL, IN_FISH(drag.transition), "2e5", FROM(0), "",
     .meaning = "skin boundary_layer: transition Reynolds number, based on the distance from the nose; 0: turbulent "
                "from the nose",
     .synonyms = "turbulence re_t"},
    {"fish.drag.waving", REAL, IN_FISH(drag.waving), NULL, ABOVE(0), "",
     .meaning = "skin boundary_layer: factor of the laminar friction due to the wave of the body",
     .derived = "1.5 for a body with a wave, else 1"},
    {"fish.drag.form", REAL, IN_FISH(drag.form), NULL, ABOVE(0), "",
     .meaning = "skin boundary_layer: factor of the friction due to the thickness of the body",
     .derived = "of an elliptic body, or of a wing with pressure.span infinite (doc/model.md, section 9)",
     .synonyms = "form_factor"},
    {"fish.drag.normal", REAL, IN_FISH(drag.normal), NULL, FROM(0), "",
     .meaning = "coefficient of the drag across the body: with force pressure, of the separated cross-flow",
     .synonyms = "c_d cd lateral", .published = "4",
     .derived = "1, or 0 with force pressure and span infinite or a prescribed motion", .derive = derive_normal_drag,
     .follows = WORDS("fish.force", "fish.pressure.span", "fish.motion.prescribed")},
    {"fish.drag.law", CHOICE, IN_FISH(drag.law), "quadratic", ANY, "",
     .meaning = "dependence of both drag forces on the velocity v: v |v|, or v (V1 + |v|)", .published = "quadratic",
     .words = WORDS("quadratic", "linear_quadratic")},
    {"fish.drag.linear_speed", REAL, IN_FISH(drag.linear_speed), "1", FROM(0), "",
     .meaning = "V1 of the law linear_quadratic, in lengths per beat; force published: 1 m/s"},

    {"fish.added_mass.coefficient", REAL, IN_FISH(added_mass.coefficient), "1", FROM(0), "",
     .meaning = "added-mass coefficient", .synonyms = "c_a ca", .published = "1.5"},
    {"fish.added_mass.extent", CHOICE, IN_FISH(added_mass.extent), "depth", ANY, "",
     .meaning = "extent of the body in added mass and normal drag, not with force pressure: thickness h or depth w",
     .words = WORDS("thickness", "depth"), .published = "thickness"},

    {"fish.start.position", PAIR, IN_FISH(start_position), "[0, 0]", ANY, "m",
     .meaning = "position of the nose at time 0", .synonyms = "x0 nose"},
    {"fish.start.heading", REAL, IN_FISH(start_heading), "180", ANGLE, "degree",
     .meaning = "heading at time 0, counter-clockwise from the x axis", .synonyms = "angle direction"},
    {"fish.start.speed", REAL, IN_FISH(start_speed), "0", ANY, "m s-1",
     .meaning = "speed of every node along the heading at time 0", .synonyms = "velocity u0 v0", .published = "1"},

    {"fish.load.tip", PAIR, IN_FISH(load_tip), "[0, 0]", ANY, "N", .meaning = "constant force on the tail node",
     .synonyms = "force"},

    {"fish.motion.prescribed", CHOICE, IN_FISH(motion.prescribed), "none", ANY, "",
     .meaning =
         "prescribed motion; head: of the nose and the direction of the first edge; all: of the entire straight body",
     .words = WORDS("none", "head", "all"), .synonyms = "drive prescribed"},
    {"fish.motion.surge", CHOICE, IN_FISH(motion.surge), "given", ANY, "",
     .meaning = "motion along start.heading; given: with motion.speed; free: determined by the forces",
     .words = WORDS("given", "free")},
    {"fish.motion.speed", REAL, IN_FISH(motion.speed), NULL, ANY, "m s-1",
     .meaning = "prescribed speed along start.heading; surge free: at the start", .derived = "start.speed",
     .multiple = {1, "fish.start.speed"}},
    {"fish.motion.heave", REAL, IN_FISH(motion.heave), "0", ANY, "m",
     .meaning = "amplitude of heave, the displacement to the left heave sin(2 pi frequency t + phase)",
     .synonyms = "plunge"},
    {"fish.motion.pitch", REAL, IN_FISH(motion.pitch), "0", ANGLE, "degree",
     .meaning = "amplitude of pitch, the rotation pitch sin(2 pi frequency t + pitch_phase + phase)"},
    {"fish.motion.pitch_phase", REAL, IN_FISH(motion.pitch_phase), "0", ANGLE, "degree",
     .meaning = "phase by which pitch leads heave"},
    {"fish.motion.frequency", REAL, IN_FISH(motion.frequency), "0", FROM(0), "Hz",
     .meaning = "frequency of heave and pitch"},
    {"fish.motion.phase", REAL, IN_FISH(motion.phase), "0", ANGLE, "degree",
     .meaning = "phase of heave and pitch at time 0"},
    {"fish.motion.pivot", REAL, IN_FISH(motion.pivot), "0", FROM_TO(0, 1), "",
     .meaning = "pitch axis, in body lengths from the nose"},

    {"fish.control.law", CHOICE, IN_FISH(control.law), NULL, ANY, "",
     .meaning = "law of the steering bias; none: the key bias; heading: error of the heading; averaged_heading: of its "
                "mean over a period; course: of the course over the last period; place: course and amplitude for a "
                "place beside another fish",
     .words = WORDS("none", "heading", "averaged_heading", "course", "place"), .synonyms = "controller type",
     .derived = "course with waypoints, else none", .derive = derive_control_law,
     .follows = WORDS("fish.control.waypoints")},
    {"fish.control.bias", REAL, IN_FISH(control.bias), "0", ANY, "",
     .meaning = "law none: the steering bias; positive turns right", .synonyms = "phi0 offset"},
    {"fish.control.desired_heading", HEADING, IN_FISH(control.desired_heading), NULL, ANGLE, "degree",
     .meaning = "desired heading: a number, or a list of [time in s, angle] with linear interpolation",
     .derived = "start.heading", .derive = derive_desired_heading, .synonyms = "target h_des target_heading"},
    {"fish.control.waypoints", PAIRS, IN_FISH(control.waypoints), "[]", ANY, "m",
     .meaning = "points to visit in order; the next point sets the desired heading", .synonyms = "route points"},
    {"fish.control.acceptance_radius", REAL, IN_FISH(control.acceptance_radius), "0.5", ABOVE(0), "",
     .meaning = "acceptance radius of a waypoint, in body lengths", .synonyms = "radius"},
    {"fish.control.gain", REAL, IN_FISH(control.gain), NULL, ANY, "",
     .meaning = "proportional gain: weight of the error of the heading or course",
     .derived = "1 with law course, else 2", .choice = {"fish.control.law", "course", 1, 2},
     .synonyms = "k_p kp proportional"},
    {"fish.control.damping", REAL, IN_FISH(control.damping), "1", ANY, "",
     .meaning = "course, place: weight of the rate of change of the course, in rad per period",
     .synonyms = "k_d kd derivative"},
    {"fish.control.slow", REAL, IN_FISH(control.slow), "0.1", FROM(0), "",
     .meaning = "course, place: speed in body lengths per period below which the course has less weight"},
    {"fish.control.course_filter", DURATION, IN_FISH(control.course_filter), NULL, FROM(0), "s",
     .meaning = "course, place: time constant of the filter of the rate of change of the course; 0: no filter",
     .derived = "a quarter of a period, 0.25/wave.frequency (0 for frequency 0)", .derive = derive_quarter_period,
     .cause = "fish.wave.frequency"},
    {"fish.control.limit", REAL, IN_FISH(control.limit), "0.5", ABOVE(0), "",
     .meaning = "maximum of the steering bias"},
    {"fish.control.feedforward", REAL, IN_FISH(control.feedforward), "0", ANY, "",
     .meaning = "weight of the feedforward: the filtered moment of the flow; 0 with force: pressure", .published = "1"},
    {"fish.control.filter", DURATION, IN_FISH(control.filter), NULL, FROM(0), "s",
     .meaning = "time constant of the filter of feedforward; 0: the moment at the last event",
     .derived = "one period, 1/wave.frequency (0 for frequency 0)", .derive = derive_period,
     .cause = "fish.wave.frequency", .published = "0"},
    {"fish.control.rate", REAL, IN_FISH(control.rate), "2", ABOVE(0), "s-1",
     .meaning = "averaged_heading, course, place: maximum rate of change of the steering bias, and of the "
                "relative amplitude with place"},
    {"fish.control.ramp", DURATION, IN_FISH(control.ramp), NULL, ABOVE(0), "s",
     .meaning = "duration of a change by a program (doc/python.md)",
     .derived = "half a period, 0.5/wave.frequency (1 s for frequency 0)", .derive = derive_control_ramp,
     .cause = "fish.wave.frequency"},
    {"fish.control.of", STRING, IN_FISH(control.of), NULL, FROM_TO(1, NAME_BYTES), "",
     .meaning = "place: name of the leader", .derived = "none; needed with law place", .synonyms = "leader follow"},
    {"fish.control.offset", PAIR, IN_FISH(control.offset), "[0, 0]", ANY, "m",
     .meaning =
         "place: nose of the fish minus nose of the leader, for the leader's start.heading; turns with the leader",
     .synonyms = "place distance spacing"},
    {"fish.control.amplitude_gain", REAL, IN_FISH(control.amplitude_gain), "4", ABOVE(0), "",
     .meaning = "place: relative change of the amplitude per body length behind the place"},
    {"fish.control.amplitude_damping", REAL, IN_FISH(control.amplitude_damping), "6", FROM(0), "",
     .meaning = "place: relative change of the amplitude per body length lost in a period"},
    {"fish.control.amplitude_limit", REAL, IN_FISH(control.amplitude_limit), "0.5", BETWEEN(0, 1), "",
     .meaning = "place: largest relative change of the amplitude"},
    {"fish.control.lookahead", REAL, IN_FISH(control.lookahead), "3", ABOVE(0), "",
     .meaning = "place: the course points at a point this many body lengths ahead of the place"},
    {"fish.control.hold_time", REAL, IN_FISH(control.hold_time), "12", ABOVE(0), "",
     .meaning = "place: time constant of the integrals, in periods"},

    {"sweep", AXES, 0, "[]", ANY, "",
     .meaning = "axes of a study, {key: PATH, values: [...]} or {keys: [...], values: [[...], ...]}",
     .synonyms = "study parameters scan"},
    {"expect", EXPECTATIONS, 0, "[]", ANY, "",
     .meaning = "expected final values of the members of a study, {of: QUANTITY, least: ..., most: ...}",
     .synonyms = "expected check assert"},
    {"error", ERRORS, 0, "{}", ANY, "",
     .meaning =
         "requested errors of quantities, {of: [QUANTITY, ...], within: ...}, for `shoal study` and `shoal error`",
     .synonyms = "uncertainty errors accuracy error_bars"},
};

const int case_table_n = sizeof case_table / sizeof *case_table;

const struct key *case_table_row(const char *path) {
    for (int i = 0; i < case_table_n; i++) {
        if (strcmp(case_table[i].path, path) == 0) return &case_table[i];
    }
    return NULL;
}

bool case_table_is_section(const char *path) {
    const size_t length = strlen(path);
    for (int i = 0; i < case_table_n; i++) {
        if (strncmp(case_table[i].path, path, length) == 0 && case_table[i].path[length] == '.') return true;
    }
    return false;
}

bool case_table_is_of_fish(const struct key *key) {
    return strncmp(key->path, "fish.", 5) == 0;
}

bool case_table_is_value(const struct key *key) {
    return key->type < FILES;
}

int case_table_n_fields(const struct key *key, const struct case_values *values) {
    if (!case_table_is_value(key)) return 0;
    return case_table_is_of_fish(key) ? values->school.n_fish : 1;
}

double case_table_beat(const struct case_values *values, const struct key *key, int fish) {
    const bool is_of_fish = case_table_is_of_fish(key);
    double slowest = 0;
    for (int f = 0; f < values->school.n_fish; f++) {
        const double frequency = fish_parameters_frequency(&values->school.fish[f]);
        if ((!is_of_fish || f == fish) && frequency > 0) slowest = fmax(slowest, 1 / frequency);
    }
    return slowest;
}

const struct case_beats *case_table_in_beats(const struct case_values *values, const struct key *key, int fish) {
    for (int i = 0; i < values->n_beats; i++) {
        if (values->beats[i].key == key && values->beats[i].fish == fish) return &values->beats[i];
    }
    return NULL;
}

void case_table_add_beats(struct case_values *values, struct case_beats beats) {
    GROW(values->arena, values->beats, values->n_beats + 1);
    values->beats[values->n_beats++] = beats;
}

void *case_table_field(const struct key *key, struct case_values *values, struct fish_parameters *fish) {
    return (case_table_is_of_fish(key) ? (char *)fish : (char *)values) + key->offset;
}

const char *case_table_word(const struct key *key, int i) {
    if (key->type == METHOD) return i < methods_n ? methods_table[i].word : NULL;
    return key->words[i];
}

const char *case_table_type(const struct key *key) {
    static const char *const names[] = {[REAL] = "number",
                                        [DURATION] = "time",
                                        [INTEGER] = "integer",
                                        [CHOICE] = "word",
                                        [METHOD] = "word",
                                        [STRING] = "string",
                                        [PAIR] = "[x, y]",
                                        [NUMBERS] = "list of numbers",
                                        [PAIRS] = "list of [x, y]",
                                        [PROFILE] = "list of [distance, number], or of numbers",
                                        [ROWS] = "list of rows of numbers",
                                        [HEADING] = "number or list of [time, angle]",
                                        [FILES] = "list of files",
                                        [DEFAULTS] = "map",
                                        [AXES] = "list of axes",
                                        [EXPECTATIONS] = "list of expectations",
                                        [ERRORS] = "map"};
    return names[key->type];
}

void case_table_range(const struct key *key, struct text *range) {
    const struct bounds *const bounds = &key->bounds;
    if (key->type == CHOICE || key->type == METHOD) {
        for (int i = 0; case_table_word(key, i); i++) {
            text_add(range, "%s%s", i > 0 ? ", " : "", case_table_word(key, i));
        }
        return;
    }

    if (key->type == STRING || key->type == FILES || isinf(bounds->min)) return;
    if (bounds->min == bounds->max) {
        text_add_number(range, bounds->min);
        return;
    }

    if (isinf(bounds->max)) {
        text_add(range, bounds->is_min_open ? "above " : "at least ");
        text_add_number(range, bounds->min);
        return;
    }

    text_add(range, bounds->is_min_open ? "between " : "from ");
    text_add_number(range, bounds->min);
    text_add(range, bounds->is_min_open ? " and " : bounds->is_max_open ? " to below " : " to ");
    text_add_number(range, bounds->max);
}

enum key_state *case_table_state(const struct case_values *values, const struct key *key, int fish) {
    return &values->state[(long)fish * case_table_n + (key - case_table)];
}

bool case_table_is_set(const struct case_values *values, const char *path, int fish) {
    return *case_table_state(values, case_table_row(path), fish) != KEY_WITHOUT_VALUE;
}

/* Round a time to a multiple of a unit, up or to the nearest; false if the time is a multiple already, or has no value.
 */
static bool round_to_multiple(double *time, double unit, bool up) {
    const double n = *time / unit, nearest = fmax(round(n), 1);
    if (!(*time > 0) || fabs(n - nearest) <= 1e-9 * n) return false;
    *time = (up ? ceil(n) : nearest) * unit;
    return true;
}

/* Set the shedding interval. If the case gives no seconds for it, round the end of the run up to an event, and the
 * output and checkpoint intervals to the nearest multiples. doc/model.md, section 7. */
static void set_shedding_interval(struct case_values *values) {
    double *const interval = &values->school.shedding_interval, *const rows = &values->time.output_interval,
                  fastest = 0;
    const struct key *const key = case_table_row("time.shedding_interval");
    enum key_state *const state = case_table_state(values, key, 0);
    if (*state == KEY_WITH_VALUE && !case_table_in_beats(values, key, 0)) return;

    for (int i = 0; i < values->school.n_fish; i++)
        fastest = fmax(fastest, fish_parameters_frequency(&values->school.fish[i]));
    if (*state != KEY_WITH_VALUE) *interval = fastest > 0 ? 1 / (100 * fastest) : 0.01;
    if (*state == KEY_WITHOUT_VALUE) *state = KEY_WITH_VALUE;
    round_to_multiple(&values->time.end, *interval, true);
    round_to_multiple(&values->time.checkpoint_interval, *interval, false);

    // round the wake interval too if the output interval is rounded, or has its default
    const bool is_given = case_table_is_set(values, "time.output_interval", 0);
    const bool are_free = !is_given || round_to_multiple(rows, *interval, false);
    if (are_free) round_to_multiple(&values->output.wake_interval, is_given ? *rows : 10 * *interval, false);
}

/* Set the default of a key that follows from another number, from a word, or by a function; false: there is none. */
static bool set_default(const struct key *key, const struct key_place *at) {
    if (key->derive) return key->derive(at);
    if (key->multiple.of) {
        const double *const other = case_table_field(case_table_row(key->multiple.of), at->values, at->fish);
        return derive_number(at, key->multiple.factor * *other);
    }
    if (!key->choice.of) return false;
    const struct key *const other = case_table_row(key->choice.of);
    const int word = *(const int *)case_table_field(other, at->values, at->fish);
    const bool is_word = strcmp(case_table_word(other, word), key->choice.word) == 0;
    const double standard = is_word ? key->choice.with : key->choice.without;
    return key->type == CHOICE ? derive_word(at, (int)standard) : derive_number(at, standard);
}

void case_table_derive(struct case_values *values, const char *origin) {
    // times in beats; without a beat they have no value, and are refused by case_check
    for (int i = 0; i < values->n_beats; i++) {
        const struct case_beats *const beats = &values->beats[i];
        const double beat = case_table_beat(values, beats->key, beats->fish);
        double *const field = case_table_field(beats->key, values, &values->school.fish[beats->fish]);
        if (!(beat > 0)) continue;
        *field = text_round(beats->n * beat);
        *case_table_state(values, beats->key, beats->fish) = KEY_WITH_VALUE;
    }

    // other times are rounded to the shedding interval
    set_shedding_interval(values);

    for (const struct key *key = case_table; key < case_table + case_table_n; key++) {
        for (int i = 0; i < case_table_n_fields(key, values); i++) {
            struct fish_parameters *const fish = &values->school.fish[i];
            const struct key_place at = {values, origin, i, fish, case_table_field(key, values, fish)};
            enum key_state *const state = case_table_state(values, key, i);
            const bool has_default = *state != KEY_WITH_VALUE && set_default(key, &at);
            if (has_default && *state == KEY_WITHOUT_VALUE) *state = KEY_WITH_VALUE;
        }
    }

    for (int f = 0; f < values->school.n_fish; f++) {
        struct fish_parameters *const fish = &values->school.fish[f];

        // a wavelength is another form of wave.number, which is shown in its place
        enum key_state *const of_length = case_table_state(values, case_table_row("fish.wave.wavelength"), f);
        if (*of_length == KEY_WITH_VALUE) {
            fish->wave.number = -2 * M_PI / fish->wave.wavelength;
            fish->wave.wavelength = 0;
            *of_length = KEY_WITHOUT_VALUE;
        }

        // the model has its own factors of friction unless the case gives them
        fish->drag.has_waving = case_table_is_set(values, "fish.drag.waving", f);
        fish->drag.has_form = case_table_is_set(values, "fish.drag.form", f);
    }
}
