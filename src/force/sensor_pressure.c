/* sensor_pressure.c: the rate of the potential at the control points, and Bernoulli's equation on both sides at the
 * sensors. */
#include "force/sensor_pressure.h"

#include <math.h>
#include <stddef.h>

#include "body/rod.h"
#include "fish/fish_sheet.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "flow/images.h"

/* One source. If the circulation before it changes at the rate dC/dt, it also acts as a dipole dC/dt dx. */
struct sensor_source {
    struct source at;
    double velocity[2]; /* m s-1 */
    double dipole[2];   /* m3 s-2 */
};

/* The control points of a body, at which the sources act. */
struct sensor_targets {
    const struct flow *flow;
    const struct state *state;
    const struct fish *fish;
    const double *x, *y;
    struct flow_at_body at;
    struct pressure *pressure;
};

static void sensor_velocity(const struct sensor_targets *at, int c, double v[2]) {
    v[0] = at->at.u[c] - at->pressure->point[c].slip[0];
    v[1] = at->at.v[c] - at->pressure->point[c].slip[1];
}

// add one source at all control points: K . (q (v - V) + dC/dt dx), and g (v - V) x d for its leg
static void sensor_add(const struct sensor_targets *at, const struct kernel_pair *pair,
                       const struct sensor_source *source) {
    const bool has_legs = at->flow->kernel->has_legs;
    for (int first = 0; first < at->fish->n_control; first += KERNEL_CHUNK) {
        const int n = at->fish->n_control - first < KERNEL_CHUNK ? at->fish->n_control - first : KERNEL_CHUNK;
        struct unit_values unit;
        kernel_unit(pair, &source->at, n, at->x + first, at->y + first, has_legs ? at->fish->point_half + first : NULL,
                    &unit);
        for (int i = 0; i < n; i++) {
            double v[2];
            sensor_velocity(at, first + i, v);
            const double slip[2] = {v[0] - source->velocity[0], v[1] - source->velocity[1]};
            const double of_legs = has_legs ? unit.leg[i] * (slip[1] * source->at.dx - slip[0] * source->at.dy) : 0;
            at->pressure->point[first + i].potential_rate +=
                unit.unit_u[i] * (source->at.q * slip[0] + source->dipole[0]) +
                unit.unit_v[i] * (source->at.q * slip[1] + source->dipole[1]) + of_legs;
        }
    }
}

// add all images of one source; in a mirror image circulation, leg and dipole are reversed
static void sensor_add_images(const struct sensor_targets *at, const struct kernel_pair *pair,
                              const struct sensor_source *source) {
    for (int k = 0; k < at->flow->n_images; k++) {
        const struct image *const of = &at->flow->image[k];
        struct sensor_source image = *source;
        image.at.y = of->sign * source->at.y + of->shift;
        image.velocity[1] *= of->sign;
        image.at.q *= of->sign;
        image.at.dx *= of->sign;
        image.dipole[0] *= of->sign;
        struct kernel_pair weighted = *pair;
        weighted.span *= of->weight;
        sensor_add(at, &weighted, &image);
    }
}

// ---- sources

// the rate of the circulation between the nose and control point c, for any fish
static double sensor_rate_before(const struct fish *fish, int c, const double *yp) {
    double sum = 0;
    for (int j = 0; j < fish->n_sheet; j++) {
        const double weight = fish->integrals ? fish->integrals->circulation[(long)j * fish->n_control + c] : j <= c;
        sum += weight * fish->sheet_weight[j] * yp[fish->at.gamma + j];
    }
    return sum;
}

static struct sensor_source sensor_sheet_source(const struct fish *fish, int j, const double *y, const double *yp) {
    const struct stencil *const point = &fish->sheet_point[j];
    struct sensor_source source = {
        .at = {.x = fish_mean(point, y + fish->at.x),
               .y = fish_mean(point, y + fish->at.y),
               .q = fish->sheet_weight[j] * y[fish->at.gamma + j],
               .half = fish->sheet_half ? fish->sheet_half[j] : 0},
        .velocity = {fish_mean(point, y + fish->at.vx), fish_mean(point, y + fish->at.vy)},
    };

    // The dipole dC/dt dx to fourth order in the spacing of theta: dC/dt, and the displacement of the body per
    // interval, come from the control points on both sides.
    static const double mean[4] = {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
    static const double difference[4] = {1.0 / 24, -27.0 / 24, 27.0 / 24, -1.0 / 24};
    double total = 0, rate = 0, line[2] = {0, 0};
    for (int i = 0; i < fish->n_sheet; i++) total += fish->sheet_weight[i] * yp[fish->at.gamma + i];
    for (int i = 0; i < 4; i++) {
        // beyond the ends, continue positions evenly and circulations oddly in theta
        const int c = j - 2 + i, n = fish->n_control, inside = c < 0 ? -1 - c : c >= n ? 2 * n - 1 - c : c;
        const double rate_inside = sensor_rate_before(fish, inside, yp);
        rate += mean[i] * (c < 0 ? -rate_inside : c >= n ? 2 * total - rate_inside : rate_inside);
        line[0] += difference[i] * fish_mean(&fish->control_point[inside], y + fish->at.x);
        line[1] += difference[i] * fish_mean(&fish->control_point[inside], y + fish->at.y);
    }

    source.dipole[0] = rate * line[0];
    source.dipole[1] = rate * line[1];
    return source;
}

// control point c of a body as a source: its leg, and for other fish also its circulation and its dipole
static struct sensor_source sensor_control_source(const struct sensor_targets *at, int g, int c, bool is_own) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct sources *const body = &at->flow->fish[g].body;
    const double *const y = at->state->y, rate = sensor_rate_before(fish, c, at->state->yp);
    struct sensor_source source = {
        .at = {.x = body->x[c], .y = body->y[c], .dx = body->dx[c], .dy = body->dy[c], .half = body->half[c]},
        .velocity = {fish_mean(&fish->control_point[c], y + fish->at.vx),
                     fish_mean(&fish->control_point[c], y + fish->at.vy)}};
    if (is_own) return source;
    source.at.q = body->q[c];
    source.dipole[0] = rate * fish->control_interval[c] * fish_mean(&fish->control_tangent[c].to, y + fish->at.x);
    source.dipole[1] = rate * fish->control_interval[c] * fish_mean(&fish->control_tangent[c].to, y + fish->at.y);
    return source;
}

// released source i of a view of a wake, whose label changes at a rate and therefore makes a dipole
static struct sensor_source sensor_wake_source(const struct sensor_targets *at, int g,
                                               const struct sheet_points *points, int i) {
    const struct wake *const wake = &at->state->wake[g];
    const struct sources *const from = &points->sources;
    const int older = points->older[i], newer = points->newer[i];
    const double xi = newer == older ? 0 : points->xi[i];
    const double decay = wake_strength_within(at->flow->school, wake_age(wake, newer, at->state->t), 0);
    const double rate = ((1 - xi) * wake->rate[newer] + xi * wake->rate[older]) * decay;
    double line[2];
    sheet_line(&at->flow->fish[g].wake, points, i, line);
    return (struct sensor_source){
        .at = {.x = from->x[i],
               .y = from->y[i],
               .q = from->q[i],
               .dx = from->dx[i],
               .dy = from->dy[i],
               .half = from->half[i],
               .leg = from->leg[i],
               .square = from->square[i]},
        .velocity = {(1 - xi) * wake->u[newer] + xi * wake->u[older], (1 - xi) * wake->v[newer] + xi * wake->v[older]},
        .dipole = {rate * line[0], rate * line[1]}};
}

static void sensor_add_fish(const struct sensor_targets *at, int f, int g) {
    const struct fish *const fish = &at->flow->school->fish[g];
    const struct flow_sum from_body = {BODY_AT_BODY, false}, from_wake = {WAKE_AT_BODY, false};
    const struct kernel_pair own = at->flow->kernel->own(fish->strip_depth, 0);
    const struct kernel_pair body = flow_pair_of(at->flow, f, g, &from_body);
    const struct kernel_pair wake = flow_pair_of(at->flow, f, g, &from_wake);
    const struct sheet *const sheet = &at->flow->fish[g].wake;
    const int n_body = at->flow->fish[g].body.n;

    // its own bound vortices and legs
    for (int j = 0; g == f && j < fish->n_sheet; j++) {
        const struct sensor_source source = sensor_sheet_source(fish, j, at->state->y, at->state->yp);
        sensor_add(at, &own, &source);
    }
    for (int c = 0; g == f && at->flow->kernel->has_legs && c < n_body; c++) {
        const struct sensor_source source = sensor_control_source(at, g, c, true);
        sensor_add(at, &own, &source);
    }

    // other bodies, and all images
    for (int c = 0; c < n_body; c++) {
        const struct sensor_source seen = fish->integrals ? sensor_control_source(at, g, c, false)
                                                          : sensor_sheet_source(fish, c, at->state->y, at->state->yp);
        if (g != f) sensor_add(at, &body, &seen);
        sensor_add_images(at, &body, &seen);
    }

    // its own wake, then the wakes of others and all images
    for (int i = 0; g == f && i < sheet->graded.n_released; i++) {
        const struct sensor_source source = sensor_wake_source(at, g, &sheet->graded, i);
        sensor_add(at, &own, &source);
    }
    for (int i = 0; i < sheet->middles.n_released; i++) {
        const struct sensor_source source = sensor_wake_source(at, g, &sheet->middles, i);
        if (g != f) sensor_add(at, &wake, &source);
        sensor_add_images(at, &wake, &source);
    }
}

// ---- Bernoulli's equation on both sides

int sensor_weights(const struct fish *fish, double fraction, double weight[4]) {
    const double place = fish_sheet_index(fish, fraction) - 0.5;  // in control points
    const int most = fish->n_control - 3, c = (int)fmin(fmax(floor(place), 1), most);
    const double x = place - c;
    weight[0] = -x * (x - 1) * (x - 2) / 6;
    weight[1] = (x + 1) * (x - 1) * (x - 2) / 2;
    weight[2] = -(x + 1) * x * (x - 2) / 2;
    weight[3] = (x + 1) * x * (x - 1) / 6;
    return c - 1;
}

void sensor_pressure_update(const struct flow *flow, const struct state *state, int f, struct pressure *pressure) {
    const struct school *const school = flow->school;
    const struct fish *const fish = &school->fish[f];
    const struct sensor_targets at = {.flow = flow,
                                      .state = state,
                                      .fish = fish,
                                      .x = flow->x + flow->points[f].first,
                                      .y = flow->y + flow->points[f].first,
                                      .at = flow_at_body(flow, f),
                                      .pressure = pressure};
    if (fish->n_sensors == 0) return;

    for (int c = 0; c < fish->n_control; c++) pressure->point[c].potential_rate = 0;
    for (int g = 0; g < school->n_fish; g++) sensor_add_fish(&at, f, g);

    for (int i = 0; i < fish->n_sensors; i++) {
        // interpolate only values that are smooth in theta up to the nose
        double weight[4], mean = 0, jump = 0, slip = 0, strength = 0;
        const int first = sensor_weights(fish, fish->sensor[i], weight);
        for (int k = 0; k < 4; k++) {
            // |v - u_ext|^2/2 - Phi, m2 s-2
            const int c = first + k;
            double stream[2], v[2];
            flow_external(school, state->t, at.x[c], at.y[c], &stream[0], &stream[1]);
            sensor_velocity(&at, c, v);
            const double square = (v[0] - stream[0]) * (v[0] - stream[0]) + (v[1] - stream[1]) * (v[1] - stream[1]);
            mean += weight[k] * (square / 2 - pressure->point[c].potential_rate);

            // dC/dt, with legs + C div u, m2 s-2; w_t, m s-1; gamma sqrt(s), m3/2 s-1
            const struct pressure_sheet sheet = pressure_sheet_at(pressure, c, state->y, state->yp);
            const double factor = fish->strip_depth > 0 ? fish->strip_depth / pressure_strip_depth_at(fish, c) : 1;
            jump += weight[k] * (factor * (sheet.rate + sheet.spanwise));
            slip += weight[k] * sheet.slip;
            strength += weight[k] * (factor * sheet.strength * sqrt(fish_mean(&fish->control_point[c], fish->arc)));
        }

        // the velocity at the surface of a round nose; the normal points to the right side of the fish
        const double s = fish->sensor[i] * fish->length, below = sqrt(s + fish->nose_radius / 2);
        for (int side = 0; side < 2; side++) {
            const double sign = side == 0 ? -1 : 1, speed = (slip * sqrt(s) - sign * strength / 2) / below;
            pressure->sensor[side][i] = fish->fluid_density * (mean + sign * jump / 2 - speed * speed / 2);
        }
    }
}
