/* others.c: far points with their polynomials, a bound for every group of sources that says whether it is near, and the
 * sums over far wakes and far bodies. */
#include "flow/others.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "flow/flow.h"

enum { FAR = KERNEL_BLOCK };

/* The times of an interval at which far wakes are summed. */
enum { START, MIDDLE, END, TIMES };

/* A body that has moved by more than this from the path of its last event, in lengths, has left it. */
static const double most_drift = 4e-3;

/* What far sources cause at the far points of a fish. */
struct far_field {
    double u[FAR], v[FAR], div[FAR];                             /* m s-1; s-1 */
    double u_x[FAR], u_y[FAR], v_x[FAR], div_x[FAR], div_y[FAR]; /* s-1; m-1 s-1 */
};

/* Neighbouring sources: a circle around them, and bounds of their strengths, half spans, legs and speeds. A group ends
 * after GROUP sources, or where it would extend over more than this part of the length of the fish. */
enum { GROUP = 8 };
static const double group_extent = 0.1;
struct group {
    struct range sources;
    double x, y, radius, q, d, half, leg, speed;
};

/* So many groups of a wake form a bundle: if it is far, all of them are. */
enum { BUNDLE = 8 };

/* What the bounds need to know about a body at the event: the distance of its ends; how far the body is from its chord,
 * and its sources from the curve of the far points; the largest speed of a node, m s-1; the sums of the sizes of its
 * strengths; the half span; and its number of sources. */
struct body_at_event {
    double chord, bend, beside, speed, q, d, half;
    int n;
};

struct others_fish {
    double *to_points;    /* values of the polynomials of the far points at the points of the fish (FAR, n_points) */
    double *from_sources; /* the same at the sources of the body                                (FAR, body sources) */
    double *from_nodes;   /* positions of the far points by nodes                              (n_nodes, FAR) */
    double half[FAR];
    /* at the event: position, velocity and acceleration of the far points */
    double start[2][FAR], velocity[2][FAR], acceleration[2][FAR];
    /* at the event: ends of the body, their middle, the distance of all points from the curve of the far points */
    double end[2][2], middle[2], aside;
    struct body_at_event at_event;
    double radius; /* of the circle around the middle that encloses body and released wake */
    double reach;  /* beyond this distance from the middle even the strongest source and the largest body are far */
    int n_released, n_body_groups, n_groups, group_capacity;
    struct group *group;  /* of the body, then of the released wake                              (n_groups) */
    struct group *bundle; /* of the released wake; `sources` says which groups                  (n_bundles) */
    int n_bundles;
    int n_near, near_capacity;
    struct near_sources *near;    /*                                                            (n_near) */
    struct far_field wake[TIMES]; /* of the far wakes; before the end only if the interval has a path */
    /* at the time of a sum: the far points, the field of all far sources, and the body by sources at its far points */
    double x[FAR], y[FAR];
    struct far_field field;
    struct sources body; /* (FAR) */
    bool has_drifted;
};

struct others {
    struct arena *arena;
    bool are_possible; /* every fish has enough nodes and one depth */
    int n_fish;
    struct others_fish *fish;  /*                                  (n_fish) */
    struct kernel_pair widest; /* bounds of all pairs, groups and bodies */
    struct group strongest;
    struct body_at_event largest;
    bool is_selected, have_drifted;
    bool has_path;         /* whether the far wakes of this interval are known at START and MIDDLE, too */
    struct sources points; /* far points of a class, for the tree */
    double *value;         /* sums at these points                 (KERNEL_SUMS, FAR n_fish) */
    double n_sources;      /* of all wakes and bodies at the event */
    double t;
    unsigned long version;
    double *past; /* unknowns at the event                         (n_unknowns) */
};

static void field_list(struct far_field *field, double *sum[KERNEL_SUMS]) {
    sum[KERNEL_U] = field->u;
    sum[KERNEL_V] = field->v;
    sum[KERNEL_DIV] = field->div;
    sum[KERNEL_U_X] = field->u_x;
    sum[KERNEL_U_Y] = field->u_y;
    sum[KERNEL_V_X] = field->v_x;
    sum[KERNEL_DIV_X] = field->div_x;
    sum[KERNEL_DIV_Y] = field->div_y;
}

// ---- far points

// the parameter of a place between the nodes, -1 at the first node and 1 at the last one
static double place_of(const struct stencil *place, int n_nodes) {
    double u = 0;
    for (int k = 0; k < place->n; k++) u += place->weight[k] * place->node[k];
    return 2 * u / (n_nodes - 1) - 1;
}

// the polynomials that are 1 at one of the far points and 0 at the others, at n places: (FAR, n)
static void polynomials_at(int n, const double *place, double *value) {
    for (int i = 0; i < FAR; i++) {
        const double node = M_PI * (2 * i + 1) / (2 * FAR);
        for (int p = 0; p < n; p++) {
            const double angle = acos(fmax(-1, fmin(1, place[p])));
            double sum = 0;
            for (int k = 0; k < FAR; k++) sum += (k == 0 ? 1.0 : 2.0) / FAR * cos(k * node) * cos(k * angle);
            value[i * n + p] = sum;
        }
    }
}

// far points on the smooth curve through n nodes
static void set_from_nodes(struct arena *arena, int n, double *from_nodes) {
    double *factor;
    NEW(arena, factor, n);
    curve_smooth_factors(n, factor);
    for (int i = 0; i < FAR; i++) {
        const double u = (n - 1) * (1 + cos(M_PI * (2 * i + 1) / (2 * FAR))) / 2;
        double sum = 0;
        for (int k = 0; k < n; k++) {
            from_nodes[k * FAR + i] = fabs(u - k) < 1e-12 ? 1e30 : factor[k] / (u - k);
            sum += from_nodes[k * FAR + i];
        }
        for (int k = 0; k < n; k++) from_nodes[k * FAR + i] /= sum;
    }
}

static void create_fish(struct arena *arena, const struct fish *fish, struct others_fish *of) {
    const int n = fish->n_nodes, n_points = flow_n_points(fish);
    const int n_sources = fish->integrals ? fish->n_control : fish->n_sheet;
    double *place;
    NEW(arena, place, n_points + n_sources);
    for (int p = 0; p < n_points; p++) {
        place[p] =
            p < fish->n_control ? place_of(&fish->control_point[p], n) : 2 * (p - fish->n_control + 0.5) / (n - 1) - 1;
    }
    place[n_points - 1] = 1;
    for (int c = 0; c < n_sources; c++) {
        place[n_points + c] = place_of(fish->integrals ? &fish->control_point[c] : &fish->sheet_point[c], n);
    }

    NEW(arena, of->to_points, FAR * n_points);
    NEW(arena, of->from_sources, FAR * n_sources);
    NEW(arena, of->from_nodes, n * FAR);
    polynomials_at(n_points, place, of->to_points);
    polynomials_at(n_sources, place + n_points, of->from_sources);
    set_from_nodes(arena, n, of->from_nodes);
}

struct others *others_create(struct arena *arena, const struct flow *flow) {
    const struct school *const school = flow->school;
    struct others *others;
    NEW(arena, others, 1);
    others->arena = others->points.arena = arena;
    others->n_fish = school->n_fish;
    others->are_possible = school->n_fish > 1;
    for (int f = 0; f < school->n_fish; f++) {
        others->are_possible &= school->fish[f].n_nodes >= 4 && !school->fish[f].depth_varies;
    }
    if (!others->are_possible) return others;

    NEW(arena, others->fish, school->n_fish);
    NEW(arena, others->past, school->n_unknowns);
    NEW(arena, others->value, KERNEL_SUMS * FAR * school->n_fish);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct others_fish *const of = &others->fish[f];
        of->body.arena = arena;
        sources_append(&of->body, FAR);
        for (int i = 0; i < FAR; i++) of->half[i] = of->body.half[i] = fish->point_half ? fish->point_half[0] : 0;

        // fish with the same points share the matrices
        if (f > 0 && fish->control_point == fish[-1].control_point && fish->sheet_point == fish[-1].sheet_point) {
            of->to_points = of[-1].to_points;
            of->from_sources = of[-1].from_sources;
            of->from_nodes = of[-1].from_nodes;
        } else {
            create_fish(arena, fish, of);
        }
    }
    return others;
}

bool others_are_selected(const struct flow *flow) {
    return flow->others->is_selected && !flow->others->have_drifted;
}

const struct near_sources *others_near(const struct flow *flow, int f, int *n) {
    const struct others_fish *const of = &flow->others->fish[f];
    *n = of->n_near;
    return of->near;
}

// ---- bounds

/* How large the error of the polynomial between the FAR points of a body is, over the value: 2 rho^-FAR, where FAR is a
 * power of two. The smallest ellipse around the other place with foci at both ends of the body has this axis, (rho +
 * 1/rho)/2, over the distance of the foci. */
static double polynomial_error(double axis) {
    double power = axis + sqrt(axis * axis - 1);
    for (int k = FAR; k > 1; k /= 2) power *= power;
    return 2 / power;
}

/* Whether every source of a group is far. Three errors have to be small: of the polynomial, of the gradient that
 * replaces the kernel, and for wakes of the parabola in time. The bounds allow for source and body to approach in an
 * interval, and for the bend of the body. */
static bool is_far(const struct others_fish *to, double interval, const struct kernel_pair *pair,
                   const struct group *group, bool is_wake, double tolerance) {
    const double chord = to->at_event.chord, step = interval * (to->at_event.speed + group->speed);
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

/* Whether a body (from) may act on another one from its far points. A polynomial of the velocity along the source, with
 * the ellipse around its body, gives the strengths at the far points; the sources of the body may lie beside their
 * curve. least: the smallest sum of the distances of the other body from both ends, m. */
static bool acts_from_far_points(const struct body_at_event *from, const struct body_at_event *to, double least,
                                 double interval, const struct kernel_pair *pair, double tolerance) {
    const double moved = from->bend + interval * (to->speed + from->speed);
    const double axis = (least - 2 * moved) / from->chord, distance = (axis - 1) * from->chord / 2;
    if (!(distance > 0)) return false;
    const double low = pair->factor * (to->half + from->half);
    const double size = pair->kernel->bound(pair, distance * distance, low, from->q, from->d, from->chord);
    const double error = size * (polynomial_error(axis) + 2 * from->beside / distance);
    return error <= tolerance * sqrt(from->n);
}

/* The smallest sum of the distances of the far points of one body from both ends of another one. */
static double least_sum_of_distances(const struct others_fish *to, const struct others_fish *from) {
    double least = INFINITY;
    for (int i = 0; i < FAR; i++) {
        double sum = 0;
        for (int k = 0; k < 2; k++) {
            const double r[2] = {to->start[0][i] - from->end[k][0], to->start[1][i] - from->end[k][1]};
            sum += sqrt(r[0] * r[0] + r[1] * r[1]);
        }
        least = fmin(least, sum);
    }
    return least;
}

// ---- what is near

/* Let the bounds of a group, apart from its circle, include those of another one. */
static void include_bounds(struct group *group, const struct group *other) {
    group->q = fmax(group->q, other->q);
    group->d = fmax(group->d, other->d);
    group->speed = fmax(group->speed, other->speed);
    group->half = fmin(group->half, other->half);
    group->leg = fmin(group->leg, other->leg);
}

/* Add the groups of n sources in their order. They move with this speed or, with points, at the speed of the markers
 * that the points name if that is higher. */
static void add_groups(struct others_fish *of, const struct sources *sources, int n, double extent, double speed,
                       const struct sheet_points *points, const struct wake *wake) {
    for (int first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && end < first + GROUP; end++) {
            const double dx = sources->x[end] - sources->x[first], dy = sources->y[end] - sources->y[first];
            if (dx * dx + dy * dy > extent * extent) break;
        }

        struct group *const group = &of->group[of->n_groups++];
        *group = (struct group){.sources = {first, end - first}, .half = INFINITY, .leg = INFINITY, .speed = speed};
        group->x = (sources->x[first] + sources->x[end - 1]) / 2;
        group->y = (sources->y[first] + sources->y[end - 1]) / 2;
        double radius2 = 0, d2 = 0, speed2 = speed * speed;
        for (int i = first; i < end; i++) {
            const double dx = sources->x[i] - group->x, dy = sources->y[i] - group->y;
            const double size2 = sources->dx[i] * sources->dx[i] + sources->dy[i] * sources->dy[i];
            const double q = fabs(sources->q[i]);
            radius2 = dx * dx + dy * dy > radius2 ? dx * dx + dy * dy : radius2;
            d2 = size2 > d2 ? size2 : d2;
            group->q = q > group->q ? q : group->q;
            group->half = sources->half[i] < group->half ? sources->half[i] : group->half;
            group->leg = sources->leg[i] < group->leg ? sources->leg[i] : group->leg;
            if (!points) continue;
            const double u = wake->u[points->newer[i]], v = wake->v[points->newer[i]];
            speed2 = u * u + v * v > speed2 ? u * u + v * v : speed2;
        }
        group->radius = sqrt(radius2);
        group->d = sqrt(d2);
        group->speed = sqrt(speed2);
    }
}

/* Enclose the groups of the released wake in bundles. */
static void add_bundles(struct others_fish *of) {
    of->n_bundles = 0;
    for (int first = of->n_body_groups; first < of->n_groups; first += BUNDLE) {
        const int left = of->n_groups - first, n = left < BUNDLE ? left : BUNDLE;
        const struct group *const part = of->group + first;
        struct group *const bundle = &of->bundle[of->n_bundles++];
        *bundle = (struct group){.sources = {first, n}, .half = INFINITY, .leg = INFINITY};
        bundle->x = (part[0].x + part[n - 1].x) / 2;
        bundle->y = (part[0].y + part[n - 1].y) / 2;
        for (int k = 0; k < n; k++) {
            const double dx = part[k].x - bundle->x, dy = part[k].y - bundle->y;
            bundle->radius = fmax(bundle->radius, sqrt(dx * dx + dy * dy) + part[k].radius);
            include_bounds(bundle, &part[k]);
        }
    }
}

// body and wake of a fish at the event
static void remember_fish(struct flow *flow, const struct state *state, int f) {
    const struct fish *const fish = &flow->school->fish[f];
    struct others_fish *const of = &flow->others->fish[f];
    const double *const y = flow->others->past, *const x = y + fish->at.x, *const aside = y + fish->at.y;
    const int last = fish->n_nodes - 1;
    const struct sources *const body = &flow->fish[f].body;
    const struct sheet_points *const wake = &flow->fish[f].wake.middles;
    struct body_at_event *const at = &of->at_event;
    *at = (struct body_at_event){.half = of->half[0], .n = body->n};
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
    for (int c = 0; c < body->n; c++) {
        at->q += fabs(body->q[c]);
        at->d += sqrt(body->dx[c] * body->dx[c] + body->dy[c] * body->dy[c]);
    }

    // groups, and the circle around them
    const double extent = group_extent * fish->length;
    of->n_groups = 0;
    add_groups(of, body, body->n, extent, at->speed, NULL, NULL);
    of->n_body_groups = of->n_groups;
    of->n_released = wake->n_released;
    add_groups(of, &wake->sources, wake->n_released, extent, 0, wake, &state->wake[f]);
    add_bundles(of);
    of->radius = 0;
    for (int k = 0; k < of->n_groups; k++) {
        const double dx = of->group[k].x - of->middle[0], dy = of->group[k].y - of->middle[1];
        of->radius = fmax(of->radius, sqrt(dx * dx + dy * dy) + of->group[k].radius);
    }

    // the far points
    const int slices[] = {fish->at.x, fish->at.y, fish->at.vx, fish->at.vy, fish->at.ax, fish->at.ay};
    double *const to[] = {of->start[0],    of->start[1],        of->velocity[0],
                          of->velocity[1], of->acceleration[0], of->acceleration[1]};
    for (int i = 0; i < 6; i++) wide_product(FAR, fish->n_nodes, of->from_nodes, y + slices[i], to[i]);

    // how far points and sources are beside the curve of the far points
    const int n_points = flow->points[f].n;
    of->aside = 3e-4 * fish->length; /* displacements within an interval */
    for (int p = 0; p < n_points + body->n; p++) {
        const bool is_point = p < n_points;
        const int c = p - n_points, at_point = flow->points[f].first + p;
        const double *const part = is_point ? of->to_points + p : of->from_sources + c;
        double r[2] = {is_point ? flow->x[at_point] : body->x[c], is_point ? flow->y[at_point] : body->y[c]};
        for (int i = 0; i < FAR; i++) {
            r[0] -= part[i * (is_point ? n_points : body->n)] * of->start[0][i];
            r[1] -= part[i * (is_point ? n_points : body->n)] * of->start[1][i];
        }
        double *const most = is_point ? &of->aside : &at->beside;
        *most = fmax(*most, sqrt(r[0] * r[0] + r[1] * r[1]));
    }
}

/* The widest pair, the strongest source and the largest body of all: every bound of an error is below theirs. */
static void find_strongest(struct flow *flow) {
    struct others *const others = flow->others;
    struct group *const most = &others->strongest;
    struct body_at_event *const largest = &others->largest;
    others->widest = flow_pair_of(flow, 0, 0, &(struct flow_sum){BODY_AT_BODY, false});
    others->widest.square = 0;
    *most = (struct group){.half = INFINITY, .leg = INFINITY};
    *largest = (struct body_at_event){.half = INFINITY, .n = INT_MAX};
    for (int g = 0; g < others->n_fish; g++) {
        const struct others_fish *const of = &others->fish[g];
        const struct body_at_event *const body = &of->at_event;
        const struct kernel_pair pair = flow_pair_of(flow, 0, g, &(struct flow_sum){BODY_AT_BODY, false});
        others->widest.span = fmax(others->widest.span, pair.span);
        for (int k = 0; k < of->n_groups; k++) include_bounds(most, &of->group[k]);
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
static double reach_of(const struct others *others, const struct others_fish *to, double interval, double tolerance) {
    const struct body_at_event *const at = &to->at_event;
    struct group source = others->strongest;
    for (double reach = at->chord; reach < 1e4 * at->chord; reach *= 1.1) {
        source.x = to->middle[0] + reach * (to->end[1][0] - to->end[0][0]) / at->chord;
        source.y = to->middle[1] + reach * (to->end[1][1] - to->end[0][1]) / at->chord;
        const double least = 2 * (reach - at->chord / 2 - at->bend);
        if (is_far(to, interval, &others->widest, &source, true, tolerance) &&
            acts_from_far_points(&others->largest, at, least, interval, &others->widest, tolerance)) {
            return 1.001 * reach; /* a margin for rounding */
        }
    }
    return INFINITY;
}

/* Add near sources, or extend the range before them; beyond the capacity only count. */
static void add_near(struct others_fish *of, struct near_sources near) {
    struct near_sources *const before =
        of->n_near > 0 && of->n_near <= of->near_capacity ? &of->near[of->n_near - 1] : NULL;
    if (before && before->fish == near.fish && before->wake.first + before->wake.n == near.wake.first) {
        before->wake.n += near.wake.n;
        before->with_body |= near.with_body;
        return;
    }
    if (of->n_near < of->near_capacity) of->near[of->n_near] = near;
    of->n_near++;
}

/* List the near sources of fish f: the groups of each wake that are not far, and bodies of which a group is not far,
 * which do not act from far points, or whose nascent point lies behind a near group. A circle around body and wake
 * beyond the reach saves the search. */
static void find_near(struct flow *flow, int f) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const struct fish *const fish = &school->fish[f];
    struct others_fish *const of = &others->fish[f];
    const double tolerance =
        school->wake_tolerance * fish->length * fish_rate(school, fish) / (4 * sqrt(others->n_sources));
    const double interval = school->interval;
    of->reach = reach_of(others, of, interval, tolerance);
    of->n_near = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct others_fish *const from = &others->fish[g];
        if (g == f) {
            add_near(of, (struct near_sources){g, {0, from->n_released}, true});
            continue;
        }
        const double dx = from->middle[0] - of->middle[0], dy = from->middle[1] - of->middle[1];
        const double least = of->reach + from->radius;
        if (dx * dx + dy * dy > least * least) continue;

        const struct kernel_pair of_wake = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        const struct kernel_pair of_body = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
        bool is_near = false;
        for (int b = 0; b < from->n_bundles; b++) {
            const struct range which = from->bundle[b].sources;
            is_near = false;
            if (is_far(of, interval, &of_wake, &from->bundle[b], true, tolerance)) continue;
            for (int k = which.first; k < which.first + which.n; k++) {
                is_near = !is_far(of, interval, &of_wake, &from->group[k], true, tolerance);
                if (is_near) add_near(of, (struct near_sources){g, from->group[k].sources, false});
            }
        }
        for (int k = 0; k < from->n_body_groups && !is_near; k++) {
            is_near = !is_far(of, interval, &of_body, &from->group[k], false, tolerance);
        }
        is_near = is_near || !acts_from_far_points(&from->at_event, &of->at_event, least_sum_of_distances(of, from),
                                                   interval, &of_body, tolerance);
        if (is_near) add_near(of, (struct near_sources){g, {from->n_released, 0}, true});
    }
}

// ---- sums at far points

// the far points of a fish as targets, with its field
static struct targets far_targets(const struct flow *flow, struct others_fish *of) {
    double *sum[KERNEL_SUMS];
    field_list(&of->field, sum);
    struct targets at = kernel_targets(FAR, of->x, of->y, sum);
    at.half = flow->kernel->has_legs ? of->half : NULL;
    return at;
}

// the far points on the path of the event, tau later
static void far_places(const struct others_fish *of, double tau, double *x, double *y) {
    for (int i = 0; i < FAR; i++) {
        x[i] = of->start[0][i] + tau * (of->velocity[0][i] + tau / 2 * of->acceleration[0][i]);
        y[i] = of->start[1][i] + tau * (of->velocity[1][i] + tau / 2 * of->acceleration[1][i]);
    }
}

static void append_wake(const struct flow *flow, int g, double span, struct sources *many) {
    const struct sheet_points *const wake = &flow->fish[g].wake.middles;
    flow_append_with_span(many, &wake->sources, (struct range){0, wake->n_released}, span);
}

static void append_body(const struct flow *flow, int g, double span, struct sources *many) {
    flow_append_with_span(many, &flow->others->fish[g].body, (struct range){0, FAR}, span);
}

static void append_nascent(const struct flow *flow, int g, double span, struct sources *many) {
    const struct sheet_points *const wake = &flow->fish[g].wake.middles;
    flow_append_with_span(many, &wake->sources, (struct range){wake->n_released, 1}, span);
}

/* Add sources of all fish, which one of the functions above appends, at the far points of all fish by the tree, class
 * by class. The near sources are included: the caller subtracts them. Each of the at most three sums takes an eighth
 * of wake.tolerance. */
static void add_all_by_tree(struct flow *flow, enum flow_pair kind,
                            void (*append)(const struct flow *flow, int g, double span, struct sources *many),
                            int threads) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    for (int c = 0; c < flow->n_classes; c++) {
        // the far points of this class
        struct sources *const points = &others->points, *const many = &flow->many;
        int first = -1;
        points->n = 0;
        for (int f = 0; f < school->n_fish; f++) {
            const struct others_fish *const of = &others->fish[f];
            if (flow->class_of[f] != c) continue;
            if (first < 0) first = f;
            const int n = points->n;
            sources_append(points, FAR);
            memcpy(points->x + n, of->x, sizeof of->x);
            memcpy(points->y + n, of->y, sizeof of->y);
            memcpy(points->half + n, of->half, sizeof of->half);
        }

        const int n = points->n;
        double *sum[KERNEL_SUMS];
        for (int k = 0; k < KERNEL_SUMS; k++) sum[k] = others->value + (long)k * n;
        struct targets at = kernel_targets(n, points->x, points->y, sum);
        at.half = points->half;
        memset(others->value, 0, KERNEL_SUMS * (size_t)n * sizeof *others->value);
        const struct fish *const fish = &school->fish[first];
        const double tolerance =
            school->wake_tolerance * fish->length * fish_rate(school, fish) / (8 * flow->n_classes);
        for (int k = 0; k < flow->n_classes; k++) {
            struct kernel_pair pair = {0};
            many->n = 0;
            for (int g = 0; g < school->n_fish; g++) {
                if (flow->class_of[g] != k) continue;
                pair = flow_pair_of(flow, first, g, &(struct flow_sum){kind, false});
                append(flow, g, pair.span, many);
            }
            pair.span = 1;
            tree_induce(flow->tree, &pair, many, fish->length, tolerance, threads, &at);
        }

        int done = 0;
        for (int f = 0; f < school->n_fish; f++) {
            if (flow->class_of[f] != c) continue;
            double *to[KERNEL_SUMS];
            field_list(&others->fish[f].field, to);
            for (int k = 0; k < KERNEL_SUMS; k++) {
                for (int i = 0; i < FAR; i++) to[k][i] += sum[k][done + i];
            }
            done += FAR;
        }
    }
}

/* Add the far wakes at the far points of fish f: of each wake the ranges between the near ones. */
static void add_far_wakes(struct flow *flow, int f) {
    struct others_fish *const of = &flow->others->fish[f];
    const struct targets at = far_targets(flow, of);
    const struct near_sources *near = of->near, *const end = of->near + of->n_near;
    for (int g = 0; g < flow->others->n_fish; g++) {
        const struct kernel_pair pair = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        const struct sources *const wake = &flow->fish[g].wake.middles.sources;
        int first = 0;
        for (; near < end && near->fish == g; near++) {
            kernel_induce(&pair, wake, (struct range){first, near->wake.first - first}, &at);
            first = near->wake.first + near->wake.n;
        }
        kernel_induce(&pair, wake, (struct range){first, flow->others->fish[g].n_released - first}, &at);
    }
}

/* Subtract the near wakes at the far points of fish f, which a sum over all wakes includes. */
static void subtract_near_wakes(struct flow *flow, int f) {
    struct others_fish *const of = &flow->others->fish[f];
    const struct targets at = far_targets(flow, of);
    for (int i = 0; i < of->n_near; i++) {
        const int g = of->near[i].fish;
        struct kernel_pair pair = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        pair.span = -pair.span;
        kernel_induce(&pair, &flow->fish[g].wake.middles.sources, of->near[i].wake, &at);
    }
}

/* Add factor times the body of fish g, from its far points, with its nascent point, at the far points of fish f. */
static void add_body(struct flow *flow, int f, int g, double factor, const struct targets *at) {
    struct kernel_pair body = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
    struct kernel_pair wake = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
    const struct sheet_points *const points = &flow->fish[g].wake.middles;
    body.span *= factor;
    wake.span *= factor;
    kernel_induce(&body, &flow->others->fish[g].body, (struct range){0, FAR}, at);
    kernel_induce(&wake, &points->sources, (struct range){points->n_released, 1}, at);
}

/* Add the far bodies at the far points of fish f: of every fish whose body is not in the list of near sources. */
static void add_far_bodies(struct flow *flow, int f) {
    struct others_fish *const of = &flow->others->fish[f];
    const struct targets at = far_targets(flow, of);
    const struct near_sources *near = of->near, *const end = of->near + of->n_near;
    for (int g = 0; g < flow->others->n_fish; g++) {
        bool is_near = false;
        for (; near < end && near->fish == g; near++) is_near |= near->with_body;
        if (!is_near) add_body(flow, f, g, 1, &at);
    }
}

/* Subtract the near bodies at the far points of fish f, which a sum over all bodies includes. */
static void subtract_near_bodies(struct flow *flow, int f) {
    struct others_fish *const of = &flow->others->fish[f];
    const struct targets at = far_targets(flow, of);
    for (int i = 0; i < of->n_near; i++) {
        if (of->near[i].with_body) add_body(flow, f, of->near[i].fish, -1, &at);
    }
}

/* Sum the far wakes at the times of the interval from `first` up to `last`. The tree is faster than the sum over pairs
 * for many fish only, because it carries all sources to the nodes of its boxes for few targets. */
static void sum_wakes(struct flow *flow, const struct state *state, int first, int last) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const double n_interactions = others->n_sources * school->n_fish * FAR;
    const bool by_tree =
        tree_is_faster(flow->kernel, (int)others->n_sources, n_interactions / 8, school->wake_tolerance);
    const int threads = parallel_threads(school->threads, school->n_fish, n_interactions, PARALLEL_INTERACTIONS);
    for (int time = first; time <= last; time++) {
        const double tau = time * school->interval / END;
        flow_place_released(flow, state, state->t + tau);
        for (int f = 0; f < school->n_fish; f++) {
            struct others_fish *const of = &others->fish[f];
            far_places(of, tau, of->x, of->y);
            of->field = (struct far_field){.u = {0}};
        }
        if (by_tree) add_all_by_tree(flow, WAKE_AT_BODY, append_wake, school->threads);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int f = 0; f < school->n_fish; f++) {
            if (by_tree) {
                subtract_near_wakes(flow, f);
            } else {
                add_far_wakes(flow, f);
            }
            others->fish[f].wake[time] = others->fish[f].field;
        }
    }
}

/* Whether a time after the event is the end of the interval, apart from rounding. */
static bool is_end(const struct flow *flow, double tau) {
    return fabs(tau - flow->school->interval) < 1e-9 * flow->school->interval;
}

/* List the near sources of every fish at the event, and sum the far wakes at the end of the interval. */
static void select_at_event(struct flow *flow, const struct state *state) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    flow_place(flow, state, state->t, others->past);
    others->n_sources = 1;
    for (int f = 0; f < school->n_fish; f++) {
        struct others_fish *const of = &others->fish[f];
        const int n = flow->fish[f].wake.middles.n_released + flow->fish[f].body.n;
        others->n_sources += n;
        if (n <= of->group_capacity) continue;
        of->group_capacity = 2 * n;
        GROW(others->arena, of->group, of->group_capacity);
        GROW(others->arena, of->bundle, of->group_capacity / BUNDLE + 1);
    }

    // no parallel region requests memory: list again where the near sources are more than the memory has room for
    const int threads = parallel_threads(school->threads, school->n_fish, others->n_sources, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) remember_fish(flow, state, f);
    find_strongest(flow);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) find_near(flow, f);
    for (int f = 0; f < school->n_fish; f++) {
        struct others_fish *const of = &others->fish[f];
        if (of->n_near <= of->near_capacity) continue;
        of->near_capacity = 2 * of->n_near;
        GROW(others->arena, of->near, of->near_capacity);
        find_near(flow, f);
    }
    sum_wakes(flow, state, END, END);
    others->has_path = false;
}

void others_select(struct flow *flow, const struct state *state, double t) {
    struct others *const others = flow->others;
    const struct school *const school = flow->school;
    const unsigned long version = state_wake_version(state, school);
    int n_vortices = 0;
    for (int f = 0; f < school->n_fish; f++) n_vortices += state->wake[f].n_vortex;
    others->have_drifted = false;
    if (!others->are_possible || !(school->wake_tolerance > 0) || flow->is_steady || state->n_past == 0 ||
        n_vortices < flow->kernel->far_sources) {
        others->is_selected = false;
        return;
    }

    const size_t size = (size_t)school->n_unknowns * sizeof *others->past;
    if (!others->is_selected || others->t != state->t || others->version != version ||
        memcmp(others->past, state->past, size) != 0) {
        others->is_selected = true;
        others->t = state->t;
        others->version = version;
        memcpy(others->past, state->past, size);
        select_at_event(flow, state);
    }
    if (others->has_path || is_end(flow, t - state->t)) return;
    sum_wakes(flow, state, START, MIDDLE);
    others->has_path = true;
}

// ---- at the time of a sum

/* Set the far points of a fish, and whether its body is elsewhere than the event predicts. */
static void place_far_points(const struct flow *flow, int f, double tau, const double *y) {
    const struct fish *const fish = &flow->school->fish[f];
    struct others_fish *const of = &flow->others->fish[f];
    const double most = most_drift * fish->length;
    double place[2][FAR];
    wide_product(FAR, fish->n_nodes, of->from_nodes, y + fish->at.x, of->x);
    wide_product(FAR, fish->n_nodes, of->from_nodes, y + fish->at.y, of->y);
    far_places(of, tau, place[0], place[1]);
    of->has_drifted = false;
    for (int i = 0; i < FAR; i++) {
        const double dx = of->x[i] - place[0][i], dy = of->y[i] - place[1][i];
        of->has_drifted |= !(dx * dx + dy * dy <= most * most);
    }
}

/* Set the sources at the far points of a fish to the moments of its body along its curve. */
static void place_body(const struct flow *flow, int f) {
    struct others_fish *const of = &flow->others->fish[f];
    const struct sources *const body = &flow->fish[f].body;
    for (int i = 0; i < FAR; i++) {
        const double *const part = of->from_sources + (long)i * body->n;
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

void others_place(struct flow *flow, const struct state *state, const double *y, int threads) {
    struct others *const others = flow->others;
    if (!others->is_selected) return;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < others->n_fish; f++) {
        place_far_points(flow, f, flow->t - state->t, y);
        place_body(flow, f);
    }
    for (int f = 0; f < others->n_fish; f++) others->have_drifted |= others->fish[f].has_drifted;
}

/* Set the field of the far wakes at the far points of a fish: on the path of the event that of the end, or before it a
 * parabola in time, and the gradient times the displacement from that path. */
static void predict_wakes(const struct flow *flow, struct others_fish *of, double tau) {
    const double s = tau / flow->school->interval;
    const double weight[TIMES] = {(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)};
    double *to[KERNEL_SUMS], *from[TIMES][KERNEL_SUMS], place[2][FAR];
    struct far_field *const field = &of->field;
    *field = of->wake[END];
    field_list(field, to);
    for (int time = START; time < TIMES; time++) field_list(&of->wake[time], from[time]);
    for (int k = 0; k < KERNEL_SUMS && !is_end(flow, tau); k++) {
        for (int i = 0; i < FAR; i++) {
            to[k][i] =
                weight[START] * from[START][k][i] + weight[MIDDLE] * from[MIDDLE][k][i] + weight[END] * from[END][k][i];
        }
    }

    far_places(of, tau, place[0], place[1]);
    for (int i = 0; i < FAR; i++) {
        const double dx = of->x[i] - place[0][i], dy = of->y[i] - place[1][i];
        const double v_y = field->div[i] - field->u_x[i];
        field->u[i] += field->u_x[i] * dx + field->u_y[i] * dy;
        field->v[i] += field->v_x[i] * dx + v_y * dy;
        field->div[i] += field->div_x[i] * dx + field->div_y[i] * dy;
    }
}

void others_sum(struct flow *flow, const struct state *state, int threads) {
    struct others *const others = flow->others;
    const int n = FAR * others->n_fish;
    const bool by_tree = tree_is_faster(flow->kernel, n, (double)n * n, flow->school->wake_tolerance);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < others->n_fish; f++) {
        predict_wakes(flow, &others->fish[f], flow->t - state->t);
        if (by_tree) {
            subtract_near_bodies(flow, f);
        } else {
            add_far_bodies(flow, f);
        }
    }
    if (!by_tree) return;
    add_all_by_tree(flow, BODY_AT_BODY, append_body, threads);
    add_all_by_tree(flow, WAKE_AT_BODY, append_nascent, threads);
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
    struct others_fish *const of = &flow->others->fish[f];
    const int stride = flow->points[f].n, first = which.first - flow->points[f].first;
    for (int begin = 0; begin < which.n; begin += FAR) {
        const int n = which.n - begin < FAR ? which.n - begin : FAR;
        const double *const part = of->to_points + first + begin;
        struct far_field here;
        double *from[KERNEL_SUMS], *to[KERNEL_SUMS], x[FAR], y[FAR];
        field_list(&of->field, from);
        field_list(&here, to);
        for (int k = 0; k < KERNEL_SUMS; k++) at_points(n, part, stride, from[k], to[k]);
        at_points(n, part, stride, of->x, x);
        at_points(n, part, stride, of->y, y);

        for (int p = 0; p < n; p++) {
            // the point beside the curve of the far points
            const int i = begin + p;
            const double dx = at->x[i] - x[p], dy = at->y[i] - y[p], v_y = here.div[p] - here.u_x[p];
            at->u[i] += here.u[p] + here.u_x[p] * dx + here.u_y[p] * dy;
            at->v[i] += here.v[p] + here.v_x[p] * dx + v_y * dy;
            if (flow->kernel->has_legs) at->div[i] += here.div[p] + here.div_x[p] * dx + here.div_y[p] * dy;
            if (!at->u_x) continue;
            at->u_x[i] += here.u_x[p];
            at->u_y[i] += here.u_y[p];
            at->v_x[i] += here.v_x[p];
            if (!flow->kernel->has_legs) continue;
            at->div_x[i] += here.div_x[p];
            at->div_y[i] += here.div_y[p];
        }
    }
}
