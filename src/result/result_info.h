/* result_info.h: summarises a result file, as text and as JSON, for `shoal info`. Tested by
 * tests/result/test_result_info.c and tests/app/test_steady_command.sh. */
#ifndef RESULT_INFO_H
#define RESULT_INFO_H

#include <stdio.h>

#include "base/status.h"
#include "result/netcdf.h"

/* Print the status of a run, the last values of every fish, and the effort of the solver. These functions request
 * memory of the arena of the reader (netcdf_print). Fails with STATUS_FILE. */
enum status result_info(const struct netcdf_reader *reader, FILE *stream);

/* Print the steady state of a result file: effort, residual, multipliers, and a table of the fish; nothing for a file
 * without a steady state. Fails with STATUS_FILE. */
enum status result_info_steady(const struct netcdf_reader *reader, FILE *stream);

/* Print the steady state of a result file as a JSON object with "file", "fish", and every variable steady_... as a
 * number or as lists over the dimensions. NaN becomes null; unused slots of multipliers are omitted. The file must have
 * a steady state. Fails with STATUS_FILE. */
enum status result_json_steady(const struct netcdf_reader *reader, FILE *stream);

/* Print an object with "file", "kind", "case", "program", "history", "status", "warnings", "rows", and the variables of
 * the file over time, fish, members and the like: of variables with rows the last row; none over nodes, edges, points
 * of the sheet, vortices or a grid. Fails with STATUS_FILE. */
enum status result_json_summary(const struct netcdf_reader *reader, const char *kind, FILE *stream);

#endif
