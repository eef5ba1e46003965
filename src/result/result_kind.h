/* result_kind.h: the kinds of files that shoal writes, and what they have in common: the summary of `shoal info` and
 * the list of variables of `shoal keys --output`. The table of kinds is in app/main_case.c. Tested by
 * tests/result/test_result_info.c. */
#ifndef RESULT_KIND_H
#define RESULT_KIND_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "result/netcdf.h"

/* A row of the list of variables. */
struct result_listed {
    const char *name, *unit, *type, *meaning;
    char dimensions[80]; /* "time, fish" */
    const char *flags;   /* the words of the values 0, 1, ..., separated by blanks; NULL: none */
};

struct result_kind {
    const char *name;        /* the subject of the file: "run" */
    const char *schema_name; /* the attribute of a file of this kind; NULL: a list in words, of no file */
    int schema;              /* the schema that this program reads */
    const char *case_name;   /* the attribute that holds the case */

    /* Print the summary of this kind, after the common part. Fails with STATUS_FILE. */
    enum status (*info)(const struct netcdf_reader *reader, FILE *stream);

    /* Row i, from 0, of the list of variables; 0 beyond the last. */
    int (*listed)(int i, struct result_listed *listed);
};

/* Print a summary of a file as text or as JSON (result_json_summary), or only the case in the file. arena: for scratch.
 * Fails with STATUS_FILE. */
enum result_info_form { RESULT_INFO_TEXT, RESULT_INFO_CASE, RESULT_INFO_JSON };
enum status result_kind_info(struct arena *arena, int n_kinds, const struct result_kind *kinds, const char *path,
                             enum result_info_form form, FILE *stream);

/* Print the variables of all kinds: name, dimensions, unit, meaning; as aligned text, or as JSON; and the lists in
 * words. With a word, print only rows whose name or meaning contains the word (NULL: all). Returns the number of rows.
 * */
int result_kind_variables(int n_kinds, const struct result_kind *kinds, int as_json, const char *word, FILE *stream);

#endif
