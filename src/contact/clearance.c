/* clearance.c: the distance of each pair at the end of a step, and within the step if a collision is possible. */
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

// insertion sort by low x: the order hardly changes between two calls
static void order_sort(struct neighbours *neighbours) {
    int *const order = neighbours->order;
    for (int i = 1; i < neighbours->n; i++) {
        const int moving = order[i];
        int j = i;
        for (; j > 0 && neighbours->box[order[j - 1]].low[0] > neighbours->box[moving].low[0]; j--)
            order[j] = order[j - 1];
        order[j] = moving;
    }
}

// store the overlapping pairs in sweep order; returns twice the number of pairs
static int pairs_sweep(struct neighbours *neighbours) {
    int n = 0;
    for (int i = 0; i < neighbours->n; i++) {
        const int here = neighbours->order[i];
        const struct box *const a = &neighbours->box[here];
        for (int j = i + 1; j < neighbours->n; j++) {
            const int there = neighbours->order[j];
            const struct box *const b = &neighbours->box[there];
            if (b->low[0] > a->high[0]) break;
            if (b->low[1] > a->high[1] || b->high[1] < a->low[1]) continue;
            if (n + 2 > neighbours->capacity) {
                neighbours->capacity = neighbours->capacity > 0 ? 2 * neighbours->capacity : 64;
                GROW(neighbours->arena, neighbours->pair, neighbours->capacity);
                GROW(neighbours->arena, neighbours->other, neighbours->capacity);
            }
            neighbours->pair[n++] = here;
            neighbours->pair[n++] = there;
        }
    }
    return n;
}

// insert a number into an ascending list of n numbers
static void ascending_insert(int *list, int n, int number) {
    for (; n > 0 && list[n - 1] > number; n--) list[n] = list[n - 1];
    list[n] = number;
}

void neighbours_find(struct neighbours *neighbours) {
    int *const first = neighbours->first, *const filled = neighbours->filled;
    memset(first, 0, ((size_t)neighbours->n + 1) * sizeof *first);
    memset(filled, 0, (size_t)neighbours->n * sizeof *filled);
    order_sort(neighbours);
    const int n = pairs_sweep(neighbours);
    for (int i = 0; i < n; i++) first[neighbours->pair[i] + 1]++;
    for (int i = 0; i < neighbours->n; i++) first[i + 1] += first[i];

    for (int i = 0; i < n; i += 2) {
        const int a = neighbours->pair[i], b = neighbours->pair[i + 1];
        ascending_insert(neighbours->other + first[a], filled[a]++, b);
        ascending_insert(neighbours->other + first[b], filled[b]++, a);
    }
}

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

    neighbours_find(neighbours);
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

// ---- fold test at every joint; beyond half a turn, all pairs of segments of line and outline

static const double pi = 3.14159265358979323846;

/* n points (x, y), joined by segments; a closed line has a segment from the last point to the first. */
struct line {
    int n, is_closed;
    const double *point; /* (n, 2) */
};

// twice the signed area of a triangle, positive for a left turn
static double triangle_area(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int segments_cross(const double *a, const double *b, const double *c, const double *d) {
    return triangle_area(a, b, c) * triangle_area(a, b, d) < 0 && triangle_area(c, d, a) * triangle_area(c, d, b) < 0;
}

// whether two segments that share no point cross
static int line_crosses(const struct line *line) {
    const int n_segments = line->is_closed ? line->n : line->n - 1;
    for (int i = 0; i < n_segments; i++) {
        const double *const a = line->point + 2 * i, *const b = line->point + 2 * ((i + 1) % line->n);
        // the first and the last segment of a closed line share a point
        const int end = i == 0 && line->is_closed ? n_segments - 1 : n_segments;
        for (int j = i + 2; j < end; j++) {
            if (segments_cross(a, b, line->point + 2 * j, line->point + 2 * ((j + 1) % line->n))) return 1;
        }
    }

    return 0;
}

// Whether the inner side of a joint is folded; *turn is the angle between the two edges. The inner side has length 0 if
// the radius of curvature, length/(2 tan(turn/2)), is half the thickness.
static int joint_is_folded(const struct fish *fish, int joint, const struct edge *before, const struct edge *after,
                           double *turn) {
    *turn = atan2(before->t[0] * after->t[1] - before->t[1] * after->t[0], edge_dot(before->t, after->t));
    const double half = (fish->thickness[joint] + fish->thickness[joint + 1]) / 4;
    return 2 * half * fabs(tan(*turn / 2)) > (before->length + after->length) / 2;
}

// test the centre line, then the outline: along the left side to the tail, back along the right side
static int all_segments_cross(const struct fish *fish, const double *y, double *scratch) {
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        scratch[2 * k] = y[edge_place(fish, 0, k)];
        scratch[2 * k + 1] = y[edge_place(fish, 1, k)];
    }

    if (line_crosses(&(struct line){n, 0, scratch})) return 1;
    for (int k = 1; k < n - 1; k++) {
        const struct edge before = edge_at(fish, k - 1, y), after = edge_at(fish, k, y);
        const double normal[2] = {before.n[0] + after.n[0], before.n[1] + after.n[1]};
        const double length = hypot(normal[0], normal[1]), half = (fish->thickness[k - 1] + fish->thickness[k]) / 4;

        for (int i = 0; i < 2 && length > 0; i++) {
            const double side = half * normal[i] / length;
            scratch[2 * (2 * n - 2 - k) + i] = scratch[2 * k + i] - side;
            scratch[2 * k + i] += side;
        }
    }

    return line_crosses(&(struct line){2 * n - 2, 1, scratch});
}

int self_crossing(const struct fish *fish, const double *y, double *scratch) {
    double angle = 0, low = 0, high = 0;
    struct edge before = edge_at(fish, 0, y);
    for (int k = 1; k < fish->n_edges; k++) {
        const struct edge after = edge_at(fish, k, y);
        double turn;
        if (joint_is_folded(fish, k - 1, &before, &after, &turn)) return 1;
        angle += turn;
        low = fmin(low, angle);
        high = fmax(high, angle);
        before = after;
    }

    // a line with all directions within half a turn advances along the mean direction and cannot cross; so do the sides
    return high - low >= pi && all_segments_cross(fish, y, scratch);
}

void self_crossing_remember(const struct school *school, struct state *state, double *scratch) {
    for (int f = 0; f < school->n_fish && state->crossed < 0; f++) {
        if (!self_crossing(&school->fish[f], state->y, scratch)) continue;
        state->crossed = f;
        state->crossed_t = state->t;
    }
}
