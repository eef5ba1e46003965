/* residual_jacobian.c: the derivatives, in the same order as the equations in residual.c. */
#include "school/residual_jacobian.h"

#include <omp.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/parallel.h"
#include "body/rod.h"
#include "fish/fish_motion.h"
#include "force/bound_sheet.h"

// how the equations of fish f depend on the unknowns of fish g through the velocity of the fluid
static void flow_jacobian(const struct residual *residual, const struct residual_mode *mode, int f, int g,
                          const double *y, struct influence_block *block, struct coupling_block *rows) {
    const struct fish *fish = &residual->school->fish[f];
    const struct fluid_force *const force = &residual->force[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    rows->n_rows = flow_n_rows(fish);
    rows->n_columns = flow_n_columns(&residual->school->fish[g]);
    memset(rows->value, 0, (size_t)rows->n_rows * (size_t)rows->n_columns * sizeof *rows->value);

    flow_derivative(residual->flow, f, g, COLUMNS_OF_ALL, block);

    if (!mode->forces) {
        force->model->flow_jacobian(force, &flow, block, y, rows);
        if (f == g && force->model->own_jacobian) force->model->own_jacobian(force, y, rows);
        contact_jacobian(residual->contact, f, g, y, rows);
    }
    bound_sheet_flow_jacobian(fish, block, y, rows);
    if (residual_sheet_law(residual, mode) == BOUND_SHEET_RATE) {
        bound_sheet_kutta_flow_jacobian(fish, block, y, rows);
    }
}

// Add the rows of a fish to its diagonal block, but only entries that may differ from zero. At the midpoint of an edge,
// the velocity of the fluid depends on the nodes of the edge and, if the fish feels its own wake, on the tail node and,
// through the nascent vortex, on the circulation shed. The flux at the tail depends on the nodes of the last two edges.
// Where the sheet loads the body, or with images in walls, every row depends on every column.
static void add_own_rows(const struct residual *residual, const struct residual_mode *mode, const struct fish *fish,
                         const struct coupling_block *rows, struct sparse *own) {
    const int n_nodes = fish->n_nodes, n_places = 2 * n_nodes;
    const bool has_rate = residual_sheet_law(residual, mode) == BOUND_SHEET_RATE;
    const int felt_at_tail = n_nodes - (fish->tail_added_mass > 0 ? 3 : 2);
    for (int c = 0; c < rows->n_columns; c++) {
        const double *const value = rows->value + (long)c * rows->n_rows;
        const int column = flow_column(fish, c), node = c % n_nodes;
        const bool is_place = c < n_places, is_shed = c == rows->n_columns - 1;

        const bool is_nascent = fish_feels_own_wake(fish) && (is_shed || (is_place && node == n_nodes - 1));
        const bool all = is_nascent || fish_is_loaded_by_sheet(fish) || residual->school->walls.n > 0;
        const int first = all || node == 0 ? 0 : node - 1, last = all || node >= felt_at_tail ? n_nodes - 1 : node + 1;

        for (int k = first; (is_place || all) && k <= last; k++) {
            sparse_add(own, fish->at.ax + k, column, value[k]);
            sparse_add(own, fish->at.ay + k, column, value[n_nodes + k]);
        }
        for (int k = 0; k < fish->n_control; k++) sparse_add(own, fish->at.gamma + k, column, value[n_places + k]);
        if (has_rate) sparse_add(own, fish->at.circulation, column, value[fish->at.circulation - fish->at.ax]);
    }
}

// the derivatives of the equations of one fish, in the order of evaluate_fish
static void fish_jacobian(struct residual *residual, const struct residual_mode *mode, int f, double t, double cj,
                          const double *y, struct jacobian *jacobian) {
    if (residual->stop && *residual->stop) return;
    const struct school *school = residual->school;
    const struct fish *fish = &school->fish[f];
    const struct fluid_force *const force = &residual->force[f];
    struct jacobian_scratch *const jacobian_scratch = &residual->jacobian_scratch[omp_get_thread_num()];
    struct sparse *const own = jacobian->own[f];
    const double *const u = residual->flow->u + residual->flow->points[f].first;
    const double *const v = residual->flow->v + residual->flow->points[f].first;

    // what depends on the unknowns of the fish directly
    sparse_begin(own);
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    if (force->model->update) force->model->update(force, &flow, y, NULL);
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        sparse_add(own, fish->at.x + i, fish->at.x + i, cj);
        sparse_add(own, fish->at.x + i, fish->at.vx + i, -1);
        sparse_add(own, fish->at.ax + i, fish->at.ax + i, 1);
    }
    force->model->motion_jacobian(force, mode->velocities_are_given, cj, y, own);
    const struct actuation muscle = residual_actuate(residual, f, t, y);
    rod_jacobian(fish, &muscle, y, own);
    const struct control_memory *const memory = &residual->state->control[f];
    const double since = t - residual->state->t;
    if (fish->damping == DAMPING_STRAIN && control_rate_varies(fish)) {
        double *const by_rate = jacobian_scratch->by_phi0_rate;
        rod_by_phi0_rate(fish, &muscle, y, by_rate);
        control_rate_jacobian(fish, memory, t, since, y, fish->at.ax, 2 * fish->n_nodes, by_rate, own);
    }
    rod_clamp_jacobian(fish, t, y, own);
    if (!mode->forces) force->model->jacobian(force, &flow, y, own);
    bound_sheet_jacobian(fish, u, v, y, own);
    bound_sheet_kutta_jacobian(fish, residual_sheet_law(residual, mode), cj, u, v, y, own);
    control_jacobian(fish, memory, t, since, y, own);

    // what depends on unknowns through the velocity of the fluid: first those of this fish, then those of coupled fish
    flow_jacobian(residual, mode, f, f, y, &jacobian_scratch->block, &jacobian_scratch->rows);
    add_own_rows(residual, mode, fish, &jacobian_scratch->rows, own);
    for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
        struct jacobian_coupling *const coupling = &jacobian->coupling[i];
        flow_jacobian(residual, mode, f, coupling->other, y, &jacobian_scratch->block, &coupling->rows);

        // prescribed rows have no entries
        const struct coupling_block *const rows = &coupling->rows;
        for (int row = fish->at.ax; row < fish->at.phi0; row++) {
            if (!sparse_is_masked(own, row)) continue;
            for (long c = 0; c < rows->n_columns; c++) rows->value[c * rows->n_rows + (row - fish->at.ax)] = 0;
        }
    }
    sparse_end(own);
}

enum status residual_jacobian(struct residual *residual, const struct residual_mode *mode, double t, double cj,
                              const double *y, struct jacobian *jacobian) {
    const struct school *school = residual->school;
    struct residual_couplings *const couplings = &residual->couplings;
    int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_MATRICES);

    TRY(contact_find(residual->contact, residual->state, t, y));
    jacobian->has_contacts = false;
    for (int f = 0; f < school->n_fish; f++) {
        const int *other;
        const int n = contact_partners(residual->contact, f, &other);
        jacobian->has_contacts |= n > 0;
        for (int i = 0; i < n; i++) {
            unsigned char *const coupled = &couplings->coupled[f * school->n_fish + other[i]];
            if (!*coupled) couplings->pattern++;
            *coupled = 1;
        }
    }

    residual->flow->stop = residual->stop;
    flow_gradient(residual->flow, residual->state, t, y, mode->shed == SHED_IS_FAR);
    if (jacobian->pattern != couplings->pattern) jacobian_couple(jacobian, couplings->coupled, couplings->pattern);

    // recording a new pattern requests memory, which no parallel region may do
    for (int f = 0; f < school->n_fish; f++) {
        if (jacobian->own[f]->recording) threads = 1;
    }
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) fish_jacobian(residual, mode, f, t, cj, y, jacobian);
    } else {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int f = 0; f < school->n_fish; f++) fish_jacobian(residual, mode, f, t, cj, y, jacobian);
    }
    return status_ask(residual->stop);
}

void residual_by_shed(struct residual *residual, const double *y, double *value) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct jacobian_scratch *const scratch = &residual->jacobian_scratch[omp_get_thread_num()];
        flow_derivative(residual->flow, f, f, COLUMN_OF_SHED, &scratch->block);

        scratch->rows.n_rows = flow_n_rows(fish);
        scratch->rows.n_columns = 1;
        memset(scratch->rows.value, 0, (size_t)scratch->rows.n_rows * sizeof *scratch->rows.value);
        bound_sheet_flow_jacobian(fish, &scratch->block, y, &scratch->rows);

        const int first = fish->at.full;
        if (first < fish->at.gamma) {
            const struct fluid_force *const force = &residual->force[f];
            const struct flow_at_body flow = flow_at_body(residual->flow, f);
            force->model->flow_jacobian(force, &flow, &scratch->block, y, &scratch->rows);
        }

        memcpy(value + first, scratch->rows.value + (first - fish->at.ax),
               (size_t)(fish->at.gamma + fish->n_control - first) * sizeof *value);
    }
}

void residual_mask(const struct residual *residual, struct jacobian *jacobian) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *fish = &residual->school->fish[f];
        for (int row = fish->at.x; row < fish->at.end; row++) {
            const struct unknown_place place = residual_place(residual->school, row);
            const bool moves = place.kind <= UNKNOWN_AY && place.kind != UNKNOWN_PX && place.kind != UNKNOWN_PY;
            sparse_mask(jacobian->own[f], row, moves && fish_is_prescribed(fish, place.index, place.component));
        }
    }
}
