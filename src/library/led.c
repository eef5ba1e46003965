/* led.c: the keys that can be set at an event, with the conditions of each key. */
#include "library/led.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_gait.h"

/* A change of one fish; memory: a copy, which replaces the memory of the fish after all checks. */
struct change {
    const struct fish *fish;
    const struct state *state;
    struct control_memory memory;
    int n;
    const double *values;
};

static enum status set_amplitude(struct change *change) {
    const struct fish *const fish = change->fish;
    if (!(fabs(fish->amplitude) > 0)) {
        return status_fail(
            STATUS_CASE, "wave.amplitude: the amplitude of %s in the case is 0: give an initial amplitude", fish->name);
    }
    control_set_amplitude(fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_frequency(struct change *change) {
    if (change->values[0] < 0) {
        return status_fail(STATUS_CASE, "wave.frequency: %g Hz: a frequency cannot be negative", change->values[0]);
    }
    control_set_frequency(change->fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_bias(struct change *change) {
    if (change->fish->control.law != CONTROL_NONE) {
        return status_fail(STATUS_CASE, "control.bias: the control law of %s sets the bias: use 'law: none'",
                           change->fish->name);
    }
    control_set_bias(change->fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_heading(struct change *change) {
    const struct fish *const fish = change->fish;
    if (fish->control.law == CONTROL_NONE) {
        return status_fail(STATUS_CASE, "control.desired_heading: %s has no control law: choose a control.law",
                           fish->name);
    }
    if (control_n_waypoints(fish, &change->memory) > 0) {
        return status_fail(STATUS_CASE, "control.desired_heading: %s follows waypoints", fish->name);
    }
    control_set_heading(fish, &change->memory, change->state->t, angle_radians(change->values[0]));
    return STATUS_OK;
}

static enum status set_waypoints(struct change *change) {
    const struct fish *const fish = change->fish;
    if (fish->control.law != CONTROL_COURSE && fish->control.law != CONTROL_AVERAGED_HEADING) {
        return status_fail(STATUS_CASE, "control.waypoints: %s needs 'law: course', which has a continuous bias",
                           fish->name);
    }
    if (change->n % 2 != 0 || change->n > 2 * CONTROL_MAX_WAYPOINTS) {
        return status_fail(STATUS_CASE, "control.waypoints: %d numbers: give 1 to %d pairs", change->n,
                           CONTROL_MAX_WAYPOINTS);
    }
    control_set_waypoints(fish, &change->memory, change->n / 2, change->values, change->state->y);
    return STATUS_OK;
}

static const struct led_key {
    const char *key;
    int is_number;
    enum status (*set)(struct change *change);
} keys[] = {
    {"wave.amplitude", 1, set_amplitude},        {"wave.frequency", 1, set_frequency},    {"control.bias", 1, set_bias},
    {"control.desired_heading", 1, set_heading}, {"control.waypoints", 0, set_waypoints},
};
enum { N_KEYS = sizeof keys / sizeof *keys };

static enum status led_find_key(const char *name, const struct led_key **key) {
    for (int k = 0; k < N_KEYS; k++) {
        *key = &keys[k];
        if (strcmp(keys[k].key, name) == 0) return STATUS_OK;
    }
    return status_fail(STATUS_CASE,
                       "'%s' cannot be set: only wave.amplitude, wave.frequency, control.bias, "
                       "control.desired_heading and control.waypoints can",
                       name);
}

// the curvature of a joint is singular at a turn of pi
static enum status led_check_turn(const struct change *change) {
    const double amplitude = 1 + change->memory.amplitude.target;
    const double bias = control_largest_bias(change->fish, &change->memory);
    const double turn = fish_largest_turn(change->fish, amplitude, bias);
    if (turn < 3.14159) return STATUS_OK;
    return status_fail(STATUS_CASE, "the wave would turn a joint of %s by up to %.3g rad; it must stay below 3.14",
                       change->fish->name, turn);
}

enum status led_set(const struct simulation *simulation, int fish, const char *key, int n, const double *values) {
    const struct led_key *found;
    TRY(led_find_key(key, &found));

    // check the values
    if (n < 1 || (found->is_number && n > 1)) {
        return status_fail(STATUS_CASE, "%s: %d numbers: give %s", key, n, found->is_number ? "one" : "pairs");
    }
    for (int i = 0; i < n; i++) {
        if (!isfinite(values[i])) return status_fail(STATUS_CASE, "%s: %g is not finite", key, values[i]);
    }

    // change a copy of the memory, then replace the memory
    struct control_memory *const memory = &simulation->state->control[fish];
    struct change change = {&simulation->school->fish[fish], simulation->state, *memory, n, values};
    TRY(found->set(&change));
    TRY(led_check_turn(&change));
    *memory = change.memory;
    return STATUS_OK;
}
