/* skin.c: rate of the potential at the control points, and Bernoulli's equation on both sides at the sensors. */
#include "force/skin.h"

#include <math.h>
#include <stddef.h>

#include "body/rod.h"
#include "flow/flow_rings.h"

static const double pi = 3.14159265358979323846;

/* One source: a vortex of circulation q, a dipole dC/dt dx, and legs C dx of a ring. */
struct skin_source {
    double x[2], velocity[2]; /* m, m s-1 */
    double q;                 /* m2 s-1 */
    double dipole[2];         /* m3 s-2 */
    double legs[2];           /* m3 s-1 */
    double square;            /* contribution to e^2, m2 */
    double half, leg;         /* as in vortex/ring.h, m2 */
};

/* The control points of a body. */
struct skin_targets {
    const struct flow *flow;
    const struct state *state;
    const struct fish *fish;
    const double *x, *y;
    struct flow_at_body at;
    struct pressure *pressure;
};

/* The mirror image of a source in the wall y = shift/2: circulation, legs and dipole have the opposite sign. */
static struct skin_source skin_mirror(const struct skin_source *of, double shift) {
    struct skin_source image = *of;
    image.x[1] = shift - of->x[1];
    image.velocity[1] = -of->velocity[1];
    image.q = -of->q;
    image.dipole[0] = -of->dipole[0];
    image.legs[0] = -of->legs[0];
    return image;
}

// K . (q (v - V) + dC/dt dx) for the velocity K of a unit vortex, at a point of velocity v
static double skin_term(const struct skin_source *source, const double v[2], double k_x, double k_y) {
    return k_x * (source->q * (v[0] - source->velocity[0]) + source->dipole[0]) +
           k_y * (source->q * (v[1] - source->velocity[1]) + source->dipole[1]);
}

static void skin_velocity(const struct skin_targets *at, int c, double v[2]) {
    v[0] = at->at.u[c] - at->pressure->point[c].slip[0];
    v[1] = at->at.v[c] - at->pressure->point[c].slip[1];
}

// add one source to all control points; pair: of rings, NULL in two dimensions
static void skin_add(const struct skin_targets *at, const struct ring_pair *pair, const struct skin_source *source) {
    for (int c = 0; c < at->fish->n_control; c++) {
        const double r[2] = {at->x[c] - source->x[0], at->y[c] - source->x[1]}, r2 = r[0] * r[0] + r[1] * r[1];
        double v[2];
        skin_velocity(at, c, v);

        // legs alone may lie at the point
        const double square = r2 + source->square + (pair ? pair->square : 0);
        double k = square > 0 ? 1 / (2 * pi * square) : 0;

        double of_legs = 0;
        if (pair) {
            const double t = r2 + pair->factor * (at->fish->point_half[c] + source->half) + source->leg;
            k *= pair->span / sqrt(t);
            of_legs = pair->span / (2 * pi * t * sqrt(t)) *
                      ((v[1] - source->velocity[1]) * source->legs[0] - (v[0] - source->velocity[0]) * source->legs[1]);
        }

        at->pressure->point[c].potential_rate += skin_term(source, v, -k * r[1], k * r[0]) + of_legs;
    }
}

// add all images of one source in a channel, in two dimensions
static void skin_add_rows(const struct skin_targets *at, const struct skin_source *source) {
    const struct walls *const walls = &at->flow->school->walls;
    const double rate = pi / image_rows_width(walls);
    const struct image_height height = image_height_of(walls, source->x[1]);
    const struct skin_source mirrored = skin_mirror(source, 0);

    for (int c = 0; c < at->fish->n_control; c++) {
        const struct image_height target = image_height_of(walls, at->y[c]);
        const double r[2] = {at->x[c] - source->x[0], at->y[c] - source->x[1]};
        const struct image_column column = image_column_of(rate, r[0], source->square);
        const struct image_rows rows = image_rows_of(&column, r, &target, &height, source->square, 0);
        double v[2];
        skin_velocity(at, c, v);
        at->pressure->point[c].potential_rate += skin_term(source, v, rows.shifted.u, rows.shifted.v) +
                                                 skin_term(&mirrored, v, rows.mirrored.u, rows.mirrored.v);
    }
}

static void skin_add_images(const struct skin_targets *at, const struct ring_pair *pair,
                            const struct skin_source *source) {
    const struct walls *const walls = &at->flow->school->walls;
    for (int k = 0; pair && k < at->flow->rings->n_images; k++) {
        const struct ring_image *const of = &at->flow->rings->image[k];
        struct skin_source image = of->sign < 0 ? skin_mirror(source, of->shift) : *source;
        if (of->sign > 0) image.x[1] += of->shift;
        struct ring_pair weighted = *pair;
        weighted.span *= of->weight;
        skin_add(at, &weighted, &image);
    }
    if (!pair && walls->n == 1) {
        const struct skin_source image = skin_mirror(source, 2 * walls->y[0]);
        skin_add(at, NULL, &image);
    }
    if (!pair && walls->n == 2) skin_add_rows(at, source);
}

// ---- bodies

// rate of the circulation between the nose and control point c of any fish
static double rate_before(const struct fish *fish, int c, const double *yp) {
    double sum = 0;
    for (int j = 0; j < fish->n_sheet; j++) {
        const double weight = fish->integrals ? fish->integrals->circulation[(long)j * fish->n_control + c] : j <= c;
        sum += weight * fish->sheet_weight[j] * yp[fish->at.gamma + j];
    }
    return sum;
}

// a value between the control points beyond the ends: positions are even, circulations odd in theta about both ends
static double rate_beyond(const struct fish *fish, int c, double total, const double *yp) {
    if (c < 0) return -rate_before(fish, -1 - c, yp);
    if (c >= fish->n_control) return 2 * total - rate_before(fish, 2 * fish->n_control - 1 - c, yp);
    return rate_before(fish, c, yp);
}

static double place_beyond(const struct fish *fish, int c, const double *of_nodes) {
    const int inside = c < 0 ? -1 - c : c >= fish->n_control ? 2 * fish->n_control - 1 - c : c;
    return fish_mean(&fish->control_point[inside], of_nodes);
}

/* Dipole dC/dt dx at bound vortex j, of fourth order in the spacing of theta: dC/dt and the displacement of the body
 * per interval, from the control points on both sides. */
static void sheet_dipole(const struct fish *fish, int j, const double *y, const double *yp, double dipole[2]) {
    static const double mean[4] = {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
    static const double difference[4] = {1.0 / 24, -27.0 / 24, 27.0 / 24, -1.0 / 24};
    double total = 0, rate = 0, line[2] = {0, 0};
    for (int i = 0; i < fish->n_sheet; i++) total += fish->sheet_weight[i] * yp[fish->at.gamma + i];
    for (int i = 0; i < 4; i++) {
        const int c = j - 2 + i;
        rate += mean[i] * rate_beyond(fish, c, total, yp);
        line[0] += difference[i] * place_beyond(fish, c, y + fish->at.x);
        line[1] += difference[i] * place_beyond(fish, c, y + fish->at.y);
    }

    dipole[0] = rate * line[0];
    dipole[1] = rate * line[1];
}

static struct skin_source sheet_source(const struct fish *fish, int j, const double *y, const double *yp) {
    const struct stencil *const point = &fish->sheet_point[j];
    struct skin_source source = {
        .x = {fish_mean(point, y + fish->at.x), fish_mean(point, y + fish->at.y)},
        .velocity = {fish_mean(point, y + fish->at.vx), fish_mean(point, y + fish->at.vy)},
        .q = fish->sheet_weight[j] * y[fish->at.gamma + j],
    };
    sheet_dipole(fish, j, y, yp, source.dipole);
    return source;
}

// ring source c of a body: its legs, and for other fish circulation and dipole
static struct skin_source ring_source(const struct skin_targets *at, int g, int c, int is_own) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct fish_rings *const of = &at->flow->rings->fish[g];
    const double *const y = at->state->y;
    struct skin_source source = {.x = {of->body.x[c], of->body.y[c]},
                                 .velocity = {fish_mean(&fish->control_point[c], y + fish->at.vx),
                                              fish_mean(&fish->control_point[c], y + fish->at.vy)},
                                 .legs = {of->body.dx[c], of->body.dy[c]},
                                 .half = of->body.half[c]};
    if (is_own) return source;
    const double rate = rate_before(fish, c, at->state->yp);
    source.q = of->body.q[c];
    for (int i = 0; i < 2; i++) source.dipole[i] = rate * of->line[i][c];
    return source;
}

static void skin_add_body(const struct skin_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const double *const y = at->state->y, *const yp = at->state->yp, smoothing = flow_sheet_smoothing(at->flow, f, g);
    const struct ring_pair own = {.span = fish->strip_depth / 4, .factor = 1},
                           other = {.span = fish->strip_depth / 2, .factor = 4, .square = smoothing * smoothing};
    const int is_ring = at->flow->rings != NULL;

    // bound vortices: of other fish only in two dimensions
    for (int j = 0; j < fish->n_sheet && (g == f || !is_ring); j++) {
        struct skin_source source = sheet_source(fish, j, y, yp);
        if (is_ring) source.half = fish->sheet_half[j];
        if (!is_ring && g != f) source.square = smoothing * smoothing;
        skin_add(at, is_ring ? &own : NULL, &source);
        if (is_ring) continue;
        source.square = smoothing * smoothing;
        skin_add_images(at, NULL, &source);
    }

    // rings of control points
    for (int c = 0; is_ring && c < fish->n_control; c++) {
        const struct skin_source source = ring_source(at, g, c, g == f), seen = ring_source(at, g, c, 0);
        skin_add(at, g == f ? &own : &other, &source);
        skin_add_images(at, &other, &seen);
    }
}

// ---- wakes

// velocity at the fraction xi of the way from the newer to the older end of a stretch, and the rate of the label there
static double stretch_velocity(const struct wake *wake, int stretch, double xi, double velocity[2]) {
    const int newer = stretch + 1;
    velocity[0] = (1 - xi) * wake->u[newer] + xi * wake->u[stretch];
    velocity[1] = (1 - xi) * wake->v[newer] + xi * wake->v[stretch];
    return (1 - xi) * wake->rate[newer] + xi * wake->rate[stretch];
}

// a point of a stretch in two dimensions; smoothing: for the own body tapered
static struct skin_source stretch_source(const struct skin_targets *at, const struct wake *wake, int stretch, double xi,
                                         double part, const struct fish *own, double smoothing) {
    const int newer = stretch + 1, newest = wake->n_vortex - 1;
    struct skin_source source = {
        .x = {(1 - xi) * wake->x[newer] + xi * wake->x[stretch], (1 - xi) * wake->y[newer] + xi * wake->y[stretch]}};
    stretch_velocity(wake, stretch, xi, source.velocity);
    source.q = part * wake_source(wake, stretch) *
               wake_strength_within(at->flow->school, at->state->t - wake->birth[newer], 0);
    if (own) {
        const double from_tail[2] = {source.x[0] - wake->x[newest], source.x[1] - wake->y[newest]};
        smoothing = free_sheet_smoothing(own, from_tail, wake->tail_tangent);
    }

    source.square = smoothing * smoothing;
    return source;
}

static void skin_add_wake(const struct skin_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct wake *const wake = &at->state->wake[g];
    const int n_stretches = wake->n_vortex - 1, has_images = at->flow->school->walls.n > 0;
    for (int i = 0; i < n_stretches; i++) {
        const struct skin_source middle = stretch_source(at, wake, i, 0.5, 1, NULL, fish->smoothing);
        if (has_images) skin_add_images(at, NULL, &middle);
        if (g != f) skin_add(at, NULL, &middle);

        // own wake: the points of the newest stretches, with tapered smoothing
        const int age = n_stretches - i, n = age <= FREE_SHEET_GRADED   ? FREE_SHEET_PANEL
                                             : age <= FREE_SHEET_PAIRED ? 2
                                                                        : 1;
        for (int k = 0; g == f && k < n; k++) {
            const double xi = n == 1 ? 0.5 : n == 2 ? free_sheet_pair_xi[k] : free_sheet_xi[k];
            const double part = n <= 2 ? 1.0 / n : free_sheet_part[k];
            const struct skin_source source = stretch_source(at, wake, i, xi, part, fish, 0);
            skin_add(at, NULL, &source);
        }
    }
}

// released ring i of a wake, with the rate of the label as a dipole; middles: ring i is the middle of stretch i
static struct skin_source ring_wake_source(const struct skin_targets *at, int g, int is_own, int i) {
    const struct wake *const wake = &at->state->wake[g];
    const struct ring_sheets *const sheets = &at->flow->rings->fish[g].wake;
    const struct ring_sheet *const graded = &sheets->graded;
    const struct rings *const rings = is_own ? &graded->rings : &sheets->middles.rings;
    const int stretch = is_own ? graded->stretch[i] : i;
    const double xi = is_own ? graded->xi[i] : 0.5, part = is_own ? graded->part[i] : 1;
    struct skin_source source = {.x = {rings->x[i], rings->y[i]},
                                 .q = rings->q[i],
                                 .legs = {rings->dx[i], rings->dy[i]},
                                 .square = rings->square[i],
                                 .half = rings->half[i],
                                 .leg = rings->leg[i]};
    const double rate = stretch_velocity(wake, stretch, xi, source.velocity) * part *
                        wake_strength_within(at->flow->school, at->state->t - wake->birth[stretch + 1], 0);
    source.dipole[0] = -rate * (wake->x[stretch] - wake->x[stretch + 1]);
    source.dipole[1] = -rate * (wake->y[stretch] - wake->y[stretch + 1]);
    return source;
}

static void skin_add_rings(const struct skin_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct fish_rings *const of = &at->flow->rings->fish[g];
    const struct ring_pair own = {.span = fish->strip_depth / 4, .factor = 1},
                           other = {
                               .span = fish->strip_depth / 2, .factor = 4, .square = fish->smoothing * fish->smoothing};
    for (int i = 0; g == f && i < of->wake.graded.n_released; i++) {
        const struct skin_source source = ring_wake_source(at, g, 1, i);
        skin_add(at, &own, &source);
    }

    for (int i = 0; i < of->wake.middles.n_released; i++) {
        const struct skin_source source = ring_wake_source(at, g, 0, i);
        if (g != f) skin_add(at, &other, &source);
        skin_add_images(at, &other, &source);
    }
}

// ---- Bernoulli's equation on both sides

/* Values at a control point that are smooth in theta up to the nose; s: distance from the nose, m. */
struct skin_values {
    double mean;     /* |v - u_ext|^2/2 - Phi, m2 s-2 */
    double jump;     /* dC/dt, with rings + C div u, m2 s-2 */
    double slip;     /* w_t, m s-1 */
    double strength; /* gamma sqrt(s), m3/2 s-1 */
};

static struct skin_values skin_values_at(const struct skin_targets *at, int c) {
    const struct fish *const fish = at->fish;
    const struct pressure_point *const point = &at->pressure->point[c];
    const struct pressure_sheet sheet = pressure_sheet_at(at->pressure, c, at->state->y, at->state->yp);
    const double s = fish_mean(&fish->control_point[c], fish->arc);
    double stream[2], v[2];
    flow_external(at->flow->school, at->state->t, at->x[c], at->y[c], &stream[0], &stream[1]);
    skin_velocity(at, c, v);
    const double square = (v[0] - stream[0]) * (v[0] - stream[0]) + (v[1] - stream[1]) * (v[1] - stream[1]);
    const double factor = fish->strip_depth > 0 ? fish->strip_depth / pressure_strip_depth_at(fish, c) : 1;
    return (struct skin_values){square / 2 - point->potential_rate, factor * (sheet.rate + sheet.spanwise), sheet.slip,
                                factor * sheet.strength * sqrt(s)};
}

int skin_weights(const struct fish *fish, double fraction, double weight[4]) {
    const double place = acos(1 - 2 * fraction) / pi * fish->n_control - 0.5;
    const int most = fish->n_control - 3, c = (int)fmin(fmax(floor(place), 1), most);
    const double x = place - c;
    weight[0] = -x * (x - 1) * (x - 2) / 6;
    weight[1] = (x + 1) * (x - 1) * (x - 2) / 2;
    weight[2] = -(x + 1) * x * (x - 2) / 2;
    weight[3] = (x + 1) * x * (x - 1) / 6;
    return c - 1;
}

// pressure on the side of the normal and on the other side, at the fraction s/L of the length
static void skin_pressure(const struct skin_targets *of, double fraction, double side[2]) {
    const struct fish *const fish = of->fish;
    double weight[4];
    const int first = skin_weights(fish, fraction, weight);
    struct skin_values at = {0, 0, 0, 0};
    for (int i = 0; i < 4; i++) {
        const struct skin_values values = skin_values_at(of, first + i);
        at.mean += weight[i] * values.mean;
        at.jump += weight[i] * values.jump;
        at.slip += weight[i] * values.slip;
        at.strength += weight[i] * values.strength;
    }

    // velocity at the surface of a round nose
    const double s = fraction * fish->length, below = sqrt(s + fish->nose_radius / 2);
    for (int i = 0; i < 2; i++) {
        const double sign = i == 0 ? 1 : -1;
        const double speed = (at.slip * sqrt(s) - sign * at.strength / 2) / below;
        side[i] = fish->fluid_density * (at.mean + sign * at.jump / 2 - speed * speed / 2);
    }
}

void skin_update(const struct flow *flow, const struct state *state, int f, struct pressure *pressure) {
    const struct school *const school = flow->school;
    const int first = flow->points[f].first;
    const struct skin_targets at = {.flow = flow,
                                    .state = state,
                                    .fish = &school->fish[f],
                                    .x = flow->x + first,
                                    .y = flow->y + first,
                                    .at = flow_at_body(flow, f),
                                    .pressure = pressure};
    if (at.fish->n_sensors == 0) return;

    // rate of the potential
    for (int c = 0; c < at.fish->n_control; c++) pressure->point[c].potential_rate = 0;
    for (int g = 0; g < school->n_fish; g++) {
        skin_add_body(&at, f, g);
        (flow->rings ? skin_add_rings : skin_add_wake)(&at, f, g);
    }

    for (int i = 0; i < at.fish->n_sensors; i++) {
        // the side of the normal is the right side of the fish
        double side[2];
        skin_pressure(&at, at.fish->sensor[i], side);
        for (int k = 0; k < 2; k++) pressure->sensor[1 - k][i] = side[k];
    }
}
