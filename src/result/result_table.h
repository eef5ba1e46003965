/* result_table.h: the variables of a result file and where the value of each lives. One table drives definition,
 * writing, reading and doc/output.md: a new variable is a new row. Tested by tests/result/test_result_file.c. */
#ifndef RESULT_TABLE_H
#define RESULT_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "case/case_values.h"
#include "result/result_kind.h"
#include "result/result_row.h"

enum {
    RESULT_SCHEMA = 1,     /* attribute shoal_schema; grows when a reader of the files has to change */
    RESULT_TABLE_MAX = 160 /* no more variables than these */
};

/* Dimensions; NONE ends a list of them. Slots beyond what a fish has hold NaN. One of length 0 is not in the file, and
 * neither are its variables. */
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
    WALL,
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

/* What a value is a part of. */
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

    /* Where the value of a school or of fish f lives: at offset in its owner; where is_pointer, the owner holds the
     * address of an array there; or gather writes it to the slots of fish f, which are NaN before. */
    enum result_owner owner;
    size_t offset;
    bool is_pointer;
    void (*gather)(const struct result_row *row, int f, double *slots);

    enum output_forces forces; /* in the file where the case asks for these forces; 0: always */
    bool of_steady;            /* in the file of a steady state only */
};

/* In the order in which they are in the file; wall_time is the last, by which scripts see that a file is whole. */
extern const struct result_variable result_table[];
extern const int result_table_n;

/* The name of a dimension in the file. */
const char *result_table_dimension(enum result_dimension dimension);

/* True if the variable has the dimension. */
bool result_table_has(const struct result_variable *variable, enum result_dimension dimension);

/* The length of a dimension for one fish; 1 where it does not depend on the fish. */
int result_table_length(const struct fish *fish, enum result_dimension dimension);

/* The address of what a value is a part of; of an axis, which is x or y, f counts the axes. NULL: there is none. */
const void *result_table_owner(const struct result_row *row, enum result_owner owner, int f);

/* Row i, from 0, of the list of variables; 0 beyond the last. */
int result_table_listed(int i, struct result_listed *listed);

#endif
