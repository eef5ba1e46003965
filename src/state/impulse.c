/* impulse.c: the impulse of vortices, and the impulse that is lost when they decay or are removed. */
#include "state/impulse.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "wake/stretch.h"

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

/* Which strengths a wake has: those at the fraction q of the interval; their change, those at q less those at `less`;
 * or their loss, those without decay less those at q. */
struct strengths {
    enum { STRENGTHS, CHANGE, LOSS } kind;
    double q, less;
};

/* What remains by one of the functions wake_part_of_label, _stretch and _marker, or the change of it. Of the three only
 * one decays, as the span asks, so a change of strengths has the change of this part and the others themselves. */
typedef double wake_part(const struct wake *wake, const struct school *school, double t, double q, int i);

static double part_of(const struct strengths *of, wake_part *part, bool decays, const struct wake *wake,
                      const struct school *school, double t, int i) {
    if (!decays) return 1;
    switch (of->kind) {
        case CHANGE: return part(wake, school, t, of->q, i) - part(wake, school, t, of->less, i);
        case LOSS: return 1 - part(wake, school, t, of->q, i);
        case STRENGTHS: break;
    }
    return part(wake, school, t, of->q, i);
}

/* The markers around a stretch, at index i % STRETCH_MARKERS, at n_times times after the event: a pass from the oldest
 * stretch to the newest evaluates each marker once. */
enum { MOST_TIMES = 2 };
struct window {
    int next; /* the first marker that is not in the window yet */
    double label[MOST_TIMES][STRETCH_MARKERS], place[MOST_TIMES][STRETCH_MARKERS][2]; /* labels with what remains */
    double part_of_marker[STRETCH_MARKERS];
};

static void window_move(struct window *window, const struct wake *wake, const struct school *school, int end, double t,
                        int n_times, const double *tau, const struct strengths *of) {
    for (; window->next < end; window->next++) {
        const int i = window->next, k = i % STRETCH_MARKERS;
        const double part = part_of(of, wake_part_of_label, school->finite, wake, school, t, i);
        window->part_of_marker[k] = part_of(of, wake_part_of_marker, !school->finite, wake, school, t, i);
        for (int time = 0; time < n_times; time++) {
            window->label[time][k] = part * wake_label(wake, i, school->interval, tau[time]);
            wake_marker(wake, i, school->interval, tau[time], window->place[time][k]);
        }
    }
}

/* Add factor times a wake with some strengths, without the sources to leave out (NULL: none), at each of n_times times
 * tau after the event at time t. */
static void impulse_add_wake(struct impulse_moments *sum, const struct wake *wake, const bool *left_out,
                             const struct school *school, double t, int n_times, const double *tau, struct strengths of,
                             double factor) {
    struct stretch_form form;
    struct window window = {.next = 0};
    for (int j = 0; j < wake_n_sources(wake); j++) {
        if (left_out && left_out[j]) continue;

        // what does not decay does not change: nothing from the oldest marker of this stretch on
        const int oldest = wake->has_markers && j > 0 ? j - 1 : j;
        if (of.kind != STRENGTHS && !(wake_strength_within(school, wake_age(wake, oldest, t), 1) < 1)) return;

        if (!wake->has_markers) {
            const double part = part_of(&of, wake_part_of_label, true, wake, school, t, j);
            for (int time = 0; time < n_times; time++) {
                double at[2];
                wake_marker(wake, j, school->interval, tau[time], at);
                impulse_add(sum, factor * part * wake->circulation[j], at[0], at[1]);
            }
            continue;
        }

        // the circulations that stretch j gives to its markers
        stretch_set_form(&form, wake, school, j);
        if (window.next < form.first) window.next = form.first;
        window_move(&window, wake, school, form.first + form.n, t, n_times, tau, &of);
        const bool is_young = j >= wake->n_old;
        const double part_of_stretch =
            is_young ? part_of(&of, wake_part_of_stretch, !school->finite, wake, school, t, j) : 1;
        for (int time = 0; time < n_times; time++) {
            double label[STRETCH_MARKERS];
            for (int b = 0; b < form.n; b++) label[b] = window.label[time][(form.first + b) % STRETCH_MARKERS];
            for (int a = 0; a < form.n; a++) {
                const int k = (form.first + a) % STRETCH_MARKERS;
                double strength = 0;
                for (int b = 0; b < form.n; b++) strength += form.part[a][b] * label[b];
                strength *= is_young ? part_of_stretch : window.part_of_marker[k];
                impulse_add(sum, factor * strength, window.place[time][k][0], window.place[time][k][1]);
            }
        }
    }
}

struct impulse_moments impulse_of_wake(const struct wake *wake, const struct school *school, double t, double tau) {
    struct impulse_moments sum = {0};
    const struct strengths now = {STRENGTHS, .q = tau / school->interval};
    impulse_add_wake(&sum, wake, NULL, school, t, 1, &tau, now, 1);
    return sum;
}

double impulse_lost_circulation(const struct wake *wake, const struct school *school, double t, double tau) {
    struct impulse_moments lost = {0};
    const struct strengths loss = {LOSS, .q = tau / school->interval};
    impulse_add_wake(&lost, wake, NULL, school, t, 1, &tau, loss, 1);
    return wake->removed + lost.circulation;
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
    const struct strengths change = {CHANGE, .q = 0, .less = 1};
    impulse_add_wake(&lost, wake, NULL, school, state->t, 2, (const double[]){0, school->interval}, change, 0.5);

    // the tail: newest marker at the beginning of the interval, node of y at the end
    const double end[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    const int newest = wake->n_vortex - 1, has_start = wake->has_markers && newest >= 0;
    const double start[2] = {has_start ? wake->x[newest] : end[0], has_start ? wake->y[newest] : end[1]};
    book_loss(school, state, f, &lost, (const double[]){(start[0] + end[0]) / 2, (start[1] + end[1]) / 2});
}

void impulse_thinning_reserve(struct arena *arena, struct impulse_thinning *thinning, const struct wake *wake) {
    if (wake->capacity <= thinning->capacity) return;
    thinning->capacity = wake->capacity;
    double **const copies[] = {&thinning->x, &thinning->y, &thinning->circulation, &thinning->birth};
    for (size_t i = 0; i < sizeof copies / sizeof *copies; i++) GROW(arena, *copies[i], wake->capacity);
    GROW(arena, thinning->after, wake->capacity);
    for (int i = 0; i < 2; i++) GROW(arena, thinning->is_same[i], wake->capacity);
}

static bool is_same(double one, double other) {
    return !(fabs(one - other) > 0);
}

// find vortices that are in both wakes, where births are in the same order
static void find_partners(const struct wake *before, const struct wake *after, int *partner) {
    for (int i = 0; i < before->n_vortex; i++) partner[i] = -1;
    for (int i = 0, k = 0; i < before->n_vortex && k < after->n_vortex;) {
        if (is_same(before->birth[i], after->birth[k])) {
            const bool is_pair = is_same(before->x[i], after->x[k]) && is_same(before->y[i], after->y[k]) &&
                                 is_same(before->circulation[i], after->circulation[k]);
            partner[i++] = is_pair ? k : -1;
            k++;
        } else if (before->birth[i] < after->birth[k]) {
            i++;
        } else {
            k++;
        }
    }
}

// all markers that may take part in source j
static struct range markers_of_source(const struct wake *wake, int j) {
    if (!wake->has_markers) return (struct range){j, 1};
    const int half = STRETCH_MARKERS / 2, first = j + 1 > half ? j + 1 - half : 0, left = wake->n_vortex - first;
    return (struct range){first, left < STRETCH_MARKERS ? left : STRETCH_MARKERS};
}

// find the sources whose markers are in both wakes, without others in between
static void find_same_sources(const struct wake *before, const struct wake *after, const int *partner,
                              bool *same_before, bool *same_after) {
    for (int k = 0; k < wake_n_sources(after); k++) same_after[k] = false;
    for (int j = 0; j < wake_n_sources(before); j++) {
        same_before[j] = false;
        const int k = partner[j];
        if (k < 0 || k >= wake_n_sources(after) || (j < before->n_old) != (k < after->n_old)) continue;
        const struct range one = markers_of_source(before, j), other = markers_of_source(after, k);
        bool is_equal = other.first - k == one.first - j && other.n == one.n;
        for (int i = 0; i < one.n && is_equal; i++) is_equal = partner[one.first + i] == other.first + i;
        same_before[j] = is_equal;
        if (is_equal) same_after[k] = true;
    }
}

struct impulse_moments impulse_thin_wake(const struct school *school, struct state *state, int f,
                                         struct impulse_thinning *thinning) {
    struct wake *const wake = &state->wake[f], before = *wake;
    const struct fish *const fish = &school->fish[f];
    const double t = state->t;
    before.x = thinning->x;
    before.y = thinning->y;
    before.circulation = thinning->circulation;
    before.birth = thinning->birth;
    const size_t size = (size_t)wake->n_vortex * sizeof *wake->x;
    memcpy(before.x, wake->x, size);
    memcpy(before.y, wake->y, size);
    memcpy(before.circulation, wake->circulation, size);
    memcpy(before.birth, wake->birth, size);

    wake_remove_old(wake, school, t);
    stretch_find_old(wake, fish, school);
    stretch_drop(wake, fish, school);
    stretch_restore(wake, fish, school, state->y);

    // at the event, velocities and rates do not matter
    const struct strengths now = {STRENGTHS, .q = 0};
    const double tau = 0;
    struct impulse_moments lost = {0};
    find_partners(&before, wake, thinning->after);
    find_same_sources(&before, wake, thinning->after, thinning->is_same[0], thinning->is_same[1]);
    impulse_add_wake(&lost, &before, thinning->is_same[0], school, t, 1, &tau, now, 1);
    impulse_add_wake(&lost, wake, thinning->is_same[1], school, t, 1, &tau, now, -1);
    lost.product = 0;
    return lost;
}

void impulse_book_thinned(const struct school *school, struct state *state, int f, const struct impulse_moments *lost) {
    double tail[2];
    fish_tail(&school->fish[f], state->y, tail);
    book_loss(school, state, f, lost, tail);
}
