/* test_others.c: Velocities that come from distant sources through far points agree with the sum over all sources
 * within the tolerance (doc/numerics.md, section 12). */
#include <stdio.h>
#include <string.h>

#include "flow/flow_at_bodies.h"
#include "flow/others.h"
#include "school.h"

/* The stream gives bodies strengths from the start on. */
#define TIME "time: {end: 2, shedding_interval: 0.02}\nsolver: {rtol: 1e-5}\nfluid: {velocity: [0, 0.1]}\n"

/* Fish of two lengths, near each other and behind each other. */
#define SCHOOL                                                                                    \
    "defaults: {fish: {nodes: 9, sheet_points: 26, start: {speed: 0.8}, pressure: {span: %s}}}\n" \
    "fish:\n"                                                                                     \
    "  - {}\n"                                                                                    \
    "  - {start: {position: [1.6, 0]}}\n"                                                         \
    "  - {length: 0.7, start: {position: [0.2, 0.9]}}\n"                                          \
    "  - {start: {position: [-2.5, 1.4]}}\n"

static struct simulation *swum(const char *span, double t) {
    struct simulation *const simulation = school_simulation_of(TIME SCHOOL, span);
    school_run(simulation, t);
    return simulation;
}

/* The tree for any number of sources. */
static struct kernel always;
static const struct kernel *kernel_of(const struct flow *flow, bool by_tree) {
    always = *flow->kernel;
    always.tree_sources = always.far_sources = 0;
    always.tree_interactions = by_tree ? 0 : INFINITY;
    return &always;
}

enum { SUMS = 8, MOST_POINTS = 2048 };
static double kept[SUMS][MOST_POINTS];
static void keep(struct flow *flow, double *sums[SUMS]) {
    double *const all[SUMS] = {flow->u, flow->v, flow->div, flow->u_x, flow->u_y, flow->v_x, flow->div_x, flow->div_y};
    AT_MOST(flow->n_points, MOST_POINTS);
    for (int k = 0; k < SUMS; k++) {
        memcpy(kept[k], all[k], sizeof(double) * (size_t)flow->n_points);
        sums[k] = all[k];
    }
}

// velocities within an interval, with the bodies displaced from the path of the event: below wake.tolerance, and the
// far points are used: the errors are not rounding. From the first interval on, in which bodies have no wake
TEST(errors_are_below_the_tolerance) {
    static const char *const spans[] = {"infinite", "finite", "infinite", "finite"};
    for (int k = 0; k < 8; k++) {
        struct simulation *const simulation = swum(spans[k / 2], k < 4 ? 0.8 : 0);
        struct school *const school = simulation->school;
        struct flow *const flow = simulation->residual->flow;
        const struct state *const at = simulation->state;
        flow->kernel = kernel_of(flow, k % 2 == 1);
        double y[4096], *sums[SUMS], worst = 0, gradient = 0;
        AT_MOST(school->n_unknowns, 4096);
        for (int part = 0; part <= 4; part++) {
            const double tau = part * school->interval / 4;
            memcpy(y, at->y, sizeof *y * (size_t)school->n_unknowns);
            for (int f = 0; f < school->n_fish; f++) {
                const struct fish *const fish = &school->fish[f];
                for (int i = 0; i < 2 * fish->n_nodes; i++) {
                    y[fish->at.x + i] +=
                        tau * (y[fish->at.vx + i] + tau / 2 * y[fish->at.ax + i]) + 1e-4 * part * sin(0.3 * i);
                }
            }
            for (int exact = 0; exact < 2; exact++) {
                const double tolerance = school->wake_tolerance;
                school->wake_tolerance = exact ? 0 : tolerance;
                flow_gradient(flow, at, at->t + tau, y, false);
                assert_true(others_are_selected(flow) == !exact);
                if (!exact) keep(flow, sums);
                school->wake_tolerance = tolerance;
            }
            for (int s = 0; s < SUMS; s++) {
                for (int p = 0; p < flow->n_points; p++) {
                    double *const to = s < 3 ? &worst : &gradient;
                    *to = fmax(*to, fabs(kept[s][p] - sums[s][p]));
                }
            }
        }

        // the smallest body: 0.7 lengths per beat
        print_message("%s, %s: velocity and divergence %.2g, gradients %.2g\n", spans[k / 2], k % 2 ? "tree" : "sums",
                      worst, gradient);
        const double unit = school->wake_tolerance * 0.7 * fish_rate(school, &school->fish[2]);
        BELOW(worst, unit);
        ABOVE(worst, 1e-6 * unit);
        BELOW(gradient, 200 * unit);
    }
}

// the largest error of velocity and divergence at fish 0 for the unknowns y at the event, over the tolerance
static double error_of(struct simulation *simulation, const double *y, bool by_tree) {
    struct school *const school = simulation->school;
    struct flow *const flow = simulation->residual->flow;
    const struct state *const at = simulation->state;
    const double tolerance = school->wake_tolerance;
    double *sums[SUMS], worst = 0;
    flow->kernel = kernel_of(flow, by_tree);
    flow_gradient(flow, at, at->t, y, false);
    assert_true(others_are_selected(flow));
    keep(flow, sums);
    school->wake_tolerance = 0;
    flow_gradient(flow, at, at->t, y, false);
    school->wake_tolerance = tolerance;
    for (int s = 0; s < 3; s++) {
        for (int p = 0; p < flow->points[0].n; p++) {
            const int i = flow->points[0].first + p;
            worst = fmax(worst, fabs(kept[s][i] - sums[s][i]));
        }
    }
    return worst / (tolerance * school->fish[0].length * fish_rate(school, &school->fish[0]));
}

/* Two straight fish far apart, at rest; the wake of the other one is put to a place, with labels that grow by this. */
static struct simulation *beside(const char *tolerance, const double place[2], double circulation) {
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 2, shedding_interval: 0.02}\nwake: {tolerance: %s}\n"
        "defaults: {fish: {nodes: 33, sheet_points: 65, wave: {amplitude: 0}}}\n"
        "fish: [{}, {start: {position: [0, 9]}}]\n",
        tolerance);
    school_run(simulation, 0.1);
    struct wake *const wake = &simulation->state->wake[1];
    for (int i = 0; i < wake->n_vortex; i++) {
        wake->x[i] = place[0] + 0.01 * i;
        wake->y[i] = place[1];
        wake->circulation[i] = circulation * i;
    }
    wake->version++;
    return simulation;
}

// the tree includes near bodies, which are subtracted
TEST(bodies_of_many_fish_act_by_the_tree) {
    for (int finite = 0; finite < 2; finite++) {
        char text[4096];
        int end = snprintf(text, sizeof text,
                           TIME
                           "defaults: {fish: {nodes: 9, sheet_points: 26, start: {speed: 0.8}, pressure: {span: "
                           "%s}}}\nfish:\n",
                           finite ? "finite" : "infinite");
        // the first one in the middle
        for (int i = 0; i < 36; i++) {
            const int place = (i + 14) % 36;
            end += snprintf(text + end, sizeof text - (size_t)end, "  - {start: {position: [%d, %d]}}\n",
                            2 * (place % 6), place / 6);
        }
        struct simulation *const simulation = school_simulation(text);
        school_run(simulation, 0.1);
        double *const y = simulation->state->y;
        const double errors[] = {error_of(simulation, y, true), error_of(simulation, y, false)};
        BELOW(errors[0], 1);
        ABOVE(fabs(errors[0] - errors[1]), 1e-4);
    }
}

// behind the middle of a horseshoe a vortex is far from both ends of the body, and near the body
TEST(beside_a_bent_body_no_source_is_far) {
    struct simulation *const simulation = beside("1.0e-4", (const double[]){0, 0}, 0.1);
    const struct fish *const fish = &simulation->school->fish[0];
    struct state *const at = simulation->state;
    double *const x = at->y + fish->at.x, *const y = at->y + fish->at.y;
    for (int k = 0; k < fish->n_edges; k++) {
        const double angle = 2.6 * ((k + 0.5) / fish->n_edges - 0.5);
        x[k + 1] = x[k] + fish->edge_length * cos(angle);
        y[k + 1] = y[k] + fish->edge_length * sin(angle);
    }
    struct wake *const wake = &at->wake[1];
    const double shift[2] = {x[16] - wake->x[0], y[16] - 0.15 - wake->y[0]};
    for (int i = 0; i < wake->n_vortex; i++) wake->x[i] += shift[0], wake->y[i] += shift[1];
    memcpy(at->past, at->y, sizeof *at->y * (size_t)simulation->school->n_unknowns);
    const double error = error_of(simulation, at->y, false);
    BELOW(error, 1);
}

// a straight body is displaced within the interval by 3e-4 lengths, beside strong vortices
TEST(a_displaced_body_has_fewer_far_sources) {
    struct simulation *const simulation = beside("1.0e-8", (const double[]){0.5, 1.2}, 5);
    const struct fish *const fish = &simulation->school->fish[0];
    double y[4096];
    AT_MOST(simulation->school->n_unknowns, 4096);
    memcpy(y, simulation->state->y, sizeof *y * (size_t)simulation->school->n_unknowns);
    for (int k = 0; k < fish->n_nodes; k++) y[fish->at.y + k] += 3e-4 * fish->length;
    const double error = error_of(simulation, y, false);
    BELOW(error, 1);
}

// a wake that stands on the middle of a straight body, whose middle is far away and whose end is near
TEST(a_wake_that_is_far_in_the_middle_may_be_near_at_its_end) {
    struct simulation *const simulation = beside("1.0e-5", (const double[]){0.5, 0}, 0.1);
    struct wake *const wake = &simulation->state->wake[1];
    for (int i = 0; i < wake->n_vortex; i++) wake->x[i] = 0.5, wake->y[i] = 0.1 + 0.4 * i;
    const double error = error_of(simulation, simulation->state->y, false);
    BELOW(error, 1);
}

// A body and its wake ahead on the axis of another body, where the strongest source has the longest reach. The circle
// around them saves the search beyond the reach, unless a marker without strength, far away, makes the circle large.
TEST(no_near_source_is_beyond_the_reach) {
    int n_near_at = 0;
    for (double ahead = 1.5; ahead < 5; ahead *= 1.15) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 2, shedding_interval: 0.02}\nwake: {tolerance: 1.0e-8}\n"
            "defaults: {fish: {nodes: 33, sheet_points: 65, wave: {amplitude: 0}}}\n"
            "fish: [{}, {start: {position: [%g, 0]}}]\n",
            ahead);
        school_run(simulation, 0.1);
        struct wake *const wake = &simulation->state->wake[1];
        for (int i = 0; i < wake->n_vortex; i++) {
            wake->x[i] = ahead + 0.01 * i;
            wake->y[i] = 0;
            wake->circulation[i] = i < 2 ? 0 : i;
        }

        int n[2] = {0, 0};
        for (int is_large = 0; is_large < 2; is_large++) {
            if (is_large) wake->y[0] = 1000;
            wake->version++;
            flow_velocity(simulation->residual->flow, simulation->state, simulation->state->t, simulation->state->y,
                          false);
            assert_true(others_are_selected(simulation->residual->flow));
            int n_of;
            const struct near_sources *const of = others_near(simulation->residual->flow, 0, &n_of);
            for (int i = 0; i < n_of; i++) {
                // all but the stretch at that marker
                if (of[i].fish == 1) n[is_large] += of[i].wake.n - (of[i].wake.n > 0 && of[i].wake.first == 0);
            }
        }
        assert_int_equal(n[0], n[1]);
        n_near_at += n[0] > 0;
    }
    assert_in_range(n_near_at, 2, 8);  // of 9
}

// a shift of everything leaves every source as far as it was
TEST(what_is_far_does_not_depend_on_the_origin) {
    struct simulation *const simulation = swum("finite", 0.8);
    const struct school *const school = simulation->school;
    struct state *const at = simulation->state;
    const double shift[] = {64, -32};
    int near[2][64] = {{0}}, n_far = 0;
    for (int moved = 0; moved < 2; moved++) {
        flow_velocity(simulation->residual->flow, at, at->t, at->y, false);
        for (int f = 0; f < 4; f++) {
            int n_near;
            const struct near_sources *const of = others_near(simulation->residual->flow, f, &n_near);
            for (int i = 0; i < n_near; i++) {
                int *const to = &near[moved][16 * f + 4 * of[i].fish];
                to[0] += of[i].with_body;
                to[1]++;
                to[2] += of[i].wake.n;
            }
            for (int g = 0; g < 4; g++) n_far += near[moved][16 * f + 4 * g] == 0;
        }
        for (int f = 0; f < 4; f++) {
            const struct layout *const layout = &school->fish[f].at;
            for (int i = layout->x; i < layout->vx; i++) {
                at->y[i] += shift[i >= layout->y];
                for (int p = 0; p < STATE_PAST; p++) at->past[p * school->n_unknowns + i] += shift[i >= layout->y];
            }
            for (int i = 0; i < at->wake[f].n_vortex; i++) at->wake[f].x[i] += shift[0], at->wake[f].y[i] += shift[1];
            at->wake[f].version++;
        }
    }
    AT_LEAST(n_far, 2);
    assert_memory_equal(near[0], near[1], sizeof near[0]);
}

// one body that has left the path of its event: every body feels all sources
TEST(a_body_elsewhere_feels_all_sources) {
    struct simulation *const simulation = swum("finite", 0.8);
    struct school *const school = simulation->school;
    struct flow *const flow = simulation->residual->flow;
    struct state *const at = simulation->state;
    const struct fish *const fish = &school->fish[0];
    for (int k = 0; k < fish->n_nodes; k++) at->y[fish->at.y + k] -= 0.3;
    double *sums[SUMS];
    flow_gradient(flow, at, at->t, at->y, false);
    assert_false(others_are_selected(flow));
    keep(flow, sums);
    school->wake_tolerance = 0;
    flow_gradient(flow, at, at->t, at->y, false);
    assert_memory_equal(flow->u, kept[0], sizeof(double) * (size_t)flow->n_points);
    assert_memory_equal(flow->div, kept[2], sizeof(double) * (size_t)flow->n_points);
}

// the selection depends on the state alone, not on evaluations before
TEST(bits_do_not_depend_on_threads_or_evaluations_before) {
    struct simulation *const simulation = swum("finite", 0.8);
    struct school *const school = simulation->school;
    const struct state *const at = simulation->state;
    struct flow *const flow = simulation->residual->flow;
    for (int k = 0; k < 2; k++) {
        flow->kernel = kernel_of(flow, k == 1);
        double *sums[SUMS];
        at->wake[0].version++;
        flow_gradient(flow, at, at->t + 0.007, at->y, false);
        keep(flow, sums);
        struct flow *const fresh = flow_create(test_arena(), school);
        fresh->kernel = flow->kernel;
        school->threads = 3;
        // first at the end, which needs the far wakes at fewer times
        flow_velocity(fresh, at, at->t + school->interval, at->y, false);
        flow_gradient(fresh, at, at->t + 0.007, at->y, false);
        school->threads = 1;
        assert_memory_equal(fresh->u, kept[0], sizeof(double) * (size_t)flow->n_points);
        assert_memory_equal(fresh->u_x, kept[3], sizeof(double) * (size_t)flow->n_points);
    }
}
