/* others.c: selection by a bound for every source, sums at far points, polynomials to the points of the body. */
#include "flow/others.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "flow/flow.h"

enum { FAR = KERNEL_BLOCK, TIMES = 3, VALUES = KERNEL_SUMS };

/* A body that has moved by more than this from the path of its last event, in lengths, has no far sources. */
static const double most_drift = 4e-3;

/* Neighbouring sources: a circle around the sources, and bounds of strengths, half spans, legs and speeds. */
enum { GROUP = 16 };
struct group {
    struct range sources;
    double x, y, radius, q, d, half, leg, speed;
};

/* A body at the event: distance of its ends; distances of the body from the chord, and of the control points from the
 * curve of the far points; the largest speed of a node, m s-1; sums of the sizes of the strengths; sources. */
struct others_body {
    double chord, bend, beside, speed, q, d, half;
    int n;
};

/* The far points of a fish. */
struct others_fish {
    bool is_used;       /* else no source is far: too few nodes, or a depth that varies */
    double *to_points;  /* values of the polynomials of the far points at the points (FAR, n_points) */
    double *from_nodes; /* positions of the far points by nodes                      (n_nodes, FAR) */
    double half[FAR];
    /* at the event: position, velocity and acceleration of the far points */
    double start[2][FAR], velocity[2][FAR], acceleration[2][FAR];
    /* at the event: ends of the body and their middle; the distance of all points from the curve of the far points */
    double end[2][2], middle[2], aside;
    struct others_body at_event;
    double radius;       /* of the circle around the middle that encloses body and released wake */
    double reach;        /* distance from the middle beyond which all sources are far, and bodies act from few points */
    struct sources body; /* the body, by sources at its far points             (FAR) */
    /* the far points at the time of a sum, with u, v, div, u_x, u_y, v_x, div_x, div_y of the far sources: of wakes at
     * three times, of all sources now */
    double x[FAR], y[FAR];
    double wake[TIMES][VALUES][FAR], now[VALUES][FAR];
    bool has_drifted;
    int n_near, near_capacity; /* ranges of near sources in wakes */
    struct range *near;
    int n_groups, group_capacity;
    struct group *group; /* the released wake of this fish, GROUP by GROUP */
    struct group around; /* the body of this fish */
    struct range whole;  /* its released sources */
    int first;           /* fish of others_next */
};

/* What one fish is for another. */
struct others_pair {
    bool is_far_body;       /* with the nascent point */
    bool by_few;            /* the body acts from its far points */
    int first_near, n_near; /* among the near ranges of the fish */
    int next;               /* fish of others_next */
};

struct others {
    struct arena *arena;
    int n_fish;
    struct others_fish *fish;  /*                        (n_fish) */
    struct others_pair *pair;  /* targets, then sources  (n_fish, n_fish) */
    struct kernel_pair widest; /* bounds of all pairs, sources and bodies */
    struct group strongest;
    struct others_body largest;
    bool have_drifted;            /* some fish */
    bool is_selected, is_by_tree; /* the far wakes */
    bool bodies_by_tree;          /* now */
    struct sources points;        /* far points of a class, for the tree */
    double *value;                /* at these points      (VALUES, FAR n_fish) */
    double t;
    unsigned long version;
    double *past; /* unknowns at the event              (n_unknowns) */
};

struct others *others_create(struct arena *arena, const struct flow *flow) {
    const struct school *const school = flow->school;
    struct others *others;
    NEW(arena, others, 1);
    others->arena = arena;
    others->n_fish = school->n_fish;
    NEW(arena, others->fish, school->n_fish);
    NEW(arena, others->pair, (size_t)school->n_fish * (size_t)school->n_fish);
    NEW(arena, others->past, school->n_unknowns);
    others->points.arena = arena;
    NEW(arena, others->value, VALUES * FAR * school->n_fish);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct others_fish *const of = &others->fish[f];
        const int n = fish->n_nodes, n_points = flow_n_points(fish);
        of->is_used = n >= 4 && !fish->depth_varies;
        if (!of->is_used) continue;
        of->body.arena = arena;
        sources_append(&of->body, FAR);
        for (int i = 0; i < FAR; i++) of->half[i] = of->body.half[i] = fish->point_half ? fish->point_half[0] : 0;

        // fish with the same points share the matrices
        const bool is_same = f > 0 && of[-1].is_used && fish->control_point == fish[-1].control_point;
        of->to_points = is_same ? of[-1].to_points : NULL;
        of->from_nodes = is_same ? of[-1].from_nodes : NULL;
        if (is_same) continue;
        NEW(arena, of->to_points, FAR * n_points);
        NEW(arena, of->from_nodes, n * FAR);

        // far points on the smooth curve through the nodes
        double *factor, chebyshev[FAR];
        NEW(arena, factor, n);
        curve_smooth_factors(n, factor);
        for (int i = 0; i < FAR; i++) {
            chebyshev[i] = cos(M_PI * (2 * i + 1) / (2 * FAR));
            const double u = (n - 1) * (1 + chebyshev[i]) / 2;
            double sum = 0;
            for (int k = 0; k < n; k++) sum += fabs(u - k) < 1e-12 ? 1e30 : factor[k] / (u - k);
            for (int k = 0; k < n; k++) {
                of->from_nodes[k * FAR + i] = (fabs(u - k) < 1e-12 ? 1e30 : factor[k] / (u - k)) / sum;
            }
        }

        // polynomials: 1 at one of the far points, 0 at the others
        for (int p = 0; p < n_points; p++) {
            const struct stencil *const point = p < fish->n_control ? &fish->control_point[p] : NULL;
            double u = p == n_points - 1 ? n - 1 : p - fish->n_control + 0.5;
            if (point) u = 0;
            for (int k = 0; point && k < point->n; k++) u += point->weight[k] * point->node[k];
            const double t = 2 * u / (n - 1) - 1;
            for (int i = 0; i < FAR; i++) {
                double value = 0;
                for (int k = 0; k < FAR; k++) {
                    value +=
                        (k == 0 ? 1.0 : 2.0) / FAR * cos(k * acos(chebyshev[i])) * cos(k * acos(fmax(-1, fmin(1, t))));
                }
                of->to_points[i * n_points + p] = value;
            }
        }
    }
    return others;
}

bool others_are_selected(const struct flow *flow) {
    return flow->others->is_selected;
}

// ---- selection

/* Error of the polynomial between the FAR points of a body, a power of two, over the value: 2 rho^-FAR. The smallest
 * ellipse with foci at both ends of the body around the other place has this axis, (rho + 1/rho)/2, over the distance
 * of the foci. */
static double polynomial_error(double axis) {
    double power = axis + sqrt(axis * axis - 1);
    for (int k = FAR; k > 1; k /= 2) power *= power;
    return 2 / power;
}

/* The group of some sources of fish g: of the body, or of the released points of a wake (points, wake; or NULL). */
static struct group group_of(const struct others *others, int g, const struct sources *sources, struct range which,
                             const struct sheet_points *points, const struct wake *wake) {
    struct group group = {
        .sources = which, .half = INFINITY, .leg = INFINITY, .speed = wake ? 0 : others->fish[g].at_event.speed};
    const int last = which.first + which.n - 1;
    group.x = (sources->x[which.first] + sources->x[last]) / 2;
    group.y = (sources->y[which.first] + sources->y[last]) / 2;
    for (int i = which.first; i <= last; i++) {
        const double dx = sources->x[i] - group.x, dy = sources->y[i] - group.y;
        const double d2 = sources->dx[i] * sources->dx[i] + sources->dy[i] * sources->dy[i];
        if (which.n > 1) group.radius = fmax(group.radius, sqrt(dx * dx + dy * dy));
        group.q = fmax(group.q, fabs(sources->q[i]));
        group.d = fmax(group.d, sqrt(d2));
        group.half = fmin(group.half, sources->half[i]);
        group.leg = fmin(group.leg, sources->leg[i]);
        if (!wake) continue;
        const int marker = points->newer[i];
        const double speed2 = wake->u[marker] * wake->u[marker] + wake->v[marker] * wake->v[marker];
        group.speed = fmax(group.speed, sqrt(speed2));
    }
    return group;
}

/* Whether a circle is beyond the reach of a body. */
static bool is_beyond(const struct others_fish *to, double x, double y, double radius) {
    const double dx = x - to->middle[0], dy = y - to->middle[1], least = to->reach + radius;
    return dx * dx + dy * dy > least * least;
}

/* Whether every source of a group is far: the errors of the polynomial, of the gradient in place of the kernel, and for
 * wakes of the parabola in time. Source and body may approach in an interval, and the body is bent. */
static bool is_far(const struct others_fish *to, double interval, const struct kernel_pair *pair,
                   const struct group *group, bool is_wake, double tolerance) {
    const double chord = to->at_event.chord, step = interval * (to->at_event.speed + group->speed);
    if (is_beyond(to, group->x, group->y, group->radius)) return true;
    double sum = -2 * (to->at_event.bend + step + group->radius);
    for (int k = 0; k < 2; k++) {
        const double r[2] = {group->x - to->end[k][0], group->y - to->end[k][1]};
        sum += sqrt(r[0] * r[0] + r[1] * r[1]);
    }
    if (!(sum > chord)) return false;
    const double distance = (sum - chord) / 2, r2 = distance * distance, axis = sum / chord;
    const double low = pair->factor * (to->half[0] + group->half) + group->leg;
    const double size = pair->kernel->bound(pair, r2, low, group->q, group->d, chord);
    const double part = step / distance, in_time = is_wake ? 0.05 * part * part * part : 0;
    return size * (polynomial_error(axis) + to->aside * to->aside / r2 + in_time) <= tolerance;
}

// add source i to the near sources, to a new range (begins) or to the last one; beyond the capacity only count
static void near_add(struct others_fish *of, int i, bool begins) {
    if (begins && of->n_near < of->near_capacity) of->near[of->n_near] = (struct range){i, 0};
    of->n_near += begins;
    if (of->n_near <= of->near_capacity) of->near[of->n_near - 1].n++;
}

// body and wake of a fish at the event
static void remember_fish(struct flow *flow, const struct state *state, int f) {
    const struct fish *const fish = &flow->school->fish[f];
    struct others_fish *const of = &flow->others->fish[f];
    const double *const y = flow->others->past, *const x = y + fish->at.x, *const aside = y + fish->at.y;
    const int last = fish->n_nodes - 1;
    struct others_body *const at = &of->at_event;
    *at = (struct others_body){.half = of->half[0], .n = flow->fish[f].body.n};
    memcpy(of->end, (const double[2][2]){{x[0], aside[0]}, {x[last], aside[last]}}, sizeof of->end);
    const double along[2] = {x[last] - x[0], aside[last] - aside[0]};
    of->middle[0] = (x[0] + x[last]) / 2;
    of->middle[1] = (aside[0] + aside[last]) / 2;
    at->chord = hypot(along[0], along[1]);
    for (int k = 0; k <= last; k++) {
        const double r[2] = {x[k] - x[0], aside[k] - aside[0]};
        at->bend = fmax(at->bend, fabs(r[0] * along[1] - r[1] * along[0]) / at->chord);
        at->speed = fmax(at->speed, hypot(y[fish->at.vx + k], y[fish->at.vy + k]));
    }

    // as sources
    const struct sources *const body = &flow->fish[f].body;
    const struct sheet_points *const wake = &flow->fish[f].wake.middles;
    of->around = group_of(flow->others, f, body, (struct range){0, body->n}, NULL, NULL);
    for (int c = 0; c < body->n; c++) {
        at->q += fabs(body->q[c]);
        at->d += sqrt(body->dx[c] * body->dx[c] + body->dy[c] * body->dy[c]);
    }
    for (int k = 0; k < of->n_groups; k++) {
        const int first = k * GROUP, left = wake->n_released - first;
        const struct range which = {first, left < GROUP ? left : GROUP};
        of->group[k] = group_of(flow->others, f, &wake->sources, which, wake, &state->wake[f]);
    }
    of->whole = (struct range){0, wake->n_released};
    of->radius = 0;
    for (int k = 0; k <= of->n_groups; k++) {
        const struct group *const group = k < of->n_groups ? &of->group[k] : &of->around;
        of->radius = fmax(of->radius, hypot(group->x - of->middle[0], group->y - of->middle[1]) + group->radius);
    }
    of->reach = INFINITY;
    if (!of->is_used) return;

    const int slices[] = {fish->at.x, fish->at.y, fish->at.vx, fish->at.vy, fish->at.ax, fish->at.ay};
    double *const to[] = {of->start[0],    of->start[1],        of->velocity[0],
                          of->velocity[1], of->acceleration[0], of->acceleration[1]};
    for (int i = 0; i < 6; i++) wide_product(FAR, fish->n_nodes, of->from_nodes, y + slices[i], to[i]);

    // the points that the body has at the event
    of->aside = 3e-4 * fish->length; /* displacements within an interval */
    for (int p = 0; p < flow->points[f].n; p++) {
        double r[2] = {flow->x[flow->points[f].first + p], flow->y[flow->points[f].first + p]};
        for (int i = 0; i < FAR; i++) {
            const double part = of->to_points[i * flow->points[f].n + p];
            r[0] -= part * of->start[0][i];
            r[1] -= part * of->start[1][i];
        }
        of->aside = fmax(of->aside, hypot(r[0], r[1]));
        if (p < fish->n_control) at->beside = fmax(at->beside, hypot(r[0], r[1]));
    }
}

/* Whether a body (from) acts on another one from its far points. A polynomial of the velocity along the source, with
 * the ellipse around its body, gives the strengths at the far points; the points of the body may lie beside their
 * curve. least: sum of the distances of the other body from both ends, m. */
static bool act_few(const struct others_body *from, const struct others_body *to, double least, double interval,
                    const struct kernel_pair *pair, double tolerance) {
    const double moved = from->bend + interval * (to->speed + from->speed);
    const double axis = (least - 2 * moved) / from->chord, distance = (axis - 1) * from->chord / 2;
    if (!(distance > 0)) return false;
    const double low = pair->factor * (to->half + from->half);
    const double size = pair->kernel->bound(pair, distance * distance, low, from->q, from->d, from->chord);
    const double error = size * (polynomial_error(axis) + 2 * from->beside / distance);
    return error <= tolerance * sqrt(from->n);
}

/* Whether a body has strengths at its far points. */
static bool has_few(const struct flow *flow, int g) {
    return flow->others->fish[g].is_used && flow->school->fish[g].integrals;
}

static bool acts_from_few(const struct flow *flow, int f, int g, double tolerance) {
    const struct others_fish *const from = &flow->others->fish[g], *const to = &flow->others->fish[f];
    double least = INFINITY;
    for (int i = 0; i < FAR; i++) {
        double sum = 0;
        for (int k = 0; k < 2; k++) {
            const double r[2] = {to->start[0][i] - from->end[k][0], to->start[1][i] - from->end[k][1]};
            sum += sqrt(r[0] * r[0] + r[1] * r[1]);
        }
        least = fmin(least, sum);
    }
    const struct kernel_pair pair = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
    return act_few(&from->at_event, &to->at_event, least, flow->school->interval, &pair, tolerance);
}

/* The widest pair, the strongest source and the largest body of all: every bound of an error is below theirs. */
static void find_strongest(struct flow *flow) {
    struct others *const others = flow->others;
    struct group *const most = &others->strongest;
    struct others_body *const largest = &others->largest;
    others->widest = flow_pair_of(flow, 0, 0, &(struct flow_sum){BODY_AT_BODY, false});
    others->widest.square = 0;
    *most = (struct group){.half = INFINITY, .leg = INFINITY};
    *largest = (struct others_body){.half = INFINITY, .n = INT_MAX};
    for (int g = 0; g < others->n_fish; g++) {
        const struct others_fish *const of = &others->fish[g];
        const struct others_body *const body = &of->at_event;
        const struct kernel_pair pair = flow_pair_of(flow, 0, g, &(struct flow_sum){BODY_AT_BODY, false});
        others->widest.span = fmax(others->widest.span, pair.span);
        for (int k = 0; k <= of->n_groups; k++) {
            const struct group *const group = k < of->n_groups ? &of->group[k] : &of->around;
            most->q = fmax(most->q, group->q);
            most->d = fmax(most->d, group->d);
            most->speed = fmax(most->speed, group->speed);
            most->half = fmin(most->half, group->half);
            most->leg = fmin(most->leg, group->leg);
        }
        if (!has_few(flow, g)) continue;
        largest->chord = fmax(largest->chord, body->chord);
        largest->bend = fmax(largest->bend, body->bend);
        largest->beside = fmax(largest->beside, body->beside);
        largest->speed = fmax(largest->speed, body->speed);
        largest->q = fmax(largest->q, body->q);
        largest->d = fmax(largest->d, body->d);
        largest->half = fmin(largest->half, body->half);
        largest->n = body->n < largest->n ? body->n : largest->n;
    }
}

/* The reach of a body, for the strongest source and the largest body on the line through its ends, where a source is
 * nearest to both: errors fall with the distance, which grows by a tenth until they are below the tolerance. */
static double reach_of(const struct flow *flow, int f, double tolerance) {
    const struct others *const others = flow->others;
    const struct others_fish *const to = &others->fish[f];
    const struct others_body *const at = &to->at_event;
    const double interval = flow->school->interval;
    struct group source = others->strongest;
    for (double reach = at->chord; reach < 1e4 * at->chord; reach *= 1.1) {
        source.x = to->middle[0] + reach * (to->end[1][0] - to->end[0][0]) / at->chord;
        source.y = to->middle[1] + reach * (to->end[1][1] - to->end[0][1]) / at->chord;
        const double least = 2 * (reach - at->chord / 2 - at->bend);
        if (is_far(to, interval, &others->widest, &source, true, tolerance) &&
            act_few(&others->largest, at, least, interval, &others->widest, tolerance)) {
            return 1.001 * reach; /* a margin for rounding */
        }
    }
    return INFINITY;
}

static void select_at(struct flow *flow, const struct state *state, int f, double n_sources) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const struct fish *const fish = &school->fish[f];
    struct others_fish *const of = &others->fish[f];
    const double tolerance = school->wake_tolerance * fish->length * fish_rate(school, fish) / (4 * sqrt(n_sources));
    const double interval = school->interval;
    int *next = &of->first;
    of->n_near = 0;
    of->reach = of->is_used ? reach_of(flow, f, tolerance) : INFINITY;
    for (int g = 0; g < school->n_fish; g++) {
        struct others_pair *const pair = &others->pair[(size_t)f * (size_t)others->n_fish + (size_t)g];
        const struct others_fish *const from = &others->fish[g];
        const struct sheet_points *const wake = &flow->fish[g].wake.middles;
        const struct sources *const body = &flow->fish[g].body;
        if (has_few(flow, g) && is_beyond(of, from->middle[0], from->middle[1], from->radius)) {
            *pair = (struct others_pair){.is_far_body = true, .by_few = true};
            continue;
        }
        *next = g;
        next = &pair->next;
        *pair = (struct others_pair){.first_near = of->n_near};
        if (g == f) continue;

        // runs of near sources in the wake
        const struct kernel_pair of_wake = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        bool was_near = false;
        for (int k = 0; k < from->n_groups; k++) {
            const struct range which = from->group[k].sources;
            const bool are_far = of->is_used && is_far(of, interval, &of_wake, &from->group[k], true, tolerance);
            if (are_far) was_near = false;
            for (int i = which.first; i < which.first + which.n && !are_far; i++) {
                const struct group one =
                    group_of(others, g, &wake->sources, (struct range){i, 1}, wake, &state->wake[g]);
                const bool near = !of->is_used || !is_far(of, interval, &of_wake, &one, true, tolerance);
                if (near) near_add(of, i, !was_near);
                was_near = near;
            }
        }
        pair->n_near = of->n_near - pair->first_near;

        // the body, with the nascent point
        const struct kernel_pair of_body = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
        pair->is_far_body = of->is_used && !was_near;
        if (pair->is_far_body && !is_far(of, interval, &of_body, &from->around, false, tolerance)) {
            for (int c = 0; c < body->n && pair->is_far_body; c++) {
                const struct group one = group_of(others, g, body, (struct range){c, 1}, NULL, NULL);
                pair->is_far_body = is_far(of, interval, &of_body, &one, false, tolerance);
            }
        }
        pair->by_few = pair->is_far_body && has_few(flow, g) && acts_from_few(flow, f, g, tolerance);
    }
    *next = school->n_fish;
}

// far points as targets, with an array of n_values for each sum
static struct targets far_targets(int n, const double *x, const double *y, const double *half, double *value,
                                  int n_values) {
    double *sum[VALUES];
    for (int k = 0; k < VALUES; k++) sum[k] = value + (long)k * n_values;
    struct targets at = kernel_targets(n, x, y, sum);
    at.half = half;
    return at;
}

// the far points on the path of the event, tau later
static void far_places(const struct others_fish *of, double tau, double *x, double *y) {
    for (int i = 0; i < FAR; i++) {
        x[i] = of->start[0][i] + tau * (of->velocity[0][i] + tau / 2 * of->acceleration[0][i]);
        y[i] = of->start[1][i] + tau * (of->velocity[1][i] + tau / 2 * of->acceleration[1][i]);
    }
}

/* Whether the body of fish g is in the sum of bodies by the tree. */
static bool acts_by_tree(const struct flow *flow, int g) {
    return !flow->others->fish[g].has_drifted && flow->school->fish[g].integrals;
}

// add sources of all fish at the far points of all fish, class by class: the released wakes; or the bodies, from their
// far points, with their nascent points
static void sum_by_tree(struct flow *flow, bool of_bodies, int threads) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    for (int c = 0; c < flow->n_classes; c++) {
        struct sources *const points = &others->points, *const many = &flow->many;
        int n = 0, first = 0;
        for (int f = 0; f < school->n_fish; f++) n += flow->class_of[f] == c && others->fish[f].is_used ? FAR : 0;
        points->n = 0;
        sources_append(points, n);
        n = 0;
        for (int f = 0; f < school->n_fish; f++) {
            const struct others_fish *const of = &others->fish[f];
            if (flow->class_of[f] != c || !of->is_used) continue;
            if (n == 0) first = f;
            memcpy(points->x + n, of->x, sizeof of->x);
            memcpy(points->y + n, of->y, sizeof of->y);
            memcpy(points->half + n, of->half, sizeof of->half);
            n += FAR;
        }
        if (n == 0) continue;

        // an eighth of wake.tolerance for each sum
        const struct fish *const fish = &school->fish[first];
        const double tolerance =
            school->wake_tolerance * fish->length * fish_rate(school, fish) / (8 * flow->n_classes);
        const struct targets at = far_targets(n, points->x, points->y, points->half, others->value, n);
        memset(others->value, 0, VALUES * (size_t)n * sizeof *others->value);
        for (int k = 0; k < (1 + of_bodies) * flow->n_classes; k++) {
            struct kernel_pair pair = {0};
            const bool is_body = k >= flow->n_classes;
            many->n = 0;
            for (int g = 0; g < school->n_fish; g++) {
                if (flow->class_of[g] != k % flow->n_classes) continue;
                const struct sheet_points *const middles = &flow->fish[g].wake.middles;
                pair = flow_pair_of(flow, first, g, &(struct flow_sum){is_body ? BODY_AT_BODY : WAKE_AT_BODY, false});
                if (of_bodies && !acts_by_tree(flow, g)) continue;
                if (is_body) {
                    flow_append_with_span(many, &others->fish[g].body, (struct range){0, FAR}, pair.span);
                } else {
                    const struct range nascent = {middles->n_released, 1};
                    const struct range released = {0, middles->n_released};
                    flow_append_with_span(many, &middles->sources, of_bodies ? nascent : released, pair.span);
                }
            }
            pair.span = 1;
            tree_induce(flow->tree, &pair, many, fish->length, tolerance, threads, &at);
        }

        int done = 0;
        for (int f = 0; f < school->n_fish; f++) {
            struct others_fish *const of = &others->fish[f];
            if (flow->class_of[f] != c || !of->is_used) continue;
            for (int k = 0; k < VALUES; k++) {
                for (int i = 0; i < FAR; i++) of->now[k][i] += others->value[(long)k * n + done + i];
            }
            done += FAR;
        }
    }
}

// add the far wakes: the far sources; or, after sum_by_tree, less the near and own sources
static void sum_wakes(struct flow *flow, int f) {
    struct others *const others = flow->others;
    struct others_fish *const of = &others->fish[f];
    if (!of->is_used) return;

    const double *const half = flow->kernel->has_legs ? of->half : NULL;
    const struct targets at = far_targets(FAR, of->x, of->y, half, of->now[0], FAR);
    for (int g = others_next(flow, f, -1, !others->is_by_tree); g < others->n_fish;
         g = others_next(flow, f, g, !others->is_by_tree)) {
        const struct sources *const sources = &flow->fish[g].wake.middles.sources;
        const struct others_pair *const near = &others->pair[(size_t)f * (size_t)others->n_fish + (size_t)g];
        const struct range *const range = of->near + near->first_near;
        struct kernel_pair pair = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        if (others->is_by_tree) {
            pair.span = -pair.span;
            if (g == f) kernel_induce(&pair, sources, others->fish[g].whole, &at);
            for (int i = 0; i < near->n_near; i++) kernel_induce(&pair, sources, range[i], &at);
            continue;
        }

        for (int i = 0, first = 0; i <= near->n_near && g != f; i++) {
            const int end = i < near->n_near ? range[i].first : others->fish[g].whole.n;
            kernel_induce(&pair, sources, (struct range){first, end - first}, &at);
            first = i < near->n_near ? end + range[i].n : end;
        }
    }
}

void others_select(struct flow *flow, const struct state *state) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const unsigned long version = state_wake_version(state, school);
    const size_t size = (size_t)school->n_unknowns * sizeof *others->past;
    int n_vortices = 0;
    for (int f = 0; f < school->n_fish; f++) n_vortices += state->wake[f].n_vortex;
    if (!(school->wake_tolerance > 0) || flow->is_steady || state->n_past == 0 || school->n_fish == 1 ||
        n_vortices < flow->kernel->far_sources) {
        others->is_selected = false;
        return;
    }
    if (others->is_selected && others->t == state->t && others->version == version &&
        memcmp(others->past, state->past, size) == 0) {
        return;
    }

    others->is_selected = true;
    others->t = state->t;
    others->version = version;
    memcpy(others->past, state->past, size);
    flow_place(flow, state, state->t, others->past);
    double n_sources = 1;
    for (int f = 0; f < school->n_fish; f++) {
        struct others_fish *const of = &others->fish[f];
        n_sources += flow->fish[f].wake.middles.n_released + flow->fish[f].body.n;
        of->n_groups = (flow->fish[f].wake.middles.n_released + GROUP - 1) / GROUP;
        if (of->n_groups <= of->group_capacity) continue;
        of->group_capacity = 2 * of->n_groups;
        GROW(others->arena, of->group, of->group_capacity);
    }

    // no parallel region requests memory: select again where the ranges are more than the memory has room for
    const int sharing = parallel_threads(school->threads, school->n_fish, n_sources, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(sharing) schedule(static)
    for (int f = 0; f < school->n_fish; f++) remember_fish(flow, state, f);
    find_strongest(flow);
#pragma omp parallel for num_threads(sharing) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) select_at(flow, state, f, n_sources);
    for (int f = 0; f < school->n_fish; f++) {
        struct others_fish *const of = &others->fish[f];
        if (of->n_near <= of->near_capacity) continue;
        of->near_capacity = 2 * of->n_near;
        GROW(others->arena, of->near, of->near_capacity);
        select_at(flow, state, f, n_sources);
    }
    others->is_by_tree =
        tree_is_faster(flow->kernel, (int)n_sources, 2 * FAR * school->n_fish * n_sources, school->wake_tolerance);

    const int threads =
        parallel_threads(school->threads, school->n_fish, n_sources * school->n_fish * FAR, PARALLEL_INTERACTIONS);
    for (int time = 0; time < TIMES; time++) {
        const double tau = time * school->interval / 2;
        flow_place_released(flow, state, state->t + tau);
        for (int f = 0; f < school->n_fish; f++) {
            struct others_fish *const of = &others->fish[f];
            far_places(of, tau, of->x, of->y);
            memset(of->now, 0, sizeof of->now);
        }
        if (others->is_by_tree) sum_by_tree(flow, false, school->threads);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int f = 0; f < school->n_fish; f++) {
            sum_wakes(flow, f);
            memcpy(others->fish[f].wake[time], others->fish[f].now, sizeof others->fish[f].now);
        }
    }
}

// ---- sums

int others_next(const struct flow *flow, int f, int g, bool is_every) {
    const struct others *const others = flow->others;
    if (is_every || others->have_drifted) return g + 1;
    return g < 0 ? others->fish[f].first : others->pair[(size_t)f * (size_t)others->n_fish + (size_t)g].next;
}

struct others_near others_near(const struct flow *flow, int f, int g) {
    const struct others *const others = flow->others;
    const struct others_pair *const pair = &others->pair[(size_t)f * (size_t)others->n_fish + (size_t)g];
    const bool has_drifted = others->fish[f].has_drifted;
    const bool is_far_body = pair->is_far_body && !has_drifted && !others->fish[g].has_drifted;
    return (struct others_near){.body = {0, is_far_body ? 0 : flow->fish[g].body.n},
                                .wake = has_drifted ? &others->fish[g].whole : others->fish[f].near + pair->first_near,
                                .n_wake = has_drifted ? 1 : pair->n_near};
}

void others_sum(struct flow *flow, const struct state *state, const double *y, int threads) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const double tau = flow->t - state->t, s = tau / school->interval;
    const double weight[TIMES] = {(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)};

    // far points, whether a body is elsewhere, and the strengths of the body at its far points
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct others_fish *const of = &others->fish[f];
        of->has_drifted = !of->is_used;
        if (!of->is_used) continue;
        wide_product(FAR, fish->n_nodes, of->from_nodes, y + fish->at.x, of->x);
        wide_product(FAR, fish->n_nodes, of->from_nodes, y + fish->at.y, of->y);
        double place[2][FAR];
        far_places(of, tau, place[0], place[1]);
        for (int i = 0; i < FAR; i++) {
            const double dx = of->x[i] - place[0][i], dy = of->y[i] - place[1][i];
            of->has_drifted =
                of->has_drifted || !(dx * dx + dy * dy <= most_drift * most_drift * fish->length * fish->length);
        }

        const struct sources *const body = &flow->fish[f].body;
        if (of->has_drifted || !fish->integrals) continue;
        for (int i = 0; i < FAR; i++) {
            const double *const part = of->to_points + (long)i * flow->points[f].n;
            double q = 0, dx = 0, dy = 0;
            for (int c = 0; c < body->n; c++) {
                q += part[c] * body->q[c];
                dx += part[c] * body->dx[c];
                dy += part[c] * body->dy[c];
            }
            of->body.x[i] = of->x[i];
            of->body.y[i] = of->y[i];
            of->body.q[i] = q;
            of->body.dx[i] = dx;
            of->body.dy[i] = dy;
        }
    }

    others->have_drifted = false;
    for (int f = 0; f < school->n_fish; f++) {
        others->have_drifted = others->have_drifted || others->fish[f].has_drifted;
    }

    const int n_far = FAR * school->n_fish;
    others->bodies_by_tree = tree_is_faster(flow->kernel, n_far, (double)n_far * n_far, school->wake_tolerance);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        struct others_fish *const of = &others->fish[f];
        memset(of->now, 0, sizeof of->now);
        if (of->has_drifted) continue;

        // the parabola of the far wakes, and the gradient times the displacement
        for (int k = 0; k < VALUES; k++) {
            for (int i = 0; i < FAR; i++) {
                of->now[k][i] =
                    weight[0] * of->wake[0][k][i] + weight[1] * of->wake[1][k][i] + weight[2] * of->wake[2][k][i];
            }
        }
        double place[2][FAR];
        far_places(of, tau, place[0], place[1]);
        for (int i = 0; i < FAR; i++) {
            const double dx = of->x[i] - place[0][i], dy = of->y[i] - place[1][i];
            const double v_y = of->now[2][i] - of->now[3][i];
            of->now[0][i] += of->now[3][i] * dx + of->now[4][i] * dy;
            of->now[1][i] += of->now[5][i] * dx + v_y * dy;
            of->now[2][i] += of->now[6][i] * dx + of->now[7][i] * dy;
        }

        // far bodies; -1: subtract what the sum by the tree includes
        const double *const half = flow->kernel->has_legs ? of->half : NULL;
        const struct targets at = far_targets(FAR, of->x, of->y, half, of->now[0], FAR);
        const bool is_every = !others->bodies_by_tree;
        for (int g = others_next(flow, f, -1, is_every); g < school->n_fish; g = others_next(flow, f, g, is_every)) {
            const struct others_pair *const pair = &others->pair[(size_t)f * (size_t)others->n_fish + (size_t)g];
            const bool is_far = pair->is_far_body && !others->fish[g].has_drifted;
            const bool is_in_tree = others->bodies_by_tree && acts_by_tree(flow, g);
            const int by_few = (is_far && pair->by_few) - is_in_tree, by_all = is_far && !pair->by_few;
            if (!by_few && !by_all && is_far == is_in_tree) continue;
            const struct flow_fish *const other = &flow->fish[g];
            struct kernel_pair body = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
            struct kernel_pair wake = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
            if (by_all) kernel_induce(&body, &other->body, (struct range){0, other->body.n}, &at);
            body.span *= by_few;
            wake.span *= is_far - is_in_tree;
            if (by_few) kernel_induce(&body, &others->fish[g].body, (struct range){0, FAR}, &at);
            const struct range nascent = {other->wake.middles.n_released, is_far != is_in_tree};
            kernel_induce(&wake, &other->wake.middles.sources, nascent, &at);
        }
    }
    if (others->bodies_by_tree) sum_by_tree(flow, true, threads);
}

// values of the polynomials with these values at the far points, at n <= FAR points; part: of each far point at the
// points (FAR, stride)
static WIDE(void, at_points, (int n, const double *part, int stride, const double from[FAR], double *restrict to),
            (n, part, stride, from, to)) {
    memset(to, 0, FAR * sizeof *to);
    for (int i = 0; i < FAR; i++) {
        for (int p = 0; p < n; p++) to[p] += part[(long)i * stride + p] * from[i];
    }
}

void others_add(const struct flow *flow, int f, struct range which, const struct targets *at) {
    const struct others_fish *const of = &flow->others->fish[f];
    const int stride = flow->points[f].n, first = which.first - flow->points[f].first;
    for (int begin = 0; begin < which.n && !of->has_drifted; begin += FAR) {
        const int n = which.n - begin < FAR ? which.n - begin : FAR;
        const double *const part = of->to_points + first + begin;
        double value[VALUES][FAR], x[FAR], y[FAR];
        for (int k = 0; k < VALUES; k++) at_points(n, part, stride, of->now[k], value[k]);
        at_points(n, part, stride, of->x, x);
        at_points(n, part, stride, of->y, y);

        for (int p = 0; p < n; p++) {
            // the point beside the curve of the far points
            const int to = begin + p;
            const double dx = at->x[to] - x[p], dy = at->y[to] - y[p];
            const double v_y = value[2][p] - value[3][p];
            at->u[to] += value[0][p] + value[3][p] * dx + value[4][p] * dy;
            at->v[to] += value[1][p] + value[5][p] * dx + v_y * dy;
            if (flow->kernel->has_legs) at->div[to] += value[2][p] + value[6][p] * dx + value[7][p] * dy;
            if (!at->u_x) continue;
            at->u_x[to] += value[3][p];
            at->u_y[to] += value[4][p];
            at->v_x[to] += value[5][p];
            if (!flow->kernel->has_legs) continue;
            at->div_x[to] += value[6][p];
            at->div_y[to] += value[7][p];
        }
    }
}
