/* steady_json.h: what a search for a steady state found as JSON, from the file that holds it: an object with "file",
 * "fish_name", and every variable steady_... under its name, as a number or as lists over its dimensions. null stands
 * where the file has NaN; slots of multipliers that are not used are left out. Tested by
 * tests/app/test_steady_command.sh. */
#ifndef STEADY_JSON_H
#define STEADY_JSON_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print it; the file must be one of a steady state. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status steady_json(const struct netcdf_reader *reader, FILE *stream);

#endif
