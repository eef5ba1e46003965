/* steady_info.h: the summary of a steady state, from the result file. Tested by
 * tests/app/test_steady_command.sh. */
#ifndef STEADY_INFO_H
#define STEADY_INFO_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print effort, residual, multipliers, and a table of the fish; nothing for a file without a steady state. Fails with
 * STATUS_FILE or STATUS_MEMORY. */
enum status steady_info(const struct netcdf_reader *reader, FILE *stream);

/* A steady state as JSON, from the result file: an object with "file", "fish_name", and every variable
 * steady_... as a number or as lists over the dimensions. NaN becomes null; unused slots of multipliers are omitted. */

/* Print the object; the file must have a steady state. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status steady_json(const struct netcdf_reader *reader, FILE *stream);

#endif
