/* field_file.h: the velocity and the vorticity of the fluid on a grid, at the time of one row of a result file, and the
 * file that holds them. Tested by tests/view/test_field_file.c. */
#ifndef FIELD_FILE_H
#define FIELD_FILE_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "fish/fish.h"
#include "result/result_kind.h"
#include "state/state.h"
#include "view/field_row.h"

enum {
    FIELD_FILE_SCHEMA = 1,       /* attribute shoal_field */
    FIELD_FILE_POINTS = 10000000 /* of a grid: no more than these */
};

/* Points at equal distances, the corners of the box included. */
struct field_grid {
    int nx, ny;             /* each at least 2 */
    double low[2], high[2]; /* m */
};

/* The box around all bodies and free vortices of a row, with a margin of half a body length, m. */
void field_file_box(const struct field_row *row, double low[2], double high[2]);

/* Sum the field of a row on a grid, and write the field to a file at path. arena: for scratch; run: the name of
 * the result file; command: the command line. Fails with STATUS_FILE or STATUS_MEMORY; no file is then left. */
enum status field_file_write(struct arena *arena, const char *path, int overwrite, const char *run, const char *command,
                             const struct field_row *row, const struct field_grid *grid);

/* Print time, grid and range of such a file. Fails with STATUS_FILE. */
enum status field_file_info(const struct netcdf_reader *file, FILE *stream);

/* Row i, from 0, of the list of variables; 0 beyond the last. */
int field_file_listed(int i, struct result_listed *listed);

#endif
