/* yaml_errors.h: places in the sources of a case, and the list of errors. Tested by tests/case/test_yaml.c.
 *
 * A reader continues after an error, so that the user sees all errors of a case at once, in the form of a compiler:
 *
 *     cases/x.yaml:23:5: error: fish[2].stifness: unknown key; did you mean 'modulus'?
 *         stifness: 1e6
 *         ^
 */
#ifndef YAML_ERRORS_H
#define YAML_ERRORS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* A file, or an assignment of the command line. */
struct yaml_source {
    char *name;    /* in messages */
    char *text;    /* not terminated by a zero */
    size_t length; /* bytes */
    int rank;      /* errors are listed by rank, then by line */
    bool one_line; /* an assignment: messages show the name, without line and caret */
};

/* A place in a source; line and column (in characters) count from 1. */
struct yaml_mark {
    const struct yaml_source *source;
    int line, column;
};

enum { YAML_ERRORS_KEPT = 64, YAML_ERRORS_SHOWN = 20 };

struct yaml_errors {
    int n; /* all errors, including those that are not kept */
    struct {
        struct yaml_mark mark;
        char *text;
    } kept[YAML_ERRORS_KEPT];
    bool out_of_memory; /* an error could not be kept */
};

/* Add an error (printf format, one line without "error:"). A failed allocation is recorded and reported by
 * yaml_errors_status. */
void yaml_errors_add(struct yaml_errors *errors, struct yaml_mark mark, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* STATUS_OK if nothing was added; else STATUS_CASE with the list as message, or STATUS_MEMORY. */
enum status yaml_errors_status(const struct yaml_errors *errors);

/* The list with another word than "error", such as "note"; "" for an empty list, NULL if out of memory. The caller
 * frees the text. */
char *yaml_errors_list(const struct yaml_errors *errors, const char *word);

/* Release the errors and zero the list. */
void yaml_errors_free(struct yaml_errors *errors);

#endif
