/* state_table.h: every field of a state, with place and length. Code that writes, reads, copies or compares a state
 * loops over this table: a new field of struct state, or of a struct owned by struct state, is a new row. Tested by
 * tests/state/test_state_table.c, which fails for a field without a row. */
#ifndef STATE_TABLE_H
#define STATE_TABLE_H

#include <stddef.h>

#include "state/state.h"

/* The struct that contains a field: the state, a struct of every fish, or the closest approach. */
enum state_owner {
    STATE_ITSELF,
    STATE_WAKE,
    STATE_CONTROL,
    STATE_HISTORY,
    STATE_BALANCE,
    STATE_MOMENTUM,
    STATE_CLOSEST
};

enum state_type {
    STATE_REAL,    /* double */
    STATE_INTEGER, /* int */
    STATE_COUNT,   /* long */
    STATE_UNKEPT   /* property of the memory, not of the state: neither copied nor written */
};

struct state_row {
    const char *name; /* "y", "wake.x" */
    enum state_owner owner;
    enum state_type type;
    size_t offset; /* offset of the field in the owner, bytes */
    size_t bytes;  /* size of the field: the values, or, with length, the address of an array */
    size_t (*length)(const struct state *state, const struct school *school,
                     int f); /* length of the array; NULL: no array */
};

/* The row of an array follows the row with the length of the array. */
extern const struct state_row state_table[];
extern const int state_table_n;

/* The number of instances of a field in a state: 1, or n_fish. */
int state_table_n_owners(const struct state_row *row, const struct school *school);

/* For the values of fish f: number of values, size of a value in bytes, address of the values. */
size_t state_table_length(const struct state_row *row, const struct state *state, const struct school *school, int f);
size_t state_table_size(const struct state_row *row);
void *state_table_values(const struct state_row *row, const struct state *state, int f);

/* Resize the arrays of all wakes to n_vortex. Code that reads a state calls this function between the numbers and the
 * arrays. Fails with STATUS_MEMORY. */
enum status state_table_make_room(struct state *state, const struct school *school);

/* Copy a state into another state of the same school. The wake versions increase, so that struct flow evaluates wakes
 * again. Fails with STATUS_MEMORY; the target can then only be freed. */
enum status state_table_copy(struct state *to, const struct state *from, const struct school *school);

/* Fail with STATUS_FILE if a number that serves as an index is out of range for the school, if the time differs from
 * the time of the event, or if a value that is always defined is not finite. */
enum status state_table_check(const struct state *state, const struct school *school);

#endif
