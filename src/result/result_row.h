/* result_row.h: what a row of a result file is made of, and those of its values that no field holds as they are in the
 * file. Tested by tests/result/test_result_file.c. */
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

/* Each writes a variable of fish f to its slots, in the order of the file, and leaves those that the fish does not use
 * as they are; where the row has no wake, all of the wake's. result/result_table.c has units and meanings. */
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

/* The Floquet multipliers of the school, where the row is of a steady state; f plays no part. */
void result_row_multiplier(const struct result_row *row, int f, double *slots);

/* The exponents of disturbances likewise. */
void result_row_exponent(const struct result_row *row, int f, double *slots);

#endif
