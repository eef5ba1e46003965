/* result_row.h: the input of a row of a result file, and variables that are computed from several fields. Tested by
 * tests/result/test_result_file.c. */
#ifndef RESULT_ROW_H
#define RESULT_ROW_H

#include <stdbool.h>

#include "result/steady_values.h"
#include "school/diagnostics.h"
#include "school/residual.h"
#include "solver/integrator.h"

/* All that a row is made of; for the constants school is enough. */
struct result_row {
    const struct school *school;
    const struct state *state;
    const struct residual *residual;
    const struct diagnostics *diagnostics;
    const struct integrator_counts *counts;
    const struct steady_values *steady; /* NULL: not of a steady state */
    double wall_time;                   /* since the start, s */
    bool with_wake;                     /* else the variables of the wake hold NaN */
};

/* Each function writes a variable of fish f to the slots of f, in the order of the file. Unused slots are unchanged, as
 * are all slots of the wake in a row without wake. Units and meanings: result/result_table.c. */
void result_row_position(const struct result_row *row, int f, double *slots);
void result_row_velocity(const struct result_row *row, int f, double *slots);
void result_row_acceleration(const struct result_row *row, int f, double *slots);
void result_row_curvature(const struct result_row *row, int f, double *slots);
void result_row_natural_curvature(const struct result_row *row, int f, double *slots);
void result_row_sheet_position(const struct result_row *row, int f, double *slots);
void result_row_sheet_strength(const struct result_row *row, int f, double *slots);
void result_row_sheet_arc(const struct result_row *row, int f, double *slots);
void result_row_wake_position(const struct result_row *row, int f, double *slots);
void result_row_wake_circulation(const struct result_row *row, int f, double *slots);
void result_row_wake_birth(const struct result_row *row, int f, double *slots);
void result_row_control_arc(const struct result_row *row, int f, double *slots);
void result_row_pressure(const struct result_row *row, int f, double *slots);
void result_row_edge_resistive_force(const struct result_row *row, int f, double *slots);
void result_row_edge_reactive_force(const struct result_row *row, int f, double *slots);
void result_row_edge_pressure_force(const struct result_row *row, int f, double *slots);

/* The Floquet multipliers of the school, for a row of a steady state; f is ignored. */
void result_row_multiplier(const struct result_row *row, int f, double *slots);

/* The exponents of disturbances likewise. */
void result_row_exponent(const struct result_row *row, int f, double *slots);

#endif
