/* result_table.h: the table of what a result file contains and where each value lives. Shared by the files of the store
 * only. Tested by tests/output/test_result_file.c. */
#ifndef RESULT_TABLE_H
#define RESULT_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "model/diagnostics.h"
#include "model/residual.h"
#include "output/result_file.h"

enum { RESULT_SCHEMA = 1 }; /* attribute shoal_schema; grows when a reader of the files has to change */

/* Dimensions; NONE ends a list of them. Slots beyond what a fish has hold NaN. */
enum result_dimension { NONE, TIME, FISH, NODE, EDGE, JOINT, SHEET, VORTEX, XY, NAME, RESULT_N_DIMENSIONS };
enum { RESULT_MOST_DIMENSIONS = 4 };

enum result_type {
    RESULT_REAL,    /* double */
    RESULT_BULK,    /* double in memory; float in the file when the case asks for precision: single */
    RESULT_INTEGER, /* int */
    RESULT_COUNT,   /* long */
    RESULT_TEXT     /* char *, cut or filled up with zeros to the length of NAME */
};

/* What a value is a part of. */
enum result_owner { OF_SCHOOL, OF_FISH, OF_STATE, OF_WAKE, OF_MEASURE, OF_MEASURED_FISH, OF_COUNTS };

/* All that one row is made of; to write the constants school is enough. */
struct result_row {
    const struct school *school;
    const struct state *state;
    const struct residual *residual;
    const struct diagnostics *diagnostics;
    const struct result_counts *counts;
    bool with_wake;
};

struct result_variable {
    const char *name;
    enum result_dimension dimension[RESULT_MOST_DIMENSIONS + 1]; /* NONE at the end */
    enum result_type type;
    const char *unit; /* "": none, as for text */
    const char *long_name;

    /* Where the value of a school or of fish f lives: at offset in its owner; where is_pointer, the owner holds the
     * address of an array there; or gather writes it to the slots of fish f, which are NaN before. */
    enum result_owner owner;
    size_t offset;
    bool is_pointer;
    void (*gather)(const struct result_row *row, int f, double *slots);
};

/* A row of the reference of variables. */
struct result_listed {
    const char *file; /* "run", "study" or "comparison" */
    const char *name, *unit, *type, *meaning;
    char dimensions[80]; /* "time, fish" */
};

/* In the order in which they stand in the file; wall_time is the last one: see result_info. */
extern const struct result_variable result_table[];
extern const int result_table_n;

/* The name of a dimension in the file. */
const char *result_table_dimension(enum result_dimension dimension);

/* True if the variable has the dimension. */
bool result_table_has(const struct result_variable *variable, enum result_dimension dimension);

/* How long a dimension is for one fish; 1 for those that no fish has an own length of. */
int result_table_length(const struct fish *fish, enum result_dimension dimension);

/* The address of what a value is a part of. */
const void *result_table_owner(const struct result_row *row, enum result_owner owner, int f);

#endif
