/* skin.c: rate of the potential at the control points, and Bernoulli's equation on both sides at the sensors. */
#include "force/skin.h"

#include <math.h>
#include <stddef.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"

static const double pi = 3.14159265358979323846;

/* One source: with the rate dC/dt of the circulation before the source, a dipole dC/dt dx. */
struct skin_source {
    struct source at;
    double velocity[2]; /* m s-1 */
    double dipole[2];   /* m3 s-2 */
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

static void skin_velocity(const struct skin_targets *at, int c, double v[2]) {
    v[0] = at->at.u[c] - at->pressure->point[c].slip[0];
    v[1] = at->at.v[c] - at->pressure->point[c].slip[1];
}

// add one source at all control points: K . (q (v - V) + dC/dt dx), and g (v - V) x d of the legs
static void skin_add(const struct skin_targets *at, const struct kernel_pair *pair, const struct skin_source *source) {
    const int has_legs = at->flow->kernel->has_legs;
    for (int first = 0; first < at->fish->n_control; first += KERNEL_CHUNK) {
        const int n = at->fish->n_control - first < KERNEL_CHUNK ? at->fish->n_control - first : KERNEL_CHUNK;
        struct unit_values unit;
        kernel_unit(pair, &source->at, n, at->x + first, at->y + first, has_legs ? at->fish->point_half + first : NULL,
                    &unit);
        for (int i = 0; i < n; i++) {
            double v[2];
            skin_velocity(at, first + i, v);
            const double slip[2] = {v[0] - source->velocity[0], v[1] - source->velocity[1]};
            const double of_legs = has_legs ? unit.leg[i] * (slip[1] * source->at.dx - slip[0] * source->at.dy) : 0;
            at->pressure->point[first + i].potential_rate +=
                unit.unit_u[i] * (source->at.q * slip[0] + source->dipole[0]) +
                unit.unit_v[i] * (source->at.q * slip[1] + source->dipole[1]) + of_legs;
        }
    }
}

// add all images of one source; in a mirror image circulation, legs and dipole have the opposite sign
static void skin_add_images(const struct skin_targets *at, const struct kernel_pair *pair,
                            const struct skin_source *source) {
    for (int k = 0; k < at->flow->n_images; k++) {
        const struct image *const of = &at->flow->image[k];
        struct skin_source image = *source;
        image.at.y = of->sign * source->at.y + of->shift;
        image.velocity[1] *= of->sign;
        image.at.q *= of->sign;
        image.at.dx *= of->sign;
        image.dipole[0] *= of->sign;
        struct kernel_pair weighted = *pair;
        weighted.span *= of->weight;
        skin_add(at, &weighted, &image);
    }
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
        .at = {.x = fish_mean(point, y + fish->at.x),
               .y = fish_mean(point, y + fish->at.y),
               .q = fish->sheet_weight[j] * y[fish->at.gamma + j],
               .half = fish->sheet_half ? fish->sheet_half[j] : 0},
        .velocity = {fish_mean(point, y + fish->at.vx), fish_mean(point, y + fish->at.vy)},
    };
    sheet_dipole(fish, j, y, yp, source.dipole);
    return source;
}

// control point c of a body: the legs, and for other fish circulation and dipole
static struct skin_source control_source(const struct skin_targets *at, int g, int c, bool is_own) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct sources *const body = &at->flow->fish[g].body;
    const double *const y = at->state->y, rate = rate_before(fish, c, at->state->yp);
    struct skin_source source = {
        .at = {.x = body->x[c], .y = body->y[c], .dx = body->dx[c], .dy = body->dy[c], .half = body->half[c]},
        .velocity = {fish_mean(&fish->control_point[c], y + fish->at.vx),
                     fish_mean(&fish->control_point[c], y + fish->at.vy)}};
    if (is_own) return source;
    source.at.q = body->q[c];
    source.dipole[0] = rate * fish->control_interval[c] * fish_mean(&fish->control_tangent[c].to, y + fish->at.x);
    source.dipole[1] = rate * fish->control_interval[c] * fish_mean(&fish->control_tangent[c].to, y + fish->at.y);
    return source;
}

static void skin_add_body(const struct skin_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct flow_sum sum = {BODY_AT_BODY, false};
    const struct kernel_pair own = at->flow->kernel->own(fish->strip_depth, 0),
                             other = flow_pair_of(at->flow, f, g, &sum);
    const int n_body = at->flow->fish[g].body.n;

    // own bound vortices and legs
    for (int j = 0; g == f && j < fish->n_sheet; j++) {
        const struct skin_source source = sheet_source(fish, j, at->state->y, at->state->yp);
        skin_add(at, &own, &source);
    }
    for (int c = 0; g == f && at->flow->kernel->has_legs && c < n_body; c++) {
        const struct skin_source source = control_source(at, g, c, true);
        skin_add(at, &own, &source);
    }

    // other bodies, and all images
    for (int c = 0; c < n_body; c++) {
        const struct skin_source seen =
            fish->integrals ? control_source(at, g, c, false) : sheet_source(fish, c, at->state->y, at->state->yp);
        if (g != f) skin_add(at, &other, &seen);
        skin_add_images(at, &other, &seen);
    }
}

// ---- wakes

// released source i of a view of a wake, with the rate of the label as a dipole; middles: source i is the middle of
// stretch i
static struct skin_source wake_source_of(const struct skin_targets *at, int g, const struct sheet_points *points,
                                         bool is_middle, int i) {
    const struct wake *const wake = &at->state->wake[g];
    const struct sources *const from = &points->sources;
    const int older = is_middle ? i : points->stretch[i], newer = older + 1;
    const double xi = is_middle ? 0.5 : points->xi[i], part = is_middle ? 1 : points->part[i];
    const double decay = wake_strength_within(at->flow->school, at->state->t - wake->birth[newer], 0);
    const double rate = ((1 - xi) * wake->rate[newer] + xi * wake->rate[older]) * part * decay;
    return (struct skin_source){
        .at = {.x = from->x[i],
               .y = from->y[i],
               .q = from->q[i],
               .dx = from->dx[i],
               .dy = from->dy[i],
               .half = from->half[i],
               .leg = from->leg[i],
               .square = from->square[i]},
        .velocity = {(1 - xi) * wake->u[newer] + xi * wake->u[older], (1 - xi) * wake->v[newer] + xi * wake->v[older]},
        .dipole = {-rate * (wake->x[older] - wake->x[newer]), -rate * (wake->y[older] - wake->y[newer])}};
}

static void skin_add_wake(const struct skin_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct sheet *const sheet = &at->flow->fish[g].wake;
    const struct flow_sum sum = {WAKE_AT_BODY, false};
    const struct kernel_pair own = at->flow->kernel->own(fish->strip_depth, 0),
                             other = flow_pair_of(at->flow, f, g, &sum);
    for (int i = 0; g == f && i < sheet->graded.n_released; i++) {
        const struct skin_source source = wake_source_of(at, g, &sheet->graded, false, i);
        skin_add(at, &own, &source);
    }

    for (int i = 0; i < sheet->middles.n_released; i++) {
        const struct skin_source source = wake_source_of(at, g, &sheet->middles, true, i);
        if (g != f) skin_add(at, &other, &source);
        skin_add_images(at, &other, &source);
    }
}

// ---- Bernoulli's equation on both sides

/* Values at a control point that are smooth in theta up to the nose; s: distance from the nose, m. */
struct skin_values {
    double mean;     /* |v - u_ext|^2/2 - Phi, m2 s-2 */
    double jump;     /* dC/dt, with legs + C div u, m2 s-2 */
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
        skin_add_wake(&at, f, g);
    }

    for (int i = 0; i < at.fish->n_sensors; i++) {
        // the side of the normal is the right side of the fish
        double side[2];
        skin_pressure(&at, at.fish->sensor[i], side);
        for (int k = 0; k < 2; k++) pressure->sensor[1 - k][i] = side[k];
    }
}
