/* impulse.c: moments of vortices, and lost moments. */
#include <math.h>

#include "state/state.h"

void impulse_add(struct impulse_moments *sum, double circulation, double x, double y) {
    sum->circulation += circulation;
    sum->x += circulation * x;
    sum->y += circulation * y;
    sum->square += circulation * (x * x + y * y);
    sum->product += circulation * x * y;
}

void impulse_add_stretch(struct impulse_moments *sum, double circulation, const double one[2], const double other[2]) {
    impulse_add(sum, circulation / 2, one[0], one[1]);
    impulse_add(sum, circulation / 2, other[0], other[1]);
}

/* Add a wake at the time t + tau, multiplied by factor: the strengths at the fraction q of the interval, less, if
 * less_q >= 0, the strengths at that fraction. */
static void impulse_add_wake(struct impulse_moments *sum, const struct wake *wake, const struct school *school,
                             double t, double tau, double q, double less_q, double factor) {
    struct wake_decay now = {.wake = wake, .school = school, .t = t, .tau = tau, .q = q}, then = now;
    then.q = less_q;
    const int first = less_q >= 0 ? wake_first_decaying(wake, school, t) : wake->n_vortex - 1;
    double newer[2] = {0, 0}, before = 0;
    for (int i = first; i >= 0; i--) {
        const double less = less_q >= 0 ? wake_next_strength(&then, i) : 0;
        const double strength = factor * (wake_next_strength(&now, i) - less);
        double at[2];
        wake_marker(wake, i, school->interval, tau, at);
        if (!wake->has_markers) impulse_add(sum, strength, at[0], at[1]);
        if (wake->has_markers && i < first) impulse_add_stretch(sum, before - strength, at, newer);
        before = strength;
        newer[0] = at[0];
        newer[1] = at[1];
    }
}

struct impulse_moments impulse_of_wake(const struct wake *wake, const struct school *school, double t, double tau) {
    struct impulse_moments sum = {0};
    impulse_add_wake(&sum, wake, school, t, tau, tau / school->interval, -1, 1);
    return sum;
}

void impulse_of(const struct impulse_moments *sum, double factor, double impulse[3]) {
    impulse[0] = factor * sum->y;
    impulse[1] = -factor * sum->x;
    impulse[2] = -factor * sum->square / 2;
}

double impulse_depth(const struct fish *fish) {
    // the unknowns of a strip are circulations times w(s)/w_L, so the strip depth w_L is the depth of the vortices
    if (fish->strip_depth > 0) return fish->strip_depth;
    for (int k = 1; k < fish->n_edges; k++) {
        if (fabs(fish->depth[k] - fish->depth[0]) > 1e-12 * fish->depth[0]) return NAN;
    }
    return fish->depth[0];
}

// ---- losses

void impulse_book(struct momentum_balance *momentum, const struct impulse_moments *before,
                  const struct impulse_moments *after) {
    momentum->lost[0] += before->x - after->x;
    momentum->lost[1] += before->y - after->y;
    momentum->lost[2] += before->square - after->square;
}

// book lost moments; with removed_circulation: dropped, the lost circulation returns at the tail
static void book_loss(const struct school *school, struct state *state, int f, const struct impulse_moments *lost,
                      const double tail[2]) {
    struct impulse_moments back = {0};
    if (school->removed == REMOVED_DROPPED) impulse_add(&back, lost->circulation, tail[0], tail[1]);
    impulse_book(&state->momentum[f], lost, &back);
}

void impulse_fade(const struct school *school, struct state *state, int f) {
    const struct wake *const wake = &state->wake[f];
    const struct fish *const fish = &school->fish[f];
    struct impulse_moments lost = {0};

    // lost moments: mean of the positions at the beginning and at the end of the interval
    impulse_add_wake(&lost, wake, school, state->t, 0, 0, 1, 0.5);
    impulse_add_wake(&lost, wake, school, state->t, school->interval, 0, 1, 0.5);

    // the tail: newest marker at the beginning of the interval, node of y at the end
    const double end[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    const int newest = wake->n_vortex - 1, has_start = wake->has_markers && newest >= 0;
    const double start[2] = {has_start ? wake->x[newest] : end[0], has_start ? wake->y[newest] : end[1]};
    book_loss(school, state, f, &lost, (const double[]){(start[0] + end[0]) / 2, (start[1] + end[1]) / 2});
}

void impulse_remove(const struct school *school, struct state *state, int f) {
    const struct wake *const wake = &state->wake[f];
    const struct fish *const fish = &school->fish[f];

    // labels of old rings have decayed completely
    const int n_old = wake_n_old(wake, school, state->t);
    struct impulse_moments lost = {0};
    for (int i = 0; i < n_old && !school->finite; i++) {
        const int newer = i + wake->has_markers;
        const double g = wake_strength(school, state->t - wake->birth[newer]) * wake_source(wake, i);
        impulse_add_stretch(&lost, g, (const double[]){wake->x[i], wake->y[i]},
                            (const double[]){wake->x[newer], wake->y[newer]});
    }

    const double tail[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    book_loss(school, state, f, &lost, tail);
}
