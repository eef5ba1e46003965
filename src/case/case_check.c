/* case_check.c: relations between keys. */
#include "case/case_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/case_table.h"
#include "case/sweep_members.h"
#include "fish/fish_sheet.h"

static const double max_events = 1e9, max_vortices = 1e7 /* of one fish */;

/* Within these bounds a double resolves positions to 1e-9 lengths and phases to 1e-6 cycles. */
static const double max_lengths = 1e6, max_cycles = 1e9;

/* The case, and the list of errors. fish: index of the fish being checked. */
struct check {
    const struct case_values *values;
    const struct case_tree *tree;
    struct yaml_errors *errors;
    int fish;
};

/* Add an error on the value at a path of the table. */
__attribute__((format(printf, 3, 4))) static void complain(const struct check *check, const char *path,
                                                           const char *format, ...) {
    char reason[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    case_merge_complain(check->tree, path, check->fish, reason, check->errors);
}

// ---- time and wake

/* Require a time to be an integer multiple of a unit; name: path of the unit. */
static void check_multiple(const struct check *check, const char *path, double time, const char *name, double unit) {
    const double n = round(time / unit);
    if (!(fabs(time - n * unit) > 1e-9 * time)) return;  // not a number: reported when the value was read

    if (n < 1) {
        complain(check, path, "%g s is less than %s, %g s", time, name, unit);
        return;
    }

    const double below = floor(time / unit);
    complain(check, path, "%.9g s is not an integer multiple of %s, %.9g s; the nearest are %.9g and %.9g", time, name,
             unit, (below < 1 ? 1 : below) * unit, (below + 1) * unit);
}

static void check_time(const struct check *check) {
    const struct case_time *const time = &check->values->time;
    const double shedding = check->values->school.shedding_interval;
    static const char interval[] = "time.shedding_interval";

    if (time->end / shedding > max_events) {
        complain(check, "time.end", "%g events; the maximum is %g: increase time.shedding_interval",
                 time->end / shedding, max_events);
        return;
    }

    check_multiple(check, "time.end", time->end, interval, shedding);
    check_multiple(check, "time.output_interval", time->output_interval, interval, shedding);
    check_multiple(check, "time.checkpoint_interval", time->checkpoint_interval, interval, shedding);
    check_multiple(check, "output.wake_interval", check->values->output.wake_interval, "time.output_interval",
                   time->output_interval);
}

/* True if an axis of the sweep changes the key at a path. */
static bool is_swept(const struct case_values *values, const char *path) {
    for (int a = 0; a < values->n_axes; a++) {
        for (int k = 0; k < values->sweep[a].n_keys; k++) {
            if (strcmp(values->sweep[a].key[k].path, path) == 0) return true;
        }
    }
    return false;
}

/* Require every swept shedding interval to divide a time that the case gives and does not sweep. */
static void check_swept_interval(const struct check *check, const char *path, double time) {
    const struct case_values *const values = check->values;
    static const char interval[] = "time.shedding_interval";
    bool is_default;
    if (is_swept(values, path) || !case_merge_value(check->tree, path, 0, &is_default)) return;

    for (int a = 0; a < values->n_axes; a++) {
        const struct sweep_axis *const axis = &values->sweep[a];
        for (int i = 0; i < axis->n_values * axis->n_keys; i++) {
            double value = 0;
            const bool is_interval = strcmp(axis->key[i % axis->n_keys].path, interval) == 0;
            if (!is_interval || !text_number(axis->value[i], &value) || !(value > 0)) continue;
            if (!(fabs(time - round(time / value) * value) > 1e-9 * time)) continue;
            complain(check, "sweep",
                     "value %s of %s does not divide %s, %g s: choose a divisor, or sweep both keys in one axis: "
                     "{keys: [%s, %s], values: [[%s, %g], ...]}",
                     axis->value[i], interval, path, time, interval, path, axis->value[i],
                     fmax(1, round(time / value)) * value);
        }
    }
}

static void check_solver(const struct check *check) {
    const struct case_solver *const solver = &check->values->solver;
    if ((int)solver->method < 0) return;  // not read: reported already
    const struct method_properties *const method = &methods_table[solver->method];

    if (!method->has_adaptive_steps && solver->step == 0) {
        complain(check, "solver.method", "needs a fixed step: set solver.step, such as %.9g (s)",
                 check->values->school.shedding_interval);
    }

    if (!(solver->step > 0)) return;
    if (!method->has_fixed_steps) {
        complain(check, "solver.step",
                 "%s has adaptive steps only: remove solver.step, or choose another solver.method", method->word);
        return;
    }

    const double interval = check->values->school.shedding_interval, n = round(interval / solver->step);
    if (n >= 1 && !(fabs(interval - n * solver->step) > 1e-9 * interval)) return;
    complain(check, "solver.step", "%.9g s does not divide time.shedding_interval, %.9g s; the nearest divisor is %.9g",
             solver->step, interval, interval / (n < 1 ? 1 : n));
}

/* Refuse parts of the model that verlet cannot integrate: velocity-dependent forces, and unknowns other than positions.
 * */
static void check_verlet(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct body_parameters *const body = &school->fish[check->fish].body;
    static const char damps[] =
        "solver.method verlet cannot integrate damping: set the damping to 0, or choose another method";
    if (check->values->solver.method != METHOD_VERLET) return;

    if (check->fish == 0 && school->fluid.density > 0) {
        complain(check, "solver.method",
                 "verlet integrates rods without fluid: set fluid.density to 0, or choose another method");
    }

    if (check->fish == 0 && school->sheet.kutta == KUTTA_RATE) {
        complain(check, "solver.method", "verlet cannot integrate the circulation: set sheet.kutta to edge");
    }
    if (body->bending_damping > 0) complain(check, "fish.body.bending_damping", damps);
    if (body->stretching_damping > 0) complain(check, "fish.body.stretching_damping", damps);
    if (body->relaxation_time > 0) complain(check, "fish.body.relaxation_time", damps);

    if (school->fish[check->fish].motion.prescribed != PRESCRIBED_NONE) {
        complain(check, "fish.motion.prescribed",
                 "solver.method verlet cannot integrate prescribed motion: choose another method");
    }

    if (school->fish[check->fish].control.law != CONTROL_NONE) {
        complain(check, "fish.control.law", "solver.method verlet cannot integrate steering: choose another method");
    }
}

static void check_wake(const struct check *check) {
    const struct wake_parameters *const wake = &check->values->school.wake;
    const double interval = check->values->school.shedding_interval;
    const double lifetime = wake->lifetime.seconds, decay = wake->decay.seconds;
    static const char no_beat[] = "is in beats, but no fish beats: give seconds";

    if (wake->lifetime.beats > 0 && !(lifetime > 0)) {
        complain(check, "wake.lifetime", no_beat);
        return;
    }

    if (wake->decay.beats > 0 && !(decay > 0)) complain(check, "wake.decay", no_beat);
    if (decay > lifetime) complain(check, "wake.decay", "%g s is longer than wake.lifetime, %g s", decay, lifetime);
    if (lifetime < interval) {
        complain(check, "wake.lifetime", "%g s is less than time.shedding_interval, %g s", lifetime, interval);
    }
    const double n_vortices = fmin(lifetime, check->values->time.end) / interval;

    if (n_vortices > max_vortices) {
        complain(check, "wake.lifetime", "%g vortices in the wake of a fish; the maximum is %g", n_vortices,
                 max_vortices);
    }
}

/* Refuse keys without effect for wake.shedding, and inconsistent combinations. */
static void check_shedding(const struct check *check) {
    const struct wake_parameters *const wake = &check->values->school.wake;
    const struct sheet_parameters *const sheet = &check->values->school.sheet;

    if (wake->shedding == SHEDDING_SHEET) {
        if (sheet->kutta == KUTTA_RATE) {
            complain(check, "sheet.kutta",
                     "'wake.shedding: sheet' requires a sheet strength that vanishes at the tail: use 'edge', or "
                     "another wake.shedding");
        }
        if (sheet->collocation == COLLOCATION_MIDPOINT) {
            complain(check, "sheet.collocation",
                     "'wake.shedding: sheet' has an end correction for chebyshev points only: use 'chebyshev', or "
                     "another wake.shedding");
        }
    } else if (wake->shedding == SHEDDING_CONTINUOUS || wake->shedding == SHEDDING_IMPULSIVE) {
        const char *const paths[] = {"wake.taper", "wake.taper_beside"};
        const double lengths[] = {wake->taper, wake->taper_beside};
        for (int i = 0; i < 2; i++) {
            if (lengths[i] > 0)
                complain(check, paths[i], "has an effect only with 'wake.shedding: sheet': remove the key");
        }
    }
}

/* Limit the number of cycles, so that a double resolves the phase until time.end. */
static void check_cycles(const struct check *check, const char *path, double frequency) {
    const double cycles = frequency * check->values->time.end;
    if (cycles > max_cycles) {
        complain(check, path, "%g cycles until time.end; the maximum is %g: beyond, rounding destroys the phase",
                 cycles, max_cycles);
    }
}

/* Limit a coordinate, so that a double resolves the shape of the body. */
static void check_place(const struct check *check, const char *path, double place, double length) {
    if (fabs(place) > max_lengths * length) {
        complain(check, path,
                 "%g m is %g body lengths; the maximum is %g: beyond, rounding destroys the shape of the body", place,
                 fabs(place) / length, max_lengths);
    }
}

static void check_gust(const struct check *check) {
    const struct fluid_parameters *const fluid = &check->values->school.fluid;
    check_cycles(check, "fluid.gust.frequency", fluid->gust_frequency);
    if (fabs(fluid->gust_amplitude) > 0 && fluid->gust_frequency == 0) {
        complain(check, "fluid.gust.amplitude", "has no effect with fluid.gust.frequency 0");
    }
}

/* Check the order and the number of walls; refuse a flow through the walls. */
static void check_walls(const struct check *check) {
    const struct fluid_parameters *const fluid = &check->values->school.fluid;
    const struct number_list *const walls = &fluid->walls;
    if (walls->n == 0) return;
    double length = 0;
    for (int f = 0; f < check->values->school.n_fish; f++) length = fmax(length, check->values->school.fish[f].length);
    for (int i = 0; i < walls->n; i++) check_place(check, "fluid.walls", walls->value[i], length);
    if (walls->n > 2) {
        complain(check, "fluid.walls", "expects y of one or two walls; got %d numbers", walls->n);
    } else if (walls->n == 2 && walls->value[0] >= walls->value[1]) {
        complain(check, "fluid.walls", "the second wall must be above the first; %g is not above %g", walls->value[1],
                 walls->value[0]);
    }

    if (fabs(fluid->velocity[1]) > 0) {
        complain(check, "fluid.velocity", "flows through fluid.walls, which are along x: set the y component to 0");
    }
    if (fabs(fluid->gust_amplitude) > 0) {
        complain(check, "fluid.gust.amplitude", "the gust flows through fluid.walls: remove the gust or the walls");
    }
}

/* Refuse a viscosity without effect: not the default, and no fish has viscous friction. */
static void check_viscosity(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    static const char path[] = "fluid.viscosity";
    double initial;
    for (int f = 0; f < school->n_fish; f++) {
        if (school->fish[f].drag.skin != SKIN_QUADRATIC) return;
    }
    if (text_number(case_table_row(path)->initial, &initial) && fabs(school->fluid.viscosity - initial) > 0) {
        complain(check, path,
                 "has no effect: all fish have 'drag.skin: quadratic' with the coefficient drag.tangential");
    }
}

// ---- fish

/* Require a list of a table profile to have one value per edge; refuse the list for other profiles. */
static void check_edge_list(const struct check *check, const char *path, const struct number_list *list) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    bool is_default;
    const bool is_read = list->n > 0 || !case_merge_value(check->tree, path, check->fish, &is_default);

    if (fish->body.profile == PROFILE_TABLE && fish->nodes > 0 && is_read && list->n != fish->nodes - 1) {
        complain(check, path, "'profile: table' needs one value per edge, %d for %d nodes; got %d", fish->nodes - 1,
                 fish->nodes, list->n);
    }

    const bool is_other = fish->body.profile == PROFILE_JOUKOWSKI || fish->body.profile == PROFILE_UNIFORM;
    if (is_other && list->n > 0) complain(check, path, "has an effect only with 'profile: table': remove the key");
}

/* Refuse a tail thickness for profiles other than joukowski. */
static void check_tail(const struct check *check) {
    const struct body_parameters *const body = &check->values->school.fish[check->fish].body;
    const bool is_other = body->profile == PROFILE_UNIFORM || body->profile == PROFILE_TABLE;
    if (is_other && body->tail_thickness > 0) {
        complain(check, "fish.body.tail_thickness", "has an effect only with 'profile: joukowski': remove the key");
    }
}

/* The largest turning angle of a joint prescribed by the muscle for a steering bias of at most `bias` [rad]. */
static double largest_turn(const struct fish_parameters *fish, double bias) {
    const struct wave_parameters *const wave = &fish->wave;
    double envelope = 0, curvature = 0;

    for (int k = 1; k < fish->nodes - 1; k++) {
        const double q = (double)k / (fish->nodes - 1);
        envelope = fmax(envelope, fabs(wave->constant + wave->linear * q + wave->quadratic * q * q));
    }

    for (int i = 0; i < wave->table.n * wave->table.width; i++) curvature = fmax(curvature, fabs(wave->table.value[i]));
    const double turn = envelope * fabs(wave->amplitude) * (fish->reference_nodes - 1) / (fish->nodes - 1);
    return wave->table.n > 0 ? curvature / (fish->nodes - 1) + turn * bias : turn * (1 + bias);
}

/* Limit the turning angle: the curvature of a joint, 2 tan(angle/2), is singular at pi. */
static void check_turn(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    if (fish->nodes == 0 || fish->reference_nodes == 0) return;
    const bool is_controlled = (int)fish->control.law > CONTROL_NONE;
    const double turn = largest_turn(fish, is_controlled ? fish->control.limit : fabs(fish->control.bias));
    if (turn >= 3.14159) {
        complain(check, fish->wave.table.n > 0 ? "fish.wave.table" : "fish.wave.amplitude",
                 "the wave turns a joint by up to %.3g rad; the maximum is 3.14", turn);
    }
}

/* True if a number of the fish differs from the default of the key and from the default under a preset. The presence of
 * a key is no criterion: a case printed by `shoal show` has every key, and no preset. False for a value that was not
 * read. */
static bool is_given(const struct check *check, const char *path) {
    const struct key *const key = case_table_row(path);
    const char *const fish = (const char *)&check->values->school.fish[check->fish];
    const double value = *(const double *)(fish + key->offset);
    double initial = NAN, published;
    if (!key->initial) return !isnan(value);  // `shoal show` omits a key without a default
    text_number(key->initial, &initial);
    if (!key->published || !text_number(key->published, &published)) published = initial;
    return fabs(value - initial) > 0 && fabs(value - published) > 0;
}

/* True if a key is present in the fish or under defaults.fish. */
static bool is_written(const struct check *check, const char *path) {
    bool is_default;
    return case_merge_value(check->tree, path, check->fish, &is_default) != NULL;
}

/* Refuse wave.number and wave.wavelength together, and both with a table, which replaces the wave. */
static void check_wave_form(const struct check *check) {
    const struct number_list *const table = &check->values->school.fish[check->fish].wave.table;
    static const char number[] = "fish.wave.number", wavelength[] = "fish.wave.wavelength";
    if (is_written(check, number) && is_written(check, wavelength)) {
        complain(check, wavelength, "sets wave.number too: remove wavelength or number");
    }
    if (table->n == 1) complain(check, "fish.wave.table", "needs at least two rows, from nose to tail");

    if (table->n > 0 && is_given(check, number)) {
        complain(check, is_written(check, wavelength) ? wavelength : number,
                 "has no effect with wave.table: remove the key");
    }
}

/* True if amplitude sin(2 pi frequency t + phase) is 0 at all times for a nonzero amplitude. */
static bool is_idle(double amplitude, double frequency, double phase) {
    return fabs(amplitude) > 0 && frequency == 0 && remainder(phase, 180) == 0;
}

static void check_motion(const struct check *check) {
    const struct motion_parameters *const motion = &check->values->school.fish[check->fish].motion;
    static const char not_prescribed[] =
        "has no effect with 'motion.prescribed: none': set motion.prescribed to head or all";
    static const char constant[] = "has no effect with motion.frequency 0";

    if (motion->prescribed == PRESCRIBED_NONE) {
        if (fabs(motion->heave) > 0) complain(check, "fish.motion.heave", not_prescribed);
        if (fabs(motion->pitch) > 0) complain(check, "fish.motion.pitch", not_prescribed);
        if (motion->surge == SURGE_FREE) complain(check, "fish.motion.surge", not_prescribed);
    } else {
        const double heading = check->values->school.fish[check->fish].start_heading;
        if (motion->surge == SURGE_FREE && fabs(remainder(heading, 180)) > 0) {
            complain(check, "fish.motion.surge", "free needs a start.heading along x, 0 or 180 degrees, not %g",
                     heading);
        }
        const double phase = motion->phase + motion->pitch_phase;
        if (is_idle(motion->heave, motion->frequency, motion->phase)) complain(check, "fish.motion.heave", constant);
        if (is_idle(motion->pitch, motion->frequency, phase)) complain(check, "fish.motion.pitch", constant);
    }
}

/* True if the control law uses the moment of the flow. */
static bool has_moment(const struct control_parameters *control) {
    const bool is_of_heading = control->law == CONTROL_HEADING || control->law == CONTROL_AVERAGED_HEADING;
    return is_of_heading && fabs(control->feedforward) > 0;
}

static void check_drag(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    const struct drag_parameters *const drag = &fish->drag;
    static const char path[] = "fish.drag.linear_speed";
    const bool has_speed = is_given(check, path);
    if (has_speed && drag->law != DRAG_LINEAR_QUADRATIC) {
        complain(check, path, "has an effect only with 'law: linear_quadratic': remove the key");
    } else if (has_speed && fish->force == FORCE_PUBLISHED) {
        complain(check, path, "has no effect with 'force: published', where the speed is 1 m/s: remove the key");
    } else if (drag->law == DRAG_LINEAR_QUADRATIC && fish->force != FORCE_PUBLISHED && drag->linear_speed > 0 &&
               fish->wave.frequency == 0) {
        complain(check, "fish.drag.law",
                 "linear_quadratic needs wave.frequency above 0, because linear_speed is in lengths per beat: choose "
                 "quadratic");
    }

    if (drag->skin != SKIN_QUADRATIC && is_given(check, "fish.drag.tangential")) {
        complain(check, "fish.drag.tangential",
                 "has no effect with 'skin: %s', which uses fluid.viscosity: remove the key",
                 drag->skin == SKIN_LAMINAR ? "laminar" : "boundary_layer");
    }

    static const char *const of_layer[] = {"fish.drag.transition", "fish.drag.waving", "fish.drag.form"};
    for (size_t i = 0; i < sizeof of_layer / sizeof *of_layer && drag->skin != SKIN_BOUNDARY_LAYER; i++) {
        if (is_given(check, of_layer[i]))
            complain(check, of_layer[i], "has an effect only with 'skin: boundary_layer': remove the key");
    }
}

/* Check the requirements of a finite span. */
static void check_span(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct fish_parameters *const fish = &school->fish[check->fish];
    static const char path[] = "fish.pressure.span";
    for (int f = 0; f < check->fish; f++) {
        if (school->fish[f].force != FORCE_PRESSURE || school->fish[f].span == fish->span) continue;
        complain(check, path, "fish[%d] has another span: use one span for all fish with 'force: pressure'", f);
        return;
    }

    if (fish->span != SPAN_FINITE) return;
    if (school->wake.removed_circulation == REMOVED_DROPPED) {
        complain(check, path, "vortex rings must stay closed: use 'wake.removed_circulation: retained'");
    }
    if (school->fluid.walls.n > 1) {
        complain(check, path, "finite allows at most one wall: use 'infinite', or remove one of fluid.walls");
    }
    const int least = fish_sheet_least(fish);
    if (fish->sheet_points < least) {
        complain(check, "fish.sheet_points", "a span of %.3g lengths needs at least %d points (1 + 5 L/w), not %d",
                 5.0 / (least - 1), least, fish->sheet_points);
    }
}

/* Check the requirements of 'force: pressure', and refuse keys of the terms that the pressure replaces. */
static void check_pressure(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    const struct wake_parameters *const wake = &check->values->school.wake;
    static const char force[] = "fish.force";

    if (fish->force != FORCE_PRESSURE) {
        if (fish->span == SPAN_FINITE) {
            complain(check, "fish.pressure.span", "has an effect only with 'force: pressure': remove the key");
        }
        if (is_given(check, "fish.pressure.suction")) {
            complain(check, "fish.pressure.suction", "has an effect only with 'force: pressure': remove the key");
        }
        if (is_given(check, "fish.pressure.suction_limit")) {
            complain(check, "fish.pressure.suction_limit", "has an effect only with 'force: pressure': remove the key");
        }
        return;
    }

    if (wake->shedding != SHEDDING_SHEET) complain(check, force, "pressure needs 'wake.shedding: sheet'");
    if (check->values->school.sheet.curve != BODY_LINE_SMOOTH)
        complain(check, force, "pressure needs 'sheet.curve: smooth'");

    if (fish->nodes > 0 && fish->sheet_points < 2 * fish->nodes - 1) {
        complain(check, "fish.sheet_points",
                 "with 'force: pressure' the added mass of %d nodes needs at least %d points, not %d", fish->nodes,
                 2 * fish->nodes - 1, fish->sheet_points);
    }

    if (is_given(check, "fish.added_mass.coefficient")) {
        complain(check, "fish.added_mass.coefficient", "has no effect with 'force: pressure': remove the key");
    }

    check_span(check);
    if (has_moment(&fish->control)) {
        complain(check, "fish.control.feedforward",
                 "is the moment of the drag, which differs from the moment of the pressure: use 0");
    }
}

static void check_headings(const struct check *check) {
    const struct number_list *const heading = &check->values->school.fish[check->fish].control.desired_heading;
    if (heading->n > 0 && heading->value[0] < 0) {
        complain(check, "fish.control.desired_heading", "the first time must be at least 0 s, not %g s",
                 heading->value[0]);
    }

    for (int i = 1; i < heading->n; i++) {
        const double before = heading->value[2 * i - 2], time = heading->value[2 * i];
        if (time <= before) {
            complain(check, "fish.control.desired_heading", "the times must increase; %g follows %g", time, before);
            return;
        }
    }
}

/* The control laws that use a key. */
static const struct {
    const char *path;
    unsigned laws; /* bits 1 << enum control_law */
} law_keys[] = {{"fish.control.gain", 1U << CONTROL_HEADING | 1U << CONTROL_AVERAGED_HEADING | 1U << CONTROL_COURSE},
                {"fish.control.limit", 1U << CONTROL_HEADING | 1U << CONTROL_AVERAGED_HEADING | 1U << CONTROL_COURSE},
                {"fish.control.feedforward", 1U << CONTROL_HEADING | 1U << CONTROL_AVERAGED_HEADING},
                {"fish.control.damping", 1U << CONTROL_COURSE},
                {"fish.control.rate", 1U << CONTROL_AVERAGED_HEADING | 1U << CONTROL_COURSE}};

/* Refuse values without effect for the chosen law. */
static void check_law_keys(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    const struct control_parameters *const control = &fish->control;
    const char *const law = case_table_word(case_table_row("fish.control.law"), (int)control->law);

    for (size_t i = 0; i < sizeof law_keys / sizeof *law_keys; i++) {
        if (law_keys[i].laws >> control->law & 1U || !is_given(check, law_keys[i].path)) continue;
        complain(check, law_keys[i].path, "has no effect with 'law: %s': remove the key", law);
    }

    const double period = fish->wave.frequency > 0 ? 1 / fish->wave.frequency : 0;
    if (!has_moment(control) && fabs(control->filter - period) > 0) {
        complain(check, "fish.control.filter", "has no effect without feedforward: remove the key");
    }
    if (control->waypoints.n == 0 && is_given(check, "fish.control.acceptance_radius")) {
        complain(check, "fish.control.acceptance_radius", "has no effect without control.waypoints: remove the key");
    }
    const struct number_list *const heading = &control->desired_heading;
    if (heading->n == 0) return;
    const bool is_start = heading->n == 1 && !(fabs(heading->value[1] - fish->start_heading) > 0);

    if (control->law == CONTROL_NONE && !is_start) {
        complain(check, "fish.control.desired_heading",
                 "has no effect with 'law: none': choose a law, or remove the key");
    } else if (control->waypoints.n > 0 && !is_start) {
        complain(check, "fish.control.desired_heading",
                 "has no effect with control.waypoints: remove the heading or the waypoints");
    }
}

static void check_control(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    const struct control_parameters *const control = &fish->control;
    check_headings(check);
    if (control->law == CONTROL_NONE && control->waypoints.n > 0) {
        complain(check, "fish.control.waypoints", "has no effect with 'law: none': remove the law, or choose course");
    }
    check_law_keys(check);
    if (control->law == CONTROL_NONE) return;

    if (fabs(control->bias) > 0) {
        complain(check, "fish.control.bias", "has an effect only with 'law: none': the law computes the steering bias");
    }
    if (fish->wave.frequency == 0 && (has_moment(control) || control->law != CONTROL_HEADING)) {
        complain(check, "fish.control.law", "needs wave.frequency above 0%s",
                 control->law == CONTROL_HEADING ? ", or feedforward: 0" : "");
    }

    if (check->values->school.fluid.density == 0 && has_moment(control)) {
        complain(check, "fish.control.law", "needs fluid.density above 0, or feedforward: 0");
    }
}

static void check_digits(const struct check *check) {
    const struct fish_parameters *const fish = &check->values->school.fish[check->fish];
    for (int i = 0; i < 2; i++) check_place(check, "fish.start.position", fish->start_position[i], fish->length);
    check_place(check, "fish.motion.heave", fish->motion.heave, fish->length);
    check_cycles(check, "fish.wave.frequency", fish->wave.frequency);
    check_cycles(check, "fish.motion.frequency", fish->motion.frequency);
}

static void check_name(const struct check *check) {
    const struct fish_parameters *const fish = check->values->school.fish;
    for (int i = 0; i < check->fish; i++) {
        if (!fish[i].name || !fish[check->fish].name || strcmp(fish[i].name, fish[check->fish].name) != 0) continue;
        complain(check, "fish.name", "fish[%d] has the same name, '%.60s'; names must be unique", i, fish[i].name);
        return;
    }
}

void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors) {
    struct check check = {values, tree, errors, 0};
    check_time(&check);
    check_swept_interval(&check, "time.end", values->time.end);
    check_swept_interval(&check, "time.output_interval", values->time.output_interval);
    check_solver(&check);
    check_wake(&check);
    check_shedding(&check);
    check_gust(&check);
    check_walls(&check);
    check_viscosity(&check);
    if (values->name && strchr(values->name, '/')) complain(&check, "name", "cannot contain a '/'");

    for (check.fish = 0; check.fish < values->school.n_fish; check.fish++) {
        const struct fish_parameters *const fish = &values->school.fish[check.fish];
        check_name(&check);
        check_digits(&check);
        check_verlet(&check);
        check_edge_list(&check, "fish.body.thickness_table", &fish->body.thickness_table);
        check_edge_list(&check, "fish.body.depth_table", &fish->body.depth_table);
        check_tail(&check);
        check_wave_form(&check);
        check_turn(&check);
        check_drag(&check);
        check_pressure(&check);
        check_motion(&check);
        check_control(&check);
    }
}
