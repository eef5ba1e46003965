/* case_notes.c: implausible values, fish by fish. */
#include "case/case_notes.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

static const double pi = 3.14159265358979323846;

/* The case, and the list of notes. fish: index of the fish being examined. */
struct look {
    const struct case_values *values;
    const struct case_tree *tree;
    struct yaml_errors *notes;
    int fish;
};

static bool is_same_mark(struct yaml_mark a, struct yaml_mark b) {
    return a.source == b.source && a.line == b.line && a.column == b.column;
}

/* Add a note on the value at a path, once for a value that several fish share. */
__attribute__((format(printf, 3, 4))) static void note_value(const struct look *look, const char *path,
                                                             const char *format, ...) {
    char reason[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    const struct yaml_mark mark = case_merge_mark(look->tree, path, look->fish);
    for (int i = 0; i < look->notes->n && i < YAML_ERRORS_KEPT; i++) {
        const char *const dot = strchr(path, '.');
        if (is_same_mark(look->notes->kept[i].mark, mark) && strstr(look->notes->kept[i].text, dot)) return;
    }
    case_merge_complain(look->tree, path, look->fish, reason, look->notes);
}

/* Note an angle in degrees that is a simple fraction of pi: the unit may be radians. */
static void note_radians(const struct look *look, const char *path, double degrees) {
    static const int parts[] = {12, 6, 4, 3, 2, 1};  // of half a turn
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const double part = pi / parts[i], n = round(degrees / part);
        if (n == 0 || fabs(degrees) > 2.001 * pi || fabs(degrees - n * part) > 5e-4 * fabs(degrees)) continue;
        note_value(look, path, "%.6g is in degrees; if radians are meant, write %.6g", degrees, n * 180 / parts[i]);
        return;
    }
}

static void note_angles(const struct look *look) {
    const struct fish_parameters *const fish = &look->values->school.fish[look->fish];
    note_radians(look, "fish.start.heading", fish->start_heading);
    note_radians(look, "fish.wave.phase", fish->wave.phase);
    note_radians(look, "fish.motion.pitch", fish->motion.pitch);
    note_radians(look, "fish.motion.pitch_phase", fish->motion.pitch_phase);
    note_radians(look, "fish.motion.phase", fish->motion.phase);
    const struct number_list *const heading = &fish->control.desired_heading;
    for (int i = 0; i < heading->n && fish->control.law != CONTROL_NONE; i++) {
        note_radians(look, "fish.control.desired_heading", heading->value[2 * i + 1]);
    }
}

/* Note a time that was rounded to the default shedding interval. */
static void note_rounded(const struct look *look, const char *path, double time, const char *unit) {
    bool is_default;
    const struct yaml_node *const node = case_merge_value(look->tree, path, 0, &is_default);
    double written;
    if (!node || !text_number(node->text, &written) || fabs(written - time) <= 1e-9 * time) return;
    note_value(look, path,
               "%.6g s is not an integer multiple of %s and is rounded to %.6g s; the default of "
               "time.shedding_interval is 1/100 of the fastest beat, %.6g s",
               written, unit, time, look->values->school.shedding_interval);
}

static void note_times(const struct look *look) {
    const struct case_time *const time = &look->values->time;
    static const char interval[] = "time.shedding_interval";
    note_rounded(look, "time.end", time->end, interval);
    note_rounded(look, "time.output_interval", time->output_interval, interval);
    note_rounded(look, "time.checkpoint_interval", time->checkpoint_interval, interval);
    note_rounded(look, "output.wake_interval", look->values->output.wake_interval, "time.output_interval");
}

static void note_body(const struct look *look) {
    const struct fish_parameters *const fish = &look->values->school.fish[look->fish];
    const double longest = 30 /* a blue whale, m */, shortest = 1e-3 /* a larva */, softest = 1e3 /* jelly, Pa */,
                 stiffest = 1e12 /* diamond */;

    if (fish->length > longest || fish->length < shortest) {
        note_value(look, "fish.length", "%g m is %s than any swimmer; the unit is metres", fish->length,
                   fish->length > longest ? "longer" : "shorter");
    }

    if (fish->body.modulus < softest) {
        note_value(look, "fish.body.modulus",
                   "%g Pa is softer than jelly (1e3 Pa): the body follows the flow, not the muscle",
                   fish->body.modulus);
    } else if (fish->body.modulus > stiffest) {
        note_value(look, "fish.body.modulus", "%g Pa is stiffer than diamond (1e12 Pa)", fish->body.modulus);
    }
}

static void note_nodes(const struct look *look) {
    const struct fish_parameters *const fish = &look->values->school.fish[look->fish];
    const int enough = 17;
    if (fish->force == FORCE_PRESSURE && fish->nodes < enough && fish->motion.prescribed != PRESCRIBED_ALL) {
        note_value(look, "fish.nodes",
                   "%d: with force pressure, fewer than %d nodes resolve the shape of the body poorly", fish->nodes,
                   enough);
    }
}

static void note_wave(const struct look *look) {
    const struct wave_parameters *const wave = &look->values->school.fish[look->fish].wave;
    if (wave->number > 0 && wave->frequency > 0 && wave->table.n == 0) {
        note_value(look, "fish.wave.number",
                   "%g: the wave travels from tail to head; for a wave from head to tail write %g", wave->number,
                   -wave->number);
    }
}

void case_notes(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *notes) {
    struct look look = {values, tree, notes, 0};
    note_times(&look);
    for (look.fish = 0; look.fish < values->school.n_fish; look.fish++) {
        note_body(&look);
        note_nodes(&look);
        note_wave(&look);
        note_angles(&look);
    }
}
