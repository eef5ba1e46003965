/* error_plan.h: the error of a value: each numerical key is varied alone. Keys, levels and members of the study.
 * doc/studies.md, "Error bars". Tested by tests/study/test_error_plan.c and test_error.sh.
 *
 *                       fish.nodes               13     17    [25]    35
 *     the case  --<     fish.sheet_points        25     35    [49]    69        [ ]: the stated value
 *                       time.shedding_interval    0.04   0.02 [0.01]   0.005
 *
 * Each level is a member of a study with one axis, which sets all keys that are varied; member 0 is the case.
 *
 * A case with a sweep has an error at every point, the combinations of the swept values. All members are rows of the
 * one axis, which also sets the swept keys. A point whose value on every axis of the sweep is the first, the middle or
 * the last one varies all keys; any other point varies the nodes and the shedding interval, and takes the largest
 * relative errors of the other keys from these full points:
 *
 *     point                  0      1      2      3      4      5      6
 *     all keys               x                    x                    x
 *     nodes and interval            x      x             x      x                 others: from 0, 3, 6
 *
 * An input, a number of the case or of one of its fish, has levels at both sides of the stated value, or on one side if
 * the other is out of its range. They give the derivative of each quantity (convergence.h), for a table of
 * sensitivities or, times the uncertainty of the number, for the error.
 *
 * With `against` every value is also compared with that of a twin: of another case, of another point of the sweep, or
 * of another fish of the same run. The twin varies the same keys by the same factors. Ratio and difference are
 * quantities of their own, judged level by level: errors that both values share cancel. */
#ifndef ERROR_PLAN_H
#define ERROR_PLAN_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "case/sweep_error.h"
#include "study/convergence.h"
#include "study/member_file.h"
#include "study/study.h"

enum {
    ERROR_STUDY_LEVELS = 1 + SWEEP_ERROR_LEVELS,
    ERROR_STUDY_QUANTITIES = 16,
    ERROR_STUDY_KEYS = SWEEP_N_ERROR_KEYS + SWEEP_N_INPUTS
};

/* A numerical key or a choice of the model and its levels from fine to coarse, or an input and its levels, growing. */
struct error_study_key {
    const struct sweep_error_key *row;
    const char *unit;                 /* " beats" if the case gives a duration in beats, otherwise "" */
    int n_levels, stated;             /* number of levels; level of the stated value */
    double value[ERROR_STUDY_LEVELS]; /* of the first fish that has the key */
    int member[ERROR_STUDY_LEVELS];
    int twin[ERROR_STUDY_LEVELS];      /* the member to compare with, in a comparison */
    int first_stated;                  /* level of the case, before any refinement */
    int n_added;                       /* levels added for `within` */
    int n_left_out;                    /* coarsest levels that the judgement leaves out: too few sheet points */
    char objection[CONVERGENCE_BYTES]; /* reason to distrust any order, or ""; n_levels 1: reason for not varying */
    double cost_exponent;              /* exponent of the resolution in the wall time */
    struct convergence_result *part;   /* of each quantity; for a choice of the model: the change (n_asked, n_fish) */
    double uncertainty;                /* of an input, as a part of it; 0: none */
    struct convergence_slope *slope;   /* of an input: d ln Q/d ln p; NULL: no input              (n_asked, n_fish) */
};

/* The lowest or highest value of a quantity over all choices of the model. */
struct error_study_model {
    double value;
    int key, level; /* key -1: no choice has another value */
};

/* What the values of a study are: of the case itself, or compared with those of the twin. */
enum error_relation { ERROR_VALUE, ERROR_RATIO, ERROR_CHANGE, N_ERROR_RELATIONS };

/* The beginnings of the names of compared quantities: "ratio", "change". */
extern const char *const error_relation_words[N_ERROR_RELATIONS];

/* The errors of one point. */
struct error_study {
    struct error_sweep *sweep;              /* the owner */
    enum error_relation relation;           /* of a ratio or a change: */
    const struct error_study *point, *twin; /* the study whose values are compared, and that of the other values */
    struct case_values *study;              /* of the sweep: the case, with the axis of members */
    const struct case_values *values;       /* the case of this point */
    bool is_full;                           /* varies all keys */
    bool is_against;                        /* the other case */
    bool is_steady, is_static;              /* steady states; equilibria, without a beat */
    int n_fish;
    double beat;     /* s; 0: none */
    double *bending; /* length over which a tail bends at its frequency, m; 0: it has none    (n_fish) */
    int n_asked;     /* requested quantities */
    int quantity[ERROR_STUDY_QUANTITIES]; /* numbers of member_file.h */
    int n_keys;
    struct error_study_key key[ERROR_STUDY_KEYS];
    int base;              /* the member of the case */
    int stated;            /* the member of the stated value */
    int finest;            /* the member with all numerical keys at their finest levels; -1: none */
    double *value, *error; /* stated values, and their errors; NaN: unknown                         (n_asked, n_fish) */
    double *shift;    /* the limit is expected at value + shift                                     (n_asked, n_fish) */
    double *together; /* part of the error: how the keys act together; below 0: they cancel         (n_asked, n_fish) */
    double *of_noise; /* part of the error: integrator and search, or the differences of a mode     (n_asked, n_fish) */
    double *parts;  /* the errors of all keys, without regard to their signs                        (n_asked, n_fish) */
    double *inputs; /* part of the error, in quadrature: inputs with an uncertainty                 (n_asked, n_fish) */
    double *shared; /* part of the error: other keys, from the full points                         (n_asked, n_fish) */
    struct error_study_model *lowest,
        *highest;    /* values with other choices of the model            (n_asked, n_fish) */
    double noise;    /* relative error of the integrator and of the search */
    double cost;     /* CPU time of the stated value over the CPU time of the case */
    bool is_reached; /* the error is within the bound of the case, or the case has no bound */
};

/* All points; one point without a sweep. */
struct error_sweep {
    struct arena *arena;
    struct case_values study; /* the case, with the axis of members */
    int n_swept;              /* the first keys of the axis are those of the sweep */
    int n_points;
    struct error_study *point;   /* (n_points) */
    signed char *of_all;         /* add_columns: one column serves all fish; 0: not known, -1: no (case_table_n) */
    struct error_study *against; /* the other case; NULL: none */
    int *twin;                   /* the point that each point is compared with; NULL: none   (n_points) */
    int fish, twin_fish;         /* the fish that are compared with each other; -1: each with its own twin */
    struct error_sweep *ratio, *change; /* the comparisons: points with other values and keys; NULL: none */
};

/* The fish of the twin of a fish; -1: none. */
int error_plan_twin_fish(const struct error_study *study, int fish);

/* The name of what fish f is compared with: "alone", "leader", "point 0". */
char *error_plan_twin_name(const struct error_study *study, int fish);

/* Plan the members of a case with `error`. options: for progress and stop; NULL: none. Fails with STATUS_CASE (an
 * unknown quantity, a quantity of runs beside one of steady states, or no key) or STATUS_STOPPED. */
enum status error_plan_create(struct arena *arena, struct error_sweep **plan, const struct case_values *values,
                              const struct study_options *options);

/* Whether a fish has a value of a quantity: one of the whole case belongs to the first fish, and a comparison needs a
 * twin. */
bool error_plan_has_value(const struct error_study *study, int quantity, int fish);

/* The index of a quantity of a fish in part, value and error. */
int error_plan_place(const struct error_study *study, int quantity, int fish);

/* The column of the axis that sets a key of a fish; -1: none. */
int error_plan_column(const struct error_study *study, const char *path, int fish);

/* The grid spacing of a level. */
double error_plan_size(const struct sweep_error_key *row, double value);

/* Find a level of a key near from*factor that is a valid case: points are rounded; an interval divides the beat of a
 * steady state or the end of a run; a step divides the interval. NaN: no such level. */
double error_plan_find_level(struct error_study *study, int key, double from, double factor);

/* Insert a value into the levels of a key. error_plan_members then adds members for all levels without a member;
 * returns the number of new members. */
void error_plan_insert(struct error_study_key *key, double value);
int error_plan_members(struct error_study *study);

/* Find the member with some changes of the case. If no such member exists (*is_new), add a member whose search starts
 * from the state of the member before. */
struct error_plan_change {
    int key;
    double value; /* of the first fish; the values of the other fish change in proportion */
};
int error_plan_member(struct error_study *study, int n, const struct error_plan_change *changes, int before,
                      bool *is_new);

/* Choose for each member the one whose estimated time it takes: itself, or a member that costs the same, of its own
 * point or, if the point does not vary all keys, of the points before. Keys that are numbers of the bodies, but for a
 * frequency, hardly change the cost. like: (members). Returns the number of members that take their own. */
int error_plan_choose_estimated(const struct error_sweep *sweep, int *like);

#endif
