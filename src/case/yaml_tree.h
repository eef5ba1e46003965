/* yaml_tree.h: reads a subset of YAML into a tree whose nodes know their places in the source. Tested by
 * tests/case/test_yaml.c.
 *
 *     time: {end: 3}          map -- "time" -- map -- "end" -- scalar "3"
 *     fish:                    |
 *       - nodes: 7             +-- "fish" -- list -- map -- "nodes" -- scalar "7"
 *
 * There are maps, lists and scalars only; anchors, aliases, tags, merge keys, duplicate keys and further documents are
 * refused. A scalar is a string whose meaning the key decides, never YAML. Only the events of libyaml are used, because
 * its loader takes quadratic time on hostile input.
 *
 * A reader continues after an error, so that the user sees all errors of a case at once, in the form of a compiler:
 *
 *     cases/x.yaml:23:5: error: fish[2].stifness: unknown key; did you mean 'modulus'?
 *         stifness: 1e6
 *         ^ */
#ifndef YAML_TREE_H
#define YAML_TREE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/status.h"
#include "base/text.h"

// ---- places in the sources of a case, and the list of errors

/* A file, or an assignment of the command line. */
struct yaml_source {
    const char *name; /* in messages */
    const char *text; /* not terminated by a zero */
    size_t length;    /* bytes */
    int rank;         /* errors are listed by rank, then by line */
    bool one_line;    /* an assignment: messages show the name, without line and caret */
};

/* A place in a source; line and column (in characters) count from 1. */
struct yaml_mark {
    const struct yaml_source *source;
    int line, column;
};

enum { YAML_ERRORS_KEPT = 64, YAML_ERRORS_SHOWN = 20 };

struct yaml_errors {
    struct arena *arena; /* of the texts */
    int n;               /* all errors, including those that are not kept */
    struct {
        struct yaml_mark mark;
        char *text;
    } kept[YAML_ERRORS_KEPT];
};

/* Add an error (printf format, one line without "error:"). */
void yaml_errors_add(struct yaml_errors *errors, struct yaml_mark mark, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* STATUS_OK if nothing was added; else STATUS_CASE with the list as message. */
enum status yaml_errors_status(const struct yaml_errors *errors);

/* The list with another word than "error", such as "note", in an arena; "" for an empty list. */
char *yaml_errors_list(struct arena *arena, const struct yaml_errors *errors, const char *word);

// ---- nodes

enum { YAML_TREE_DEPTH = 32, YAML_TREE_KEYS = 256 /* keys of one map */, YAML_TREE_BYTES = 4 * 1024 * 1024 };

enum yaml_kind { YAML_SCALAR, YAML_LIST, YAML_MAP };

struct yaml_node {
    enum yaml_kind kind;
    struct yaml_mark mark;
    char *text;               /* string of a scalar, UTF-8 */
    int n, capacity;          /* entries of a list or map */
    struct yaml_entry *entry; /* in the order of the text */
};

struct yaml_entry {
    char *key;             /* of a map; NULL in a list */
    struct yaml_mark mark; /* of the key */
    struct yaml_node *value;
};

/* Parse a source. Fails with STATUS_CASE after adding to errors; *root is then NULL, as for a source without values.
 * The nodes point at the source. */
enum status yaml_tree_read(struct arena *arena, struct yaml_node **root, const struct yaml_source *source,
                           struct yaml_errors *errors);

/* A node without entries or text, and a copy of a tree. */
struct yaml_node *yaml_tree_node(struct arena *arena, enum yaml_kind kind, struct yaml_mark mark);
struct yaml_node *yaml_tree_copy(struct arena *arena, const struct yaml_node *node);

/* The entry of a map under a key of length bytes; NULL if there is none or the node is NULL or no map. */
struct yaml_entry *yaml_tree_entry(const struct yaml_node *map, const char *key, size_t length);

/* The node at a path of keys like "time.end"; NULL if there is none. */
const struct yaml_node *yaml_tree_find(const struct yaml_node *map, const char *path);

/* Merge over onto *base: maps are merged key by key, anything else is replaced. The nodes of over become part of *base.
 * yaml_tree_put: the same for one key of a map. */
void yaml_tree_merge(struct arena *arena, struct yaml_node **base, struct yaml_node *over);
void yaml_tree_put(struct arena *arena, struct yaml_node *map, const char *key, struct yaml_mark mark,
                   struct yaml_node *value);

/* Remove a key of a map; returns the value, NULL without the key. */
struct yaml_node *yaml_tree_take(struct yaml_node *map, const char *key);

/* Add an error for each key of a map that is not among the known ones, "key, values"; path: path of the map. */
void yaml_tree_check_keys(const struct yaml_node *map, const char *path, const char *known, struct yaml_errors *errors);

/* True for the word "true"; adds an error, with the path, unless the node is true or false. */
bool yaml_tree_boolean(const struct yaml_node *node, const char *path, struct yaml_errors *errors);

/* The number above 0 under a key of a map; path: path of the map. Without the key it is the standard, or an error if
 * the standard is 0. After an error it is the standard. */
double yaml_tree_positive(const struct yaml_node *map, const char *path, const char *key, double standard,
                          struct yaml_errors *errors);

/* "a map of keys", "a list of 3", "'text'" or "nothing": for messages, kept in buffer and returned. */
const char *yaml_tree_describe(const struct yaml_node *node, char *buffer, size_t size);

// ---- writing

/* Add a string, quoted if YAML needs quotes. */
void yaml_write_scalar(struct text *text, const char *scalar);

/* Add any value on one line: [1, 2] and {a: 1}. */
void yaml_write_node(struct text *text, const struct yaml_node *node);

#endif
