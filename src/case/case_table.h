/* case_table.h: the table of keys of a case file, with the types and ranges of their values and the functions that
 * search it. Tested by tests/case/test_case.c. */
#ifndef CASE_TABLE_H
#define CASE_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/text.h"
#include "case/case_values.h"
#include "case/yaml_tree.h"

enum { CASE_MAX_FISH = 10000 };

enum key_type {
    REAL,         /* double */
    DURATION,     /* double: a time in s; in the case also in beats, as '3 beats' or '1/50 beat' */
    INTEGER,      /* int */
    CHOICE,       /* an enum: the index of the word in .words */
    METHOD,       /* enum method: the index of the word in the table of methods (base/methods.h) */
    STRING,       /* char * */
    PAIR,         /* double[2] */
    NUMBERS,      /* struct number_list of numbers */
    PAIRS,        /* struct number_list of pairs */
    PROFILE,      /* struct number_list of numbers, or of pairs (distance, number): then width is 2 */
    ROWS,         /* struct number_list of rows of numbers, all of the same length */
    HEADING,      /* struct number_list of pairs (time, angle); one number is the pair (0, angle) */
    FILES,        /* include: no field in struct case_values */
    DEFAULTS,     /* defaults: no field in struct case_values */
    AXES,         /* sweep: read by sweep.c */
    EXPECTATIONS, /* expect: read by sweep_expect.c */
    ERRORS        /* error: read by sweep_error.c */
};

/* The range of a number, or of each number of a list; of a STRING, max is the maximum number of bytes. */
struct bounds {
    double min, max;
    bool is_min_open, is_max_open; /* the bound itself is excluded */
};

/* A number that is a multiple of another number, or the number (also the index of a word) that follows from a word. */
struct key_multiple {
    double factor;
    const char *of; /* path of the other key */
};
struct key_choice {
    const char *of, *word; /* path of the other key, and one of the words of this key */
    double with, without;
};

/* The place of a default: a case with all values read, its file, a fish of the case (the first for a key of no fish),
 * and the field of the key. */
struct key_place {
    struct case_values *values;
    const char *origin;
    int number;
    struct fish_parameters *fish;
    void *field;
};

struct key {
    const char *path; /* "time.end"; keys of every fish begin with "fish." */
    enum key_type type;
    size_t offset;       /* in struct case_values, or in struct fish_parameters */
    const char *initial; /* the default as YAML; NULL: see derived, or required when that is NULL too */
    struct bounds bounds;
    const char *unit; /* "": none */
    const char *meaning;
    const char *derived; /* the default that follows from other keys, in words, and where it is set by one of: */
    struct key_multiple multiple;
    struct key_choice choice;
    bool (*derive)(const struct key_place *at); /* set the field; false: the key has no value in this case */
    const char *const *follows; /* paths of the keys that switch the model by the derived default, NULL at the end */
    const char *cause;          /* path of the key that can put the derived number out of its range; NULL: none */
    const char *published;      /* the default under preset: published; NULL: as without the preset */
    const char *const *words;   /* of a CHOICE, in the order of its enum, NULL at the end */
    const char *synonyms;       /* words that users write instead, separated by blanks */
};

extern const struct key case_table[];
extern const int case_table_n;

/* The row of a path without indices ("fish.nodes"); NULL if there is none. */
const struct key *case_table_row(const char *path);

/* True if a path is a section, such as "fish.body": keys of the table begin with "path.". */
bool case_table_is_section(const char *path);

/* True if every fish has the key. */
bool case_table_is_of_fish(const struct key *key);

/* True if the key has one value and a field in struct case_values; false from FILES on. */
bool case_table_is_value(const struct key *key);

/* The number of fields of a key in a case: one for each fish, or one; 0 for a key without a field. */
int case_table_n_fields(const struct key *key, const struct case_values *values);

/* The place of the state of a key; fish is 0 unless the key is of a fish. */
enum key_state *case_table_state(const struct case_values *values, const struct key *key, int fish);

/* Whether the key at a path has a value. */
bool case_table_is_set(const struct case_values *values, const char *path, int fish);

/* Set the derived defaults of keys without a value, row by row. origin: the name of the file with the case. */
void case_table_derive(struct case_values *values, const char *origin);

/* What a beat is for a key, in s. A key of a fish counts the beats of this fish, a key of the case those of the slowest
 * fish; 0: no fish beats. */
double case_table_beat(const struct case_values *values, const struct key *key, int fish);

/* The time of a key in beats; NULL: the case has it in seconds. */
const struct case_beats *case_table_in_beats(const struct case_values *values, const struct key *key, int fish);

/* Add a time in beats. */
void case_table_add_beats(struct case_values *values, struct case_beats beats);

/* The field of a key; fish is ignored unless the key is of a fish. */
void *case_table_field(const struct key *key, struct case_values *values, struct fish_parameters *fish);

/* Word i of a CHOICE or METHOD; NULL past the last. */
const char *case_table_word(const struct key *key, int i);

/* The type and the range of a key as in doc/cases.md: "number"; "from 0 to 1", "above 0" or "". */
const char *case_table_type(const struct key *key);
void case_table_range(const struct key *key, struct text *range);

/* The name of fish f if the case gives it none. */
char *case_table_fish_name(struct arena *arena, int f);

#endif
