/* result_json.h: a steady state, and the summary of any file, as JSON. A steady state from the result file: an object
 * with "file", "fish_name", and every variable steady_... as a number or as lists over the dimensions. NaN becomes
 * null; unused slots of multipliers are omitted. Tested by tests/app/test_steady_command.sh. */
#ifndef RESULT_JSON_H
#define RESULT_JSON_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print the object; the file must have a steady state. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status result_json_steady(const struct netcdf_reader *reader, FILE *stream);

/* Print an object with "file", "kind", "case", "program", "history", "status", "warnings", "rows", and the variables of
 * the file over time, fish, members and the like: of variables with rows the last row; none over nodes, edges, points
 * of the sheet, vortices or a grid. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status result_json_summary(const struct netcdf_reader *reader, const char *kind, FILE *stream);

#endif
