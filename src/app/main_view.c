/* main_view.c: the commands for looking at a result: shoal view and export for other programs, field for the flow on a
 * grid. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "base/arena.h"
#include "base/text.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "view/field_file.h"
#include "view/field_row.h"
#include "view/page.h"
#include "view/vtk.h"

/* Print a note on rows that are missing because the file is truncated. */
static void note_missing(const char *path) {
    struct netcdf_rows rows;
    if (netcdf_read_rows(path, &rows) != STATUS_OK || rows.n == 0 || rows.n == rows.n_counted) return;
    say_line(stderr, "shoal: note: %s: the last %llu of %llu rows are missing: the file was cut off\n", path,
             (unsigned long long)(rows.n_counted - rows.n), (unsigned long long)rows.n_counted);
}

enum status main_view(const struct request *request) {
    const char *const run = request->positional, *path = request->output;
    if (path) {
        TRY(target_refuse_input(path, run));
    } else {
        // the name of the run without folders and ending
        const char *const slash = strrchr(run, '/'), *const name = slash ? slash + 1 : run;
        const char *const dot = strrchr(name, '.');
        const size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
        path = arena_text(request->arena, "%.*s.html", (int)length, name);
    }

    main_leave_no_part();
    TRY(page_write(request->arena, run, path, request->force));
    note_missing(run);
    if (!request->quiet) say_line(stdout, "%s\n", path);
    return STATUS_OK;
}

enum status main_export(const struct request *request) {
    const char *list;
    if (!request->vtk)
        return status_fail(STATUS_CASE, "export: choose a format: --vtk FOLDER; see shoal export --help");
    main_leave_no_part();
    TRY(vtk_export(request->arena, request->positional, request->vtk, request->force, &list));
    note_missing(request->positional);
    if (!request->quiet) say_line(stdout, "%s\n", list);
    return STATUS_OK;
}

// ---- the flow of a result on a grid

/* Default number of points along the longer side. */
enum { STANDARD_POINTS = 400 };

/* Read the n comma-separated numbers of an option. */
static enum status read_numbers(const char *option, const char *text, const char *expected, int n, double *number) {
    const char *at = text;
    for (int i = 0; i < n; i++) {
        char word[64];
        const size_t length = strcspn(at, ",");
        const bool is_last = i + 1 == n;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        if ((at[length] == ',') == is_last || !text_number(word, &number[i]) || !isfinite(number[i])) {
            return status_fail(STATUS_CASE, "%s %s: expects %s", option, text, expected);
        }
        at += length + !is_last;
    }

    return STATUS_OK;
}

enum status main_field(const struct request *request) {
    const char *const run = request->positional, *path = request->output;
    struct field_row *row;
    struct field_grid grid;
    double t;
    if (request->at) TRY(read_numbers("--at", request->at, "a time in s", 1, &t));
    if (path) TRY(target_refuse_input(path, run));
    TRY(field_row_read(request->arena, &row, run, request->at ? &t : NULL, request->n_assignments,
                       request->assignments));

    // RUN-field.nc of RUN.nc
    if (!path) {
        const size_t length = strlen(run);
        const bool has_ending = length > 3 && strcmp(run + length - 3, ".nc") == 0;
        path = arena_text(request->arena, "%.*s-field.nc", (int)(has_ending ? length - 3 : length), run);
    }

    // the box
    double corner[4], n[2];
    field_file_box(row, grid.low, grid.high);
    if (request->box) TRY(read_numbers("--box", request->box, "X0,Y0,X1,Y1 in m", 4, corner));
    for (int i = 0; i < 2 && request->box; i++) {
        grid.low[i] = corner[i];
        grid.high[i] = corner[i + 2];
        if (corner[i] < corner[i + 2]) continue;
        return status_fail(STATUS_CASE, "--box %s: expects the lower left corner before the upper right one",
                           request->box);
    }

    // the numbers of points; the default depends on the sides
    const double side[2] = {grid.high[0] - grid.low[0], grid.high[1] - grid.low[1]};
    for (int i = 0; i < 2; i++) n[i] = fmax(2, 1 + round((STANDARD_POINTS - 1) * side[i] / fmax(side[0], side[1])));
    if (request->grid) TRY(read_numbers("--grid", request->grid, "NX,NY, integers", 2, n));
    if (n[0] != floor(n[0]) || n[1] != floor(n[1]) || n[0] < 2 || n[1] < 2) {
        return status_fail(STATUS_CASE, "--grid %s: expects NX,NY, integers from 2 on", request->grid);
    }
    if (n[0] * n[1] > FIELD_FILE_POINTS) {
        return status_fail(STATUS_CASE, "--grid %s: more than %d points", request->grid, FIELD_FILE_POINTS);
    }
    grid.nx = (int)n[0];
    grid.ny = (int)n[1];

    main_leave_no_part();
    TRY(field_file_write(request->arena, path, request->force, run, request->command_line, row, &grid));
    if (!request->quiet) say_line(stdout, "%s: %d x %d points at t = %g s\n", path, grid.nx, grid.ny, row->state->t);
    return STATUS_OK;
}
