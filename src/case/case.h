/* case.h: a case as plain values. One table of keys (src/case_table.c) drives parsing, checking, printing and
 * the reference doc/cases.md. Tested by tests/case/test_case.c and, for bad input, tests/case/test_bad.sh.
 *
 *     text of the case ---yaml---> tree ---merge---> tree ---table---> struct case_values ---check--->
 *     (and its includes)                  preset < include < case file < --set;  defaults.fish < fish[f]
 *
 * Values are in the units of the case file: angles in degrees, lengths in metres or in fractions of the body length as
 * the key's meaning says. Those that the model needs are in model/parameters.h. */
#ifndef CASE_H
#define CASE_H

#include <stdio.h>

#include "base/methods.h"
#include "base/status.h"
#include "model/parameters.h"

enum precision { PRECISION_DOUBLE, PRECISION_SINGLE };
enum preset { PRESET_NONE, PRESET_PUBLISHED };

struct case_time {
    double end;                 /* s */
    double output_interval;     /* s; default ten shedding intervals */
    double checkpoint_interval; /* s; 0: none */
};

struct case_solver {
    enum method method;
    int order;
    double step;   /* s; 0: adaptive */
    int max_steps; /* per shedding interval */
};

struct case_output {
    char *file; /* NULL: the name of the case with .nc, in the working directory */
    enum precision precision;
    double wake_interval; /* s; default the output interval */
};

/* What a case can expect something of: quantities that a study gathers from the ends of its members (study_file.h). */
struct sweep_quantity {
    const char *name;
    int of_fish, of_xy; /* one value for every fish; a point in the plane */
};
enum {
    SWEEP_NOSE,
    SWEEP_TAIL,
    SWEEP_N_ORDERS = 8, /* of the first ones orders of convergence are observed */
    SWEEP_N_QUANTITIES = 15
};
extern const struct sweep_quantity sweep_quantities[SWEEP_N_QUANTITIES];

/* A key that an axis of a sweep changes. */
struct sweep_key {
    char *path;       /* as --set takes it */
    const char *unit; /* of the table of keys */
    int is_number;    /* each value is one number */
};

/* One axis of a sweep. It changes one key, or several together. */
struct sweep_axis {
    int n_keys;
    struct sweep_key *key; /* (n_keys) */
    int n_values;
    char **value;         /* value i of key k is value[i * n_keys + k], a text as --set takes it (n_values * n_keys) */
    int refine;           /* the values are resolutions of the first key: a study of convergence */
    double order, within; /* what is expected of the observed order: order +- within; NaN: nothing */
    unsigned order_of;    /* bit q: of quantity q */
    double *reference;    /* see sweep_reference; NULL: none */
};

/* A key of the sweep has a value. */
struct sweep_condition {
    int axis, key;
    char *value;
};

/* A statement about the ends of members: of all, or of those that have the values of where. */
struct sweep_expectation {
    char *fails; /* they fail, and their reasons have these words in them; nothing else is then said. NULL: no */
    unsigned of; /* bit q: of quantity q */
    int fish;    /* -1: of all */
    int n_where;
    struct sweep_condition *where; /* one of each key must hold                (n_where) */
    double least, most;            /* of each value; NaN: no bound, as below */
    double spread; /* from the least to the largest value; of points, the diagonal of the box around them */
    double ratio;  /* of the largest value to the least */
};

struct case_values {
    int format;
    char *name; /* default: the file's name without folder and ending */
    enum preset preset;
    struct case_time time;
    struct school_parameters school;
    struct case_solver solver;
    struct case_output output;
    int n_axes;
    struct sweep_axis *sweep;
    int n_expectations;
    struct sweep_expectation *expect;
    char *text;   /* the text of the case file as read (without its includes) */
    char *merged; /* what the case file, its includes and the assignments say, as one text: defaults are not in it */
    char *study;  /* of a member of a study: the merged text of the study; else NULL */
    int member;   /* its number, from 0 */
};

/* Read the case file at path, apply the n_assignments texts "path=value" in order, check everything and fill *settings.
 * Fails with STATUS_FILE (cannot be read) or STATUS_CASE; the message then lists up to 20 errors in the form of a
 * compiler, each with a caret under its place. *settings then owns nothing. Free with case_free. */
enum status case_read(struct case_values *values, const char *path, int n_assignments, const char *const *assignments);

/* The same from a text in memory; origin stands for the file name in messages, folder (NULL or "": the working
 * directory) is where includes are looked up. */
enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments);

/* The number of members of the study: the product of the axes; 1 without a sweep. */
int sweep_n_members(const struct case_values *study);

/* Which value of an axis a member has. The last axis runs fastest. */
int sweep_member_value(const struct case_values *study, int member, int axis);

/* The value of a quantity (one with orders) that errors along the refined axis are to be taken against; NaN where none is
 * given. xy is 0 where the quantity is no point. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

/* Whether a statement is about a member. */
int sweep_expects_of(const struct case_values *study, const struct sweep_expectation *one, int member);

/* "solver.rtol=1e-5, fish[*].nodes=7": what one member sets. Empty without a sweep. The caller frees *text. Fails with
 * STATUS_MEMORY. */
enum status sweep_member_text(const struct case_values *study, int member, char **text);

/* Fill *settings with the case of one member: the study's, with the member's values set as --set sets them and without
 * a sweep. Fails with STATUS_CASE, naming the member, or with STATUS_MEMORY. Free with case_free. */
enum status sweep_member(struct case_values *values, const struct case_values *study, int member);

/* Refuse what this version does not run (case_read has checked everything else): one error per such value. */
enum status case_runnable(const struct case_values *values);

/* Release what the settings own and zero them. Accepts zeroed settings. */
void case_free(struct case_values *values);

/* The whole case with every key and its value, as a case file that reads back to the same settings bit for bit. The
 * caller frees *text. Fails with STATUS_MEMORY. */
enum status case_show(const struct case_values *values, char **text);

/* Print the table of keys: path, type, default, range, unit, meaning; as text, or as JSON. */
void case_keys(FILE *stream, int as_json);

#endif
