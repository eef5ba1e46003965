/* result_row.h: what a row of a result file is made from, and the variables that combine several fields. Tested by
 * tests/result/test_result_file.c. */
#ifndef RESULT_ROW_H
#define RESULT_ROW_H

#include <stdbool.h>

#include "school/diagnostics.h"
#include "school/residual.h"
#include "solver/integrator.h"

/* The results of a search for a steady state (steady/steady.h): the variables steady_... */

/* A fish has at most so many slow quantities, and multipliers: enum steady_quantity without the shed circulation
 * (steady/steady_map.h). */
enum { STEADY_QUANTITIES = 8 };

/* Beats over which the growth of a disturbance is sought: steady_amplification. */
enum { STEADY_AMPLIFIED_BEATS = 32 };

/* Whether a state is stable, by the excess of the modulus of its largest multiplier over 1, or, without a beat, by its
 * growth rate, and by the error of this number. */
static inline const char *steady_verdict(double excess, double error) {
    return excess + error < 0 ? "stable" : excess - error > 0 ? "unstable" : "undecided";
}

/* One fish: means over the last beat; without a beat the values at equilibrium. */
struct steady_fish {
    double speed;      /* of the centre of mass through the water, m s-1 */
    double turn;       /* of the heading in a beat, degree */
    double place[2];   /* mean of the centre of mass relative to the first fish: ahead and to the left, m */
    double force[2];   /* of the fluid on the body, N */
    double thrust;     /* of the fluid on the body, along the direction of travel, N */
    double drag, lift; /* along the oncoming stream, and to the left of the stream, N; without a beat only, */
    double deflection; /* and of the tail, to the left of the heading of a stiff body, m; else NaN */
    double actuation_power, damping_power, constraint_power; /* W */
    double fluid_power;                                      /* that goes into the fluid, W */
    double power;                                            /* of muscle and drive without the work of the thrust, W */
    double cost_of_transport;                                /* m s-2 */
    double efficiency, towed_efficiency, strouhal;
};

struct steady_values {
    int n_beats;              /* of the search, without the beats of the multipliers */
    int n_multiplier_beats;   /* and those */
    double residual;          /* largest relative change from one beat to the next: doc/steady.md; without a beat the
                             * largest residual over the scale of the equation */
    double stiffness;         /* static stiffness over the stiffness at rest; NaN with a beat or for a rigid body */
    double error;             /* estimate of how far that is from the fixed point; NaN without multipliers */
    int n_multipliers;        /* 0: none were asked for, or there is no slow quantity */
    double *real, *imaginary; /* by falling absolute value                         (n_multipliers) */
    double *multiplier_error; /* of the absolute value                             (n_multipliers) */
    double *mode; /* real and imaginary parts of the slow quantities of each multiplier, over the largest; NaN: not slow
                     (n_multipliers, n_fish, STEADY_QUANTITIES, 2) */
    double amplification; /* largest growth of the disturbance of one slow quantity; NaN: unknown */
    int n_exponents;      /* of small disturbances, of a pair one: of the multipliers, or without a beat of the modes
                                 of the bodies */
    double *rate, *omega; /* growth rate, s-1, and angular frequency, rad s-1, by falling rate (n_exponents) */
    double growth, growth_frequency; /* of the first, s-1 and Hz; NaN: there is none */
    struct steady_fish *fish;        /* (n_fish) */
};

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

/* Variables that are computed from several fields. */
enum result_part {
    PART_POSITION,
    PART_VELOCITY,
    PART_ACCELERATION,
    PART_CURVATURE,
    PART_NATURAL_CURVATURE,
    PART_EDGE_ARC,
    PART_JOINT_ARC,
    PART_SHEET_POSITION,
    PART_SHEET_STRENGTH,
    PART_SHEET_ARC,
    PART_CONTROL_ARC,
    PART_PRESSURE,
    PART_SENSOR_LEFT,
    PART_SENSOR_RIGHT,
    PART_WAKE_POSITION,
    PART_WAKE_CIRCULATION,
    PART_WAKE_BIRTH,
    PART_LEFT_FRICTION,
    PART_RIGHT_FRICTION,
    PART_LEFT_SEPARATION,
    PART_RIGHT_SEPARATION,
    PART_FRICTION_RATIO,
    PART_EDGE_RESISTIVE_FORCE,
    PART_EDGE_REACTIVE_FORCE,
    PART_EDGE_PRESSURE_FORCE,
    PART_DIFFERENTIAL,
    PART_ALGEBRAIC,
    PART_MULTIPLIER,
    PART_MULTIPLIER_ERROR,
    PART_MODE,
    PART_EXPONENT
};

/* Write a part of fish f to the slots of f, in the order of the file. Unused slots are unchanged, as are all slots of
 * the wake in a row without wake. Units and meanings: result/result_table.c. The functions compute the parts of the
 * body, of the bound sheet, of the wake, of friction by side, of forces on the edges, of the equations, and
 * of a steady state. */
void result_row_body(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_sheet(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_wake(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_sides(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_edges(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_equations(const struct result_row *row, int f, enum result_part part, double *slots);
void result_row_steady(const struct result_row *row, int f, enum result_part part, double *slots);

#endif
