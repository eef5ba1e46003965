/* yaml_errors.h: places in texts, and the list of what is wrong there. Tested by tests/case/test_yaml.c.
 *
 * A reader goes on after an error and adds the next one here, so that a user sees all errors of a case at once, in the
 * form that a compiler uses:
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

/* One text: a file, or an assignment of the command line. */
struct yaml_source {
    char *name;    /* as messages call it */
    char *text;    /* without a terminating zero: length bytes count */
    size_t length; /* bytes */
    int rank;      /* errors are listed by rank, then by line */
    bool one_line; /* the name says it all: messages need neither line nor caret */
};

/* A place in a text; line and column (in characters) count from 1. */
struct yaml_mark {
    const struct yaml_source *source;
    int line, column;
};

enum { YAML_ERRORS_KEPT = 64, YAML_ERRORS_SHOWN = 20 };

struct yaml_errors {
    int n; /* all errors, also those of which no text is kept */
    struct {
        struct yaml_mark mark;
        char *text;
    } kept[YAML_ERRORS_KEPT];
    bool out_of_memory; /* a text could not be kept */
};

/* Add an error (printf format, one line without "error:"). A failing allocation is remembered, see below. */
void yaml_errors_add(struct yaml_errors *errors, struct yaml_mark mark, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* STATUS_OK if nothing was added; else STATUS_CASE with the list as message, or STATUS_MEMORY. */
enum status yaml_errors_status(const struct yaml_errors *errors);

/* Release the texts and zero the list. */
void yaml_errors_free(struct yaml_errors *errors);

#endif
