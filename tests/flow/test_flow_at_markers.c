/* test_flow_at_markers.c: Pair by pair, the velocities of bodies and wakes conserve the impulse of the fluid
 * (doc/model.md, section 8). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "flow/flow_leg_rate.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SHEET "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\nsheet: {curve: smooth}\n"

/* Two lengths, not in consecutive order; bodies with control points as sources, close to each other. */
#define SCHOOL                                                                                      \
    "defaults: {fish: {force: pressure, pressure: {span: infinite}, nodes: 5, sheet_points: 11}}\n" \
    "fish:\n"                                                                                       \
    "  - {start: {position: [0, 0.2]}}\n"                                                           \
    "  - {length: 0.5, start: {position: [0.3, 0.5], heading: 165}}\n"                              \
    "  - {start: {position: [0.2, 0.8], heading: 190}}\n"

enum { N_FISH = 3, N_PAIRS = 8, N_MARKERS = 2 * N_PAIRS + 1 };

static double random_in(struct setup *setup, double low, double high) {
    return low + (high - low) * (1 + school_random(setup)) / 2;
}

/* Wakes with stretches of length 0, so that the sources at bodies are markers: two markers at every position, and a
 * newborn marker of strength 0 at the tail. Some markers are near the own tail, behind and beside. */
static void make_wakes(struct setup *setup) {
    for (int f = 0; f < N_FISH; f++) {
        const struct fish *const fish = &setup->school->fish[f];
        double tail[2], label = 0;
        struct wake *const wake = school_wake(setup, f, N_MARKERS, tail);
        const struct direction body = fish_direction(fish, &fish->tail_tangent, setup->state->y);
        for (int i = 0; i < N_PAIRS; i++) {
            const double along = fish->length * random_in(setup, -0.6, 1.2);
            const double across = fish->length * random_in(setup, -0.4, 0.4);
            for (int k = 0; k < 2; k++) {
                wake->x[2 * i + k] = tail[0] + along * body.t[0] + across * body.n[0];
                wake->y[2 * i + k] = tail[1] + along * body.t[1] + across * body.n[1];
                if (k == 1) label += random_in(setup, -0.1, 0.1);
                wake->circulation[2 * i + k] = label;
            }
        }

        wake->x[N_MARKERS - 1] = tail[0];
        wake->y[N_MARKERS - 1] = tail[1];
        wake->circulation[N_MARKERS - 1] = label;
        school_shed(setup, f);
    }
}

/* Strengths and velocities of bodies and markers. Only body f and wake g are sources; -1: none. */
struct felt {
    double body_u[N_FISH][10], body_v[N_FISH][10], body_q[N_FISH][10];
    double wake_u[N_FISH][N_MARKERS], wake_v[N_FISH][N_MARKERS], wake_q[N_FISH][N_MARKERS];
    double wake_x[N_FISH][N_MARKERS], wake_y[N_FISH][N_MARKERS];
};

static void feel(struct setup *setup, int body, int wake, struct felt *felt) {
    const struct school *const school = setup->school;
    struct state *const state = setup->state;
    struct flow *const flow = setup->residual->flow;
    double kept[N_FISH][16], labels[N_FISH][N_MARKERS];

    for (int f = 0; f < N_FISH; f++) {
        const struct fish *const fish = &school->fish[f];
        memcpy(kept[f], state->y + fish->at.gamma, sizeof(double) * (size_t)(fish->n_sheet + 1));
        memcpy(labels[f], state->wake[f].circulation, sizeof labels[f]);
        for (int j = 0; j < fish->n_sheet && f != body; j++) state->y[fish->at.gamma + j] = 0;
        for (int i = 0; i < N_MARKERS && f != wake; i++) state->wake[f].circulation[i] = 0;
        state->wake[f].shed_before = state->y[fish->at.circulation] = f == wake ? labels[f][N_MARKERS - 1] : 0;
        state->wake[f].version++;
    }

    flow_velocity(flow, state, state->t, state->y, false);
    for (int f = 0; f < N_FISH; f++) {
        for (int c = 0; c < school->fish[f].n_control; c++) {
            felt->body_u[f][c] = flow->u[flow->points[f].first + c];
            felt->body_v[f][c] = flow->v[flow->points[f].first + c];
        }
    }

    flow_at_wake(flow, state);
    for (int f = 0; f < N_FISH; f++) {
        for (int i = 0; i < N_MARKERS; i++) {
            const int at = flow->wake_range[f].first + i;
            felt->wake_u[f][i] = flow->wake_u[at];
            felt->wake_v[f][i] = flow->wake_v[at];
            felt->wake_x[f][i] = flow->fish[f].markers.x[i];
            felt->wake_y[f][i] = flow->fish[f].markers.y[i];
            felt->wake_q[f][i] = flow->fish[f].markers.q[i];
        }

        for (int c = 0; c < school->fish[f].n_control; c++) felt->body_q[f][c] = flow->fish[f].body.q[c];

        memcpy(state->y + school->fish[f].at.gamma, kept[f], sizeof(double) * (size_t)(school->fish[f].n_sheet + 1));
        memcpy(state->wake[f].circulation, labels[f], sizeof labels[f]);
        state->wake[f].shed_before = labels[f][N_MARKERS - 1];
        state->wake[f].version++;
    }
}

/* A sum of terms, and the sum of the absolute values. */
struct sum {
    double value, size;
};

static void add(struct sum *sum, double term) {
    sum->value += term;
    sum->size += fabs(term);
}

static void vanishes(const struct sum *sum) {
    ABOVE(sum->size, 1e-6);
    // rounding of some hundred terms
    NEAR(sum->value / sum->size, 0, 1e-13, 0);
}

static void build(struct setup *setup, const char *fluid) {
    char text[2048];
    snprintf(text, sizeof text, TIME SHEET "%s" SCHOOL, fluid);
    school_build(setup, text);
    school_stir(setup);
    setup->t = setup->state->t;
    make_wakes(setup);
}

static const char *const fluids[] = {"", "fluid: {walls: [-1]}\n", "fluid: {walls: [-1, 2]}\n"};

// with walls only the impulse along the walls is conserved: the walls exert a force across
TEST(a_body_and_a_wake_have_opposite_forces_for_each_other) {
    for (int w = 0; w < 3; w++) {
        struct setup setup;
        build(&setup, fluids[w]);
        assert_int_equal(setup.residual->flow->n_classes, 2);
        for (int f = 0; f < N_FISH; f++) {
            for (int g = 0; g < N_FISH; g++) {
                struct felt by_wake, by_body;
                struct sum u = {0}, v = {0};
                feel(&setup, -1, g, &by_wake);
                feel(&setup, f, -1, &by_body);
                for (int c = 0; c < setup.school->fish[f].n_control; c++) {
                    add(&u, by_body.body_q[f][c] * by_wake.body_u[f][c]);
                    add(&v, by_body.body_q[f][c] * by_wake.body_v[f][c]);
                }
                for (int i = 0; i < N_MARKERS; i++) {
                    add(&u, by_wake.wake_q[g][i] * by_body.wake_u[g][i]);
                    add(&v, by_wake.wake_q[g][i] * by_body.wake_v[g][i]);
                }
                if (w == 0) vanishes(&u);
                vanishes(&v);
            }
        }
    }
}

TEST(two_wakes_have_opposite_forces_for_each_other) {
    for (int w = 0; w < 3; w++) {
        struct setup setup;
        build(&setup, fluids[w]);
        for (int f = 0; f < N_FISH; f++) {
            for (int g = 0; g <= f; g++) {
                struct felt by_f, by_g;
                struct sum u = {0}, v = {0}, virial = {0};
                feel(&setup, -1, f, &by_f);
                feel(&setup, -1, g, &by_g);
                for (int i = 0; i < N_MARKERS; i++) {
                    add(&u, by_f.wake_q[f][i] * by_g.wake_u[f][i]);
                    add(&v, by_f.wake_q[f][i] * by_g.wake_v[f][i]);
                    add(&u, by_g.wake_q[g][i] * by_f.wake_u[g][i]);
                    add(&v, by_g.wake_q[g][i] * by_f.wake_v[g][i]);
                    // x . u, a term of the angular impulse
                    for (int k = 0; k < 2; k++) {
                        const struct felt *const of = k ? &by_g : &by_f, *const by = k ? &by_f : &by_g;
                        const int h = k ? g : f;
                        add(&virial, of->wake_q[h][i] * of->wake_x[h][i] * by->wake_u[h][i]);
                        add(&virial, of->wake_q[h][i] * of->wake_y[h][i] * by->wake_v[h][i]);
                    }
                }
                if (w == 0) {
                    vanishes(&u);
                    vanishes(&virial);
                }
                vanishes(&v);
            }
        }
    }
}

TEST(a_wake_acts_on_another_with_its_own_depth) {
    struct setup setup;
    school_build(&setup, TIME SHEET
                 "defaults: {fish: {force: pressure, pressure: {span: finite}, nodes: 5, sheet_points: 11, body: "
                 "{depth: 0.5}}}\n"
                 "fish: [{body: {depth: 1}}, {start: {position: [0.3, 0.5]}}, {start: {position: [0.2, 0.8]}}]\n");
    school_stir(&setup);
    make_wakes(&setup);
    const struct flow *const flow = setup.residual->flow;
    assert_int_equal(flow->n_classes, 1);
    for (int i = 0; i < N_FISH * N_FISH; i++) {
        const int f = i / N_FISH, g = i % N_FISH;
        if (f == g) continue;
        struct felt by_f;
        feel(&setup, -1, f, &by_f);
        const struct sources *const from = &flow->fish[f].markers, *const to = &flow->fish[g].markers;
        const struct kernel_pair pair = flow_pair_of(flow, g, f, &(struct flow_sum){WAKE_AT_WAKE, false});
        double u[N_MARKERS] = {0}, v[N_MARKERS] = {0};
        kernel_induce(&pair, from, (struct range){0, N_MARKERS},
                      &(struct targets){N_MARKERS, to->x, to->y, to->half, to->leg, .u = u, .v = v});
        NEAR_ARRAY(N_MARKERS, by_f.wake_u[g], u, 1e-14, 1e-12);
        NEAR_ARRAY(N_MARKERS, by_f.wake_v[g], v, 1e-14, 1e-12);
        ABOVE(fabs(u[0]), 1e-5);
    }
}

#define MIRRORED(y, heading, phase)                                                                \
    "force: pressure, nodes: 7, sheet_points: 26, pressure: {span: finite}, wave: {phase: " #phase \
    "}, "                                                                                          \
    "start: {position: [0, " #y "], heading: " #heading "}"

// every sum begins at zero, whatever the arrays hold
TEST(sums_do_not_depend_on_the_evaluation_before) {
    struct simulation *const simulation = school_simulation(
        TIME SHEET "fluid: {walls: [-0.6, 0.8]}\nfish: [{" MIRRORED(0.3, 170, 0) "}, {" MIRRORED(-0.3, 190, 90) "}]\n");
    school_run(simulation, 0.1);
    struct flow *const flow = simulation->residual->flow;
    double *const all[] = {flow->u,
                           flow->v,
                           flow->u_x,
                           flow->u_y,
                           flow->v_x,
                           flow->div,
                           flow->div_x,
                           flow->div_y,
                           flow->image_u,
                           flow->image_v,
                           flow->image_div,
                           flow->wake_u,
                           flow->wake_v,
                           flow->wake_div,
                           flow->wake_rate,
                           flow->wake_leg_u,
                           flow->wake_leg_v,
                           flow->wake_leg_div,
                           flow->wake_image_u,
                           flow->wake_image_v,
                           flow->wake_image_div};
    enum { N = sizeof all / sizeof *all, MOST = 256 };
    static double kept[N][MOST];
    double rate[2][6];
    AT_MOST(flow->n_points, MOST);
    AT_MOST(flow->n_markers, MOST);
    for (int again = 0; again < 2; again++) {
        flow_gradient(flow, simulation->state, simulation->state->t, simulation->state->y, false);
        flow_at_wake(flow, simulation->state);
        flow_images(flow, simulation->state);
        flow_leg_boxes(flow);
        flow_leg_rate(flow, simulation->state, 0, rate[again], rate[again] + 3);
        for (int k = 0; k < N; k++) {
            for (int i = 0; i < (k < 11 ? flow->n_points : flow->n_markers); i++) {
                if (again) NEAR(all[k][i], kept[k][i], 0, 0);
                kept[k][i] = all[k][i];
                all[k][i] = 7;
            }
        }
    }
    NEAR_ARRAY(6, rate[1], rate[0], 0, 0);
}

// a wall between a fish and its mirror image changes nothing, also for rings, whose circulation changes
TEST(a_wall_is_a_mirror) {
    static const char *const texts[] = {"fluid: {walls: [0]}\nfish: [{" MIRRORED(0.3, 170, 0) "}]\n",
                                        "fish: [{" MIRRORED(0.3, 170, 0) "}, {" MIRRORED(-0.3, 190, 180) "}]\n"};
    struct simulation *simulation[2];
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text, TIME SHEET "solver: {rtol: 1e-9}\n%s", texts[i]);
        simulation[i] = school_simulation(text);
        school_run(simulation[i], 0.4);
        flow_at_wake(simulation[i]->residual->flow, simulation[i]->state);
    }
    const int n = simulation[0]->state->wake[0].n_vortex;
    const struct wake *const with = &simulation[0]->state->wake[0], *const without = &simulation[1]->state->wake[0];
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(with->rate[i]));
    ABOVE(largest, 1e-3);
    NEAR_ARRAY(n, with->rate, without->rate, 1e-6 * largest, 0);
    NEAR_ARRAY(n, with->x, without->x, 1e-7, 0);
    NEAR_ARRAY(n, with->y, without->y, 1e-7, 0);
}
