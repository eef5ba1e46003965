/* case_schema.h: the table of keys as a JSON schema, with which editors check and complete case files. Tested by
 * tests/app/test_manual.sh, which validates every case of cases/. */
#ifndef CASE_SCHEMA_H
#define CASE_SCHEMA_H

#include <stdio.h>

/* Print the schema (draft 7). */
void case_schema(FILE *stream);

#endif
