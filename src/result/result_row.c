/* result_row.c: variables whose values have to be put together. */
#include "result/result_row.h"

#include <math.h>
#include <string.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/bound_sheet.h"
#include "force/edge_force.h"
#include "force/thwaites.h"

static void interleave(int n, const double *x, const double *y, double *slots) {
    for (int i = 0; i < n; i++) {
        slots[2 * i] = x[i];
        slots[2 * i + 1] = y[i];
    }
}

static void copy_values(int n, const double *value, double *slots) {
    if (n > 0) memcpy(slots, value, (size_t)n * sizeof *value);
}

void result_row_body(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct fish *const fish = &row->school->fish[f];
    const double *const y = row->state ? row->state->y : NULL;
    const int n = fish->n_nodes;

    switch (part) {
        case PART_EDGE_ARC:
            for (int k = 0; k < fish->n_edges; k++) slots[k] = (fish->arc[k] + fish->arc[k + 1]) / 2;
            break;
        case PART_JOINT_ARC: copy_values(fish->n_joints, fish->arc + 1, slots); break;
        case PART_POSITION: interleave(n, y + fish->at.x, y + fish->at.y, slots); break;
        case PART_VELOCITY: interleave(n, y + fish->at.vx, y + fish->at.vy, slots); break;
        case PART_ACCELERATION: {
            // with momenta as unknowns, the unknowns a are the rates of the momenta
            const bool has_momenta = fish->at.second > fish->at.vx;
            const double *const a = has_momenta ? row->state->yp + fish->at.vx : y + fish->at.ax;
            interleave(n, a, a + n, slots);
            break;
        }
        case PART_CURVATURE: rod_curvature(fish, y, slots); break;
        default: {
            const struct range joints = row->residual->joints[f];
            const double *const bends = row->residual->muscle.curvature + joints.first;
            for (int j = 0; j < joints.n; j++) slots[j] = bends[j] / fish->edge_length;
        }
    }
}

void result_row_sheet(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct fish *const fish = &row->school->fish[f];
    const double *const y = row->state ? row->state->y : NULL;

    // bound vortices
    for (int j = 0; j < fish->n_sheet; j++) {
        if (part == PART_SHEET_POSITION) {
            slots[2 * j] = fish_mean(&fish->sheet_point[j], y + fish->at.x);
            slots[2 * j + 1] = fish_mean(&fish->sheet_point[j], y + fish->at.y);
        }
        if (part == PART_SHEET_STRENGTH) slots[j] = bound_sheet_strength(fish, j, y);
        if (part == PART_SHEET_ARC) slots[j] = fish_mean(&fish->sheet_point[j], fish->arc);
    }

    // control points, and sensors
    struct pressure *const pressure = row->residual ? row->residual->force[f].pressure : NULL;
    for (int c = 0; c < fish->n_control; c++) {
        if (part == PART_CONTROL_ARC) slots[c] = fish_mean(&fish->control_point[c], fish->arc);
        if (part == PART_PRESSURE && pressure) slots[c] = pressure_jump(pressure, c, y, row->state->yp);
    }
    if (part == PART_SENSOR_LEFT && pressure) copy_values(fish->n_sensors, pressure->sensor[0], slots);
    if (part == PART_SENSOR_RIGHT && pressure) copy_values(fish->n_sensors, pressure->sensor[1], slots);
}

void result_row_wake(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct wake *const wake = &row->state->wake[f];
    if (!row->with_wake) return;
    if (part == PART_WAKE_POSITION) interleave(wake->n_vortex, wake->x, wake->y, slots);
    if (part == PART_WAKE_BIRTH) copy_values(wake->n_vortex, wake->birth, slots);
    for (int i = 0; part == PART_WAKE_CIRCULATION && i < wake->n_vortex; i++) slots[i] = wake_circulation(wake, i);
}

void result_row_sides(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct fish *const fish = &row->school->fish[f];
    const struct fluid_force *const force = &row->residual->force[f];
    if (!force->pressure) return;
    const struct thwaites_friction sides = thwaites_friction(force->pressure, row->state->y, row->state->yp);

    switch (part) {
        case PART_LEFT_FRICTION: copy_values(2, sides.force[0], slots); break;
        case PART_RIGHT_FRICTION: copy_values(2, sides.force[1], slots); break;
        case PART_LEFT_SEPARATION: slots[0] = sides.separation[0]; break;
        case PART_RIGHT_SEPARATION: slots[0] = sides.separation[1]; break;
        default: {
            // over the friction of the law that acts
            const struct flow_at_body flow = flow_at_body(row->residual->flow, f);
            const double *const about = row->diagnostics->fish[f].com;
            double law = 0;
            for (int k = 0; k < fish->n_edges; k++) {
                const struct edge edge = edge_at(fish, k, row->state->y);
                law += edge_dot(edge_force_of_edge(force, &flow, k, about, row->state->y).friction, edge.t);
            }
            slots[0] = fabs(law) > 0 ? sides.along / law : NAN;
        }
    }
}

void result_row_edges(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct fish *const fish = &row->school->fish[f];
    const struct fluid_force *const force = &row->residual->force[f];
    const struct flow_at_body flow = flow_at_body(row->residual->flow, f);
    const double *const about = row->diagnostics->fish[f].com;

    for (int k = 0; k < fish->n_edges; k++) {
        if (part == PART_EDGE_PRESSURE_FORCE) {
            slots[2 * k] = slots[2 * k + 1] = 0;
            if (force->pressure) pressure_of_edge(force->pressure, k, row->state->y, row->state->yp, slots + 2 * k);
        } else {
            const struct fluid_forces forces = edge_force_of_edge(force, &flow, k, about, row->state->y);
            copy_values(2, part == PART_EDGE_RESISTIVE_FORCE ? forces.resistive : forces.reactive, slots + 2 * k);
        }
    }
}

void result_row_equations(const struct result_row *row, int f, enum result_part part, double *slots) {
    const struct layout *const at = &row->school->fish[f].at;
    int n = 0;
    for (int i = at->x; i < at->end; i++) {
        n += residual_is_differential(row->school, &residual_run, i) == (part == PART_DIFFERENTIAL);
    }
    slots[0] = n;
}

void result_row_steady(const struct result_row *row, int f, enum result_part part, double *slots) {
    (void)f;
    const struct steady_values *const steady = row->steady;
    if (!steady) return;
    if (part == PART_MULTIPLIER) interleave(steady->n_multipliers, steady->real, steady->imaginary, slots);
    if (part == PART_MULTIPLIER_ERROR) copy_values(steady->n_multipliers, steady->multiplier_error, slots);
    if (part == PART_MODE) {
        copy_values(steady->n_multipliers * row->school->n_fish * STEADY_QUANTITIES * 2, steady->mode, slots);
    }
    if (part == PART_EXPONENT) interleave(steady->n_exponents, steady->rate, steady->omega, slots);
}
