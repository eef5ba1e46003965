/* steady_json.h: a steady state as JSON, from the result file: an object with "file", "fish_name", and every variable
 * steady_... as a number or as lists over the dimensions. NaN becomes null; unused slots of multipliers are omitted.
 * Tested by tests/app/test_steady_command.sh. */
#ifndef STEADY_JSON_H
#define STEADY_JSON_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print the object; the file must have a steady state. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status steady_json(const struct netcdf_reader *reader, FILE *stream);

#endif
