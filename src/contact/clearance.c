/* clearance.c: the distance of each pair at the end of a step, and within the step if a collision is possible. */
#include "contact/clearance.h"

#include <math.h>
#include <string.h>

#include "fish/fish_distance.h"

enum { MAX_ADVANCES = 200 };

struct box clearance_box(const struct fish *fish, double distance, const double *before, const double *y) {
    double margin = 0;
    for (int k = 0; k < fish->n_edges; k++) margin = fmax(margin, fish->thickness[k] / 2);

    // a small margin for rounding
    margin += (0.5 + 1e-9) * distance;
    const int n = fish->n_nodes;
    const struct box old = box_around(n, before + fish->at.x, before + fish->at.y);

    return box_widen(box_union(old, box_around(n, y + fish->at.x, y + fish->at.y)), margin);
}

// displacement of a body during a step: of the nose, and the largest displacement of another node relative to the nose,
// m
struct shift {
    double nose[2], beyond;
};

static struct shift shift_of(const struct fish *fish, const double *before, const double *y) {
    const double *const x[2] = {y + fish->at.x, y + fish->at.y};
    const double *const old[2] = {before + fish->at.x, before + fish->at.y};
    struct shift shift = {{x[0][0] - old[0][0], x[1][0] - old[1][0]}, 0};
    double square = 0;

    for (int k = 1; k < fish->n_nodes; k++) {
        const double dx = x[0][k] - old[0][k] - shift.nose[0], dy = x[1][k] - old[1][k] - shift.nose[1];
        square = fmax(square, dx * dx + dy * dy);
    }

    shift.beyond = sqrt(square);
    return shift;
}

// upper bound of the decrease of the distance between any two points of two bodies, m
static double approach(const struct shift *a, const struct shift *b) {
    return hypot(a->nose[0] - b->nose[0], a->nose[1] - b->nose[1]) + a->beyond + b->beyond;
}

// nodes of a fish at the fraction s of a step
static void nodes_between(const struct fish *fish, const double *before, const double *y, double s, double *between) {
    for (int k = 0; k < fish->n_nodes; k++) {
        const int at[2] = {fish->at.x + k, fish->at.y + k};
        for (int i = 0; i < 2; i++) between[at[i]] = before[at[i]] + s * (y[at[i]] - before[at[i]]);
    }
}

// Conservative advancement (Mirtich 1996): advance by the largest fraction of the step that cannot produce contact.
// Returns the fraction of the step before contact, or 1 without contact; *least is the smallest distance found.
static double meeting(const struct fish *a, const struct fish *b, const double *before, const double *y, double travel,
                      double *between, double *least) {
    // far below the gap of bodies in contact
    const double near = 1e-8 * fmin(a->length, b->length);
    double s = 0;

    for (int i = 0; i < MAX_ADVANCES && s < 1; i++) {
        nodes_between(a, before, y, s, between);
        nodes_between(b, before, y, s, between);
        const double distance = fish_distance(a, b, between, INFINITY);
        *least = fmin(*least, distance);

        if (distance <= near) {
            *least = 0;
            return s;
        }

        s += distance / travel;
    }

    return 1;
}

// upper bound of the decrease of the distance of two bodies from before to y, m
static double travel_of(const struct fish *a, const struct fish *b, const double *before, const double *y) {
    const struct shift shift = shift_of(a, before, y), other = shift_of(b, before, y);
    return approach(&shift, &other);
}

int clearance_may_be_near(const struct fish *a, const struct fish *b, const double *before, const double *y,
                          double limit) {
    const double travel = travel_of(a, b, before, y), now = fish_distance(a, b, y, limit + travel);
    return now < limit || now < travel;
}

static void closest_update(struct closest *closest, double distance, double t, int f, int g) {
    if (distance >= closest->distance) return;
    closest->distance = distance;
    closest->t = t;
    closest->fish[0] = g;
    closest->fish[1] = f;
}

struct passage clearance_passage(const struct fish *a, const struct fish *b, const double *before, const double *y,
                                 double limit, double *between) {
    const double travel = travel_of(a, b, before, y);
    // bodies further apart than limit + travel at the end were never closer than the limit
    const double now = fish_distance(a, b, y, limit + travel);
    struct passage passage = {.now = now, .least = now, .part = 1};
    if (now > 0 && now < travel) passage.part = meeting(a, b, before, y, travel, between, &passage.least);
    return passage;
}

static void pair_compare(const struct school *school, struct state *state, double t, const double *y, double *between,
                         int f, int g) {
    struct closest *const closest = state->closest;
    const struct passage passage =
        clearance_passage(&school->fish[f], &school->fish[g], closest->before, y, closest->distance, between);
    const double when = passage.part < 1 ? closest->before_t + passage.part * (t - closest->before_t) : t;
    closest_update(closest, passage.least, when, f, g);
}

// whether the distance of fish f and a fish before f may be below the record
static int may_be_nearest(const struct school *school, const struct closest *closest, const double *y,
                          const struct neighbours *neighbours, int f) {
    for (int i = neighbours->first[f]; i < neighbours->first[f + 1] && neighbours->other[i] < f; i++) {
        const struct fish *const other = &school->fish[neighbours->other[i]];
        if (clearance_may_be_near(&school->fish[f], other, closest->before, y, closest->distance)) return 1;
    }
    return 0;
}

// Find the candidates for a new record in filled; returns 0 if the candidates are unknown. This parallel search rejects
// nearly all pairs.
static int candidates_find(const struct school *school, const struct closest *closest, const double *y,
                           struct neighbours *neighbours) {
    if (isinf(closest->distance)) return 0;
    const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        neighbours->box[f] = clearance_box(&school->fish[f], closest->distance, closest->before, y);
    }

    // without memory for neighbours every pair is a candidate
    if (neighbours_find(neighbours) != STATUS_OK) return 0;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) neighbours->filled[f] = may_be_nearest(school, closest, y, neighbours, f);

    return 1;
}

void clearance_step(const struct school *school, struct state *state, double t, const double *y,
                    struct neighbours *neighbours, double *between) {
    struct closest *const closest = state->closest;
    const int is_known = candidates_find(school, closest, y, neighbours);

    // after contact the record is 0
    for (int f = 0; f < school->n_fish && closest->distance > 0; f++) {
        if (is_known && !neighbours->filled[f]) continue;
        const int *const other = is_known ? neighbours->other + neighbours->first[f] : NULL;
        const int n = is_known ? neighbours->first[f + 1] - neighbours->first[f] : f;

        for (int i = 0; i < n && closest->distance > 0; i++) {
            const int g = other ? other[i] : i;
            if (g < f) pair_compare(school, state, t, y, between, f, g);
        }
    }

    memcpy(closest->before, y, (size_t)school->n_unknowns * sizeof *y);
    closest->before_t = t;
}

void clearance_start(const struct school *school, struct state *state, struct neighbours *neighbours, double *between) {
    struct closest *const closest = state->closest;
    memcpy(closest->before, state->y, (size_t)school->n_unknowns * sizeof *state->y);
    closest->distance = INFINITY;
    closest->before_t = state->t;
    clearance_step(school, state, state->t, state->y, neighbours, between);
}
