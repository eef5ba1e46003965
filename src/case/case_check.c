/* case_check.c: refuses values that contradict each other, and warns of values that are hardly ever meant. */
#include "case/case_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_merge.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep.h"
#include "fish/fish_school.h"
#include "fish/fish_sheet.h"

static const double max_events = 1e9, max_vortices = 1e7 /* of one fish */;

/* More memory than a computer has, and the memory of a vortex [bytes]. */
static const double max_bytes = 1e12, bytes_per_vortex = 950;

/* Within these bounds a double resolves positions to 1e-9 lengths and phases to 1e-6 cycles. */
static const double max_lengths = 1e6, max_cycles = 1e9;

/* The case that is being checked, and the list of its errors or notes; fish and its index if the check is about a fish.
 * */
struct check {
    const struct case_values *values;
    const struct case_tree *tree;
    struct yaml_errors *errors;
    const struct fish_parameters *fish;
    int index;
    const struct fish_parameters **named; /* the fish with a name, in the order of the names             (n_named) */
    int n_named;
    bool is_of_notes;  /* skip a note on a value that another fish shares */
    bool is_of_limits; /* the messages are on single numbers, whatever the values of other keys are */
};

/* Whether the value at a path cannot be read, or one to which it may be related: a word, an integer or a time of the
 * same section or fish, any value of the same subsection, and for a time any time. Relations to what stands in for such
 * a value would be reported in error. */
static bool is_misread(const struct check *check, const char *path) {
    const bool is_of_fish = strncmp(path, "fish.", 5) == 0, is_time = case_table_row(path)->type == DURATION;
    const char *const dot = strrchr(path, '.');
    const size_t subsection = dot ? (size_t)(dot - path) : strlen(path);
    for (const struct key *key = case_table; key < case_table + case_table_n; key++) {
        const int n_fields = case_table_n_fields(key, check->values), fish = is_of_fish ? check->index : 0;
        if (fish >= n_fields || *case_table_state(check->values, key, fish) != KEY_MISREAD) continue;
        if (strcmp(key->path, path) == 0) return true;
        if (check->is_of_limits) continue;
        const bool is_near = strncmp(key->path, path, strcspn(path, ".")) == 0, is_other_time = key->type == DURATION;
        const bool is_word = key->type == CHOICE || key->type == METHOD, is_exact = key->type == INTEGER;
        if (strncmp(key->path, path, subsection + 1) == 0 || (is_time && is_other_time)) return true;
        if (is_near && (is_word || is_exact || is_other_time)) return true;
    }
    return false;
}

/* Under a condition, add an error or a note on the value at a path of the table. */
__attribute__((format(printf, 4, 5))) static void complain_if(bool condition, const struct check *check,
                                                              const char *path, const char *format, ...) {
    if (!condition || is_misread(check, path)) return;
    char reason[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);

    const struct yaml_mark mark = case_merge_mark(check->tree, path, check->index);
    for (int i = 0; check->is_of_notes && i < check->errors->n && i < YAML_ERRORS_KEPT; i++) {
        const struct yaml_mark other = check->errors->kept[i].mark;
        const bool is_same = other.source == mark.source && other.line == mark.line && other.column == mark.column;
        const char *const name = strstr(check->errors->kept[i].text, strchr(path, '.'));
        if (is_same && name && strstr(name, reason)) return;
    }
    if (strncmp(path, "fish.", 5) == 0) {
        yaml_errors_add(check->errors, mark, "fish[%d].%s: %s", check->index, path + 5, reason);
    } else {
        yaml_errors_add(check->errors, mark, "%s: %s", path, reason);
    }
}

// ---- times in beats

/* Refuse a time in beats without a beat, or of fish with different beats; true if none is refused. */
static bool check_beats(struct check *check) {
    const struct case_values *const values = check->values;
    const struct school_parameters *const school = &values->school;
    double least = INFINITY, most = 0;
    int slowest = 0, fastest = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const double frequency = fish_parameters_frequency(&school->fish[f]);
        if (!(frequency > 0)) continue;
        if (frequency < least) slowest = f;
        if (frequency > most) fastest = f;
        least = fmin(least, frequency);
        most = fmax(most, frequency);
    }

    bool are_good = true;
    for (int i = 0; i < values->n_beats; i++) {
        const struct case_beats *const beats = &values->beats[i];
        if (beats->is_default) continue;
        const bool is_of_fish = case_table_is_of_fish(beats->key);
        const bool lacks_beat = !(case_table_beat(values, beats->key, beats->fish) > 0);
        // a wake lives as long as the slowest fish needs
        const bool is_of_wake = strncmp(beats->key->path, "wake.", 5) == 0;
        const bool is_unclear = !is_of_fish && !is_of_wake && most - least > 1e-9 * most;
        check->index = beats->fish;
        complain_if(lacks_beat, check, beats->key->path, "is in beats, but %s: give seconds",
                    is_of_fish ? "the fish does not beat" : "no fish beats");
        complain_if(is_unclear, check, beats->key->path,
                    "is in beats, but fish[%d] beats with %g Hz and fish[%d] with %g Hz: give seconds", slowest, least,
                    fastest, most);
        are_good &= !lacks_beat && !is_unclear;
    }
    check->index = 0;
    return are_good;
}

// ---- time and solver

/* Require a time to be an integer multiple of a unit; name: path of the unit. */
static void check_multiple(const struct check *check, const char *path, double time, const char *name, double unit) {
    const double n = round(time / unit), below = floor(time / unit);
    if (fabs(time - n * unit) <= 1e-9 * time) return;
    complain_if(below < 1, check, path, "%g s is less than %s, %g s", time, name, unit);
    complain_if(below >= 1, check, path,
                "%.9g s is not an integer multiple of %s, %.9g s; the nearest are %.9g and %.9g", time, name, unit,
                below * unit, (below + 1) * unit);
}

static void check_time(const struct check *check) {
    const struct case_time *const time = &check->values->time;
    const double shedding = check->values->school.shedding_interval;
    static const char interval[] = "time.shedding_interval";

    complain_if(time->end / shedding > max_events, check, "time.end",
                "%g events; the maximum is %g: increase time.shedding_interval", time->end / shedding, max_events);
    if (!(time->end / shedding > max_events)) {
        check_multiple(check, "time.end", time->end, interval, shedding);
        check_multiple(check, "time.output_interval", time->output_interval, interval, shedding);
        check_multiple(check, "time.checkpoint_interval", time->checkpoint_interval, interval, shedding);
        check_multiple(check, "output.wake_interval", check->values->output.wake_interval, "time.output_interval",
                       time->output_interval);
    }

    // the steps of the method
    const struct case_solver *const solver = &check->values->solver;
    const struct method_properties *const method = &methods_table[solver->method];
    complain_if(!method->has_adaptive_steps && solver->step == 0, check, "solver.method",
                "needs a fixed step: set solver.step, such as %.9g (s)", shedding);
    if (!(solver->step > 0)) return;
    const double n = round(shedding / solver->step);
    complain_if(!method->has_fixed_steps, check, "solver.step",
                "%s has adaptive steps only: remove solver.step, or choose another solver.method", method->word);
    complain_if(method->has_fixed_steps && (n < 1 || fabs(shedding - n * solver->step) > 1e-9 * shedding), check,
                "solver.step", "%.9g s does not divide time.shedding_interval, %.9g s; the nearest divisor is %.9g",
                solver->step, shedding, shedding / (n < 1 ? 1 : n));
}

/* Require every swept shedding interval to divide a time that the case gives and does not sweep. */
static void check_swept_interval(const struct check *check, const char *path, double time) {
    const struct case_values *const values = check->values;
    static const char interval[] = "time.shedding_interval";
    bool is_default;
    if (!case_merge_value(check->tree, path, 0, &is_default) || is_misread(check, path)) return;
    for (int a = 0; a < values->n_axes; a++) {
        for (int k = 0; k < values->sweep[a].n_keys; k++) {
            if (strcmp(values->sweep[a].key[k].path, path) == 0) return;
        }
    }

    for (int a = 0; a < values->n_axes; a++) {
        const struct sweep_axis *const axis = &values->sweep[a];
        for (int i = 0; i < axis->n_values * axis->n_keys; i++) {
            const bool is_interval = strcmp(axis->key[i % axis->n_keys].path, interval) == 0;
            if (!is_interval) continue;
            // beats of the first member; another frequency changes both times alike, or is refused by its member
            struct duration duration;
            const struct key *const key = case_table_row(interval);
            struct yaml_errors silent = {.arena = check->tree->arena};
            const struct yaml_node node = {.kind = YAML_SCALAR, .text = axis->value[i]};
            if (!case_value_read(check->tree->arena, key, &duration, &node, interval, &silent)) continue;
            const double value = duration.time * (duration.is_in_beats ? case_table_beat(values, key, 0) : 1);
            if (!(value > 0)) continue;
            if (!(fabs(time - round(time / value) * value) > 1e-9 * time)) continue;
            const struct yaml_node *const sweep = yaml_tree_find(check->tree->root, "sweep");
            const int row = i / axis->n_keys;
            const struct yaml_mark mark = yaml_tree_find(sweep->entry[a].value, "values")->entry[row].value->mark;
            yaml_errors_add(check->errors, mark,
                            "sweep[%d].values[%d]: value %s of %s does not divide %s, %g s: choose a divisor, or sweep "
                            "both keys in one axis: {keys: [%s, %s], values: [[%s, %g], ...]}",
                            a, row, axis->value[i], interval, path, time, interval, path, axis->value[i],
                            fmax(1, round(time / value)) * value);
        }
    }
}

/* Refuse parts of the model that a method cannot integrate. verlet takes no forces that depend on velocities and no
 * unknowns besides positions; imex takes no forces in proportion to accelerations. */
static void check_method(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct body_parameters *const body = &check->fish->body;
    static const char damps[] =
        "solver.method verlet cannot integrate damping: set the damping to 0, or choose another method";
    complain_if(
        check->values->solver.method == METHOD_IMEX && check->fish->force != FORCE_PRESSURE, check, "fish.force",
        "solver.method imex would be unstable: it extrapolates the added mass, unless 'force: pressure'; choose "
        "another method");
    if (check->values->solver.method != METHOD_VERLET) return;

    complain_if(check->index == 0 && school->fluid.density > 0, check, "solver.method",
                "verlet integrates rods without fluid: set fluid.density to 0, or choose another method");
    complain_if(check->index == 0 && school->sheet.kutta == KUTTA_RATE, check, "solver.method",
                "verlet cannot integrate the circulation: set sheet.kutta to edge");
    complain_if(body->bending_damping > 0, check, "fish.body.bending_damping", damps);
    complain_if(body->stretching_damping > 0, check, "fish.body.stretching_damping", damps);
    complain_if(body->relaxation_time > 0, check, "fish.body.relaxation_time", damps);
    complain_if(check->fish->motion.prescribed != PRESCRIBED_NONE, check, "fish.motion.prescribed",
                "solver.method verlet cannot integrate prescribed motion: choose another method");
    complain_if(check->fish->control.law != CONTROL_NONE, check, "fish.control.law",
                "solver.method verlet cannot integrate steering: choose another method");
}

// ---- wake and fluid

/* Check lifetime and decay, refuse keys without effect for wake.shedding, and a school beyond any memory. */
static void check_wake(const struct check *check) {
    const struct wake_parameters *const wake = &check->values->school.wake;
    const struct sheet_parameters *const sheet = &check->values->school.sheet;
    const double interval = check->values->school.shedding_interval;
    const double lifetime = wake->lifetime, decay = wake->decay;
    const double n_vortices = fmin(lifetime, check->values->time.end) / interval;
    static const char only_sheet[] = "has an effect only with 'wake.shedding: sheet': remove the key";
    const bool is_sheet = wake->shedding == SHEDDING_SHEET, is_other = !is_sheet;
    complain_if(is_sheet && sheet->kutta == KUTTA_RATE, check, "sheet.kutta",
                "'wake.shedding: sheet' requires a sheet strength that vanishes at the tail: use 'edge', or another "
                "wake.shedding");
    complain_if(is_sheet && sheet->collocation == COLLOCATION_MIDPOINT, check, "sheet.collocation",
                "'wake.shedding: sheet' has an end correction for chebyshev points only: use 'chebyshev', or another "
                "wake.shedding");
    complain_if(is_other && wake->taper > 0, check, "wake.taper", only_sheet);
    complain_if(is_other && wake->taper_beside > 0, check, "wake.taper_beside", only_sheet);

    bool is_finite = false;
    const struct school_parameters *const school = &check->values->school;
    for (int f = 0; f < school->n_fish; f++) is_finite |= fish_is_strip(&school->fish[f]);
    complain_if(!is_finite && fabs(wake->leg_length - 1) > 0, check, "wake.leg_length",
                "has an effect only with 'pressure.span: finite': remove the key");

    complain_if(decay > lifetime, check, "wake.decay", "%g s is longer than wake.lifetime, %g s", decay, lifetime);
    complain_if(lifetime < interval, check, "wake.lifetime", "%g s is less than time.shedding_interval, %g s", lifetime,
                interval);
    complain_if(n_vortices > max_vortices, check, "wake.lifetime",
                "%g vortices in the wake of a fish; the maximum is %g", n_vortices, max_vortices);

    // a lower bound of the memory: vortices, and full matrices of the sheets
    const double most = case_table_row("fish.sheet_points")->bounds.max;  // more are refused by check_derived
    double of_sheets = 0;
    for (int f = 0; f < school->n_fish; f++) of_sheets += 32 * pow(fmin(school->fish[f].sheet_points, most), 2);
    const double of_wakes = bytes_per_vortex * n_vortices * school->n_fish;
    complain_if(of_wakes > max_bytes, check, "wake.lifetime", "the wakes of %d fish take %.2g TB; the maximum is %g TB",
                school->n_fish, 1e-12 * of_wakes, 1e-12 * max_bytes);
    complain_if(of_sheets > max_bytes, check, "fish.sheet_points",
                "the sheets of %d fish take %.2g TB; the maximum is %g TB", school->n_fish, 1e-12 * of_sheets,
                1e-12 * max_bytes);
}

/* Limit the number of cycles, so that a double resolves the phase until time.end. */
static void check_cycles(const struct check *check, const char *path, double frequency) {
    const double cycles = frequency * check->values->time.end;
    struct check limits = *check;
    limits.is_of_limits = true;
    complain_if(cycles > max_cycles, &limits, path,
                "%g cycles until time.end; the maximum is %g: beyond, rounding destroys the phase", cycles, max_cycles);
}

/* Limit a coordinate, so that a double resolves the shape of the body. */
static void check_place(const struct check *check, const char *path, double place, double length) {
    struct check limits = *check;
    limits.is_of_limits = true;
    complain_if(fabs(place) > max_lengths * length, &limits, path,
                "%g m is %g body lengths; the maximum is %g: beyond, rounding destroys the shape of the body", place,
                fabs(place) / length, max_lengths);
}

/* Check the keys of a gust against the profile. */
static void check_gust(const struct check *check) {
    const struct case_values *const values = check->values;
    const struct school_parameters *const school = &values->school;
    const struct fluid_parameters *const fluid = &school->fluid;
    const enum gust_profile profile = fluid->gust_profile;
    static const char frequency[] = "fluid.gust.frequency", wavelength[] = "fluid.gust.wavelength",
                      amplitude[] = "fluid.gust.amplitude", name[] = "fluid.gust.profile";
    const bool has_gust = fabs(fluid->gust_amplitude) > 0;
    if (profile == GUST_UNIFORM) {
        check_cycles(check, frequency, fluid->gust_frequency);
        complain_if(has_gust && fluid->gust_frequency == 0, check, amplitude,
                    "has no effect with fluid.gust.frequency 0");
    }

    complain_if(profile == GUST_SINE && fluid->gust_wavelength == 0, check, name,
                "sine needs a fluid.gust.wavelength above 0");
    if (profile == GUST_SINE && fluid->gust_wavelength > 0) {
        check_cycles(check, wavelength, fabs(fluid->gust_speed) / fluid->gust_wavelength);
    }

    // keys of other profiles
    const struct {
        const char *path;
        bool is_given, is_used;
        const char *profiles;
    } keys[] = {
        {frequency, fluid->gust_frequency > 0, profile == GUST_UNIFORM, "uniform"},
        {wavelength, fluid->gust_wavelength > 0, profile == GUST_SINE, "sine"},
        {"fluid.gust.speed", case_table_is_set(values, "fluid.gust.speed", 0), profile != GUST_UNIFORM, "sine or step"},
        {"fluid.gust.position", fabs(fluid->gust_position) > 0, profile != GUST_UNIFORM, "sine or step"},
        {"fluid.gust.gradient_distance", case_table_is_set(values, "fluid.gust.gradient_distance", 0),
         profile == GUST_STEP, "step"}};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        complain_if(keys[i].is_given && !keys[i].is_used, check, keys[i].path,
                    "has an effect only with 'profile: %s': remove the key", keys[i].profiles);
    }

    for (int f = 0; f < school->n_fish && profile != GUST_UNIFORM && has_gust; f++) {
        if (school->fish[f].force != FORCE_REACTIVE) continue;
        complain_if(true, check, name,
                    "the reactive force needs a gust that is uniform along the body: use 'force: pressure' for every "
                    "fish");
        return;
    }
}

/* Check the order and the number of walls; refuse a flow through the walls, and a viscosity without effect. */
static void check_fluid(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct fluid_parameters *const fluid = &school->fluid;
    const struct number_list *const walls = &fluid->walls;
    const bool has_walls = walls->n > 0;
    double length = 0, initial;
    for (int f = 0; f < school->n_fish; f++) length = fmax(length, school->fish[f].length);
    for (int i = 0; i < walls->n; i++) check_place(check, "fluid.walls", walls->value[i], length);
    complain_if(walls->n > 2, check, "fluid.walls", "expects y of one or two walls; got %d numbers", walls->n);
    if (walls->n == 2) {
        complain_if(walls->value[0] >= walls->value[1], check, "fluid.walls",
                    "the second wall must be above the first; %g is not above %g", walls->value[1], walls->value[0]);
    }
    complain_if(has_walls && fabs(fluid->velocity[1]) > 0, check, "fluid.velocity",
                "flows through fluid.walls, which are along x: set the y component to 0");
    complain_if(has_walls && fabs(fluid->gust_amplitude) > 0, check, "fluid.gust.amplitude",
                "the gust flows through fluid.walls: remove the gust or the walls");

    bool is_viscous = !text_number(case_table_row("fluid.viscosity")->initial, &initial);
    for (int f = 0; f < school->n_fish; f++) is_viscous |= school->fish[f].drag.friction != FRICTION_QUADRATIC;
    complain_if(!is_viscous && fabs(fluid->viscosity - initial) > 0, check, "fluid.viscosity",
                "has no effect: all fish have 'drag.skin: quadratic' with the coefficient drag.tangential");
}

// ---- body and wave

/* True if a number of the fish differs from the default of the key and from the default under a preset. The presence of
 * a key is no criterion: a case printed by `shoal show` has every key that has a value, and no preset. */
static bool is_given(const struct check *check, const char *path) {
    const struct key *const key = case_table_row(path);
    const double value = *(const double *)((const char *)check->fish + key->offset);
    double initial, published;
    if (!key->initial) return case_table_is_set(check->values, path, check->index);
    text_number(key->initial, &initial);
    if (!key->published || !text_number(key->published, &published)) published = initial;
    return fabs(value - initial) > 0 && fabs(value - published) > 0;
}

/* True if a key is present in the fish or under defaults.fish. */
static bool check_is_written(const struct check *check, const char *path) {
    bool is_default;
    return case_merge_value(check->tree, path, check->index, &is_default) != NULL;
}

/* Check the lists of the profile and the wave against each other, and the turn of the joints by the muscle. */
static void check_body(const struct check *check) {
    const struct fish_parameters *const fish = check->fish;
    const struct body_parameters *const body = &fish->body;
    const struct wave_parameters *const wave = &fish->wave;
    const enum profile profile = body->profile;

    // with a table profile pairs from nose to tail, or one value per edge; no list for other profiles
    static const char *const paths[] = {"fish.body.thickness_table", "fish.body.depth_table"};
    for (int i = 0; i < 2; i++) {
        const struct number_list *const list = i == 0 ? &body->thickness_table : &body->depth_table;
        const bool is_table = profile == PROFILE_TABLE, are_pairs = list->width == 2;
        complain_if(is_table && !are_pairs && list->n != fish->nodes - 1, check, paths[i],
                    "'profile: table' needs pairs [distance over length, value], as in [[0, 0.01], [0.3, 0.1], [1, "
                    "0.02]], or one value per edge, %d for %d nodes; got %d",
                    fish->nodes - 1, fish->nodes, list->n);
        bool is_ascending = list->n > 1;
        for (int k = 0; are_pairs && k < list->n; k++) {
            const double distance = list->value[2 * k];
            if (k == 0) is_ascending &= fabs(distance) <= 0;
            if (k > 0) is_ascending &= distance > list->value[2 * k - 2];
            if (k == list->n - 1) is_ascending &= fabs(distance - 1) <= 0;
        }
        complain_if(is_table && are_pairs && !is_ascending, check, paths[i],
                    "the distances must grow from 0 at the nose to 1 at the tail, in body lengths");
        complain_if(!is_table && list->n > 0, check, paths[i],
                    "has an effect only with 'profile: table': remove the key");
    }
    complain_if(profile != PROFILE_JOUKOWSKI && body->tail_thickness > 0, check, "fish.body.tail_thickness",
                "has an effect only with 'profile: joukowski': remove the key");

    // a number, a wavelength or a table
    static const char number[] = "fish.wave.number", wavelength[] = "fish.wave.wavelength";
    const bool has_length = check_is_written(check, wavelength);
    complain_if(has_length && check_is_written(check, number), check, wavelength,
                "sets wave.number too: remove wavelength or number");
    complain_if(wave->table.n == 1, check, "fish.wave.table", "needs at least two rows, from nose to tail");
    complain_if(wave->table.n > 0 && is_given(check, number), check, has_length ? wavelength : number,
                "has no effect with wave.table: remove the key");

    // the curvature of a joint, 2 tan(angle/2), is singular at an angle of pi
    double envelope = 0, curvature = 0;
    for (int k = 1; k < fish->nodes - 1; k++) {
        const double q = (double)k / (fish->nodes - 1);
        envelope = fmax(envelope, fabs(wave->constant + wave->linear * q + wave->quadratic * q * q));
    }
    for (int i = 0; i < wave->table.n * wave->table.width; i++) curvature = fmax(curvature, fabs(wave->table.value[i]));
    const double bias = fish->control.law != CONTROL_NONE ? fish->control.limit : fabs(fish->control.bias);
    const double of_wave = envelope * fabs(wave->amplitude) * (fish->reference_nodes - 1) / (fish->nodes - 1);
    const double most = fish->control.law == CONTROL_PLACE ? 1 + fish->control.amplitude_limit : 1;
    const double turn =
        most * (wave->table.n > 0 ? curvature / (fish->nodes - 1) + of_wave * bias : of_wave * (1 + bias));
    complain_if(turn >= M_PI, check, wave->table.n > 0 ? "fish.wave.table" : "fish.wave.amplitude",
                "the wave turns a joint by up to %.3g rad; the maximum is 3.14", turn);
}

static void check_motion(const struct check *check) {
    const struct motion_parameters *const motion = &check->fish->motion;
    static const char not_prescribed[] =
        "has no effect with 'motion.prescribed: none': set motion.prescribed to head or all";
    static const char constant[] = "has no effect with motion.frequency 0";

    if (motion->prescribed == PRESCRIBED_NONE) {
        const struct {
            const char *path;
            bool is_given;
        } keys[] = {{"fish.motion.heave", fabs(motion->heave) > 0},
                    {"fish.motion.pitch", fabs(motion->pitch) > 0},
                    {"fish.motion.pitch_phase", fabs(motion->pitch_phase) > 0},
                    {"fish.motion.frequency", motion->frequency > 0},
                    {"fish.motion.phase", fabs(motion->phase) > 0},
                    {"fish.motion.pivot", motion->pivot > 0},
                    {"fish.motion.speed", fabs(motion->speed - check->fish->start_speed) > 1e-12 * fabs(motion->speed)},
                    {"fish.motion.surge", motion->surge == SURGE_FREE}};
        for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
            complain_if(keys[i].is_given, check, keys[i].path, not_prescribed);
        }
        return;
    }

    const double heading = check->fish->start_heading, phase = motion->phase + motion->pitch_phase;
    complain_if(motion->surge == SURGE_FREE && fabs(remainder(heading, 180)) > 0, check, "fish.motion.surge",
                "free needs a start.heading along x, 0 or 180 degrees, not %g", heading);

    // without a frequency, sin(phase) is 0 at all times for a phase of 0 or 180 degrees
    const bool is_constant = motion->frequency == 0;
    complain_if(is_constant && fabs(motion->heave) > 0 && remainder(motion->phase, 180) == 0, check,
                "fish.motion.heave", constant);
    complain_if(is_constant && fabs(motion->pitch) > 0 && remainder(phase, 180) == 0, check, "fish.motion.pitch",
                constant);
}

// ---- forces

static void check_drag(const struct check *check) {
    const struct fish_parameters *const fish = check->fish;
    const struct drag_parameters *const drag = &fish->drag;
    static const char speed[] = "fish.drag.linear_speed";
    const bool has_speed = is_given(check, speed), is_linear = drag->law == DRAG_LINEAR_QUADRATIC;

    complain_if(has_speed && !is_linear, check, speed,
                "has an effect only with 'law: linear_quadratic': remove the key");
    complain_if(has_speed && is_linear && fish->force == FORCE_PUBLISHED, check, speed,
                "has no effect with 'force: published', where the speed is 1 m/s: remove the key");
    complain_if(is_linear && fish->force != FORCE_PUBLISHED && drag->linear_speed > 0 && fish->wave.frequency == 0,
                check, "fish.drag.law",
                "linear_quadratic needs wave.frequency above 0, because linear_speed is in lengths per beat: choose "
                "quadratic");
    complain_if(drag->friction != FRICTION_QUADRATIC && is_given(check, "fish.drag.tangential"), check,
                "fish.drag.tangential", "has no effect with 'skin: %s', which uses fluid.viscosity: remove the key",
                drag->friction == FRICTION_LAMINAR ? "laminar" : "boundary_layer");

    static const char *const of_layer[] = {"fish.drag.transition", "fish.drag.waving", "fish.drag.form"};
    for (size_t i = 0; i < sizeof of_layer / sizeof *of_layer; i++) {
        complain_if(drag->friction != FRICTION_BOUNDARY_LAYER && is_given(check, of_layer[i]), check, of_layer[i],
                    "has an effect only with 'skin: boundary_layer': remove the key");
    }
}

/* True if the control law uses the moment of the flow. */
static bool has_moment(const struct control_parameters *control) {
    const bool is_of_heading = control->law == CONTROL_HEADING || control->law == CONTROL_AVERAGED_HEADING;
    return is_of_heading && fabs(control->feedforward) > 0;
}

/* True for a height at or beyond a wall, seen from the first fish. */
static bool is_beyond_wall(const struct school_parameters *school, double y) {
    const struct number_list *const walls = &school->fluid.walls;
    const double start = school->fish[0].start_position[1];
    for (int i = 0; i < walls->n && i < 2; i++) {
        const double wall = walls->value[i];
        if (start > wall ? y <= wall : y >= wall) return true;
    }

    return false;
}

/* Check the vortices and the street in the fluid at the start. */
static void check_vortices(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct number_list *const vortices = &school->wake.vortices;
    const struct street_parameters *const street = &school->wake.street;
    static const char of_street[] = "wake.street.vortices", no_street[] = "has no effect with wake.street.vortices 0";
    complain_if(street->n > 0 && street->spacing == 0, check, of_street, "needs a wake.street.spacing above 0");
    complain_if(street->n > 0 && street->circulation == 0, check, of_street, "needs a wake.street.circulation");
    complain_if(street->n == 0 && street->spacing > 0, check, "wake.street.spacing", no_street);
    complain_if(street->n == 0 && fabs(street->circulation) > 0, check, "wake.street.circulation", no_street);
    complain_if(street->n == 0 && case_table_is_set(check->values, "wake.street.row_distance", 0), check,
                "wake.street.row_distance", no_street);
    if (vortices->n == 0 && street->n == 0) return;

    complain_if(vortices->n > 0 && vortices->width != 3, check, "wake.vortices",
                "needs rows of 3 numbers, x, y and circulation, not of %d", vortices->width);
    for (int i = 0; vortices->width == 3 && i < vortices->n; i++) {
        complain_if(is_beyond_wall(school, vortices->value[3 * i + 1]), check, "wake.vortices",
                    "vortex %d is beyond a wall of fluid.walls", i + 1);
    }
    const double half = street->row_distance / 2, middle = street->position[1];
    complain_if(street->n > 0 && (is_beyond_wall(school, middle - half) || is_beyond_wall(school, middle + half)),
                check, "wake.street.position", "a row of the street is beyond a wall of fluid.walls");

    // the wake of the first fish
    const char *const path = street->n > 0 ? of_street : "wake.vortices";
    complain_if(school->wake.removed_circulation == REMOVED_DROPPED, check, path,
                "the removal of a vortex would add its circulation to the body: use "
                "'wake.removed_circulation: retained'");
    complain_if(
        school->fish[0].force == FORCE_REACTIVE, check, path,
        "belongs to the wake of the first fish, and with 'force: reactive' that fish is not affected by its own "
        "wake: use 'force: pressure' and 'pressure.span: infinite'");
    bool has_rings = false;
    for (int f = 0; f < school->n_fish; f++) {
        has_rings |= school->fish[f].force == FORCE_PRESSURE && school->fish[f].span == SPAN_FINITE;
    }
    complain_if(has_rings, check, path, "a single vortex is not a ring: use 'pressure.span: infinite'");
}

/* Check the requirements of 'force: pressure', and refuse keys of the terms that the pressure replaces. */
static void check_pressure(const struct check *check) {
    const struct fish_parameters *const fish = check->fish;
    const struct school_parameters *const school = &check->values->school;
    const struct fluid_parameters *const fluid = &school->fluid;
    static const char of_span[] = "fish.pressure.span", of_points[] = "fish.sheet_points";

    if (fish->force != FORCE_PRESSURE) {
        static const char only_pressure[] = "has an effect only with 'force: pressure': remove the key";
        static const char suction[] = "fish.pressure.suction", limit[] = "fish.pressure.suction_limit";
        complain_if(fish->span == SPAN_FINITE, check, of_span, only_pressure);
        complain_if(is_given(check, suction), check, suction, only_pressure);
        complain_if(is_given(check, limit), check, limit, only_pressure);
        complain_if(fish->sensors.n > 0, check, "fish.sensors",
                    "needs the pressure on the body: use 'force: pressure'");
        return;
    }

    complain_if(school->wake.shedding != SHEDDING_SHEET, check, "fish.force", "pressure needs 'wake.shedding: sheet'");
    complain_if(school->sheet.curve != BODY_LINE_SMOOTH, check, "fish.force", "pressure needs 'sheet.curve: smooth'");
    complain_if(fish->sheet_points < 2 * fish->nodes - 1, check, of_points,
                "with 'force: pressure' the added mass of %d nodes needs at least %d points, not %d", fish->nodes,
                2 * fish->nodes - 1, fish->sheet_points);
    static const char extent[] = "fish.added_mass.extent",
                      no_effect[] = "has no effect with 'force: pressure': remove the key";
    complain_if(is_given(check, "fish.added_mass.coefficient"), check, "fish.added_mass.coefficient", no_effect);
    // under defaults the key may serve fish with another force
    bool is_default, serves_another = false;
    const bool is_written = case_merge_value(check->tree, extent, check->index, &is_default) != NULL;
    for (int f = 0; f < school->n_fish; f++) serves_another |= is_default && school->fish[f].force != FORCE_PRESSURE;
    complain_if(fish->added_mass.extent == EXTENT_THICKNESS && is_written && !serves_another, check, extent, no_effect);
    complain_if(fish->sensors.n > 0 && (fabs(fluid->shear) > 0 || fluid->gust_profile != GUST_UNIFORM), check,
                "fish.sensors",
                "the pressure on a side needs a stream with a potential: remove fluid.shear and fluid.gust.profile");
    complain_if(has_moment(&fish->control), check, "fish.control.feedforward",
                "is the moment of the drag, which differs from the moment of the pressure: use 0");

    // one span; a finite span needs closed rings and enough points
    int first = 0;
    while (school->fish[first].force != FORCE_PRESSURE) first++;
    const bool differs = school->fish[first].span != fish->span;
    complain_if(differs, check, of_span, "fish[%d] has another span: use one span for all fish with 'force: pressure'",
                first);
    if (!differs && fish->span == SPAN_FINITE) {
        const int least = fish_sheet_least(fish);
        complain_if(school->wake.removed_circulation == REMOVED_DROPPED, check, of_span,
                    "vortex rings must stay closed: use 'wake.removed_circulation: retained'");
        complain_if(fish->sheet_points < least, check, of_points,
                    "a span of %.3g lengths needs at least %d points (1 + 5 L/w), not %d", 5.0 / (least - 1), least,
                    fish->sheet_points);
    }

    // with fewer points the lift oscillates by 6 per cent while a gust passes (doc/verification.md, "Encounters")
    const bool is_step = fluid->gust_profile == GUST_STEP, is_sine = fluid->gust_profile == GUST_SINE;
    const double rise = is_step ? fluid->gust_gradient_distance : is_sine ? fluid->gust_wavelength / 2 : 0;
    const double least = 1 + ceil(6 * fish->length / rise - 1e-9);
    complain_if(rise > 0 && fabs(fluid->gust_amplitude) > 0 && fish->sheet_points < least, check, of_points,
                "a gust that changes within %g m needs at least %g points, not %d", rise, least, fish->sheet_points);
}

// ---- control

/* The control laws that use a key. */
#define LAWS_HEADING (1U << CONTROL_HEADING | 1U << CONTROL_AVERAGED_HEADING)
#define LAWS_COURSE (1U << CONTROL_COURSE | 1U << CONTROL_PLACE)
static const struct {
    const char *path;
    unsigned laws; /* bits 1 << enum control_law */
} law_keys[] = {{"fish.control.limit", LAWS_HEADING | LAWS_COURSE},
                {"fish.control.feedforward", LAWS_HEADING},
                {"fish.control.damping", LAWS_COURSE},
                {"fish.control.slow", LAWS_COURSE},
                {"fish.control.rate", 1U << CONTROL_AVERAGED_HEADING | LAWS_COURSE},
                {"fish.control.amplitude_gain", 1U << CONTROL_PLACE},
                {"fish.control.amplitude_damping", 1U << CONTROL_PLACE},
                {"fish.control.amplitude_limit", 1U << CONTROL_PLACE},
                {"fish.control.lookahead", 1U << CONTROL_PLACE},
                {"fish.control.hold_time", 1U << CONTROL_PLACE}};

static int by_name_of(const void *name, const void *fish) {
    return strcmp(name, (*(const struct fish_parameters *const *)fish)->name);
}

// the fish from which the law of fish f counts its place; -1: no fish has this name
static int find_leader(const struct check *check, int f) {
    const struct fish_parameters *const fish = check->values->school.fish;
    const struct fish_parameters **const found =
        bsearch(fish[f].control.of, check->named, (size_t)check->n_named, sizeof *check->named, by_name_of);
    return found ? (int)(*found - fish) : -1;
}

// the leader of law place: another fish that does not follow this one
static void check_law_place(const struct check *check) {
    const struct school_parameters *const school = &check->values->school;
    const struct control_parameters *const control = &check->fish->control;
    const int f = check->index, leader = control->of ? find_leader(check, f) : -1;
    static const char path[] = "fish.control.of";
    complain_if(control->waypoints.n > 0, check, "fish.control.waypoints",
                "has no effect with 'law: place': remove the waypoints, or choose course");
    complain_if(check->fish->motion.prescribed != PRESCRIBED_NONE, check, "fish.control.law",
                "place needs a fish that swims: set motion.prescribed to none");
    complain_if(!check_is_written(check, path), check, "fish.control.law",
                "place needs the name of another fish in control.of");
    if (!control->of) return;
    complain_if(control->of[0] != '\0' && leader < 0, check, path, "no fish has the name '%.60s'", control->of);
    complain_if(leader == f, check, path, "a fish cannot hold a place beside itself: name another fish");

    // follow the leaders until a fish has none; a way that is longer than the school goes round in a circle
    int last = leader, n = 0;
    while (last >= 0 && last != f && n++ < school->n_fish) {
        const struct control_parameters *const next = &school->fish[last].control;
        last = next->law == CONTROL_PLACE && next->of ? find_leader(check, last) : -1;
    }
    complain_if(leader >= 0 && leader != f && last == f, check, path,
                "'%.60s' holds a place beside this fish in turn: let one of them lead", control->of);
}

/* Refuse a wake that would end before it decays, or before the next marker. */
static void check_wake_of_fish(const struct check *check) {
    const struct wake_parameters *const wake = &check->values->school.wake;
    const double interval = check->values->school.shedding_interval,
                 lives = check->fish->wake_lifetime * wake->lifetime;
    const double least = larger(wake->decay, interval);
    complain_if(lives < least && least <= wake->lifetime, check, "fish.wake_lifetime",
                "%g of wake.lifetime is %g s, less than %s, %g s: choose a larger fraction", check->fish->wake_lifetime,
                lives, wake->decay > interval ? "wake.decay" : "time.shedding_interval", least);
}

static void check_control(const struct check *check) {
    const struct fish_parameters *const fish = check->fish;
    const struct control_parameters *const control = &fish->control;
    const struct number_list *const heading = &control->desired_heading;
    const char *const law = case_table_word(case_table_row("fish.control.law"), (int)control->law);
    const bool is_free = control->law == CONTROL_NONE, has_points = control->waypoints.n > 0;

    // the times of the desired heading
    static const char path[] = "fish.control.desired_heading";
    const double begin = heading->n > 0 ? heading->value[0] : 0;
    complain_if(begin < 0, check, path, "the first time must be at least 0 s, not %g s", begin);
    for (int i = 1; i < heading->n; i++) {
        const double before = heading->value[2 * i - 2], time = heading->value[2 * i];
        complain_if(time <= before, check, path, "the times must increase; %g follows %g", time, before);
        if (time <= before) break;
    }

    // values without effect for the chosen law
    complain_if(is_free && has_points, check, "fish.control.waypoints",
                "has no effect with 'law: none': remove the law, or choose course");
    for (size_t i = 0; i < sizeof law_keys / sizeof *law_keys; i++) {
        complain_if(!(law_keys[i].laws >> control->law & 1U) && is_given(check, law_keys[i].path), check,
                    law_keys[i].path, "has no effect with 'law: %s': remove the key", law);
    }

    const bool holds_place = control->law == CONTROL_PLACE;
    static const char only_place[] = "has an effect only with 'law: place': remove the key";
    complain_if(!holds_place && check_is_written(check, "fish.control.of"), check, "fish.control.of", only_place);
    complain_if(!holds_place && fabs(control->offset[0]) + fabs(control->offset[1]) > 0, check, "fish.control.offset",
                only_place);

    const double free_gain = 2;  // the derived default with law none
    complain_if(is_free && fabs(control->gain - free_gain) > 0, check, "fish.control.gain",
                "has no effect with 'law: none': remove the key");
    const double period = fish->wave.frequency > 0 ? 1 / fish->wave.frequency : 0;
    // neither the default, up to the rounding of durations, nor the 0 of preset: published
    const bool has_filter = control->filter > 0 && fabs(control->filter - period) > 1e-9 * period;
    complain_if(!has_moment(control) && has_filter, check, "fish.control.filter",
                "has no effect without feedforward: remove the key");
    complain_if(!(LAWS_COURSE >> control->law & 1U) && fabs(control->course_filter - period / 4) > 1e-9 * period, check,
                "fish.control.course_filter", "has no effect with 'law: %s': remove the key", law);
    complain_if(!has_points && is_given(check, "fish.control.acceptance_radius"), check,
                "fish.control.acceptance_radius", "has no effect without control.waypoints: remove the key");
    const bool is_start = heading->n == 1 && !(fabs(heading->value[1] - fish->start_heading) > 0);
    complain_if(heading->n > 0 && !is_start && is_free, check, path,
                "has no effect with 'law: none': choose a law, or remove the key");
    complain_if(heading->n > 0 && !is_start && !is_free && has_points, check, path,
                "has no effect with control.waypoints: remove the heading or the waypoints");
    complain_if(heading->n > 0 && !is_start && holds_place, check, path,
                "has no effect with 'law: place', which points where the leader does: remove the key");
    if (is_free) return;

    // the requirements of a law
    if (holds_place) check_law_place(check);
    complain_if(fabs(control->bias) > 0, check, "fish.control.bias",
                "has an effect only with 'law: none': the law computes the steering bias");
    complain_if(fish->wave.frequency == 0 && (has_moment(control) || control->law != CONTROL_HEADING), check,
                "fish.control.law", "needs wave.frequency above 0%s",
                control->law == CONTROL_HEADING ? ", or feedforward: 0" : "");
    complain_if(check->values->school.fluid.density == 0 && has_moment(control), check, "fish.control.law",
                "needs fluid.density above 0, or feedforward: 0");
}

// ---- derived defaults

/* Refuse a derived default out of the range of its key, at the place of its cause. */
static void check_derived(const struct check *check, bool is_of_fish) {
    const struct fish_parameters *const fish = check->fish;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (!key->cause || case_table_is_of_fish(key) != is_of_fish || check_is_written(check, key->path)) continue;
        if (!case_table_is_set(check->values, key->path, is_of_fish ? check->index : 0)) continue;

        // the key that puts the number out of its range
        const char *cause = key->cause;
        if (strcmp(cause, "fish.wave.frequency") == 0 && fish_parameters_move(fish)) cause = "fish.motion.frequency";
        if (strcmp(key->path, "fish.sheet_points") == 0) {
            if (fish->body.profile == PROFILE_TABLE) cause = "fish.body.depth_table";
            if (2 * fish->nodes - 1 > key->bounds.max) cause = "fish.nodes";
        }

        const void *const field =
            (const char *)(is_of_fish ? (const void *)fish : (const void *)check->values) + key->offset;
        const double value = key->type == INTEGER ? *(const int *)field : *(const double *)field;
        const struct bounds *const bounds = &key->bounds;
        const bool is_low = value < bounds->min || (bounds->is_min_open && value <= bounds->min);
        const bool is_out = is_low || value > bounds->max || isinf(value);
        if (!is_out || !check_is_written(check, cause)) continue;

        struct text range = {.arena = check->errors->arena};
        case_table_range(key, &range);
        complain_if(true, check, cause, "the default of %s would be %.9g, and must be %s: change this value, or set %s",
                    key->path, value, isinf(value) || !range.text ? "finite" : range.text, key->path);
    }
}

static int by_name(const void *a, const void *b) {
    const struct fish_parameters *const one = *(const struct fish_parameters *const *)a,
                                        *const other = *(const struct fish_parameters *const *)b;
    const int order = strcmp(one->name, other->name);
    return order != 0 ? order : (one > other) - (one < other);
}

void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors) {
    const struct school_parameters *const school = &values->school;
    struct check check = {.values = values, .tree = tree, .errors = errors};
    if (!check_beats(&check)) return;  // the relations of a time that has no value
    check_time(&check);
    check_swept_interval(&check, "time.end", values->time.end);
    check_swept_interval(&check, "time.output_interval", values->time.output_interval);
    check_vortices(&check);
    check_wake(&check);
    check_gust(&check);
    check_fluid(&check);
    complain_if(values->name && strchr(values->name, '/'), &check, "name", "cannot contain a '/'");

    // refuse a name that an earlier fish has; in the order of the names, fish of one name are neighbours
    int first = 0;
    NEW(tree->arena, check.named, school->n_fish);
    for (int f = 0; f < school->n_fish; f++) {
        if (school->fish[f].name) check.named[check.n_named++] = &school->fish[f];
    }
    qsort(check.named, (size_t)check.n_named, sizeof *check.named, by_name);
    for (int i = 1; i < check.n_named; i++) {
        const bool is_same = strcmp(check.named[first]->name, check.named[i]->name) == 0;
        if (!is_same) first = i;
        check.index = (int)(check.named[i] - school->fish);
        complain_if(is_same, &check, "fish.name", "fish[%d] has the same name, '%.60s'; names must be unique",
                    (int)(check.named[first] - school->fish), check.named[i]->name);
    }

    // the fish with the extreme beat decides the derived times of the school
    double size = 0;
    check.index = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const double frequency = fish_parameters_frequency(&school->fish[f]);
        if (!(frequency > 0) || fabs(log(frequency)) <= size) continue;
        size = fabs(log(frequency));
        check.index = f;
    }
    check.fish = &school->fish[check.index];
    if (school->n_fish > 0) check_derived(&check, false);

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish_parameters *const fish = check.fish = &school->fish[f];
        check.index = f;
        for (int i = 0; i < 2; i++) check_place(&check, "fish.start.position", fish->start_position[i], fish->length);
        check_place(&check, "fish.motion.heave", fish->motion.heave, fish->length);
        check_cycles(&check, "fish.wave.frequency", fish->wave.frequency);
        check_cycles(&check, "fish.motion.frequency", fish->motion.frequency);
        check_derived(&check, true);
        check_method(&check);
        check_body(&check);
        check_drag(&check);
        check_pressure(&check);
        check_motion(&check);
        check_wake_of_fish(&check);
        check_control(&check);
    }
}

// ---- implausible values

/* Note an angle in degrees that is a simple fraction of pi: the unit may be radians. */
static void note_radians(const struct check *check, const char *path, double degrees) {
    static const int parts[] = {12, 6, 4, 3, 2, 1};  // of half a turn
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const double part = M_PI / parts[i], n = round(degrees / part);
        if (n == 0 || fabs(degrees) > 2.001 * M_PI || fabs(degrees - n * part) > 5e-4 * fabs(degrees)) continue;
        complain_if(true, check, path, "%.6g is in degrees; if radians are meant, write %.6g", degrees,
                    n * 180 / parts[i]);
        return;
    }
}

/* Note a time that was rounded to a shedding interval in beats or by default. */
static void note_rounded(const struct check *check, const char *path, double time, const char *unit) {
    bool is_default;
    const struct yaml_node *const node = case_merge_value(check->tree, path, 0, &is_default);
    double written;
    if (!node) return;
    const struct case_beats *const interval =
        case_table_in_beats(check->values, case_table_row("time.shedding_interval"), 0);
    const struct key *const key = case_table_row(path);
    const struct case_beats *const beats = case_table_in_beats(check->values, key, 0);
    if (beats) written = beats->n * case_table_beat(check->values, key, 0);
    if (!beats && !text_number(node->text, &written)) return;
    complain_if(
        fabs(written - time) > 1e-9 * time, check, path,
        "%.6g s is not an integer multiple of %s and is rounded to %.6g s; time.shedding_interval is %s, %.6g s",
        written, unit, time, interval ? "in beats" : "1/100 of the fastest beat by default",
        check->values->school.shedding_interval);
}

static void note_fish(const struct check *check) {
    const struct fish_parameters *const fish = check->fish;
    const struct wave_parameters *const wave = &fish->wave;
    const double longest = 30 /* a blue whale, m */, shortest = 1e-3 /* a larva */, softest = 1e3 /* jelly, Pa */,
                 stiffest = 1e12 /* diamond */;
    const int enough = 17;

    const bool is_long = fish->length > longest, is_short = fish->length < shortest;
    complain_if(is_long || is_short, check, "fish.length", "%g m is %s than any swimmer; the unit is metres",
                fish->length, is_long ? "longer" : "shorter");
    complain_if(fish->body.modulus < softest, check, "fish.body.modulus",
                "%g Pa is softer than jelly (1e3 Pa): the body follows the flow, not the muscle", fish->body.modulus);
    complain_if(fish->body.modulus > stiffest, check, "fish.body.modulus", "%g Pa is stiffer than diamond (1e12 Pa)",
                fish->body.modulus);
    complain_if(fish->force == FORCE_PRESSURE && fish->nodes < enough && fish->motion.prescribed != PRESCRIBED_ALL,
                check, "fish.nodes",
                "%d: with force pressure, fewer than %d nodes resolve the shape of the body poorly", fish->nodes,
                enough);
    complain_if(wave->number > 0 && wave->frequency > 0 && wave->table.n == 0, check, "fish.wave.number",
                "%g: the wave travels from tail to head; for a wave from head to tail write %g", wave->number,
                -wave->number);

    note_radians(check, "fish.start.heading", fish->start_heading);
    note_radians(check, "fish.wave.phase", wave->phase);
    note_radians(check, "fish.motion.pitch", fish->motion.pitch);
    note_radians(check, "fish.motion.pitch_phase", fish->motion.pitch_phase);
    note_radians(check, "fish.motion.phase", fish->motion.phase);
    const struct number_list *const heading = &fish->control.desired_heading;
    for (int i = 0; i < heading->n && fish->control.law != CONTROL_NONE; i++) {
        note_radians(check, "fish.control.desired_heading", heading->value[2 * i + 1]);
    }
}

// ---- switched models

/* The key in the case that switches the derived default of a key of the fish to another model than the initial value;
 * NULL: none. It switches if it has another word, if a term vanishes or appears, or if a list becomes empty or ceases
 * to be. */
static const struct key *switching_key(const struct check *check, const struct key *key,
                                       const struct case_values *initial) {
    const bool is_of_fish = case_table_is_of_fish(key);
    const void *const field = (const char *)(is_of_fish ? (const void *)check->fish : check->values) + key->offset;
    const void *const other = (const char *)(is_of_fish ? (const void *)initial->school.fish : initial) + key->offset;
    const bool is_switched = key->type == CHOICE ? *(const int *)field != *(const int *)other
                             : key->type == REAL || key->type == DURATION
                                 ? (fabs(*(const double *)field) > 0) != (fabs(*(const double *)other) > 0)
                                 : ((const struct number_list *)field)->n > 0;
    if (!is_switched) return NULL;
    if (check_is_written(check, key->path)) return key;
    const struct key *cause = NULL;
    for (int i = 0; key->follows && key->follows[i] && !cause; i++) {
        cause = switching_key(check, case_table_row(key->follows[i]), initial);
    }
    return cause;
}

void case_notes(const struct case_values *values, const struct case_values *initial, const struct case_tree *tree,
                struct yaml_errors *notes) {
    struct check check = {.values = values, .tree = tree, .errors = notes, .is_of_notes = true};
    static const char interval[] = "time.shedding_interval";
    bool has_layer = false;
    for (int f = 0; f < values->school.n_fish; f++)
        has_layer |= values->school.fish[f].drag.friction != FRICTION_QUADRATIC;
    complain_if(has_layer && values->school.fluid.density > 0 && values->school.fluid.viscosity == 0, &check,
                "fluid.viscosity", "0 removes the friction of the skin");
    note_rounded(&check, "time.end", values->time.end, interval);
    note_rounded(&check, "time.output_interval", values->time.output_interval, interval);
    note_rounded(&check, "time.checkpoint_interval", values->time.checkpoint_interval, interval);
    note_rounded(&check, "output.wake_interval", values->output.wake_interval, "time.output_interval");
    for (check.index = 0; check.index < values->school.n_fish; check.index++) {
        check.fish = &values->school.fish[check.index];
        note_fish(&check);

        // go through each key of the case that switches derived defaults of this fish, with these defaults
        for (int first = 0; first < case_table_n; first++) {
            const struct key *const cause =
                case_table[first].follows ? switching_key(&check, &case_table[first], initial) : NULL;
            if (!cause || cause == &case_table[first]) continue;

            // list all keys with this cause; the same list of a later key is skipped
            struct text list = {.arena = notes->arena};
            for (const struct key *key = case_table; key < case_table + case_table_n; key++) {
                if (!key->follows || key == cause || switching_key(&check, key, initial) != cause) continue;
                const bool is_of_fish = case_table_is_of_fish(key);
                const void *const base = is_of_fish ? (const void *)check.fish : (const void *)values;
                text_add(&list, "%s%s ", list.text ? ", " : "", key->path);
                case_value_write(&list, key, (const char *)base + key->offset);
            }
            complain_if(list.text != NULL, &check, cause->path, "changes the defaults of other keys: %s", list.text);
        }
    }
}
