/* result_row.c: values that have to be put together. */
#include "result/result_row.h"

#include <math.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/bound_sheet.h"
#include "force/fluid_force.h"
#include "force/thwaites.h"

// ---- bodies and wakes

static void interleave(int n, const double *x, const double *y, double *slots) {
    for (int i = 0; i < n; i++) {
        slots[2 * i] = x[i];
        slots[2 * i + 1] = y[i];
    }
}

static void copy_values(int n, const double *value, double *slots) {
    for (int i = 0; i < n; i++) slots[i] = value[i];
}

void result_row_position(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    interleave(fish->n_nodes, row->state->y + fish->at.x, row->state->y + fish->at.y, slots);
}

void result_row_velocity(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    interleave(fish->n_nodes, row->state->y + fish->at.vx, row->state->y + fish->at.vy, slots);
}

void result_row_acceleration(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    // with momenta as unknowns, the unknowns a are the rates of the momenta
    const double *const a = fish_has_momentum(fish) ? row->state->yp + fish->at.vx : row->state->y + fish->at.ax;
    interleave(fish->n_nodes, a, a + fish->n_nodes, slots);
}

void result_row_curvature(const struct result_row *row, int f, double *slots) {
    rod_curvature(&row->school->fish[f], row->state->y, slots);
}

void result_row_natural_curvature(const struct result_row *row, int f, double *slots) {
    const struct range joints = row->residual->joints[f];
    copy_values(joints.n, row->residual->muscle.curvature + joints.first, slots);
}

void result_row_sheet_position(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) {
        slots[2 * j] = fish_mean(&fish->sheet_point[j], row->state->y + fish->at.x);
        slots[2 * j + 1] = fish_mean(&fish->sheet_point[j], row->state->y + fish->at.y);
    }
}

void result_row_sheet_strength(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) slots[j] = bound_sheet_strength(fish, j, row->state->y);
}

void result_row_sheet_arc(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) slots[j] = fish_mean(&fish->sheet_point[j], fish->arc);
}

void result_row_wake_position(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    if (row->with_wake) interleave(wake->n_vortex, wake->x, wake->y, slots);
}

void result_row_wake_circulation(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    for (int i = 0; row->with_wake && i < wake->n_vortex; i++) slots[i] = wake_circulation(wake, i);
}

void result_row_wake_birth(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    if (row->with_wake) copy_values(wake->n_vortex, wake->birth, slots);
}

// ---- pressure

void result_row_control_arc(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int c = 0; c < fish->n_control; c++) slots[c] = fish_mean(&fish->control_point[c], fish->arc);
}

void result_row_pressure(const struct result_row *row, int f, double *slots) {
    struct pressure *const pressure = row->residual->pressure[f];
    const int n = row->school->fish[f].n_control;
    for (int c = 0; pressure && c < n; c++) slots[c] = pressure_jump(pressure, c, row->state->y, row->state->yp);
}

static void sensor_pressure(const struct result_row *row, int f, int side, double *slots) {
    const struct pressure *const pressure = row->residual->pressure[f];
    if (pressure) copy_values(row->school->fish[f].n_sensors, pressure->sensor[side], slots);
}

void result_row_sensor_left(const struct result_row *row, int f, double *slots) {
    sensor_pressure(row, f, 0, slots);
}

void result_row_sensor_right(const struct result_row *row, int f, double *slots) {
    sensor_pressure(row, f, 1, slots);
}

// ---- friction on the sides

// all values NaN without force: pressure
static struct thwaites_friction sides_of(const struct result_row *row, int f) {
    struct pressure *const pressure = row->residual->pressure[f];
    if (pressure) return thwaites_friction(pressure, row->state->y, row->state->yp);
    return (struct thwaites_friction){{{NAN, NAN}, {NAN, NAN}}, {NAN, NAN}, NAN};
}

void result_row_left_friction(const struct result_row *row, int f, double *slots) {
    const struct thwaites_friction sides = sides_of(row, f);
    copy_values(2, sides.force[0], slots);
}

void result_row_right_friction(const struct result_row *row, int f, double *slots) {
    const struct thwaites_friction sides = sides_of(row, f);
    copy_values(2, sides.force[1], slots);
}

void result_row_left_separation(const struct result_row *row, int f, double *slots) {
    slots[0] = sides_of(row, f).separation[0];
}

void result_row_right_separation(const struct result_row *row, int f, double *slots) {
    slots[0] = sides_of(row, f).separation[1];
}

void result_row_friction_ratio(const struct result_row *row, int f, double *slots) {
    const struct fish *const fish = &row->school->fish[f];
    if (!row->residual->pressure[f]) return;
    const struct flow_at_body flow = flow_at_body(row->residual->flow, f);
    double law = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, row->state->y);
        const double *const about = row->diagnostics->fish[f].com;
        law += edge_dot(fluid_force_of_edge(fish, &flow, k, about, row->state->y).friction, edge.t);
    }

    slots[0] = fabs(law) > 0 ? sides_of(row, f).along / law : NAN;
}

// ---- forces on the edges

enum named_force { RESISTIVE, REACTIVE };

static void edge_force(const struct result_row *row, int f, enum named_force name, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    const struct flow_at_body flow = flow_at_body(row->residual->flow, f);
    const double *const about = row->diagnostics->fish[f].com;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct fluid_forces forces = fluid_force_of_edge(fish, &flow, k, about, row->state->y);
        copy_values(2, name == RESISTIVE ? forces.resistive : forces.reactive, slots + 2 * k);
    }
}

void result_row_edge_resistive_force(const struct result_row *row, int f, double *slots) {
    edge_force(row, f, RESISTIVE, slots);
}

void result_row_edge_reactive_force(const struct result_row *row, int f, double *slots) {
    edge_force(row, f, REACTIVE, slots);
}

void result_row_edge_pressure_force(const struct result_row *row, int f, double *slots) {
    const struct pressure *const pressure = row->residual->pressure[f];
    for (int k = 0; k < row->school->fish[f].n_edges; k++) {
        slots[2 * k] = slots[2 * k + 1] = 0;
        if (pressure) pressure_of_edge(pressure, k, row->state->y, row->state->yp, slots + 2 * k);
    }
}

// ---- a steady state

void result_row_multiplier(const struct result_row *row, int f, double *slots) {
    (void)f;
    if (row->steady) interleave(row->steady->n_multipliers, row->steady->real, row->steady->imaginary, slots);
}

void result_row_exponent(const struct result_row *row, int f, double *slots) {
    (void)f;
    if (row->steady) interleave(row->steady->n_exponents, row->steady->rate, row->steady->omega, slots);
}
