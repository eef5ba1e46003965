/* clearance.c: finds the distance of each pair at the end of a step, and within the step if they could have
 * collided. */
#include "contact/clearance.h"

#include <math.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish.h"

// ---- sort by x, sweep, and list the overlaps of each box

struct neighbours *neighbours_create(struct arena *arena, int n) {
    struct neighbours *neighbours;
    NEW(arena, neighbours, 1);
    neighbours->arena = arena;
    neighbours->n = n;
    NEW(arena, neighbours->box, n);
    NEW(arena, neighbours->order, n);
    NEW(arena, neighbours->filled, n);
    NEW(arena, neighbours->first, n + 1);
    for (int i = 0; i < n; i++) neighbours->order[i] = i;
    return neighbours;
}

void neighbours_find(struct neighbours *neighbours) {
    int *const first = neighbours->first, *const filled = neighbours->filled, *const order = neighbours->order;
    const struct box *const box = neighbours->box;

    // insertion sort by low x: the order hardly changes between two calls
    for (int i = 1; i < neighbours->n; i++) {
        const int moving = order[i];
        int j = i;
        for (; j > 0 && box[order[j - 1]].low[0] > box[moving].low[0]; j--) order[j] = order[j - 1];
        order[j] = moving;
    }

    // store the overlapping pairs in sweep order
    int n = 0;
    for (int i = 0; i < neighbours->n; i++) {
        const struct box *const a = &box[order[i]];
        for (int j = i + 1; j < neighbours->n; j++) {
            const struct box *const b = &box[order[j]];
            if (b->low[0] > a->high[0]) break;
            if (b->low[1] > a->high[1] || b->high[1] < a->low[1]) continue;
            if (n + 2 > neighbours->capacity) {
                neighbours->capacity = neighbours->capacity > 0 ? 2 * neighbours->capacity : 64;
                GROW(neighbours->arena, neighbours->pair, neighbours->capacity);
                GROW(neighbours->arena, neighbours->other, neighbours->capacity);
            }
            neighbours->pair[n++] = order[i];
            neighbours->pair[n++] = order[j];
        }
    }

    // list both boxes of each pair, in ascending order
    memset(first, 0, ((size_t)neighbours->n + 1) * sizeof *first);
    memset(filled, 0, (size_t)neighbours->n * sizeof *filled);
    for (int i = 0; i < n; i++) first[neighbours->pair[i] + 1]++;
    for (int i = 0; i < neighbours->n; i++) first[i + 1] += first[i];
    for (int i = 0; i < n; i++) {
        const int here = neighbours->pair[i], there = neighbours->pair[i ^ 1];
        int *const list = neighbours->other + first[here], at = filled[here]++;
        for (; at > 0 && list[at - 1] > there; at--) list[at] = list[at - 1];
        list[at] = there;
    }
}

struct box clearance_box(const struct fish *fish, double distance, const double *before, const double *y) {
    double margin = 0;
    for (int k = 0; k < fish->n_edges; k++) margin = fmax(margin, fish->thickness[k] / 2);

    // a small margin for rounding
    margin += (0.5 + 1e-9) * distance;
    const int n = fish->n_nodes;
    const struct box old = box_around(n, before + fish->at.x, before + fish->at.y);

    return box_widen(box_union(old, box_around(n, y + fish->at.x, y + fish->at.y)), margin);
}

// Upper bound of the decrease of the distance of two bodies from before to y, m: by the displacements of the noses, and
// of each body by the largest displacement of another node relative to the nose.
static double travel_of(const struct fish *a, const struct fish *b, const double *before, const double *y) {
    double nose[2][2], beyond[2];
    for (int i = 0; i < 2; i++) {
        const struct fish *const fish = i == 0 ? a : b;
        const double *const x[2] = {y + fish->at.x, y + fish->at.y};
        const double *const old[2] = {before + fish->at.x, before + fish->at.y};
        double square = 0;
        for (int c = 0; c < 2; c++) nose[i][c] = x[c][0] - old[c][0];
        for (int k = 1; k < fish->n_nodes; k++) {
            const double dx = x[0][k] - old[0][k] - nose[i][0], dy = x[1][k] - old[1][k] - nose[i][1];
            square = fmax(square, dx * dx + dy * dy);
        }
        beyond[i] = sqrt(square);
    }
    return hypot(nose[0][0] - nose[1][0], nose[0][1] - nose[1][1]) + beyond[0] + beyond[1];
}

bool clearance_may_be_near(const struct fish *a, const struct fish *b, const double *before, const double *y,
                           double limit) {
    const double travel = travel_of(a, b, before, y), now = fish_distance(a, b, y, limit + travel);
    return now < limit || now < travel;
}

struct passage clearance_passage(const struct fish *a, const struct fish *b, const double *before, const double *y,
                                 double limit, double *between) {
    enum { MAX_ADVANCES = 200 };
    const double travel = travel_of(a, b, before, y);
    // bodies further apart than limit + travel at the end were never closer than the limit
    const double now = fish_distance(a, b, y, limit + travel);
    struct passage passage = {.now = now, .least = now, .part = 1};
    if (now <= 0 || now >= travel) return passage;

    // Conservative advancement (Mirtich 1996): advance by the largest fraction of the step that cannot produce contact,
    // until far below the gap of bodies in contact.
    const double near = 1e-8 * fmin(a->length, b->length);
    double s = 0;
    for (int i = 0; i < MAX_ADVANCES && s < 1; i++) {
        for (int n = 0; n < 2; n++) {
            const struct fish *const fish = n == 0 ? a : b;
            for (int j = 0; j < 2 * fish->n_nodes; j++) {
                const int at = fish->at.x + j;
                between[at] = before[at] + s * (y[at] - before[at]);
            }
        }

        const double distance = fish_distance(a, b, between, INFINITY);
        passage.least = fmin(passage.least, distance);
        if (distance <= near) {
            passage.least = 0;
            passage.part = s;
            return passage;
        }
        s += distance / travel;
    }
    return passage;
}

void clearance_step(const struct school *school, struct state *state, double t, const double *y,
                    struct neighbours *neighbours, double *between) {
    struct closest *const closest = state->closest;
    const bool is_known = isfinite(closest->distance);
    if (is_known) {
        // candidates for a new record: fish that may be nearer to a fish before; this rejects nearly all pairs
        const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) {
            neighbours->box[f] = clearance_box(&school->fish[f], closest->distance, closest->before, y);
        }

        neighbours_find(neighbours);
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) {
            bool is_candidate = false;
            for (int i = neighbours->first[f]; i < neighbours->first[f + 1] && !is_candidate; i++) {
                const int g = neighbours->other[i];
                if (g > f) break;
                is_candidate =
                    clearance_may_be_near(&school->fish[f], &school->fish[g], closest->before, y, closest->distance);
            }
            neighbours->filled[f] = is_candidate;
        }
    }

    // after contact the record is 0
    for (int f = 0; f < school->n_fish && closest->distance > 0; f++) {
        if (is_known && !neighbours->filled[f]) continue;
        const int *const other = is_known ? neighbours->other + neighbours->first[f] : NULL;
        const int n = is_known ? neighbours->first[f + 1] - neighbours->first[f] : f;

        for (int i = 0; i < n && closest->distance > 0; i++) {
            const int g = other ? other[i] : i;
            if (g > f) break;
            const struct passage passage =
                clearance_passage(&school->fish[f], &school->fish[g], closest->before, y, closest->distance, between);
            if (passage.least >= closest->distance) continue;
            closest->distance = passage.least;
            closest->t = passage.part < 1 ? closest->before_t + passage.part * (t - closest->before_t) : t;
            closest->fish[0] = g;
            closest->fish[1] = f;
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

// ---- fold test at every joint; beyond half a turn, all pairs of segments of line and outline

// whether two segments cross: of n points (x, y) joined by segments, on a closed line also from the last point to the
// first; neighbours share a point, and do not cross there
static bool line_crosses(int n, int n_segments, const double *point) {
    for (int i = 0; i < n_segments; i++) {
        const double *const a = point + 2 * i, *const b = point + 2 * ((i + 1) % n);
        for (int j = i + 2; j < n_segments; j++) {
            if (segments_cross(a, b, point + 2 * j, point + 2 * ((j + 1) % n))) return true;
        }
    }
    return false;
}

bool self_crossing(const struct fish *fish, const double *y, double *scratch) {
    const int n = fish->n_nodes;
    double angle = 0, low = 0, high = 0;
    struct edge before = edge_at(fish, 0, y);
    for (int k = 1; k < fish->n_edges; k++) {
        // the inner side of a folded joint has length 0: the radius of curvature, length/(2 tan(turn/2)), is half the
        // thickness
        const struct edge after = edge_at(fish, k, y);
        const double turn = atan2(edge_cross(before.t, after.t), edge_dot(before.t, after.t));
        const double half = (fish->thickness[k - 1] + fish->thickness[k]) / 4;
        if (2 * half * fabs(tan(turn / 2)) > (before.length + after.length) / 2) return true;
        angle += turn;
        low = fmin(low, angle);
        high = fmax(high, angle);
        before = after;
    }

    // a line with all directions within half a turn advances along the mean direction and cannot cross; so do the sides
    if (high - low < M_PI) return false;

    // the centre line
    for (int k = 0; k < n; k++) {
        scratch[2 * k] = y[edge_place(fish, 0, k)];
        scratch[2 * k + 1] = y[edge_place(fish, 1, k)];
    }
    if (line_crosses(n, n - 1, scratch)) return true;

    // the outline: along the left side to the tail, back along the right side
    for (int k = 1; k < n - 1; k++) {
        const struct edge ahead = edge_at(fish, k - 1, y), behind = edge_at(fish, k, y);
        const double normal[2] = {ahead.n[0] + behind.n[0], ahead.n[1] + behind.n[1]};
        const double length = hypot(normal[0], normal[1]), half = (fish->thickness[k - 1] + fish->thickness[k]) / 4;
        for (int i = 0; i < 2 && length > 0; i++) {
            const double side = half * normal[i] / length;
            scratch[2 * (2 * n - 2 - k) + i] = scratch[2 * k + i] - side;
            scratch[2 * k + i] += side;
        }
    }
    return line_crosses(2 * n - 2, 2 * n - 2, scratch);
}

void self_crossing_remember(const struct school *school, struct state *state, double *scratch) {
    for (int f = 0; f < school->n_fish && !state->has_crossed; f++) {
        if (!self_crossing(&school->fish[f], state->y, scratch)) continue;
        state->has_crossed = true;
        state->crossed = f;
        state->crossed_t = state->t;
    }
}
