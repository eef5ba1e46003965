/* shoal_read.c: functions of include/shoal.h that read a run at the last event. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flow/flow_field.h"
#include "library/handle.h"

static enum shoal_type type_of(enum result_type type) {
    switch (type) {
        case RESULT_INTEGER: return SHOAL_INT;
        case RESULT_COUNT: return SHOAL_LONG;
        case RESULT_TEXT: return SHOAL_CHAR;
        default: return SHOAL_DOUBLE;
    }
}

// the number of the variable with this name, or result_table_n
static int find_variable(const char *name) {
    int i = 0;
    while (i < result_table_n && strcmp(result_table[i].name, name) != 0) i++;
    return i;
}

static int longest_wake(const struct simulation *simulation) {
    int longest = 0;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const int n = simulation->state->wake[f].n_vortex;
        if (n > longest) longest = n;
    }
    return longest;
}

// allocate the buffer of variable i once, for the largest size in this run: pointers of callers stay valid
static enum status reserve_buffer(struct shoal *run, int i) {
    if (run->buffer[i]) return STATUS_OK;

    const struct school *const school = run->simulation->school;
    size_t length[RESULT_N_DIMENSIONS];
    result_values_lengths(school, wake_most(school, run->simulation->n_events), length);
    const size_t n = result_values_n(&result_table[i], length);
    run->buffer[i] = calloc(n + 1, result_values_size(result_table[i].type));
    return run->buffer[i] ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %s", result_table[i].name);
}

int shoal_read(struct shoal *run, const char *name, struct shoal_array *array) {
    TRY(handle_need(array, __func__, "array"));
    *array = (struct shoal_array){.values = NULL};
    TRY(handle_need(run, __func__, "run"));
    TRY(handle_need(name, __func__, "name"));

    const int i = find_variable(name);
    if (i == result_table_n) {
        return status_fail(STATUS_CASE, "%s: there is no variable '%s': `shoal keys --output` lists all variables",
                           __func__, name);
    }

    // fill the buffer of the variable once per event
    const struct result_variable *const variable = &result_table[i];
    TRY(reserve_buffer(run, i));
    size_t length[RESULT_N_DIMENSIONS];
    result_values_lengths(run->simulation->school, longest_wake(run->simulation), length);
    if (!run->is_filled[i]) result_values_fill(variable, length, handle_row(run), run->buffer[i]);
    run->is_filled[i] = 1;

    *array = (struct shoal_array){.values = run->buffer[i],
                                  .type = type_of(variable->type),
                                  .unit = variable->unit,
                                  .long_name = variable->long_name};
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        if (*d == TIME) continue;
        array->shape[array->n_dimensions] = length[*d];
        array->dimension[array->n_dimensions++] = result_table_dimension(*d);
    }
    return STATUS_OK;
}

const char *shoal_variable(int i) {
    return i >= 0 && i < result_table_n ? result_table[i].name : NULL;
}

// velocity and vorticity at n points; work: (7 n)
static enum status flow_at_points(struct shoal *run, int n, const double *points, double *work, double *velocity,
                                  double *vorticity) {
    double *const x = work, *const y = x + n;
    const struct induced at = {
        .n = n, .x = x, .y = y, .u = y + n, .v = y + 2 * n, .u_x = y + 3 * n, .u_y = y + 4 * n, .v_x = y + 5 * n};

    for (int i = 0; i < n; i++) {
        x[i] = points[2 * i];
        y[i] = points[2 * i + 1];
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            return status_fail(STATUS_CASE, "shoal_flow: point %d, (%g, %g), is not finite", i, x[i], y[i]);
        }
    }

    TRY(flow_field(run->simulation->residual->flow, run->simulation->state, &at));
    for (int i = 0; i < n; i++) {
        velocity[2 * i] = at.u[i];
        velocity[2 * i + 1] = at.v[i];
        if (vorticity) vorticity[i] = at.v_x[i] - at.u_y[i];
    }
    return STATUS_OK;
}

int shoal_flow(struct shoal *run, int n, const double *points, double *velocity, double *vorticity) {
    TRY(handle_need(run, __func__, "run"));
    if (n < 0 || n > INT_MAX / 8)
        return status_fail(STATUS_CASE, "%s: %d points: the number must be between 0 and %d", __func__, n, INT_MAX / 8);
    if (n == 0) return STATUS_OK;
    TRY(handle_need(points, __func__, "points"));
    TRY(handle_need(velocity, __func__, "velocity"));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;

    double *const work = calloc((size_t)n, 7 * sizeof *work);
    if (!work) return status_fail(STATUS_MEMORY, "out of memory: %d points", n);
    const enum status status = flow_at_points(run, n, points, work, velocity, vorticity);
    free(work);
    return status;
}

int shoal_n_fish(const struct shoal *run) {
    TRY(handle_need(run, __func__, "run"));
    return run->simulation->school->n_fish;
}

int shoal_n_nodes(const struct shoal *run, int fish) {
    TRY(handle_check_fish(run, fish, __func__));
    return run->simulation->school->fish[fish].n_nodes;
}

int shoal_n_vortices(const struct shoal *run, int fish) {
    TRY(handle_check_fish(run, fish, __func__));
    return run->simulation->state->wake[fish].n_vortex;
}

int shoal_nodes(const struct shoal *run, int fish, double *x, double *y) {
    TRY(handle_check_fish(run, fish, __func__));
    TRY(handle_need(x, __func__, "x"));
    TRY(handle_need(y, __func__, "y"));
    const struct fish *const from = &run->simulation->school->fish[fish];
    memcpy(x, run->simulation->state->y + from->at.x, (size_t)from->n_nodes * sizeof *x);
    memcpy(y, run->simulation->state->y + from->at.y, (size_t)from->n_nodes * sizeof *y);
    return STATUS_OK;
}

int shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation) {
    TRY(handle_check_fish(run, fish, __func__));
    const struct wake *const wake = &run->simulation->state->wake[fish];
    const size_t size = (size_t)wake->n_vortex * sizeof *x;
    if (size == 0) return STATUS_OK;

    TRY(handle_need(x, __func__, "x"));
    TRY(handle_need(y, __func__, "y"));
    TRY(handle_need(circulation, __func__, "circulation"));

    memcpy(x, wake->x, size);
    memcpy(y, wake->y, size);
    for (int i = 0; i < wake->n_vortex; i++) circulation[i] = wake_circulation(wake, i);
    return STATUS_OK;
}
