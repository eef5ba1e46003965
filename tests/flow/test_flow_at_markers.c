/* test_flow_at_markers.c: smoothing between markers and bodies, and conservation of the impulse of bodies and wakes
 * pair by pair. doc/model.md, section 8. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "school.h"
#include "vortex/images.h"
#include "vortex/kernel.h"

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
        struct wake *const wake = &setup->state->wake[f];
        double *const y = setup->state->y;
        const int last = fish->n_nodes - 1;
        const double tail[2] = {y[fish->at.x + last], y[fish->at.y + last]};
        const struct direction body = fish_direction(fish, &fish->tail_tangent, y);
        school_ok(wake_resize(wake, N_MARKERS));
        double label = 0;
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
        for (int i = 0; i < N_MARKERS; i++) {
            wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
            wake->birth[i] = setup->state->t - 0.01 * (N_MARKERS - 1 - i);
        }

        wake_set_tail(wake, (const double[]){0, 0}, body.t);
        wake->shed_before = label;
        y[fish->at.circulation] = label;
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

    school_ok(flow_velocity(flow, state, state->t, state->y));
    for (int f = 0; f < N_FISH; f++) {
        for (int c = 0; c < school->fish[f].n_control; c++) {
            felt->body_u[f][c] = flow->u[flow->points[f].first + c];
            felt->body_v[f][c] = flow->v[flow->points[f].first + c];
        }
    }

    school_ok(flow_at_wake(flow, state));
    for (int f = 0; f < N_FISH; f++) {
        for (int i = 0; i < N_MARKERS; i++) {
            const int at = flow->wake_range[f].first + i;
            felt->wake_u[f][i] = flow->wake_u[at];
            felt->wake_v[f][i] = flow->wake_v[at];
            felt->wake_x[f][i] = flow->convecting.x[at];
            felt->wake_y[f][i] = flow->convecting.y[at];
            felt->wake_q[f][i] = flow->convecting.circulation[at];
        }

        for (int c = 0; c < school->fish[f].n_control; c++) {
            felt->body_q[f][c] = flow->convecting.circulation[flow->body_range[f].first + c];
        }

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
    assert_true(sum->size > 1e-6);
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
static void a_body_and_a_wake_have_opposite_forces_for_each_other(void **state) {
    (void)state;
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

        school_clear(&setup);
    }
}

static void two_wakes_have_opposite_forces_for_each_other(void **state) {
    (void)state;
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

        school_clear(&setup);
    }
}

// velocity of unit vortices at (x, y) with the smoothing of the pair
static void add_unit(double strength, double x, double y, double from_x, double from_y, double smoothing, double *u,
                     double *v) {
    struct kernel_values unit;
    kernel_unit(1, &x, &y, from_x, from_y, smoothing, &unit);
    *u += strength * *unit.u;
    *v += strength * *unit.v;
}

// velocity of fish g at marker i of fish f, written out
static void add_fish(const struct setup *setup, int f, int i, int g, double *u, double *v) {
    const struct fish *const fish = &setup->school->fish[f], *const other = &setup->school->fish[g];
    const struct state *const state = setup->state;
    const struct wake *const own = &state->wake[f], *const wake = &state->wake[g];
    const double x = own->x[i], y = own->y[i];
    double strength[64];

    free_sheet_strengths(wake, setup->school, state->t, state->y[other->at.circulation] - wake->shed_before, strength);
    const double both = sqrt((fish->smoothing * fish->smoothing + other->smoothing * other->smoothing) / 2);
    for (int k = 0; k < wake->n_vortex; k++) add_unit(strength[k], x, y, wake->x[k], wake->y[k], both, u, v);
    const int last = fish->n_nodes - 1;
    const double tail[2] = {state->y[fish->at.x + last], state->y[fish->at.y + last]};
    const struct direction body = fish_direction(fish, &fish->tail_tangent, state->y);
    const double r[2] = {x - tail[0], y - tail[1]};
    const double along = own->slip[0] * body.t[0] + own->slip[1] * body.t[1];
    const double behind = fmax(0, along) * setup->school->interval / (2 * M_PI);
    const int is_newborn = f == g && i == own->n_vortex - 1;
    const double smoothing = is_newborn ? 0 : f == g ? free_sheet_smoothing(fish, r, body.t) : fish->smoothing;
    const double at[2] = {is_newborn ? tail[0] + behind * body.t[0] : x, is_newborn ? tail[1] + behind * body.t[1] : y};
    double circulation[64];
    for (int j = 0; j < other->n_sheet; j++) {
        circulation[j] = other->sheet_weight[j] * state->y[other->at.gamma + j];
    }

    const int by_control = other->force == FORCE_PRESSURE, n = by_control ? other->n_control : other->n_sheet;
    double around[64];
    if (by_control) sheet_integrals_around(other->integrals, circulation, around);
    for (int c = 0; c < n; c++) {
        const struct stencil *const point = by_control ? &other->control_point[c] : &other->sheet_point[c];
        add_unit(by_control ? around[c] : circulation[c], at[0], at[1], fish_mean(point, state->y + other->at.x),
                 fish_mean(point, state->y + other->at.y), smoothing, u, v);
    }
}

static void markers_feel_the_sources_that_the_model_says(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fluid: {velocity: [0.1, 0.2], shear: 0.3}\n" SCHOOL
                                    "  - {force: reactive, length: 0.7, start: {position: [0.4, -0.3]}}\n");
    school_stir(&setup);
    setup.t = setup.state->t;
    struct flow *const flow = setup.residual->flow;
    for (int f = 0; f < 4; f++) {
        // the newest marker starts at the tail; the slip points backwards, for one fish forwards
        const struct fish *const fish = &setup.school->fish[f];
        struct wake *const wake = &setup.state->wake[f];
        const struct direction body = fish_direction(fish, &fish->tail_tangent, setup.state->y);
        wake->x[wake->n_vortex - 1] = setup.state->y[fish->at.x + fish->n_nodes - 1];
        wake->y[wake->n_vortex - 1] = setup.state->y[fish->at.y + fish->n_nodes - 1];
        for (int k = 0; k < 2; k++) wake->slip[k] = (f == 1 ? -1 : 1) * body.t[k] + 0.3 * body.n[k];
        wake->version++;
    }

    school_ok(flow_at_wake(flow, setup.state));
    for (int f = 0; f < 4; f++) {
        const struct wake *const wake = &setup.state->wake[f];
        for (int i = 0; i < wake->n_vortex; i++) {
            double u, v;
            flow_external(setup.school, setup.t, wake->x[i], wake->y[i], &u, &v);
            for (int g = 0; g < 4; g++) add_fish(&setup, f, i, g, &u, &v);
            // rounding of sums of 60 terms, each at most 100 next to the tail
            NEAR(flow->wake_u[flow->wake_range[f].first + i], u, 1e-13, 1e-12);
            NEAR(flow->wake_v[flow->wake_range[f].first + i], v, 1e-13, 1e-12);
        }
    }

    school_clear(&setup);
}

static void bodies_feel_the_sheets_of_others_with_the_mean_of_squares(void **state) {
    (void)state;
    struct setup setup;
    build(&setup, "");
    const struct flow *const flow = setup.residual->flow;
    for (int f = 0; f < N_FISH; f++) {
        for (int g = 0; g < N_FISH; g++) {
            struct felt felt;
            const struct fish *const fish = &setup.school->fish[f], *const other = &setup.school->fish[g];
            const double e = 0.05 * sqrt((fish->length * fish->length + other->length * other->length) / 2);
            NEAR(flow_sheet_smoothing(flow, f, g), e, 0, 1e-15);
            if (f == g) continue;
            feel(&setup, g, -1, &felt);
            for (int c = 0; c < fish->n_control; c++) {
                const int p = flow->points[f].first + c;
                double u = 0, v = 0;
                for (int j = 0; j < other->n_sheet; j++) {
                    const struct stencil *const at = &other->sheet_point[j];
                    add_unit(other->sheet_weight[j] * setup.state->y[other->at.gamma + j], flow->x[p], flow->y[p],
                             fish_mean(at, setup.state->y + other->at.x), fish_mean(at, setup.state->y + other->at.y),
                             e, &u, &v);
                }
                NEAR(felt.body_u[f][c], u, 1e-14, 1e-13);
                NEAR(felt.body_v[f][c], v, 1e-14, 1e-13);
            }
        }
    }

    school_clear(&setup);
}

// ---- many

enum { MANY_FISH = 30, MANY_SHEET = 100, MANY_MARKERS = 70 };

/* A school with sheets and wakes large enough for the tree if the tolerance is not 0; two lengths: the tree sums the
 * points and markers of one length. */
static void build_many(struct setup *setup, const char *fluid, double length) {
    char text[8192];
    size_t used = (size_t)snprintf(text, sizeof text, TIME SHEET "%sdefaults: {fish: {sheet_points: %d}}\nfish:\n",
                                   fluid, MANY_SHEET);

    for (int f = 0; f < MANY_FISH; f++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "  - {length: %g, start: {position: [%g, %g]}}\n",
                                 f % 4 == 1 ? length : 1, 1.4 * (f % 6) + 0.1 * (f / 6), 0.5 * (f / 6));
        assert_true(used < sizeof text);
    }

    school_build(setup, text);
    school_stir(setup);
    setup->t = setup->state->t;
    school_fill_wakes(setup, MANY_MARKERS);
}

/* Velocities at all points of the bodies and all markers: u of both, then v of both. */
static double *feel_many(struct setup *setup) {
    struct flow *const flow = setup->residual->flow;
    const size_t n = (size_t)flow->n_points, m = MANY_FISH * MANY_MARKERS;
    double *const u = malloc(2 * (n + m) * sizeof *u), *const v = u + n + m;

    assert_non_null(u);
    school_ok(flow_velocity(flow, setup->state, setup->t, setup->state->y));
    memcpy(u, flow->u, n * sizeof *u);
    memcpy(v, flow->v, n * sizeof *v);
    school_ok(flow_at_wake(flow, setup->state));
    assert_int_equal(flow->n_markers, (int)m);
    memcpy(u + n, flow->wake_u, m * sizeof *u);
    memcpy(v + n, flow->wake_v, m * sizeof *v);
    return u;
}

static void by_tree_and_cells_it_is_the_direct_sum_to_the_tolerance(void **state) {
    (void)state;
    static const char *const many_fluids[] = {"", "fluid: {walls: [-1.5]}\n", "fluid: {walls: [-1.5, 4]}\n"};
    for (int w = 0; w < 6; w++) {
        struct setup setup;
        build_many(&setup, many_fluids[w / 2], w % 2 ? 0.7 : 1);
        struct flow *const flow = setup.residual->flow;
        const int n = flow->n_points + MANY_FISH * MANY_MARKERS;
        assert_int_equal(flow->n_classes, 1 + w % 2);
        setup.school->wake_tolerance = 0;
        double *const direct = feel_many(&setup);
        setup.school->wake_tolerance = 1e-6;
        double *const by_tree = feel_many(&setup);
        assert_true(velocity_sum_by_tree(&flow->convecting, flow->class[0].markers.n, setup.school->wake_tolerance));
        assert_true(flow->class[0].sheet_by_tree);
        if (w % 2) {
            assert_false(
                velocity_sum_by_tree(&flow->convecting, flow->class[1].markers.n, setup.school->wake_tolerance));
            assert_false(flow->class[1].sheet_by_tree);
        }

        double worst = 0;
        for (int i = 0; i < n; i++) {
            worst = fmax(worst, hypot(by_tree[i] - direct[i], by_tree[n + i] - direct[n + i]));
        }

        // a tenth of the tolerance times the velocity without cancellation, about ten lengths per beat
        assert_true(worst > 0 && worst < 1e-6);
        setup.school->threads = 3;
        double *const more = feel_many(&setup);
        assert_memory_equal(more, by_tree, 2 * (size_t)n * sizeof *more);
        setup.school->threads = 1;
        free(more);
        free(direct);
        free(by_tree);
        school_clear(&setup);
    }
}

static void without_memory_it_fails(void **state) {
    (void)state;
    for (int k = 0, failed = 1; failed; k++) {
        struct setup setup;
        build(&setup, "");
        const int live = n_live;
        n_until_failure = k;
        const enum status status = flow_at_wake(setup.residual->flow, setup.state);
        n_until_failure = -1;
        failed = status != STATUS_OK;
        assert_int_equal(status, failed ? STATUS_MEMORY : STATUS_OK);
        assert_true(failed || (k > 3 && n_live > live));
        school_clear(&setup);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_and_a_wake_have_opposite_forces_for_each_other),
        cmocka_unit_test(two_wakes_have_opposite_forces_for_each_other),
        cmocka_unit_test(markers_feel_the_sources_that_the_model_says),
        cmocka_unit_test(bodies_feel_the_sheets_of_others_with_the_mean_of_squares),
        cmocka_unit_test(by_tree_and_cells_it_is_the_direct_sum_to_the_tolerance),
        cmocka_unit_test(without_memory_it_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
