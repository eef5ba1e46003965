/* impulse.c: moments of vortices, and lost moments. */
#include "state/impulse.h"

#include <math.h>

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

// add the given fraction (part) of the circulation of source i at the position of the source tau after the event
static void impulse_add_source(struct impulse_moments *sum, const struct wake *wake, int i, double part,
                               double interval, double tau) {
    double older[2], newer[2];
    wake_marker(wake, i, interval, tau, older);
    wake_marker(wake, i + wake->has_markers, interval, tau, newer);

    impulse_add_stretch(sum, part * wake_source(wake, i), older, newer);
}

// the age of source i at the event at time t
static double source_age(const struct wake *wake, int i, double t) {
    return t - wake->birth[i + wake->has_markers];
}

// add the stretches of a free sheet of rings at time t + tau, multiplied by factor; labels of markers include the
// decay; decaying: only the fraction of each label that decays within the interval
static void add_rings(struct impulse_moments *sum, const struct wake *wake, const struct school *school, double t,
                      double tau, int decaying, double factor) {
    const double interval = school->interval;
    double older[2] = {0}, before = 0;
    for (int i = 0; i < wake->n_vortex; i++) {
        const double age = t - wake->birth[i];
        const double part = decaying ? wake_strength(school, age) - wake_strength(school, age + interval)
                                     : wake_strength_within(school, age, tau / interval);

        const double label = factor * part * wake_label(wake, i, interval, tau);
        double newer[2];
        wake_marker(wake, i, interval, tau, newer);
        if (i > 0) impulse_add_stretch(sum, label - before, older, newer);

        before = label;
        older[0] = newer[0];
        older[1] = newer[1];
    }
}

struct impulse_moments impulse_of_wake(const struct wake *wake, const struct school *school, double t, double tau) {
    struct impulse_moments sum = {0};
    if (school->finite) {
        add_rings(&sum, wake, school, t, tau, 0, 1);
        return sum;
    }

    for (int i = 0; i < wake_n_sources(wake); i++) {
        const double strength = wake_strength_within(school, source_age(wake, i, t), tau / school->interval);
        impulse_add_source(&sum, wake, i, strength, school->interval, tau);
    }
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
    if (school->finite) {
        add_rings(&lost, wake, school, state->t, 0, 1, 0.5);
        add_rings(&lost, wake, school, state->t, school->interval, 1, 0.5);
    }
    for (int i = 0; i < wake_n_sources(wake) && !school->finite; i++) {
        const double age = source_age(wake, i, state->t);
        const double part = wake_strength(school, age) - wake_strength(school, age + school->interval);
        // sources are ordered by age: all younger sources keep full strength
        if (!(part > 0) && wake_strength(school, age + school->interval) >= 1) break;
        impulse_add_source(&lost, wake, i, part / 2, school->interval, 0);
        impulse_add_source(&lost, wake, i, part / 2, school->interval, school->interval);
    }

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
    const int n_old = school->finite ? 0 : wake_n_old(wake, school, state->t);
    struct impulse_moments lost = {0};
    for (int i = 0; i < n_old; i++) {
        impulse_add_source(&lost, wake, i, wake_strength(school, source_age(wake, i, state->t)), school->interval, 0);
    }

    const double tail[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    book_loss(school, state, f, &lost, tail);
}
