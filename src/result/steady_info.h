/* steady_info.h: the summary of a steady state, from the result file. Tested by
 * tests/app/test_steady_command.sh. */
#ifndef STEADY_INFO_H
#define STEADY_INFO_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print effort, residual, multipliers, and a table of the fish; nothing for a file without a steady state. Fails with
 * STATUS_FILE or STATUS_MEMORY. */
enum status steady_info(const struct netcdf_reader *reader, FILE *stream);

#endif
