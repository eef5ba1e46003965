/* state_table.h: every field of a state, with its place and length. Code that writes, reads, copies or compares a state
 * loops over this table: a new field of struct state, or of what it owns, is a new row. Tested by
 * tests/state/test_state_table.c, which fails when a field has no row. */
#ifndef STATE_TABLE_H
#define STATE_TABLE_H

#include <stddef.h>

#include "state/state.h"

/* What a field is a part of: the state, or what the state owns of every fish, and once. */
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
    STATE_UNKEPT   /* belongs to the memory that holds the state, not to the state: it is neither copied nor kept */
};

struct state_row {
    const char *name; /* "y", "wake.x" */
    enum state_owner owner;
    enum state_type type;
    size_t offset; /* in the owner */
    size_t bytes;  /* of the field: its values; or, where length is given, the address of an array */
    size_t (*length)(const struct state *state, const struct school *school, int f); /* number of values of the array */
};

/* The number of values of an array comes before the array. */
extern const struct state_row state_table[];
extern const int state_table_n;

/* How many times a state has this field: once, or once for every fish. */
int state_table_n_owners(const struct state_row *row, const struct school *school);

/* The values of fish f: how many, the bytes of each, and where they are. */
size_t state_table_length(const struct state_row *row, const struct state *state, const struct school *school, int f);
size_t state_table_size(const struct state_row *row);
void *state_table_values(const struct state_row *row, const struct state *state, int f);

/* Give wakes room for as many vortices as they have. For who sets these numbers before the arrays. Fails with
 * STATUS_MEMORY. */
enum status state_table_make_room(struct state *state, const struct school *school);

/* Make a state of the same school equal to another one. What is kept of its wakes (struct flow) knows that they have
 * changed. Fails with STATUS_MEMORY; the state can then only be freed. */
enum status state_table_copy(struct state *to, const struct state *from, const struct school *school);

/* Fail with STATUS_FILE where a number that others rely on as an index is none that a run of the school can have, where
 * the time is not that of the event, or where a value is not finite that a run always knows. */
enum status state_table_check(const struct state *state, const struct school *school);

#endif
