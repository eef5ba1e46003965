/* test_flow_sources.c: The velocity at points and at markers is the sum over the sources of doc/model.md, sections 6 to
 * 9, 17 and 18, one by one, with both kernels of the program and with a third one. */
#include <stdio.h>
#include <string.h>

#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "flow/flow_derivative.h"
#include "flow/flow_external.h"
#include "school.h"
#include "third_kernel.h"

#define TIME "time: {end: 1, shedding_interval: 0.02}\ncontact: {action: warn}\n"
#define ONE "fish: [{nodes: 5, sheet_points: 26, force: pressure, pressure: {span: %s}}]\n"
#define TWO                                                                                \
    "fish:\n"                                                                              \
    "  - {nodes: 5, sheet_points: 26, force: pressure, pressure: {span: %s}}\n"            \
    "  - {nodes: 6, sheet_points: 23, force: reactive, length: 0.8, body: {depth: 0.4},\n" \
    "     start: {position: [0.2, 0.6], heading: 165}}\n"

static const double two_pi = 6.28318530717958647692;

/* The kernel of the program, or with finite span a kernel with b doubled. */
static enum { INFINITE, FINITE, THIRD, N_KERNELS } kind;

/* A test of every kernel. */
#define TEST_OF_KERNELS(name)                                        \
    static void of_kernel_##name(void);                              \
    TEST(name) {                                                     \
        for (kind = 0; kind < N_KERNELS; kind++) of_kernel_##name(); \
    }                                                                \
    static void of_kernel_##name(void)

static void build(struct setup *setup, const char *fluid, const char *fish) {
    char text[1024], all[2048];
    snprintf(all, sizeof all, TIME "%s%s", fluid, fish);
    snprintf(text, sizeof text, all, kind == INFINITE ? "infinite" : "finite");
    school_build(setup, text);
    school_stir(setup);
    if (kind == THIRD) setup->residual->flow->kernel = third_kernel();
}

/* Label of marker i less the decay; without legs of all stretches up to the newest marker. */
static double label_of(const struct setup *setup, const struct wake *wake, int i, double tau) {
    double label[64];
    assert_in_range(wake->n_vortex, 1, 64);
    wake_strengths(wake, setup->school, setup->state->t, tau, label);
    if (setup->school->finite || !wake->has_markers) return label[i];
    double sum = label[wake->n_vortex - 1];
    for (int j = wake->n_vortex - 2; j >= i; j--) {
        const double age = setup->state->t - wake->birth[j + 1];
        sum -= wake_strength_within(setup->school, age, tau / setup->school->interval) * (label[j + 1] - label[j]);
    }
    return sum;
}

/* After the velocities of an event, sources that are built for the markers already only turn: they have the bits of
 * sources that are built anew. */
TEST_OF_KERNELS(new_velocities_turn_the_sources_that_are_there) {
    char text[512];
    snprintf(text, sizeof text, "time: {end: 2, shedding_interval: 0.02}\nwake: {lifetime: 1.2}\n" ONE,
             kind == INFINITE ? "infinite" : "finite");
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, 1.6);
    struct flow *const turned = simulation->residual->flow, *const anew = flow_create(test_arena(), simulation->school);
    const struct state *const state = simulation->state;
    const double t = state->t + 0.3 * simulation->school->interval;
    const unsigned long version = state_wake_version(state, simulation->school);
    const unsigned long n_turns = state_wake_turns(state, simulation->school);
    assert_int_not_equal(turned->version, version);
    assert_int_equal(turned->version - turned->n_turns, version - n_turns);
    flow_place(turned, state, t, state->y);
    flow_place(anew, state, t, state->y);
    for (int view = 0; view < 2; view++) {
        const struct sheet *const one = &turned->fish[0].wake, *const other = &anew->fish[0].wake;
        const struct sources *const a = view == 0 ? &one->graded.sources : &one->middles.sources;
        const struct sources *const b = view == 0 ? &other->graded.sources : &other->middles.sources;
        const double *const from[] = {a->x, a->y, a->q, a->dx, a->dy, a->half, a->leg, a->square};
        const double *const to[] = {b->x, b->y, b->q, b->dx, b->dy, b->half, b->leg, b->square};
        assert_int_equal(a->n, b->n);
        for (int i = 0; i < 8; i++) assert_memory_equal(from[i], to[i], (size_t)a->n * sizeof(double));
    }
}

/* Velocity and divergence at a target. */
struct felt {
    double u, v, div;
};
static void add_source(struct felt *felt, const double at[2], const double from[2], double q, const double d[2],
                       double span, double half, double leg, double square) {
    const double r[2] = {at[0] - from[0], at[1] - from[1]}, r2 = r[0] * r[0] + r[1] * r[1];
    if (kind == INFINITE) {
        const double f = r2 + square > 0 ? q / (two_pi * (r2 + square)) : 0;
        felt->u -= f * r[1];
        felt->v += f * r[0];
        return;
    }
    if (kind == THIRD) span *= 2, half *= 4;
    const double t = r2 + half + leg, f = r2 + square > 0 ? span * q / (two_pi * (r2 + square) * sqrt(t)) : 0;
    const double g = span / (two_pi * pow(t, 1.5));
    felt->u += -f * r[1] - g * d[1];
    felt->v += f * r[0] + g * d[0];
    felt->div += -3 * span / (two_pi * pow(t, 2.5)) * (-r[0] * d[1] + r[1] * d[0]);
}

// velocity at a point with the half span b, induced by the ends of a stretch with these labels, as one point at the
// middle
static void add_middle(struct felt *felt, const double at[2], const double newer[2], const double older[2], double gn,
                       double go, const struct fish *fish, double factor, double b2, double leg, double mirror) {
    double from[2], d[2], q = gn - go;
    for (int i = 0; i < 2; i++) {
        from[i] = (newer[i] + older[i]) / 2;
        d[i] = -(gn + go) / 2 * (older[i] - newer[i]);
    }

    if (mirror < 0) {
        from[1] = mirror - from[1];
        q = -q;
        d[0] = -d[0];
    }

    const double w = fish->strip_depth, span = factor * w / 4;
    add_source(felt, at, from, q, d, span, factor * factor * (b2 + w * w / 16) / 2, leg,
               fish->smoothing * fish->smoothing);
}

// s of the middle of stretch i, from the length of the sheet between tail and middle, tau after the event
static double middle_leg(const struct fish *fish, const struct wake *wake, int i, double interval, double tau) {
    const int newest = wake->n_vortex - 1;
    const double w = fish->strip_depth;
    double before[2] = {wake->x[newest] + tau * wake->tail_velocity[0], wake->y[newest] + tau * wake->tail_velocity[1]};
    double distance = 0;
    for (int k = newest; k >= i; k--) {
        double marker[2];
        wake_marker(wake, k, interval, tau, marker);
        distance += (k == i ? 0.5 : 1) * hypot(marker[0] - before[0], marker[1] - before[1]);
        for (int j = 0; j < 2; j++) before[j] = marker[j];
    }

    return kind == INFINITE ? 0 : w * w / 8 * (1 - exp(-pow(distance / (3 * w), 4)));
}

// all stretches of fish g at a point, each as one point at the middle
static void add_wake(struct felt *felt, const struct setup *setup, int g, const double at[2], double factor, double b2,
                     double mirror) {
    const struct fish *const fish = &setup->school->fish[g];
    const struct wake *const wake = &setup->state->wake[g];
    const double tau = setup->t - setup->state->t, interval = setup->school->interval, q = tau / interval;
    const double *const y = setup->state->y;
    const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
    const int n = wake->n_vortex;
    double older[2], newer[2];

    for (int i = 0; i < n; i++) {
        const bool is_last = i == n - 1;
        wake_marker(wake, i, interval, tau, older);
        const double leg = is_last ? 0
                                   : (1 - q) * middle_leg(fish, wake, i, interval, 0) +
                                         q * middle_leg(fish, wake, i, interval, interval);
        const double go = label_of(setup, wake, i, tau);
        const double gn = is_last ? y[fish->at.circulation] : label_of(setup, wake, i + 1, tau);
        if (!is_last) wake_marker(wake, i + 1, interval, tau, newer);
        add_middle(felt, at, is_last ? tail : newer, older, gn, go, fish, factor, b2, leg, mirror);
    }
}

/* A source of a body: with integrals of the sheet a control point with the circulation of its interval and a leg, else
 * a bound vortex. */
struct body_source {
    double at[2], q, d[2];
};
static int body_source(const struct setup *setup, int g, int c, struct body_source *source) {
    const struct fish *const fish = &setup->school->fish[g];
    const double *const y = setup->state->y;
    const struct stencil *const point = fish->integrals ? &fish->control_point[c] : &fish->sheet_point[c];
    double around = 0, before = 0;
    for (int j = 0; j < fish->n_sheet; j++) {
        const double q = fish->sheet_weight[j] * y[fish->at.gamma + j];
        if (!fish->integrals && j == c) around = q;
        if (!fish->integrals) continue;
        around += fish->integrals->strength[j * fish->n_control + c] * q;
        before += fish->integrals->circulation[j * fish->n_control + c] * q;
    }

    const double du = fish->integrals ? fish->control_interval[c] * before : 0;
    const int k = c < fish->n_control ? c : 0;
    *source = (struct body_source){.at = {fish_mean(point, y + fish->at.x), fish_mean(point, y + fish->at.y)},
                                   .q = around,
                                   .d = {du * fish_mean(&fish->control_tangent[k].to, y + fish->at.x),
                                         du * fish_mean(&fish->control_tangent[k].to, y + fish->at.y)}};
    return fish->integrals ? fish->n_control : fish->n_sheet;
}

static void mirror_source(struct body_source *source, double mirror) {
    if (!(mirror < 0)) return;
    source->at[1] = mirror - source->at[1];
    source->q = -source->q;
    source->d[0] = -source->d[0];
}

// the body of fish g at a point
static void add_body(struct felt *felt, const struct setup *setup, int f, int g, const double at[2], double b2,
                     double mirror) {
    const struct fish *const fish = &setup->school->fish[g];
    const double e = fish->sheet_smoothing, other = setup->school->fish[f].sheet_smoothing, w = fish->strip_depth;
    struct body_source source;
    for (int c = 0, n = 1; c < n; c++) {
        n = body_source(setup, g, c, &source);
        mirror_source(&source, mirror);
        add_source(felt, at, source.at, source.q, source.d, w / 2, 2 * (b2 + w * w / 16), 0,
                   (e * e + other * other) / 2);
    }
}

// the images of all bodies and wakes at a point of fish f
static void add_images(struct felt *felt, const struct setup *setup, int f, const double at[2], double b2,
                       double wall) {
    for (int g = 0; g < 2; g++) {
        add_body(felt, setup, f, g, at, b2, wall);
        add_wake(felt, setup, g, at, 2, b2, wall);
    }
}

TEST_OF_KERNELS(midpoints_feel_bodies_wakes_and_images) {
    struct setup setup;
    build(&setup, "fluid: {walls: [-0.9]}\n", TWO);
    flow_velocity(setup.residual->flow, setup.state, setup.t, setup.state->y, false);
    const struct flow *const flow = setup.residual->flow;
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        for (int k = 0; k < fish->n_edges; k++) {
            const int p = flow->points[f].first + fish->n_control + k;
            const double at[2] = {flow->x[p], flow->y[p]}, b = fish->depth[k] / 4, wall = 2 * -0.9;
            struct felt felt = {0};
            add_body(&felt, &setup, f, 1 - f, at, b * b, 0);
            add_wake(&felt, &setup, 1 - f, at, 2, b * b, 0);
            add_images(&felt, &setup, f, at, b * b, wall);
            // own wake with the own span, unless the force already contains the wake
            if (fish->force == FORCE_PRESSURE) add_wake(&felt, &setup, f, at, 1, b * b, 0);
            NEAR(flow->u[p], felt.u, 1e-12, 1e-11);
            NEAR(flow->v[p], felt.v, 1e-12, 1e-11);
            NEAR(flow->div[p], felt.div, 1e-10, 1e-10);
        }
    }
}

TEST_OF_KERNELS(images_alone_are_those_of_all_bodies_and_wakes) {
    struct setup setup;
    build(&setup, "fluid: {walls: [-0.9]}\n", TWO);
    setup.t = setup.state->t;
    flow_images(setup.residual->flow, setup.state);
    const struct flow *const flow = setup.residual->flow;
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        for (int k = 0; k < fish->n_edges; k++) {
            const int p = flow->points[f].first + flow_midpoint(fish, k);
            const double at[2] = {flow->x[p], flow->y[p]}, b = fish->depth[k] / 4;
            struct felt images = {0};
            add_images(&images, &setup, f, at, b * b, 2 * -0.9);
            NEAR(flow->image_u[p], images.u, 1e-12, 1e-11);
            NEAR(flow->image_v[p], images.v, 1e-12, 1e-11);
            NEAR(flow->image_div[p], images.div, 1e-10, 1e-10);
        }
    }
}

// graded points of the newest stretches and tapered smoothing have a small effect for a wake far from the body
TEST_OF_KERNELS(control_points_feel_their_own_body_and_wake) {
    struct setup setup;
    build(&setup, "", ONE);
    const struct fish *const fish = setup.school->fish;
    double *const y = setup.state->y;
    struct wake *const wake = setup.state->wake;
    for (int i = 0; i < wake->n_vortex; i++) wake->x[i] += 50;
    wake->version++;
    y[fish->at.circulation] = label_of(&setup, wake, wake->n_vortex - 1, 0.008);
    flow_velocity(setup.residual->flow, setup.state, setup.t, y, false);
    const struct flow *const flow = setup.residual->flow;
    for (int p = 0; p < fish->n_control; p++) {
        struct felt felt = {0};
        const double at[2] = {flow->x[p], flow->y[p]}, w = fish->strip_depth, none[2] = {0, 0};
        for (int j = 0; j < fish->n_sheet; j++) {
            const double from[2] = {flow->fish[0].own.x[j], flow->fish[0].own.y[j]};
            add_source(&felt, at, from, flow->fish[0].own.q[j], none, w / 4, w * w / 16, 0, 0);
        }

        for (int c = 0; c < fish->n_control; c++) {
            double before = 0;
            for (int j = 0; j < fish->n_sheet; j++) {
                before += fish->integrals->circulation[j * fish->n_control + c] * flow->fish[0].own.q[j];
            }
            const double du = fish->control_interval[c] * before, from[2] = {flow->x[c], flow->y[c]};
            const double d[2] = {du * fish_mean(&fish->control_tangent[c].to, y + fish->at.x),
                                 du * fish_mean(&fish->control_tangent[c].to, y + fish->at.y)};
            add_source(&felt, at, from, 0, d, w / 4, w * w / 16, 0, 0);
        }

        // the leg of the nascent stretch extends from the tail to markers at a distance of 50
        struct felt nascent = {0};
        const double tail[2] = {y[fish->at.x + 4], y[fish->at.y + 4]};
        double newest[2];
        wake_marker(wake, wake->n_vortex - 1, setup.school->interval, 0.008, newest);
        for (int k = 0; k < 4; k++) {
            const struct sheet_points *const panel = &flow->fish[0].wake.graded;
            const double xi = panel->xi[panel->n_released + k], part = panel->part[panel->n_released + k],
                         label = y[fish->at.circulation];
            const double from[2] = {(1 - xi) * tail[0] + xi * newest[0], (1 - xi) * tail[1] + xi * newest[1]};
            const double d[2] = {-label * part * (newest[0] - tail[0]), -label * part * (newest[1] - tail[1])};
            add_source(&nascent, at, from, 0, d, w / 4, w * w / 16, 0, 0);
        }

        // the released wake at 50 lengths acts as a dipole, with infinite span as a vortex of 0.1 m2/s
        const double atol = kind == INFINITE ? 2e-3 : 5e-6;
        NEAR(flow->u[p], felt.u + nascent.u, atol, 1e-12);
        NEAR(flow->v[p], felt.v + nascent.v, atol, 1e-12);
        NEAR(flow->div[p], felt.div + nascent.div, 5e-6, 1e-11);
    }
}

// for the own control points the nascent stretch ends beside the tail, for all others at the marker
TEST_OF_KERNELS(a_tail_that_overtakes_its_newest_marker_keeps_the_nascent_stretch_beside_it) {
    struct setup setup;
    build(&setup, "", ONE);
    const struct fish *const fish = setup.school->fish;
    struct wake *const wake = setup.state->wake;
    const double *const y = setup.state->y, tail[2] = {y[fish->at.x + 4], y[fish->at.y + 4]};
    const struct direction at = fish_direction(fish, &fish->tail_tangent, y);
    for (int is_behind = 0; is_behind < 2; is_behind++) {
        const double along = is_behind ? 0.03 : -0.03;
        double marker[2], moved[2];
        wake_marker(wake, wake->n_vortex - 1, setup.school->interval, setup.t - setup.state->t, marker);
        for (int k = 0; k < 2; k++) moved[k] = tail[k] + along * at.t[k] + 0.01 * at.n[k] - marker[k];
        wake->x[wake->n_vortex - 1] += moved[0];
        wake->y[wake->n_vortex - 1] += moved[1];
        wake->version++;

        school_flow(&setup, y);
        const struct sheet *const sheet = &setup.residual->flow->fish[0].wake;
        const struct sources *const graded = &sheet->graded.sources, *const middles = &sheet->middles.sources;
        const double shed = y[fish->at.circulation], nascent = setup.residual->flow->fish[0].nascent;
        assert_int_equal(sheet->graded.end.is_overtaken, !is_behind);
        for (int i = 0; i < SHEET_PANEL; i++) {
            const int source = sheet->graded.n_released + i;
            const double xi = sheet->graded.xi[source], part = sheet->graded.part[source];
            const double label = -(shed - xi * nascent) * part;
            const double way[2] = {0.01 * at.n[0] + fmax(0, along) * at.t[0],
                                   0.01 * at.n[1] + fmax(0, along) * at.t[1]};
            NEAR(graded->x[source], tail[0] + xi * way[0], 1e-15, 1e-14);
            NEAR(graded->y[source], tail[1] + xi * way[1], 1e-15, 1e-14);
            NEAR(graded->dx[source], label * way[0], 1e-15, 1e-13);
            NEAR(graded->dy[source], label * way[1], 1e-15, 1e-13);
            NEAR(graded->q[source], part * nascent, 1e-15, 1e-13);
        }

        const int middle = sheet->middles.n_released;
        NEAR(middles->x[middle], tail[0] + (along * at.t[0] + 0.01 * at.n[0]) / 2, 1e-15, 1e-14);
        NEAR(middles->y[middle], tail[1] + (along * at.t[1] + 0.01 * at.n[1]) / 2, 1e-15, 1e-14);
    }
}

// the newborn marker has the velocity of the own body at h/(2 pi) behind the tail, without smoothing
TEST_OF_KERNELS(the_newborn_marker_feels_its_body_behind_the_tail) {
    struct setup setup;
    build(&setup, "", ONE);
    setup.t = setup.state->t;
    const struct fish *const fish = setup.school->fish;
    double *const y = setup.state->y;
    struct wake *const wake = setup.state->wake;

    // a wake without circulation
    for (int i = 0; i < wake->n_vortex; i++) wake->circulation[i] = 0;
    y[fish->at.circulation] = 0;
    wake->version++;
    const struct direction tail = fish_direction(fish, &fish->tail_tangent, y);
    const double speeds[] = {0.7, 0, -0.7}, last[2] = {y[fish->at.x + 4], y[fish->at.y + 4]};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 2; j++) wake->slip[j] = speeds[i] * tail.t[j];
        school_flow(&setup, y);
        struct flow *const flow = setup.residual->flow;
        flow_at_wake(flow, setup.state);

        const int newest = wake->n_vortex - 1;
        const double behind = fmax(0, speeds[i]) * setup.school->interval / two_pi, w = fish->strip_depth;
        const double at[2] = {last[0] + behind * tail.t[0], last[1] + behind * tail.t[1]};
        struct felt felt = {0};
        for (int c = 0; c < fish->n_control; c++) {
            const struct sources *const body = &flow->fish[0].body;
            const double from[2] = {body->x[c], body->y[c]}, d[2] = {body->dx[c], body->dy[c]};
            add_source(&felt, at, from, body->q[c], d, w / 4, w * w / 16, 0, 0);
        }
        NEAR(flow->wake_u[newest], felt.u, 1e-13, 1e-11);
        NEAR(flow->wake_v[newest], felt.v, 1e-13, 1e-11);
    }
}

// no flow through the wall; the labels change with the divergence at markers
TEST(markers_are_stretched_and_a_wall_lets_nothing_through) {
    struct setup setup;
    kind = FINITE;
    build(&setup, "fluid: {walls: [-0.9]}\n", TWO);
    setup.t = setup.state->t;
    school_flow(&setup, setup.state->y);
    struct flow *const flow = setup.residual->flow;
    flow_at_wake(flow, setup.state);
    int n = 0;
    for (int f = 0; f < 2; f++) {
        const struct wake *const wake = &setup.state->wake[f];
        for (int i = 0; i < wake->n_vortex; i++, n++) {
            ABOVE(fabs(flow->wake_div[n]), 0);
            ABOVE(fabs(flow->wake_image_div[n]), 0);
            NEAR(flow->wake_rate[n], -wake->circulation[i] * flow->wake_div[n], 0, 1e-15);
        }
    }

    enum { N = 9 };
    double x[N], y[N], u[N], v[N], u_x[N], u_y[N], v_x[N];
    for (int i = 0; i < N; i++) {
        x[i] = -1 + 0.4 * i;
        y[i] = -0.9;
    }

    const struct targets at = {.n = N, .x = x, .y = y, .u = u, .v = v, .u_x = u_x, .u_y = u_y, .v_x = v_x};
    flow_field(flow, setup.state, &at, false);
    for (int i = 0; i < N; i++) NEAR(v[i], 0, 1e-15, 0);
}

// s of marker k, from the length of the sheet between the newest marker and marker k
static double marker_leg(const struct fish *fish, const struct wake *wake, int k) {
    const double w = fish->strip_depth;
    double distance = 0;
    for (int i = k; i + 1 < wake->n_vortex; i++)
        distance += hypot(wake->x[i + 1] - wake->x[i], wake->y[i + 1] - wake->y[i]);
    return kind == INFINITE ? 0 : w * w / 8 * (1 - exp(-pow(distance / (3 * w), 4)));
}

// fish g at marker m of fish f: both ends of a leg are at markers, so each marker has half of both stretches
static void add_at_marker(struct felt *felt, const struct setup *setup, int f, int m, int g, const double at[2],
                          double mirror) {
    const struct fish *const fish = &setup->school->fish[f], *const other = &setup->school->fish[g];
    const struct wake *const own = &setup->state->wake[f], *const wake = &setup->state->wake[g];
    const bool is_own = f == g && !(mirror < 0);
    const int newest = wake->n_vortex - 1;
    const double factor = is_own ? 1 : 4, span = other->strip_depth / (is_own ? 4 : 2);
    const double one = fish->strip_depth * fish->strip_depth / 32, two = other->strip_depth * other->strip_depth / 32;
    const double leg = marker_leg(fish, own, m), square = fish->smoothing * fish->smoothing;
    double label[64];
    assert_in_range(newest, 2, 62);
    for (int k = 0; k <= newest; k++) label[k] = label_of(setup, wake, k, 0);
    label[newest + 1] = setup->state->y[other->at.circulation];

    for (int k = 0; k <= newest; k++) {
        const int older = k > 0 ? k - 1 : k, newer = k < newest ? k + 1 : k;
        const double released = k < newest ? (label[k + 1] - label[k]) / 2 : label[k + 1] - label[k];
        const double sign = mirror < 0 ? -1 : 1, q = sign * ((label[k] - label[older]) / 2 + released);
        const double d[2] = {sign * label[k] * (wake->x[newer] - wake->x[older]) / 2,
                             label[k] * (wake->y[newer] - wake->y[older]) / 2};
        const double from[2] = {wake->x[k], mirror < 0 ? mirror - wake->y[k] : wake->y[k]};
        const double pair = is_own ? square : (square + other->smoothing * other->smoothing) / 2;
        add_source(felt, (const double[]){own->x[m], own->y[m]}, from, q, d, span, factor * (one + two),
                   leg + marker_leg(other, wake, k), pair);
    }

    // the body: next to the own body with the tapered smoothing, and at the newborn marker without smoothing
    struct body_source body;
    for (int k = 0, n = 1; k < n; k++) {
        n = body_source(setup, g, k, &body);
        mirror_source(&body, mirror);
        const double half = other->point_half ? other->point_half[k] : 0;
        double pair = square;
        if (is_own) {
            const double *const y = setup->state->y;
            const int tail = fish->n_nodes - 1;
            const struct direction tangent = fish_direction(fish, &fish->tail_tangent, y);
            const double place[2] = {own->x[m] - y[fish->at.x + tail], own->y[m] - y[fish->at.y + tail]};
            const double tapered = sheet_taper(fish, place, tangent.t);
            pair = m < newest ? tapered * tapered : 0;
        }
        add_source(felt, is_own ? at : (const double[]){own->x[m], own->y[m]}, body.at, body.q, body.d, span,
                   factor * (one + half), leg, pair);
    }
}

TEST_OF_KERNELS(markers_feel_all_bodies_all_markers_and_all_images) {
    struct setup setup;
    build(&setup, "fluid: {velocity: [0.1, 0], shear: 0.3, walls: [-0.9]}\n", TWO);
    setup.t = setup.state->t;
    struct state *const now = setup.state;
    for (int f = 0; f < 2; f++) {
        // the tail moves back: the newborn marker feels the own body at the tail
        const struct fish *const fish = &setup.school->fish[f];
        const struct direction tail = fish_direction(fish, &fish->tail_tangent, now->y);
        for (int i = 0; i < 2; i++) now->wake[f].slip[i] = -0.3 * tail.t[i];
    }
    school_flow(&setup, now->y);
    struct flow *const flow = setup.residual->flow;
    flow_at_wake(flow, now);

    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        const struct wake *const wake = &now->wake[f];
        for (int m = 0; m < wake->n_vortex; m++) {
            const bool is_newborn = m == wake->n_vortex - 1;
            const int n = flow->wake_range[f].first + m, tail = fish->n_nodes - 1;
            const double at[2] = {is_newborn ? now->y[fish->at.x + tail] : wake->x[m],
                                  is_newborn ? now->y[fish->at.y + tail] : wake->y[m]};
            struct felt all = {0}, images = {0};
            flow_external(setup.school, setup.t, wake->x[m], wake->y[m], &all.u, &all.v);
            for (int g = 0; g < 2; g++) {
                add_at_marker(&all, &setup, f, m, g, at, 0);
                add_at_marker(&images, &setup, f, m, g, at, 2 * -0.9);
            }
            NEAR(flow->wake_image_u[n], images.u, 1e-13, 1e-11);
            NEAR(flow->wake_image_v[n], images.v, 1e-13, 1e-11);
            NEAR(flow->wake_image_div[n], images.div, 1e-13, 1e-11);
            NEAR(flow->wake_u[n], all.u + images.u, 1e-12, 1e-11);
            NEAR(flow->wake_v[n], all.v + images.v, 1e-12, 1e-11);
            NEAR(flow->wake_div[n], all.div + images.div, 1e-12, 1e-11);
        }
    }
}

// the points of a graded sheet: s by the length of the sheet between tail and point, at both ends of the interval
TEST(legs_of_graded_points_begin_at_the_tail) {
    struct setup setup;
    kind = FINITE;
    build(&setup, "", TWO);
    struct flow *const flow = setup.residual->flow;
    const double interval = setup.school->interval;
    for (int end = 0; end < 2; end++) {
        setup.t = setup.state->t + end * interval;
        school_flow(&setup, setup.state->y);
        for (int f = 0; f < 2; f++) {
            const struct fish *const fish = &setup.school->fish[f];
            const struct wake *const wake = &setup.state->wake[f];
            const struct sheet_points *const sheet = &flow->fish[f].wake.graded;
            const int newest = wake->n_vortex - 1;
            const double w = fish->strip_depth;
            ABOVE(sheet->n_released, 2 * SHEET_PANEL);
            for (int i = 0; i < sheet->n_released; i++) {
                double newer[2] = {wake->x[newest] + end * interval * wake->tail_velocity[0],
                                   wake->y[newest] + end * interval * wake->tail_velocity[1]},
                       older[2], distance = 0;
                for (int k = newest; k >= sheet->older[i]; k--) {
                    wake_marker(wake, k, interval, end * interval, older);
                    const double length = hypot(newer[0] - older[0], newer[1] - older[1]);
                    distance += k > sheet->older[i] ? length : sheet->xi[i] * length;
                    for (int j = 0; j < 2; j++) newer[j] = older[j];
                }
                NEAR(sheet->sources.leg[i], w * w / 8 * (1 - exp(-pow(distance / (3 * w), 4))), 1e-15, 1e-9);
            }
        }
    }
}

// ---- large schools

// five fish beside a wall, one of them shorter, with wavy wakes of n markers
static void build_large(struct setup *setup, const char *tolerance, int n) {
    char text[1024];
    snprintf(text, sizeof text,
             "time: {end: 1, shedding_interval: 0.02}\nwake: {tolerance: %s}\nfluid: {walls: [-1.5]}\n"
             "contact: {action: warn}\n"
             "defaults: {fish: {nodes: 25, sheet_points: 199, force: pressure, pressure: {span: %s}}}\nfish:\n"
             "  - {start: {position: [0, 0]}}\n  - {start: {position: [0.5, 1]}}\n  - {start: {position: [0, 2]}}\n"
             "  - {start: {position: [0.5, 3]}}\n  - {length: 0.8, start: {position: [0, -0.9]}}\n",
             tolerance, kind == INFINITE ? "infinite" : "finite");
    school_build(setup, text);

    // the tree for few interactions, too
    static struct kernel kernel;
    kernel = kind == THIRD ? *third_kernel() : *setup->residual->flow->kernel;
    kernel.tree_sources = 1000;
    kernel.tree_interactions = 1e5;
    setup->residual->flow->kernel = &kernel;
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *const fish = &setup->school->fish[f];
        const double *const y = setup->state->y;
        const double tail[2] = {y[fish->at.x + fish->n_edges], y[fish->at.y + fish->n_edges]};
        for (int i = n - 1; i >= 0; i--) {
            const double behind = 6.0 * i / n, phase = 6 * behind + f;
            wake_release(&setup->state->wake[f], tail[0] + behind, tail[1] + 0.1 * sin(phase), 0.02 * cos(phase), 0);
        }
        setup->state->y[fish->at.circulation] = 0.02;
    }
}

static double largest_difference(int n, const double *one, const double *other) {
    double most = 0;
    for (int i = 0; i < n; i++) {
        const double difference = fabs(one[i] - other[i]);
        if (!(difference <= most)) most = difference;
    }
    return most;
}

// velocity and div u in lengths (1 m) per beat (1 s); the tolerance is 1e-7
TEST_OF_KERNELS(large_schools_are_summed_by_the_tree_to_half_the_tolerance) {
    struct setup exact, fast;
    build_large(&exact, "0", 1000);
    build_large(&fast, "1e-7", 1000);
    const struct flow *const a = exact.residual->flow, *const b = fast.residual->flow;
    flow_gradient(exact.residual->flow, exact.state, exact.t, exact.state->y, false);
    flow_gradient(fast.residual->flow, fast.state, fast.t, fast.state->y, false);
    ABOVE(tree_interactions(b->tree), 0);
    AT_MOST(tree_interactions(a->tree), 0);
    const double *const values[][2] = {{a->u, b->u}, {a->v, b->v}, {a->div, b->div}};
    for (int i = 0; i < 3; i++) BELOW(largest_difference(a->n_points, values[i][0], values[i][1]), 5e-8);
    // gradients serve Newton's iteration; the smallest box of a target is 0.04 lengths wide
    const double *const gradients[][2] = {
        {a->u_x, b->u_x}, {a->u_y, b->u_y}, {a->v_x, b->v_x}, {a->div_x, b->div_x}, {a->div_y, b->div_y}};
    for (int i = 0; i < 5; i++) BELOW(largest_difference(a->n_points, gradients[i][0], gradients[i][1]), 1e-5);

    build_large(&exact, "0", 800);
    build_large(&fast, "1e-7", 800);
    flow_at_wake(exact.residual->flow, exact.state);
    flow_at_wake(fast.residual->flow, fast.state);
    const struct flow *const c = exact.residual->flow, *const d = fast.residual->flow;
    ABOVE(tree_interactions(d->tree), 0);
    const double *const at_markers[][2] = {{c->wake_u, d->wake_u},
                                           {c->wake_v, d->wake_v},
                                           {c->wake_image_u, d->wake_image_u},
                                           {c->wake_image_v, d->wake_image_v},
                                           {c->wake_div, d->wake_div},
                                           {c->wake_image_div, d->wake_image_div},
                                           {c->wake_rate, d->wake_rate}};
    for (int i = 0; i < 7; i++) BELOW(largest_difference(c->n_markers, at_markers[i][0], at_markers[i][1]), 5e-8);

    // the bits do not depend on the number of threads
    struct setup threads;
    build_large(&threads, "1e-7", 800);
    const int n_threads = threads.school->threads;
    threads.school->threads = 3;
    flow_at_wake(threads.residual->flow, threads.state);
    threads.school->threads = n_threads;
    assert_memory_equal(threads.residual->flow->wake_u, d->wake_u, (size_t)d->n_markers * sizeof(double));
    assert_memory_equal(threads.residual->flow->wake_rate, d->wake_rate, (size_t)d->n_markers * sizeof(double));
}

// bodies, wakes and the images of both have equal parts of half the tolerance, in lengths per beat
TEST(sums_by_the_tree_have_equal_parts_of_half_the_tolerance) {
    enum { MOST = 1000 };
    kind = FINITE;
    struct setup setup;
    build_large(&setup, "1e-4", 1000);
    struct flow *const flow = setup.residual->flow;
    flow_velocity(flow, setup.state, setup.t, setup.state->y, false);
    const struct flow_sum sum = {WAKE_AT_BODY, false};
    struct sources many = {.arena = test_arena()};
    struct kernel_pair pair = flow_pair_of(flow, 0, 0, &sum);
    for (int f = 0; f < 4; f++) {
        const struct sources *const sources = flow_sources(flow, f, &sum);
        flow_append_with_span(&many, sources, (struct range){0, sources->n}, pair.span);
    }
    pair.span = 1;

    const struct fish *const fish = &setup.school->fish[0];
    const struct range points = flow->classes[0].points;
    AT_MOST(points.n, MOST);
    int n_other = 0;
    for (double tolerance = 1e-3; tolerance > 1e-6; tolerance /= 2) {
        const double half = tolerance * fish->length * fish_rate(setup.school, fish) / 2;
        double value[3][KERNEL_SUMS][MOST] = {0};
        setup.school->wake_tolerance = tolerance;
        for (int k = 0; k < 3; k++) {
            double *sums[KERNEL_SUMS];
            for (int s = 0; s < KERNEL_SUMS; s++) sums[s] = value[k][s];
            const struct targets at = kernel_targets(points.n, flow->x + points.first, flow->y + points.first, sums);
            struct tree *const tree = tree_create(test_arena());
            if (k == 0) flow_sum_by_tree(flow, 0, 0, &sum, 1, &at);
            if (k > 0) tree_induce(tree, &pair, &many, fish->length, half / (k == 1 ? 4 : 2), 1, &at);
        }
        assert_memory_equal(value[0], value[1], sizeof value[0]);
        n_other += memcmp(value[0], value[2], sizeof value[0]) != 0;
    }
    ABOVE(n_other, 0);
}

// ---- derivatives

// velocity and div u at all points, with unknown i changed by step
static void values_at(struct setup *setup, int i, double step, double *value) {
    struct flow *flow = setup->residual->flow;
    const double here = setup->state->y[i];
    const size_t n = (size_t)flow->n_points;
    setup->state->y[i] = here + step;
    flow_velocity(flow, setup->state, setup->t, setup->state->y, flow->is_steady);
    setup->state->y[i] = here;
    memcpy(value, flow->u, n * sizeof *value);
    memcpy(value + n, flow->v, n * sizeof *value);
    memcpy(value + 2 * n, flow->div, n * sizeof *value);
}

static void compare_derivatives(const char *fluid, bool is_steady) {
    struct setup setup;
    build(&setup, fluid, TWO);
    struct flow *flow = setup.residual->flow;
    struct influence_block *block = &setup.residual->jacobian_scratch[0].block;
    enum { MOST = 128 };
    static double value[4][3 * MOST];
    assert_in_range(flow->n_points, 1, MOST);
    assert_int_equal(block->div != NULL, kind != INFINITE);
    for (int f = 0; f < 2; f++) {
        for (int g = 0; g < 2; g++) {
            const struct fish *other = &setup.school->fish[g];
            flow_gradient(flow, setup.state, setup.t, setup.state->y, is_steady);
            flow_derivative(flow, f, g, COLUMNS_OF_ALL, block);
            assert_int_equal(block->n_points, flow->points[f].n);
            assert_int_equal(block->n_columns, flow_n_columns(other));
            for (int c = 0; c < block->n_columns; c++) {
                // fourth order; the distance of bound vortices to control points is above 0.002
                const double h = 1e-5;
                for (int i = 0; i < 4; i++)
                    values_at(&setup, flow_column(other, c), h * (i < 2 ? i - 2 : i - 1), value[i]);
                for (int i = 0; i < (block->div ? 3 : 2); i++) {
                    const double *const got = (i == 0   ? block->u
                                               : i == 1 ? block->v
                                                        : block->div) +
                                              c * block->n_points;
                    for (int p = 0; p < block->n_points; p++) {
                        const int at = i * flow->n_points + flow->points[f].first + p;
                        const double want =
                            (value[0][at] - 8 * value[1][at] + 8 * value[2][at] - value[3][at]) / (12 * h);
                        // a steady wake has no source so near a control point
                        NEAR(got[p], want, is_steady ? 2e-6 : 2e-5, 2e-5);
                    }
                }
            }
        }
    }
}

TEST(derivatives_agree_with_differences) {
    for (kind = 0; kind < N_KERNELS; kind++) {
        compare_derivatives("", false);
        compare_derivatives("fluid: {walls: [-0.9]}\n", false);
        compare_derivatives("fluid: {walls: [-0.9, 1.4]}\n", false);
        compare_derivatives("fluid: {velocity: [0.5, 0.1]}\n", true);
    }
}

// the images of both walls, and the divergence of the legs: no flow through the walls, continuity of the field
TEST(the_field_does_not_go_through_walls) {
    enum { N = 40 };
    for (kind = 0; kind < N_KERNELS; kind++) {
        struct setup setup;
        build(&setup, "fluid: {velocity: [0.3, 0], shear: 0.2, walls: [-0.9, 1.9]}\n", TWO);
        setup.t = setup.state->t;
        double x[N], y[N], u[N], v[N], u_x[N], u_y[N], v_x[N], largest = 0;
        const struct targets at = {.n = N, .x = x, .y = y, .u = u, .v = v, .u_x = u_x, .u_y = u_y, .v_x = v_x};
        for (int i = 0; i < N; i++) {
            x[i] = 0.05 * i - 1;
            y[i] = i % 2 ? -0.9 : 1.9;
        }
        flow_field(setup.residual->flow, setup.state, &at, false);
        for (int i = 0; i < N; i++) {
            NEAR(v[i], 0, 1e-12, 0);
            NEAR(v_x[i], 0, 1e-11, 0);
            largest = fmax(largest, fabs(u[i] - u[(i + 2) % N]));
        }
        ABOVE(largest, 1e-3);

        // no fluid beyond the walls
        for (int i = 0; i < N; i++) y[i] = i % 3 == 0 ? -0.91 : i % 3 == 1 ? 1.91 : 0.2;
        flow_field(setup.residual->flow, setup.state, &at, false);
        for (int i = 0; i < N; i++) {
            assert_int_equal(isnan(u[i]) && isnan(v[i]) && isnan(u_x[i]) && isnan(u_y[i]) && isnan(v_x[i]), i % 3 != 2);
        }
    }
}

TEST(a_steady_wake_is_fine_as_far_as_the_tail_of_a_long_fish) {
    // a third fish without circulation lies far behind: the wake of the first is fine up to there
    enum { MOST = 128 };
    double v[2][MOST];
    for (int n_fish = 2; n_fish <= 3; n_fish++) {
        struct setup setup = setup_of(arena_text(
            test_arena(),
            "time: {end: 1, shedding_interval: 0.01}\nfluid: {velocity: [1, 0]}\n"
            "defaults: {fish: {nodes: 5, force: pressure, pressure: {span: finite}, motion: {prescribed: all}, "
            "wave: {frequency: 0}}}\n"
            "fish: [{length: 0.2, sheet_points: 61, body: {depth: 0.1}}, {sheet_points: 31, start: {position: "
            "[0.4, 0.1]}}%s]\n",
            n_fish == 2 ? "" : ", {sheet_points: 31, start: {position: [4, 0]}}"));
        struct flow *const flow = setup.residual->flow;
        setup.state->y[setup.school->fish[0].at.circulation] = 1;
        flow_velocity(flow, setup.state, 0, setup.state->y, true);
        assert_in_range(flow->points[1].n, 30, MOST);
        memcpy(v[n_fish - 2], flow->v + flow->points[1].first, (size_t)flow->points[1].n * sizeof *flow->v);
        if (n_fish == 3) NEAR_ARRAY(flow->points[1].n, v[0], v[1], 1e-7, 1e-5);
    }
}
