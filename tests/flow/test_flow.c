/* test_flow.c: Every point feels the sources that doc/model.md, sections 6 to 9 and 17, name for it: the external flow,
 * vortices, and walls, which act like mirrored fish. The number of threads changes no bit. */
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "flow/flow_derivative.h"
#include "flow/flow_external.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
// point vortices without a free sheet
#define CONTINUOUS TIME "wake: {shedding: continuous}\n"
#define TWO_FISH                                         \
    "fish:\n"                                            \
    "  - {nodes: 5, sheet_points: 7, force: reactive}\n" \
    "  - {nodes: 6, sheet_points: 9, force: published, length: 0.8, start: {position: [0.2, 0.5], heading: 165}}\n"
#define STREAM "fluid: {velocity: [0.1, 0.2], shear: 0.3, gust: {amplitude: 0.2, frequency: 1}}\n"
#define TWO CONTINUOUS STREAM TWO_FISH

static void add_vortex(double g, double x, double y, double from_x, double from_y, double e, double *u, double *v) {
    const double r[2] = {x - from_x, y - from_y}, square = r[0] * r[0] + r[1] * r[1] + e * e;
    const double f = square > 0 ? g / (6.28318530717958647692 * square) : 0;
    *u -= f * r[1];
    *v += f * r[0];
}

// velocity at (x, y) from the sources of fish g: free vortices, and the bound sheet with a smoothing (< 0: omitted)
static void add_fish(const struct setup *setup, int g, double x, double y, double smoothing, double *u, double *v) {
    const struct fish *fish = &setup->school->fish[g];
    const struct state *state = setup->state;
    const struct wake *wake = &state->wake[g];
    const double tau = setup->t - state->t, interval = setup->school->interval;
    double px[16], py[16], strength[16], nascent[2];

    wake_places(wake, interval, tau, px, py);
    wake_strengths(wake, setup->school, state->t, tau, strength);
    const double tail[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    wake_nascent(wake, tau, tail, nascent);
    for (int i = 0; i < wake->n_vortex; i++) add_vortex(strength[i], x, y, px[i], py[i], fish->smoothing, u, v);
    add_vortex(state->y[fish->at.circulation] - wake->shed_before, x, y, nascent[0], nascent[1], fish->smoothing, u, v);
    for (int j = 0; j < fish->n_sheet && smoothing >= 0; j++) {
        add_vortex(fish->sheet_weight[j] * state->y[fish->at.gamma + j], x, y,
                   fish_mean(&fish->sheet_point[j], state->y + fish->at.x),
                   fish_mean(&fish->sheet_point[j], state->y + fish->at.y), smoothing, u, v);
    }
}

TEST(every_point_feels_the_sources_that_the_model_says) {
    struct setup setup = setup_stirred(TWO);
    school_flow(&setup, setup.state->y);
    flow_velocity(setup.residual->flow, setup.state, setup.t, setup.state->y, false);
    const struct flow *flow = setup.residual->flow;
    for (int f = 0; f < 2; f++) {
        const struct fish *fish = &setup.school->fish[f], *other = &setup.school->fish[1 - f];
        assert_int_equal(flow->points[f].n, fish->n_control + fish->n_edges + 1);
        for (int p = 0; p < flow->points[f].n; p++) {
            const int at = flow->points[f].first + p;
            double u, v;
            flow_external(setup.school, setup.t, flow->x[at], flow->y[at], &u, &v);
            const double own = p < fish->n_control ? 0 : p == flow_tail(fish) ? fish->sheet_smoothing : -1;
            // with force: reactive the own wake is omitted at the midpoints
            const int feels_own = fish->force != FORCE_REACTIVE || own >= 0;
            if (feels_own) add_fish(&setup, f, flow->x[at], flow->y[at], own, &u, &v);
            add_fish(&setup, 1 - f, flow->x[at], flow->y[at], other->sheet_smoothing, &u, &v);
            // rounding of sums of 40 terms, each at most 100 next to a bound vortex
            NEAR(flow->u[at], u, 1e-13, 1e-13);
            NEAR(flow->v[at], v, 1e-13, 1e-13);
        }

        const int k = 2, middle = flow->points[f].first + flow_midpoint(fish, k);
        NEAR(flow->x[middle], (setup.state->y[fish->at.x + k] + setup.state->y[fish->at.x + k + 1]) / 2, 1e-15, 0);
        const int tail = flow->points[f].first + flow_tail(fish);
        NEAR(flow->y[tail], setup.state->y[fish->at.y + fish->n_nodes - 1], 1e-15, 0);
        double slip[2];
        flow_slip(flow, f, setup.state->y, slip);
        NEAR(slip[0], flow->u[tail] - setup.state->y[fish->at.vx + fish->n_nodes - 1], 0, 0);
        NEAR(slip[1], flow->v[tail] - setup.state->y[fish->at.vy + fish->n_nodes - 1], 0, 0);
    }
}

TEST(wake_vortices_feel_everything_with_smoothed_sheets) {
    struct setup setup = setup_stirred(TWO);

    // at an event: the positions of the vortices are stored in the wake
    setup.t = setup.state->t;
    school_flow(&setup, setup.state->y);
    struct flow *const flow = setup.residual->flow;
    flow_at_wake(flow, setup.state);
    assert_in_range(flow->n_markers, 1, 34);
    for (int f = 0; f < 2; f++) {
        const struct wake *wake = &setup.state->wake[f];
        const double *const u = flow->wake_u + flow->wake_range[f].first;
        const double *const v = flow->wake_v + flow->wake_range[f].first;
        for (int i = 0; i < wake->n_vortex; i++) {
            double want_u, want_v;
            flow_external(setup.school, setup.t, wake->x[i], wake->y[i], &want_u, &want_v);
            for (int g = 0; g < 2; g++) {
                add_fish(&setup, g, wake->x[i], wake->y[i], setup.school->fish[g].sheet_smoothing, &want_u, &want_v);
            }
            NEAR(u[i], want_u, 1e-13, 0);
            NEAR(v[i], want_v, 1e-13, 0);
        }
    }
}

TEST(external_flow_is_stream_plus_shear_plus_gust) {
    struct setup setup = setup_of(TWO);
    double u, v;
    const double t = 1.0 / 12, gust = 0.2 * 0.5, stream = hypot(0.1, 0.2);
    flow_external(setup.school, t, 0, 2, &u, &v);
    NEAR(u, 0.1 + 0.6 - gust * 0.2 / stream, 1e-15, 0);
    NEAR(v, 0.2 + gust * 0.1 / stream, 1e-15, 0);
    // a gust along x
    setup.school->gust[1] = 0;
    flow_external(setup.school, t, 0, 2, &u, &v);
    NEAR(u, 0.1 + 0.6 - gust * 0.2 / stream, 1e-15, 0);
    NEAR(v, 0.2, 0, 0);
}

// a gust of unit amplitude across a stream along (3, 4)/5
TEST(a_travelling_gust_moves_along_the_stream) {
    static const char *const profiles[] = {"profile: sine, wavelength: 0.7", "profile: step, gradient_distance: 0.4"};
    for (int i = 0; i < 2; i++) {
        struct setup setup =
            setup_with(TIME
                       "fluid: {velocity: [0.6, 0.8], shear: 0.3, gust: {amplitude: 1, position: 0.2, %s}}\n"
                       "fish: [{nodes: 5, sheet_points: 21, force: published}]\n",
                       profiles[i]);
        const struct school *const school = setup.school;

        // the zero of the sine and the middle of the step are 0.2 m along the stream at the start, and move at 1 m/s
        double u, v, later[2];
        flow_external_gust(school, 0, 0.12, 0.16, &u, &v);
        NEAR(hypot(u, v), i == 0 ? 0 : 0.5, 1e-14, 0);
        const double ahead = 0.07, x = 0.12 + 0.6 * ahead, y = 0.16 + 0.8 * ahead;
        flow_external_gust(school, 0, x, y, &u, &v);
        const double shape = i == 0 ? sin(2 * 3.14159265358979323846 * ahead / 0.7) : ramp_step(0.5 - ahead / 0.4);
        NEAR(u, -0.8 * shape, 1e-14, 0);
        NEAR(v, 0.6 * shape, 1e-14, 0);
        flow_external_gust(school, 0.3, x + 0.3 * 0.6, y + 0.3 * 0.8, &later[0], &later[1]);
        NEAR(later[0], u, 1e-14, 0);
        NEAR(later[1], v, 1e-14, 0);

        // gradient by differences; truncation error: h^2 (2 pi/0.7)^3/6
        double gradient[3], to[2], from[2];
        const double h = 1e-5, t = 0.1;
        flow_external_gradient(school, t, x, y, gradient);
        flow_external(school, t, x + h, y, &to[0], &to[1]);
        flow_external(school, t, x - h, y, &from[0], &from[1]);
        NEAR(gradient[0], (to[0] - from[0]) / (2 * h), 1e-7, 0);
        NEAR(gradient[2], (to[1] - from[1]) / (2 * h), 1e-7, 0);
        ABOVE(fabs(gradient[0]), 0.1);
        flow_external(school, t, x, y + h, &to[0], &to[1]);
        flow_external(school, t, x, y - h, &from[0], &from[1]);
        NEAR(gradient[1], (to[0] - from[0]) / (2 * h), 1e-7, 0);
        NEAR(gradient[0], (from[1] - to[1]) / (2 * h), 1e-7, 0);
    }
}

TEST(external_acceleration_is_that_of_a_particle_of_the_fluid) {
    struct setup setup = setup_of(TWO);
    const double t = 0.3, h = 1e-5, y = 2;
    double u[3], v[3], acceleration[2];
    for (int i = 0; i < 3; i++) flow_external(setup.school, t + (i - 1) * h, 0, y, &u[i], &v[i]);
    flow_external_acceleration(setup.school, t, acceleration);

    // the velocity changes with time, and with the motion of the particle across the shear; truncation error: h^2 (2
    // pi)^3 0.2/6
    NEAR(acceleration[0], (u[2] - u[0]) / (2 * h) + 0.3 * v[1], 1e-8, 0);
    NEAR(acceleration[1], (v[2] - v[0]) / (2 * h), 1e-8, 0);
}

// velocity at all points of fish f, u then v, with unknown i changed by step
static void velocity_at(struct setup *setup, int i, double step, double *velocity) {
    struct flow *flow = setup->residual->flow;
    const double here = setup->state->y[i];
    setup->state->y[i] = here + step;
    flow_velocity(flow, setup->state, setup->t, setup->state->y, false);
    setup->state->y[i] = here;
    memcpy(velocity, flow->u, (size_t)flow->n_points * sizeof *velocity);
    memcpy(velocity + flow->n_points, flow->v, (size_t)flow->n_points * sizeof *velocity);
}

static void compare_derivatives(const char *text) {
    struct setup setup = setup_stirred(text);
    struct flow *flow = setup.residual->flow;
    struct influence_block *block = &setup.residual->jacobian_scratch[0].block;
    double velocity[4][64];
    AT_MOST(2 * flow->n_points, 64);
    for (int f = 0; f < 2; f++) {
        for (int g = 0; g < 2; g++) {
            const struct fish *other = &setup.school->fish[g];
            school_flow(&setup, setup.state->y);
            flow_derivative(flow, f, g, COLUMNS_OF_ALL, block);
            assert_int_equal(block->n_points, flow->points[f].n);
            assert_int_equal(block->n_columns, 2 * other->n_nodes + other->n_sheet + 1);
            assert_int_equal(block->n_columns, flow_n_columns(other));
            for (int c = 0; c < block->n_columns; c++) {
                // fourth order; the distance of bound vortices to control points is at least 0.01: (1e-4/0.01)^4/30 of
                // the largest
                const double h = 1e-4;
                for (int i = 0; i < 4; i++)
                    velocity_at(&setup, flow_column(other, c), h * (i < 2 ? i - 2 : i - 1), velocity[i]);
                for (int p = 0; p < block->n_points; p++) {
                    const int at[2] = {flow->points[f].first + p, flow->n_points + flow->points[f].first + p};
                    const double got[2] = {block->u[c * block->n_points + p], block->v[c * block->n_points + p]};
                    for (int i = 0; i < 2; i++) {
                        const double want = (velocity[0][at[i]] - 8 * velocity[1][at[i]] + 8 * velocity[2][at[i]] -
                                             velocity[3][at[i]]) /
                                            (12 * h);
                        NEAR(got[i], want, 2e-6, 1e-6);
                    }
                }
            }
        }
    }
}

TEST(derivative_by_every_unknown_agrees_with_differences) {
    compare_derivatives(TWO);
    // free sheets: fish of two lengths have a smoothing of the pair, and so do images
    compare_derivatives(TIME STREAM TWO_FISH);
    compare_derivatives(TIME "fluid: {walls: [-0.5]}\n" TWO_FISH);
}

// ---- walls

#define BESIDE                                                                        \
    "fish:\n"                                                                         \
    "  - {nodes: 5, sheet_points: 7, force: reactive, start: {position: [0, 0.5]}}\n" \
    "  - {nodes: 6, sheet_points: 9, force: published, length: 0.8, start: {position: [0.2, 1.1], heading: 165}}\n"
#define MIRRORED                                                                       \
    "  - {nodes: 5, sheet_points: 7, force: reactive, start: {position: [0, -0.5]}}\n" \
    "  - {nodes: 6, sheet_points: 9, force: published, length: 0.8, start: {position: [0.2, -1.1], heading: -165}}\n"

// sources: fish and wake g are fish and wake f of another setup, mirrored in y = 0 or unchanged
static void copy_fish(const struct setup *from, int f, struct setup *to, int g, double sign) {
    const struct fish *const a = &from->school->fish[f], *const b = &to->school->fish[g];
    const double *const y = from->state->y;
    double *const z = to->state->y;

    for (int k = 0; k < a->n_nodes; k++) {
        z[b->at.x + k] = y[a->at.x + k];
        z[b->at.y + k] = sign * y[a->at.y + k];
    }

    for (int j = 0; j <= a->n_sheet; j++) z[b->at.gamma + j] = sign * y[a->at.gamma + j];
    const struct wake *const wake = &from->state->wake[f];
    struct wake *const copy = &to->state->wake[g];
    wake_resize(copy, wake->n_vortex);
    copy->has_markers = wake->has_markers;
    for (int i = 0; i < wake->n_vortex; i++) {
        copy->x[i] = wake->x[i];
        copy->y[i] = sign * wake->y[i];
        copy->u[i] = wake->u[i];
        copy->v[i] = sign * wake->v[i];
        copy->u_before[i] = wake->u_before[i];
        copy->v_before[i] = sign * wake->v_before[i];
        copy->circulation[i] = sign * wake->circulation[i];
        copy->rate[i] = sign * wake->rate[i];
        copy->rate_before[i] = sign * wake->rate_before[i];
        copy->birth[i] = wake->birth[i];
    }

    copy->shed_before = sign * wake->shed_before;
    for (int i = 0; i < 2; i++) {
        const double turn = i == 0 ? 1 : sign;
        copy->slip[i] = turn * wake->slip[i];
        copy->tail_velocity[i] = turn * wake->tail_velocity[i];
        copy->tail_tangent[i] = turn * wake->tail_tangent[i];
    }

    copy->version++;
}

static void same_velocities(const struct flow *one, const struct flow *other, int f) {
    const int n = one->points[f].n, i = one->points[f].first, k = other->points[f].first;
    // rounding of sums of a hundred terms, each at most 100 next to a bound vortex
    NEAR_ARRAY(n, one->u + i, other->u + k, 1e-12, 1e-12);
    NEAR_ARRAY(n, one->v + i, other->v + k, 1e-12, 1e-12);
}

static void same_gradients(const struct flow *one, const struct flow *other, int f) {
    const int n = one->points[f].n, i = one->points[f].first, k = other->points[f].first;
    NEAR_ARRAY(n, one->u_x + i, other->u_x + k, 1e-10, 1e-11);
    NEAR_ARRAY(n, one->u_y + i, other->u_y + k, 1e-10, 1e-11);
    NEAR_ARRAY(n, one->v_x + i, other->v_x + k, 1e-10, 1e-11);
}

static void same_wake(const struct flow *one, const struct flow *other, int f) {
    const int n = one->wake_range[f].n, i = one->wake_range[f].first, k = other->wake_range[f].first;
    ABOVE(n, 5);
    NEAR_ARRAY(n, one->wake_u + i, other->wake_u + k, 1e-13, 1e-12);
    NEAR_ARRAY(n, one->wake_v + i, other->wake_v + k, 1e-13, 1e-12);
}

TEST(beside_a_wall_everything_feels_mirrored_fish) {
    static const char *const wakes[] = {"wake: {shedding: continuous}\n",
                                        "wake: {shedding: sheet, taper: 0.4, taper_beside: 0.1}\n"};
    for (int w = 0; w < 2; w++) {
        struct setup wall, free;
        char text[2048];
        snprintf(text, sizeof text, TIME "%sfluid: {velocity: [0.3, 0], walls: [0]}\n" BESIDE, wakes[w]);
        school_build(&wall, text);
        snprintf(text, sizeof text, TIME "%sfluid: {velocity: [0.3, 0]}\n" BESIDE MIRRORED, wakes[w]);
        school_build(&free, text);
        school_stir(&wall);
        free.state->t = wall.state->t;
        for (int f = 0; f < 2; f++) {
            copy_fish(&wall, f, &free, f, 1);
            copy_fish(&wall, f, &free, f + 2, -1);
        }

        free.t = wall.t;
        struct flow *const one = wall.residual->flow, *const other = free.residual->flow;
        flow_velocity(one, wall.state, wall.t, wall.state->y, false);
        flow_velocity(other, free.state, free.t, free.state->y, false);
        for (int f = 0; f < 2; f++) same_velocities(one, other, f);
        school_flow(&wall, wall.state->y);
        school_flow(&free, free.state->y);
        for (int f = 0; f < 2; f++) {
            same_velocities(one, other, f);
            same_gradients(one, other, f);
        }

        flow_at_wake(one, wall.state);
        flow_at_wake(other, free.state);
        for (int f = 0; f < 2; f++) same_wake(one, other, f);
    }
}

TEST(changed_wakes_are_placed_again) {
    struct setup setup = setup_stirred(TWO);
    struct flow *flow = setup.residual->flow;
    school_flow(&setup, setup.state->y);
    const double before = flow->u[0];
    setup.state->wake[0].circulation[3] += 1;
    setup.state->wake[0].version++;
    school_flow(&setup, setup.state->y);
    ABOVE(fabs(flow->u[0] - before), 1e-4);
}

TEST(gradient_pass_leaves_the_velocity_as_it_is) {
    struct setup setup = setup_stirred(TWO);
    struct flow *flow = setup.residual->flow;
    school_flow(&setup, setup.state->y);
    double with[64];
    memcpy(with, flow->u, (size_t)flow->n_points * sizeof *with);
    flow_velocity(flow, setup.state, setup.t, setup.state->y, false);

    // the loops differ in the order of a division and a product
    NEAR_ARRAY(flow->n_points, flow->u, with, 1e-13, 1e-13);
}

TEST(threads_change_no_bit) {
    struct setup setup = setup_stirred(TWO);
    struct flow *flow = setup.residual->flow;
    double one[64];
    school_flow(&setup, setup.state->y);
    flow_velocity(flow, setup.state, setup.t, setup.state->y, false);
    memcpy(one, flow->u, (size_t)flow->n_points * sizeof *one);
    for (int threads = 2; threads <= 5; threads++) {
        setup.school->threads = threads;
        flow_velocity(flow, setup.state, setup.t, setup.state->y, false);
        assert_memory_equal(flow->u, one, (size_t)flow->n_points * sizeof *one);
    }

    // the ones that the residual has allocated
    setup.school->threads = 1;
}
