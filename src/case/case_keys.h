/* case_keys.h: the table of keys in print: `shoal keys`, and doc/cases.md by way of JSON. Tested by
 * tests/app/test_command.sh. */
#ifndef CASE_KEYS_H
#define CASE_KEYS_H

#include <stdio.h>

/* Print path, type, default, range, unit and meaning of every key; as text, or as JSON. */
void case_keys(FILE *stream, int as_json);

#endif
