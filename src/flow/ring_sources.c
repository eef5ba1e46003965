/* ring_sources.c: rings of bodies, and points of wakes. */
#include "flow/ring_sources.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum status ring_sources_create(struct flow_rings **rings, const struct school *school, int n_points) {
    *rings = NULL;
    struct flow_rings *new;
    TRY(MEMORY_NEW(new, 1, "the rings of fish"));
    *rings = new;
    TRY(MEMORY_NEW(new->fish, school->n_fish, "the rings of fish"));
    double **const at_points[] = {&new->div, &new->div_x, &new->div_y, &new->image_div};
    TRY(MEMORY_ARRAYS(at_points, n_points, "the points of the flow"));
    TRY(MEMORY_NEW(new->legs[0], N_LEG_SUMS * n_points, "the points of the flow"));
    for (int i = 1; i < N_LEG_SUMS; i++) new->legs[i] = new->legs[0] + (long)i *n_points;
    TRY(MEMORY_NEW(new->edge, 2 * n_points, "the points of the flow"));
    TRY(MEMORY_NEW(new->edge_gradient, 4 * n_points, "the points of the flow"));
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct fish_rings *const of = &new->fish[f];
        TRY(ring_append(&of->own, fish->n_sheet + fish->n_control));
        TRY(ring_append(&of->body, fish->n_control));
        for (int i = 0; i < 2; i++) TRY(MEMORY_NEW(of->line[i], fish->n_control, "the rings of a fish"));
        memcpy(of->own.half, fish->sheet_half, (size_t)fish->n_sheet * sizeof *of->own.half);
        memcpy(of->own.half + fish->n_sheet, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
        memcpy(of->body.half, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
    }

    return STATUS_OK;
}

void ring_sources_free(struct flow_rings *rings, int n_fish) {
    if (!rings) return;
    for (int f = 0; rings->fish && f < n_fish; f++) {
        struct fish_rings *const of = &rings->fish[f];
        struct rings *const all[] = {&of->own,        &of->body,          &of->markers,
                                     &of->body_image, &of->middles_image, &of->markers_image};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++) ring_free(all[i]);
        ring_sheet_free(&of->graded);
        ring_sheet_free(&of->middles);
        for (int i = 0; i < 2; i++) free(of->line[i]);
    }

    double *const owned[] = {rings->div,           rings->div_x,      rings->div_y,      rings->image_div,
                             rings->edge,          rings->wake_div,   rings->wake_rate,  rings->wake_image_div,
                             rings->edge_gradient, rings->wake_leg_u, rings->wake_leg_v, rings->wake_leg_div,
                             rings->legs[0]};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(rings->fish);
    free(rings);
}

double ring_sources_mirror(const struct school *school) {
    return 2 * school->walls.y[0];
}

// ---- positions

enum status ring_sources_place_wakes(struct flow_rings *rings, const struct school *school, const struct state *state,
                                     double tau, int is_new) {
    int n_placed = 0, n_failed = 0;
    for (int f = 0; f < school->n_fish; f++) n_placed += (is_new ? 4 : 2) * state->wake[f].n_vortex;
    const int threads = parallel_threads(school->threads, school->n_fish, n_placed, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct wake *const wake = &state->wake[f];
        struct ring_sheet *const graded = &rings->fish[f].graded, *const middles = &rings->fish[f].middles;
        enum status status = STATUS_OK;
        if (is_new) status = ring_sheet_build(graded, RING_GRADED, fish, school, wake);
        if (is_new && status == STATUS_OK) status = ring_sheet_build(middles, RING_MIDDLES, fish, school, wake);
        if (status == STATUS_OK) {
            ring_sheet_place(graded, fish, school, wake, state->t, tau);
            ring_sheet_place(middles, fish, school, wake, state->t, tau);
        } else {
#pragma omp atomic
            n_failed++;
        }
    }

    // messages are per thread: write the message on the calling thread
    return n_failed == 0 ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: free sheets of %d fish", n_failed);
}

// bound vortices, legs and control points of a body
static void place_body(struct fish_rings *of, const struct fish *fish, const struct ring_body *body, const double *y) {
    const int n = fish->n_sheet;
    const size_t size = (size_t)n * sizeof(double);
    memcpy(of->own.x, body->sheet[0], size);
    memcpy(of->own.y, body->sheet[1], size);
    memcpy(of->own.q, body->circulation, size);
    for (int c = 0; c < fish->n_control; c++) {
        const double *const of_point = fish->integrals->circulation + (long)c * n;
        const struct stencil *const slope = &fish->control_tangent[c].to;
        double before = 0;
        for (int j = 0; j < n; j++) before += of_point[j] * body->circulation[j];
        of->line[0][c] = fish->control_interval[c] * fish_mean(slope, y + fish->at.x);
        of->line[1][c] = fish->control_interval[c] * fish_mean(slope, y + fish->at.y);
        of->body.x[c] = of->own.x[n + c] = body->point[0][c];
        of->body.y[c] = of->own.y[n + c] = body->point[1][c];
        of->body.dx[c] = of->own.dx[n + c] = before * of->line[0][c];
        of->body.dy[c] = of->own.dy[n + c] = before * of->line[1][c];
        of->body.q[c] = sheet_integrals_around(fish->integrals, c, body->circulation);
    }
}

enum status ring_sources_place(struct flow_rings *rings, const struct school *school, const struct state *state, int f,
                               double tau, const double *y, const struct ring_body *body, double *nascent) {
    const struct fish *const fish = &school->fish[f];
    const struct wake *const wake = &state->wake[f];
    struct fish_rings *const of = &rings->fish[f];
    const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
    const double shed = y[fish->at.circulation];

    place_body(of, fish, body, y);
    ring_sheet_place_nascent(&of->graded, fish, school, wake, state->t, tau, tail, shed);
    *nascent = ring_sheet_place_nascent(&of->middles, fish, school, wake, state->t, tau, tail, shed);
    double newest[2] = {tail[0], tail[1]};
    if (wake->n_vortex > 0) wake_marker(wake, wake->n_vortex - 1, school->interval, tau, newest);
    of->newest[0] = shed - *nascent;
    for (int i = 0; i < 2; i++) of->newest[1 + i] = newest[i] - tail[i];
    if (school->walls.n == 0) return STATUS_OK;
    TRY(ring_mirror(&of->body, ring_sources_mirror(school), &of->body_image));
    return ring_mirror(&of->middles.rings, ring_sources_mirror(school), &of->middles_image);
}
