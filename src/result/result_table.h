/* result_table.h: the variables of a result file, and where the value of each comes from. One table drives definition,
 * writing, reading and doc/output.md. Tested by tests/result/test_result_file.c. */
#ifndef RESULT_TABLE_H
#define RESULT_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "case/case_values.h"
#include "result/result_kind.h"
#include "result/result_row.h"

enum {
    RESULT_SCHEMA = 1,     /* attribute shoal_schema; grows when a reader of the files has to change */
    RESULT_TABLE_MAX = 192 /* no more variables than these */
};

/* Dimensions; NONE ends a list of dimensions. Unused slots of a fish are NaN. A dimension of length 0 and variables
 * over this dimension are not in the file. */
enum result_dimension {
    NONE,
    TIME,
    FISH,
    NODE,
    EDGE,
    JOINT,
    SHEET,
    CONTROL,
    VORTEX,
    XY,
    NAME,
    MULTIPLIER,
    SLOW,
    WALL,
    SENSOR,
    ORDER,
    RESULT_N_DIMENSIONS
};
enum { RESULT_MAX_DIMENSIONS = 4 };

enum result_type {
    RESULT_REAL,    /* double */
    RESULT_BULK,    /* double in memory; float in the file when the case asks for precision: single */
    RESULT_INTEGER, /* int */
    RESULT_COUNT,   /* long */
    RESULT_TEXT     /* char *, cut or filled up with zeros to the length of NAME */
};

/* The struct that contains a value. */
enum result_owner {
    OF_SCHOOL,
    OF_FISH,
    OF_STATE,
    OF_WAKE,
    OF_DIAGNOSTICS,
    OF_DIAGNOSTICS_FISH,
    OF_COUNTS,
    OF_AXIS,
    OF_STEADY,
    OF_STEADY_FISH,
    OF_ROW
};

struct result_variable {
    const char *name;
    enum result_dimension dimension[RESULT_MAX_DIMENSIONS + 1]; /* NONE at the end */
    enum result_type type;
    const char *unit; /* "": none, as for text */
    const char *long_name;

    /* The source of the value of a school or of fish f: at offset in the owner (is_pointer: the address of an array is
     * at offset), or gather writes a part to the slots of fish f, initially NaN. */
    enum result_owner owner;
    size_t offset;
    bool is_pointer;
    void (*gather)(const struct result_row *row, int f, enum result_part part, double *slots);
    enum result_part part;

    enum output_forces forces; /* in the file if the case has these output.forces; 0: always */
    bool of_steady;            /* in the file of a steady state only */
    const char *flags;         /* the words of the values 0, 1, ..., separated by blanks; NULL: none */
};

/* In the order of the file; wall_time is last, so that scripts can check a file for completeness. */
extern const struct result_variable result_table[];
extern const int result_table_n;

/* The name of a dimension in the file. */
const char *result_table_dimension(enum result_dimension dimension);

/* True if the variable has the dimension. */
bool result_table_has(const struct result_variable *variable, enum result_dimension dimension);

/* The length of a dimension for one fish; 1 for dimensions that do not depend on the fish. */
int result_table_length(const struct fish *fish, enum result_dimension dimension);

/* The address of the struct that contains a value; f is the fish, or for the axes x and y the number of the axis. NULL:
 * none. */
const void *result_table_owner(const struct result_row *row, enum result_owner owner, int f);

/* Row i, from 0, of the list of variables; 0 beyond the last. */
int result_table_listed(int i, struct result_listed *listed);

#endif
