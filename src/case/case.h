/* case.h: reads a case. One table of keys (case_table.c) drives parsing, checking, printing and the reference
 * doc/cases.md; case_show.c prints a case, and case_keys.c the table. Tested by tests/case/test_case.c and, for bad
 * input, tests/case/test_bad_cases.c and test_bad.sh.
 *
 *     text of the case ---yaml---> tree ---merge---> tree ---table---> struct case_values ---check--->
 *     (and includes)                  preset < include < case file < --set;  defaults.fish < fish[f] */
#ifndef CASE_H
#define CASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"

/* Read the case file at path, apply the n_assignments strings "path=value" in order, check everything and fill *values.
 * Fails with STATUS_FILE (cannot be read) or STATUS_CASE; the message then lists up to 20 errors in the form of a
 * compiler, each with a caret under the place. After a failure *values owns nothing. Free with
 * case_free. */
enum status case_read(struct case_values *values, const char *path, int n_assignments, const char *const *assignments);

/* Read a case from a string. origin: the name of the string in messages; folder: the folder of includes (NULL or "":
 * the working directory). Otherwise as case_read. */
enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments);

/* Release the values and zero *values. Accepts zeroed values. */
void case_free(struct case_values *values);

/* Fill *values with the case of one member of a study: the case of the study with the values of the member assigned as
 * by --set, without a sweep. Fails with STATUS_CASE, naming the member. Free with case_free. */
enum status case_member(struct case_values *values, const struct case_values *study, int member);

/* The complete case with the values of all keys, in an arena, written as a case file from which case_read reads the
 * same bits (case_show.c). */
char *case_show(struct arena *arena, const struct case_values *values);

/* Print path, type, default, range, unit and meaning of every key, as text or as JSON, from which doc/cases.md and
 * doc/case.schema.json are made (case_keys.c). With a word, print only the keys that have the word in path, synonyms,
 * words or meaning (NULL: all keys). Returns the number of printed keys. Tested by tests/app/test_command.sh and
 * tests/extra/test_manual.sh. */
int case_keys(struct arena *arena, FILE *stream, bool as_json, const char *word);

/* case_show.c: a commented case to start from, complete and valid. */
extern const char case_template[];

#endif
