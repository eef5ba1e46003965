/* flow_leg_rate.c: the momentum that legs take because their lengths s and half spans b change along a strip. The
 * fish's own legs are summed at control points and markers. For other fish and images the same rate is integrated by
 * parts, which concentrates it where s or b change, and far legs are left out. */
#include "flow/flow_leg_rate.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "flow/images.h"

enum {
    TARGETS = 64,  // so many changes of one fish are summed at once
    CHUNK = 64     // markers in one box
};

/* Beyond this many depths the legs of others act on the changes of s by less than 1e-4 of what those nearby do, because
 * the kernel falls as T^(-5/2). */
static const double reach = 5;

/* A change of s by less than this fraction of its full size is ignored. */
static const double least_change = 1e-6;

/* Places where b^2/2 and s of a strip change along its line, each with the circulation C there times the change. */
struct changes {
    int n;
    double x[TARGETS], y[TARGETS], half[TARGETS], leg[TARGETS], change[TARGETS];
};

// ---- own legs

// Add the rate of momentum of sources in the velocity of legs, sum of q E3 u + div E3 d, and its moment.
static void add_rate(const struct sources *sources, const double *u, const double *v, const double *div,
                     double rate[3]) {
    for (int i = 0; i < sources->n; i++) {
        const double x = -sources->q[i] * v[i] - div[i] * sources->dy[i];
        const double y = sources->q[i] * u[i] + div[i] * sources->dx[i];
        rate[0] += x;
        rate[1] += y;
        rate[2] += sources->x[i] * y - sources->y[i] * x;
    }
}

// the circulation of the strip at a control point times the change of b^2/2 there
static double body_change(const struct flow *flow, int f, int c) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct flow_fish *const of = &flow->fish[f];
    const double *const line[2] = {of->line[0] + c, of->line[1] + c};
    const double circulation =
        (of->body.dx[c] * *line[0] + of->body.dy[c] * *line[1]) / (*line[0] * *line[0] + *line[1] * *line[1]);
    return circulation * fish->control_widening[c] * fish->control_interval[c];
}

static void add_own(const struct flow *flow, int f, double rate[3]) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct flow_fish *const of = &flow->fish[f];
    const struct kernel_pair exact = flow->kernel->own(fish->strip_depth, 0);
    const int wake = flow->wake_range[f].first, n = fish->n_control;

    // u and v receive all parts, but only the parts of the legs are used
    double *sum[N_LEG_SUMS];
    for (int i = 0; i < N_LEG_SUMS; i++) {
        sum[i] = flow->legs[i] + flow->points[f].first;
        memset(sum[i], 0, (size_t)n * sizeof(double));
    }
    const struct targets at = {.n = n,
                               .x = of->body.x,
                               .y = of->body.y,
                               .half = of->body.half,
                               .u = sum[0],
                               .v = sum[1],
                               .leg_u = sum[2],
                               .leg_v = sum[3],
                               .div = sum[4],
                               .edge = fish->depth_varies ? sum[5] : NULL,
                               .edge_stride = (int)(sum[6] - sum[5])};
    kernel_induce(&exact, &of->body, (struct range){0, of->body.n}, &at);
    kernel_induce(&exact, &of->markers, (struct range){0, of->markers.n}, &at);
    add_rate(&of->body, at.leg_u, at.leg_v, at.div, rate);
    add_rate(&of->markers, flow->wake_leg_u + wake, flow->wake_leg_v + wake, flow->wake_leg_div + wake, rate);

    // leave out the force along the side edges, which acts on the body
    for (int c = 0; c < n && fish->depth_varies; c++) {
        const double change = body_change(flow, f, c);
        rate[0] -= change * sum[5][c];
        rate[1] -= change * sum[6][c];
        rate[2] -= change * (of->body.x[c] * sum[6][c] - of->body.y[c] * sum[5][c]);
    }
}

// ---- legs of other fish, and images of legs

void flow_leg_boxes(struct flow *flow) {
    for (int g = 0; g < flow->school->n_fish; g++) {
        struct flow_fish *const of = &flow->fish[g];
        const struct sources *const body = &of->body, *const markers = &of->markers;
        of->n_leg_boxes = 1 + (markers->n + CHUNK - 1) / CHUNK;
        if (of->n_leg_boxes > of->leg_box_capacity) {
            of->leg_box_capacity = 2 * of->n_leg_boxes;
            GROW(flow->arena, of->leg_box, of->leg_box_capacity);
        }
        of->leg_box[0] = box_around(body->n, body->x, body->y);
        for (int i = 1, first = 0; i < of->n_leg_boxes; i++, first += CHUNK) {
            const int n = markers->n - first < CHUNK ? markers->n - first : CHUNK;
            of->leg_box[i] = box_around(n, markers->x + first, markers->y + first);
        }
    }
}

static struct box image_of(struct box box, const struct image *image) {
    const double low = image->sign * box.low[1] + image->shift, high = image->sign * box.high[1] + image->shift;
    box.low[1] = fmin(low, high);
    box.high[1] = fmax(low, high);
    return box;
}

/* Add the edge field of those legs of fish g that are within the reach, of the fish itself (image -1) or of an
 * image. */
static void add_legs_of(const struct flow *flow, int g, int image, double depth, const struct box *around,
                        const struct targets *at) {
    const struct flow_fish *const from = &flow->fish[g];
    const struct kernel_pair pair = flow->kernel->other(flow->school->fish[g].strip_depth, 0);
    const struct sources *const body = image < 0 ? &from->body : &from->body_image;
    const struct sources *const markers = image < 0 ? &from->markers : &from->markers_image;
    for (int i = 0; i < from->n_leg_boxes; i++) {
        const struct box box = image < 0 ? from->leg_box[i] : image_of(from->leg_box[i], &flow->image[image]);
        if (box_gap(&box, around) > reach * fmax(depth, flow->school->fish[g].strip_depth)) continue;
        const int n = i == 0 ? from->body.n : from->markers.n, first = i == 0 ? 0 : (i - 1) * CHUNK;
        const int left = n - first, size = i > 0 && left > CHUNK ? CHUNK : left;
        const struct range which = {(image < 0 ? 0 : image * n) + first, size};
        kernel_induce(&pair, i == 0 ? body : markers, which, at);
    }
}

static void add_changes(const struct flow *flow, int f, const struct changes *changes, double rate[3],
                        double image[3]) {
    const double depth = flow->school->fish[f].strip_depth;
    const struct box around = box_around(changes->n, changes->x, changes->y);
    double edge[2][2 * TARGETS];
    memset(edge, 0, sizeof edge);
    for (int k = -1; k < flow->n_images; k++) {
        const struct targets at = {.n = changes->n,
                                   .x = changes->x,
                                   .y = changes->y,
                                   .half = changes->half,
                                   .leg = changes->leg,
                                   .edge = edge[k >= 0],
                                   .edge_stride = TARGETS};
        for (int g = 0; g < flow->school->n_fish; g++) {
            if (k >= 0 || g != f) add_legs_of(flow, g, k, depth, &around, &at);
        }
    }

    for (int i = 0; i < changes->n; i++) {
        const double x = changes->change[i] * edge[0][i], y = changes->change[i] * edge[0][TARGETS + i];
        const double along = changes->change[i] * edge[1][i];
        rate[0] += x;
        rate[1] += y;
        rate[2] += changes->x[i] * y - changes->y[i] * x;
        // a wall without friction pushes only across itself
        image[0] += along;
        image[2] -= changes->y[i] * along;
    }
}

static void add_of_others(const struct flow *flow, const struct state *state, int f, double rate[3], double image[3]) {
    const struct school *const school = flow->school;
    const struct fish *const fish = &school->fish[f];
    const struct flow_fish *const of = &flow->fish[f];
    const struct sources *const markers = &of->markers;
    if (school->n_fish == 1 && flow->n_images == 0) return;
    const double least = least_change * fish->strip_depth * fish->strip_depth / 8;
    const struct wake *const wake = &state->wake[f];
    const int n_body = fish->depth_varies ? fish->n_control : 0;
    struct changes changes = {.n = 0};
    for (int i = markers->n - 1; i >= -n_body; i--) {
        const struct sources *const from = i < 0 ? &of->body : markers;
        const int at = i < 0 ? i + n_body : i, to = changes.n;
        if (i < 0) {
            // for targets outside the strip b is twice as large
            changes.change[to] = 4 * body_change(flow, f, at);
        } else {
            const double growth = sheet_change(&of->wake, wake, i, markers->leg);
            if (!(fabs(growth) > least)) continue;
            changes.change[to] = wake_strength_of(wake, school, state->t, 0, i) * growth;
        }
        changes.x[to] = from->x[at];
        changes.y[to] = from->y[at];
        changes.half[to] = from->half[at];
        changes.leg[to] = from->leg[at];
        if (++changes.n < TARGETS) continue;
        add_changes(flow, f, &changes, rate, image);
        changes.n = 0;
    }
    if (changes.n > 0) add_changes(flow, f, &changes, rate, image);
}

void flow_leg_rate(const struct flow *flow, const struct state *state, int f, double rate[3], double image[3]) {
    for (int i = 0; i < 3; i++) rate[i] = image[i] = 0;
    if (!flow->kernel->has_legs) return;
    add_own(flow, f, rate);
    add_of_others(flow, state, f, rate, image);
}
