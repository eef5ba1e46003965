/* school.h: What the tests of the physics share: a school from the text of a case, a state without accidental zeros and
 * symmetries, a comparison of derivatives with differences, and short runs. */
#ifndef SCHOOL_H
#define SCHOOL_H

#include "base/arena.h"
#include "base/sparse.h"
#include "case/case.h"
#include "near.h"
#include "run/simulate.h"
#include "school/jacobian.h"
#include "school/residual.h"
#include "solver/initial_conditions.h"

struct setup {
    struct arena *arena;
    struct case_values values;
    struct school *school;
    struct state *state;
    struct residual *residual;
    const struct residual_mode *mode; /* of school_compare: of a run */
    struct jacobian *jacobian;        /* empty, rows of given motions masked */
    struct sparse *term;              /* empty, of all unknowns: for the derivatives of one term */
    double *value;                    /* a residual                                        (n_unknowns) */
    double t;                         /* time of the state; after school_stir in the middle of an interval, s */
    uint64_t seed;                    /* of the random numbers */
};

/* "format: 1" and a name go before the text; what the text leaves out is the default of the program. Fails the test
 * with the message of an error. Values and a school live until the end of the test, a school also until
 * school_clear. */
struct case_values school_values(const char *text);
void school_build(struct setup *setup, const char *text);
struct setup setup_of(const char *text);      /* the same */
struct setup setup_stirred(const char *text); /* and school_stir */
struct setup setup_with(const char *format, ...) __attribute__((format(printf, 1, 2)));
void school_clear(struct setup *setup);

/* A random number in [-1, 1], always the same ones in the same order. */
double school_random(struct setup *setup);

/* Bend, stretch and move all bodies, give every unknown and every memory a value, fill the wakes, and go 0.4 intervals
 * past the last event. */
void school_stir(struct setup *setup);

/* Unknowns and rates that satisfy the equations at a time; returns their solver. */
struct initial_conditions *school_consistent(struct setup *setup, double t);

/* Fill the wake of each fish up to n vortices, at random places behind the body. */
void school_fill_wakes(struct setup *setup, int n);

/* Replace the wake of fish f by n markers at rest, born at the last n events, for the caller to place, with labels;
 * finds the tail. Then shed the label of the newest marker. */
struct wake *school_wake(struct setup *setup, int f, int n, double tail[2]);
void school_shed(struct setup *setup, int f);

/* The fluid's velocity (and gradient) everywhere for the unknowns y at setup->t. */
void school_flow(struct setup *setup, const double *y);

/* Compare the matrix of jacobian, entry by entry, with the differences of value. No jacobian: residual_jacobian. */
typedef void school_value(struct setup *setup, const double *y, const double *yp, double *value);
typedef void school_jacobian(struct setup *setup, double cj, const double *y, struct sparse *term);
void school_compare(struct setup *setup, school_value *value, school_jacobian *jacobian, const char *name);

/* For derivatives through the flow: the derivative of the velocity at fish f by the unknowns of fish g, with empty
 * rows; adding these rows to the term. */
struct jacobian_scratch *school_influence(struct setup *setup, int f, int g);
void school_add_rows(struct setup *setup, int f, int g, struct sparse *term);

/* The matrix as a dense matrix, row after row, in an arena. */
double *school_dense(struct arena *arena, const struct sparse *matrix);
double *school_dense_jacobian(struct arena *arena, const struct jacobian *jacobian);

/* A simulation at the first event, which lives until the end of the test, and advanced to a time. Fails the test with
 * the message of an error. */
struct simulation *school_simulation(const char *text);
struct simulation *school_simulation_of(const char *format, ...) __attribute__((format(printf, 1, 2)));
void school_run(struct simulation *simulation, double t);

/* The same, with the diagnostics of that time. */
void school_measure(struct simulation *simulation, double t);

struct integrator_counts school_counts(const struct simulation *simulation);

/* Fail the test, with the text of the case, unless two runs of the case have the same bits in every field of the state
 * and the same totals. */
void school_same_bits(const struct simulation *got, const struct simulation *want, const char *text);

/* The integration fails within 50 events, and the message has this text. */
void school_fails(struct simulation *simulation, const char *message);

/* The rate of the shed circulation at an event is the slope of the quartic through the last five events. */
void school_shed_event_by_event(struct simulation *simulation);

/* Fail the test with the message unless the status is STATUS_OK. */
void school_ok(enum status status);

#endif
