/* case_values.h: a case as plain values, in the units of the case file: angles in degrees, lengths in metres or in
 * fractions of the body length, as the meaning of each key says. The parameters of the model are in fish/parameters.h,
 * the axes and expectations of a study in sweep.h, and errors in sweep_error.h. */
#ifndef CASE_VALUES_H
#define CASE_VALUES_H

#include <stdbool.h>

#include "base/methods.h"
#include "case/sweep_expect.h"
#include "fish/parameters.h"

enum precision { PRECISION_DOUBLE, PRECISION_SINGLE };
enum preset { PRESET_NONE, PRESET_PUBLISHED };

struct case_time {
    double end;                 /* s */
    double output_interval;     /* s; default ten shedding intervals */
    double checkpoint_interval; /* s; 0: only when the run is stopped */
    double checkpoint_wall;     /* wall time after which the next event has a checkpoint, s; 0: never */
};

struct case_solver {
    enum method method;
    enum error_test error_test;
    int order;
    double rtol;   /* error tolerance: doc/numerics.md, section 3 */
    double step;   /* s; 0: adaptive */
    int max_steps; /* per shedding interval */
};

enum output_forces { OUTPUT_FORCES_TOTALS, OUTPUT_FORCES_EDGES, OUTPUT_FORCES_SIDES };

struct case_output {
    char *file; /* NULL: the name of the case with .nc, in the working directory */
    enum precision precision;
    enum output_forces forces;
    double wake_interval; /* s; default the output interval */
};

enum yes { NO, YES };

/* Whether a key has a value, given, by default or derived. Without a value, its field is 0 or empty, and the model does
 * without it. In a case with errors, a default may stand in for a value that cannot be read. */
enum key_state { KEY_WITHOUT_VALUE, KEY_WITH_VALUE, KEY_MISREAD };

/* shoal steady */
struct case_steady {
    double tolerance; /* change from beat to beat, relative */
    int beats;        /* of the search at most */
    int output_beats;
    enum yes formation, multipliers;
};

struct key;

/* A time that the case gives in beats, or that is in beats by default. */
struct case_beats {
    const struct key *key;
    int fish; /* 0 for a key of the whole case */
    double n;
    bool is_default;
};

struct sweep_axis;
struct sweep_error;
struct sweep_expectation;

struct case_values {
    struct arena *arena; /* of all pointers below */
    int format;
    char *name; /* default: the file's name without folder and ending */
    enum preset preset;
    struct case_time time;
    struct school_parameters school;
    struct case_solver solver;
    struct case_output output;
    struct case_steady steady;
    enum key_state *state; /* of each key: case_table_state */
    int n_beats;
    struct case_beats *beats; /* (n_beats); the fields of these times are in seconds */
    int n_axes;
    struct sweep_axis *sweep;  /* (n_axes) */
    struct sweep_error *error; /* requested error estimates; NULL: none */
    int n_expectations;
    struct sweep_expectation *expect; /* (n_expectations) */
    char *text;                       /* text of the case file, without includes */
    char *merged;                     /* case file, includes and assignments merged into one text, without defaults */
    char *common;                     /* merged without sweep and error: of the members of a study */
    char *notes; /* on values that are hardly ever meant, one after the other as errors are written; "": none */
    char *study; /* of a member of a study: the merged text of the study; else NULL */
    int member;  /* number of the member, from 0 */
};

#endif
