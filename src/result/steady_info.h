/* steady_info.h: the summary of a steady state, from the file that holds it. Tested by
 * tests/app/test_steady_command.sh. */
#ifndef STEADY_INFO_H
#define STEADY_INFO_H

#include <stdio.h>

#include "result/netcdf.h"

/* Print what the search found: effort, residual, multipliers, and a table of the fish. Nothing where the file holds no
 * steady state. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status steady_info(const struct netcdf_reader *reader, FILE *stream);

#endif
