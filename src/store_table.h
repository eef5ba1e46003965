/* store_table.h: the table of what a result file contains and where each value lives. Shared by the files of the store
 * only. Tested by tests/test_store.c. */
#ifndef STORE_TABLE_H
#define STORE_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "measure.h"
#include "residual.h"
#include "store.h"

enum { STORE_SCHEMA = 1 }; /* attribute shoal_schema; grows when a reader of the files has to change */

/* Dimensions; NONE ends a list of them. Slots beyond what a fish has hold NaN. */
enum store_dimension { NONE, TIME, FISH, NODE, EDGE, JOINT, SHEET, VORTEX, XY, NAME, STORE_N_DIMENSIONS };
enum { STORE_MOST_DIMENSIONS = 4 };

enum store_type {
    STORE_REAL,    /* double */
    STORE_BULK,    /* double in memory; float in the file when the case asks for precision: single */
    STORE_INTEGER, /* int */
    STORE_COUNT,   /* long */
    STORE_TEXT     /* char *, cut or filled up with zeros to the length of NAME */
};

/* What a value is a part of. */
enum store_owner { OF_SCHOOL, OF_FISH, OF_STATE, OF_WAKE, OF_MEASURE, OF_MEASURED_FISH, OF_COUNTS };

/* All that one row is made of; to write the constants school is enough. */
struct store_row {
    const struct school *school;
    const struct state *state;
    const struct residual *residual;
    const struct measure *measure;
    const struct store_counts *counts;
    bool with_wake;
};

struct store_variable {
    const char *name;
    enum store_dimension dimension[STORE_MOST_DIMENSIONS + 1]; /* NONE at the end */
    enum store_type type;
    const char *unit; /* "": none, as for text */
    const char *long_name;

    /* Where the value of a school or of fish f lives: at offset in its owner; where is_pointer, the owner holds the
     * address of an array there; or gather writes it to the slots of fish f, which are NaN before. */
    enum store_owner owner;
    size_t offset;
    bool is_pointer;
    void (*gather)(const struct store_row *row, int f, double *slots);
};

/* A row of the reference of variables. */
struct store_listed {
    const char *file; /* "run", "study" or "comparison" */
    const char *name, *unit, *type, *meaning;
    char dimensions[80]; /* "time, fish" */
};

/* In the order in which they stand in the file; wall_time is the last one: see store_info. */
extern const struct store_variable store_table[];
extern const int store_table_n;

/* The name of a dimension in the file. */
const char *store_table_dimension(enum store_dimension dimension);

/* True if the variable has the dimension. */
bool store_table_has(const struct store_variable *variable, enum store_dimension dimension);

/* How long a dimension is for one fish; 1 for those that no fish has an own length of. */
int store_table_length(const struct fish *fish, enum store_dimension dimension);

/* The address of what a value is a part of. */
const void *store_table_owner(const struct store_row *row, enum store_owner owner, int f);

#endif
