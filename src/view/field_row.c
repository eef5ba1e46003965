/* field_row.c: makes a state again from the variables of a result file. */
#include "view/field_row.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "case/case.h"
#include "fish/fish_school.h"
#include "force/bound_sheet.h"
#include "result/netcdf.h"
#include "result/result_reader.h"
#include "result/result_table.h"
#include "view/field_file.h"
#include "wake/stretch.h"

/* A result file that is being read. */
struct reading {
    struct netcdf_reader file;
    long n_rows;
    double *time;   /* of the rows, s (n_rows + 1) */
    double *buffer; /* (2 of the longest dimension) */
};

// ---- the row

static bool is_row(const struct reading *reading, long row) {
    return row >= 0 && row < reading->n_rows;
}

/* The first row with a wake from the given row on, forwards or backwards; an invalid row number if there is none. All
 * fish or none have a wake in a row. */
static enum status next_with_wake(const struct reading *reading, const struct school *school, long from, int step,
                                  long *row) {
    bool has_wake = false;
    for (*row = from; is_row(reading, *row); *row += step) {
        has_wake = true;
        for (int f = 0; f < school->n_fish; f++) {
            double count, first;
            const struct netcdf_slice slice[] = {
                {"time", (size_t)*row, 1}, {"fish", (size_t)f, 1}, {"vortex", 0, 1}, {NULL, 0, 0}};
            const struct netcdf_slice of_fish[] = {slice[0], slice[1], {NULL, 0, 0}};
            TRY(netcdf_read_doubles(&reading->file, "wake_count", of_fish, &count));
            if (count < 1) continue;
            TRY(netcdf_read_doubles(&reading->file, "wake_circulation", slice, &first));
            if (isnan(first)) has_wake = false;
        }
        if (has_wake) break;
    }
    return STATUS_OK;
}

/* The row at a time; without one (NULL), the last row with a wake. */
static enum status field_find_row(const struct reading *reading, const struct school *school, const double *t,
                                  long *row) {
    const long last = reading->n_rows - 1;
    const double *const time = reading->time, rounding = 1e-6 * school->interval;
    if (last < 0) return status_fail(STATUS_CASE, "%s: there is no row yet", reading->file.path);
    *row = t ? 0 : last;
    if (t && (*t < time[0] - rounding || *t > time[last] + rounding)) {
        return status_fail(STATUS_CASE, "%s: t = %g s is outside of the rows, %g s to %g s", reading->file.path, *t,
                           time[0], time[last]);
    }

    while (t && *row < last && time[*row] < *t - rounding) ++*row;
    if (t && *row > 0 && fabs(time[*row] - *t) > rounding) {
        return status_fail(STATUS_CASE, "%s: there is no row at t = %g s: the nearest are at %g s and %g s",
                           reading->file.path, *t, time[*row - 1], time[*row]);
    }

    // the row itself or, without a time, the nearest earlier row with a wake
    const long found = *row;
    long before, after;
    TRY(next_with_wake(reading, school, found, -1, &before));
    if (is_row(reading, before) && (!t || before == found)) {
        *row = before;
        return STATUS_OK;
    }

    // name the nearest rows with a wake
    char near[96] = "; no row has a wake";
    TRY(next_with_wake(reading, school, found, 1, &after));
    if (is_row(reading, before) && is_row(reading, after)) {
        snprintf(near, sizeof near, ": the nearest rows with a wake are at %g s and %g s", time[before], time[after]);
    } else if (is_row(reading, before) || is_row(reading, after)) {
        snprintf(near, sizeof near, ": the nearest row with a wake is at %g s",
                 time[is_row(reading, before) ? before : after]);
    }
    return status_fail(STATUS_CASE, "%s: the row at t = %g s has no wake (output.wake_interval)%s", reading->file.path,
                       time[found], near);
}

// ---- the values of a row

/* A variable over (time, fish, dimension): n values of fish f, all of them finite; with y, over (..., xy). */
static enum status field_read_values(const struct reading *reading, const char *name, long row, int f,
                                     const char *dimension, int n, double *x, double *y) {
    const struct netcdf_slice slice[] = {{"time", (size_t)row, 1},
                                         {"fish", (size_t)f, 1},
                                         {dimension, 0, (size_t)n},
                                         {y ? "xy" : NULL, 0, 2},
                                         {NULL, 0, 0}};
    if (n == 0) return STATUS_OK;
    TRY(netcdf_read_doubles(&reading->file, name, slice, reading->buffer));

    for (int i = 0; i < n; i++) {
        x[i] = reading->buffer[y ? 2 * i : i];
        if (y) y[i] = reading->buffer[2 * i + 1];
        if (isfinite(x[i]) && (!y || isfinite(y[i]))) continue;
        return status_fail(STATUS_FILE, "%s: variable %s has a gap where fish %d has a value", reading->file.path, name,
                           f);
    }

    return STATUS_OK;
}

static enum status read_wake(const struct reading *reading, long row, int f, const struct field_row *to) {
    struct wake *const wake = &to->state->wake[f];
    double count;
    const struct netcdf_slice slice[] = {{"time", (size_t)row, 1}, {"fish", (size_t)f, 1}, {NULL, 0, 0}};
    TRY(netcdf_read_doubles(&reading->file, "wake_count", slice, &count));
    if (!(count >= 0 && count < INT_MAX / 4)) {
        return status_fail(STATUS_FILE, "%s: fish %d has %g vortices", reading->file.path, f, count);
    }
    const int n = (int)count;
    wake_resize(wake, n);
    TRY(field_read_values(reading, "wake_x", row, f, "vortex", n, wake->x, wake->y));
    TRY(field_read_values(reading, "wake_circulation", row, f, "vortex", n, wake->circulation, NULL));
    TRY(field_read_values(reading, "wake_birth", row, f, "vortex", n, wake->birth, NULL));
    for (int i = 0; i < n; i++) {
        wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = wake->rate[i] = wake->rate_before[i] = 0;
    }

    // turn circulations of vortices into labels: each marker has half of both stretches that meet there
    double label = 0, stretch = 0;
    for (int i = 0; wake->has_markers && i < n; i++) {
        const double both = 2 * wake->circulation[i];
        wake->circulation[i] = label;
        stretch = both - stretch;
        label += stretch;
    }

    // a row follows the release of an event: the newest label is the shed circulation
    double shed;
    TRY(netcdf_read_doubles(&reading->file, "shed_circulation", slice, &shed));
    to->state->y[to->school->fish[f].at.circulation] = wake->shed_before = shed;
    const double oldest = wake->has_markers && n > 0 ? shed - wake->circulation[n - 1] : 0;
    for (int i = 0; i < n; i++) wake->circulation[i] += oldest;

    // old is what is far from the tail, or where markers were dropped
    const double longest = 1.5 * to->school->interval;
    stretch_find_old(wake, &to->school->fish[f], to->school);
    for (int j = wake->n_old; wake->has_markers && j + 1 < n; j++) {
        if (wake->birth[j + 1] - wake->birth[j] > longest) wake->n_old = j + 1;
    }
    wake->version++;
    return STATUS_OK;
}

// ---- the whole

static enum status field_read_row(struct arena *arena, struct reading *reading, const double *t, struct field_row *to) {
    const struct school *const school = to->school;
    size_t n_fish, n_rows, longest = 1;
    long row = 0;
    TRY(netcdf_read_length(&reading->file, "fish", (size_t)school->n_fish, (size_t)school->n_fish, &n_fish));
    static const char *const dimensions[] = {"node", "sheet", "vortex"};

    for (int i = 0; i < 3; i++) {
        size_t length;
        TRY(netcdf_read_length(&reading->file, dimensions[i], 1, INT_MAX, &length));
        if (length > longest) longest = length;
    }

    TRY(netcdf_read_length(&reading->file, "time", 0, INT_MAX, &n_rows));
    reading->n_rows = (long)n_rows;
    NEW(arena, reading->time, n_rows + 1);
    NEW(arena, reading->buffer, 2 * longest);
    const struct netcdf_slice rows[] = {{"time", 0, n_rows}, {NULL, 0, 0}};
    if (n_rows > 0) TRY(netcdf_read_doubles(&reading->file, "time", rows, reading->time));
    TRY(field_find_row(reading, school, t, &row));
    to->state->t = reading->time[row];

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double *const y = to->state->y;
        double *const gamma = y + fish->at.gamma;
        TRY(field_read_values(reading, "x", row, f, "node", fish->n_nodes, y + fish->at.x, y + fish->at.y));
        TRY(field_read_values(reading, "sheet_strength", row, f, "sheet", fish->n_sheet, gamma, NULL));
        for (int j = 0; j < fish->n_sheet; j++) {
            // the file has the strength per actual length, the unknown is per natural length
            const double strength = gamma[j];
            gamma[j] = 1;
            gamma[j] = strength / bound_sheet_strength(fish, j, y);
        }
        TRY(read_wake(reading, row, f, to));
    }

    return STATUS_OK;
}

enum status field_row_read(struct arena *arena, struct field_row **created, const char *path, const double *t,
                           int n_assignments, const char *const *assignments) {
    struct arena *const scratch = arena_create(arena, path);
    struct reading *reading;
    struct field_row *row;
    NEW(arena, row, 1);
    *created = row;
    NEW(scratch, reading, 1);
    TRY(netcdf_open(scratch, &reading->file, path));

    // the case
    char *effective;
    TRY(result_reader_check(&reading->file));
    TRY(netcdf_attribute(&reading->file, "case_effective", &effective));
    row->effective = arena_text(arena, "%s", effective);
    TRY(case_parse(&row->values, effective, strlen(effective), path, NULL, n_assignments, assignments));
    arena_move(row->values.arena, arena);
    TRY(fish_school_create(arena, &row->school, &row->values.school));
    row->state = state_create(arena, row->school);

    TRY(field_read_row(scratch, reading, t, row));
    arena_free(scratch);
    return STATUS_OK;
}
