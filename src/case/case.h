/* case.h: reading a case. One table of keys (case_table.c) drives parsing, checking, printing and the reference
 * doc/cases.md. Tested by tests/case/test_case.c and, for bad input, tests/case/test_bad.sh.
 *
 *     text of the case ---yaml---> tree ---merge---> tree ---table---> struct case_values ---check--->
 *     (and includes)                  preset < include < case file < --set;  defaults.fish < fish[f] */
#ifndef CASE_H
#define CASE_H

#include <stddef.h>

#include "base/status.h"
#include "case/case_values.h"

/* Read the case file at path, apply the n_assignments strings "path=value" in order, check everything and fill *values.
 * Fails with STATUS_FILE (cannot be read) or STATUS_CASE; the message then lists up to 20 errors in the form of a
 * compiler, each with a caret under the place. *values then owns nothing. Free with case_free. */
enum status case_read(struct case_values *values, const char *path, int n_assignments, const char *const *assignments);

/* Read a case from a string. origin: the name of the string in messages; folder: the folder of includes (NULL or "":
 * the working directory). Otherwise as case_read. */
enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments);

/* Release the values and zero *values. Accepts zeroed values. */
void case_free(struct case_values *values);

#endif
