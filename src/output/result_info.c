/* result_info.c: reading a result file: the summary that `shoal info` prints, and the case in it. */
#include <errno.h>
#include <math.h>
#include <netcdf.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "output/result_file.h"
#include "output/result_table.h"
#include "study/compare_file.h"
#include "study/study_file.h"

struct info {
    const char *path;
    int file;
    size_t n_rows, n_fish, n_name;
    FILE *stream;
};

// ---- reading ----

/* A text attribute of the file, "" if it is missing. The caller frees it; NULL: out of memory. */
static char *text_attribute(const struct info *info, const char *name) {
    size_t length;
    if (nc_inq_attlen(info->file, NC_GLOBAL, name, &length) != NC_NOERR) length = 0;
    char *text = calloc(length + 1, 1);
    if (text && length > 0) nc_get_att_text(info->file, NC_GLOBAL, name, text);
    return text;
}

/* NetCDF's number of a variable with at most so many dimensions, or -1. */
static int variable_number(const struct info *info, const char *name, int most_dimensions) {
    int number, n;
    if (nc_inq_varid(info->file, name, &number) != NC_NOERR) return -1;
    return nc_inq_varndims(info->file, number, &n) == NC_NOERR && n <= most_dimensions ? number : -1;
}

/* The value in a row of a school's variable, of fish f for a fish's variable; NaN if it is missing. */
static double row_value(const struct info *info, size_t row, const char *name, size_t f) {
    double value;
    const int number = variable_number(info, name, 2);
    return nc_get_var1_double(info->file, number, (size_t[]){row, f}, &value) == NC_NOERR ? value : NAN;
}

static double last_value(const struct info *info, const char *name, size_t f) {
    return row_value(info, info->n_rows - 1, name, f);
}

/* The same for a value that does not change with time. */
static double constant(const struct info *info, const char *name, size_t f) {
    double value;
    const int number = variable_number(info, name, 1);
    return nc_get_var1_double(info->file, number, &f, &value) == NC_NOERR ? value : NAN;
}

static size_t dimension_length(const struct info *info, const char *name) {
    int number;
    size_t length;
    if (nc_inq_dimid(info->file, name, &number) != NC_NOERR) return 0;
    return nc_inq_dimlen(info->file, number, &length) == NC_NOERR ? length : 0;
}

// ---- refusing ----

static enum status open_file(struct info *info) {
    struct stat target;
    if (stat(info->path, &target) != 0)
        return status_fail(STATUS_FILE, "%s: cannot be read: %s", info->path, strerror(errno));
    if (S_ISDIR(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a folder: name a file that shoal wrote", info->path);
    const int code = nc_open(info->path, NC_NOWRITE, &info->file);
    if (code == NC_NOERR) return STATUS_OK;
    if (code == NC_ENOMEM) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", info->path);
    if (code > 0) return status_fail(STATUS_FILE, "%s: cannot be read: %s", info->path, strerror(code));
    return status_fail(STATUS_FILE, "%s: not a NetCDF file (%s): name a file that shoal wrote", info->path,
                       nc_strerror(code));
}

/* Missing data at the end of a file reads as zero; the time the run took, the last value of each row, never is. */
static bool is_cut(const struct info *info) {
    return info->n_rows > 1 && last_value(info, "wall_time", 0) == 0;
}

// ---- printing ----

static enum status print_attribute(const struct info *info, const char *label, const char *name) {
    char *text = text_attribute(info, name);
    if (text == NULL) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", info->path);
    if (label)
        fprintf(info->stream, "  %-10s  %s\n", label, text);
    else
        fputs(text, info->stream);
    free(text);
    return STATUS_OK;
}

static void print_size(const struct info *info) {
    struct stat target;
    if (stat(info->path, &target) != 0) return;
    const double bytes = (double)target.st_size;
    if (bytes < 1e6)
        fprintf(info->stream, "  %-10s  %.1f kB\n", "size", bytes / 1e3);
    else
        fprintf(info->stream, "  %-10s  %.1f MB\n", "size", bytes / 1e6);
}

static void print_span(const struct info *info) {
    if (info->n_rows == 0) {
        fprintf(info->stream, "  %-10s  none yet\n", "rows");
        return;
    }
    fprintf(info->stream, "  %-10s  %zu, from t = %g s to %g s; a vortex every %g s\n", "rows", info->n_rows,
            row_value(info, 0, "time", 0), last_value(info, "time", 0), constant(info, "shedding_interval", 0));
}

/* A number of a table, or "-" where there is none. */
static void print_cell(const struct info *info, const char *format, double value) {
    char text[32];
    snprintf(text, sizeof text, format, value);
    fprintf(info->stream, "  %10s", isnan(value) ? "-" : text);
}

/* The columns of the table of fish; those with time show the last row. */
static const struct column {
    const char *head, *unit, *variable, *format;
    bool with_time;
} columns[] = {
    {"nodes", "", "n_nodes", "%.0f", false},
    {"sheet", "", "n_sheet", "%.0f", false},
    {"length", "m", "body_length", "%.4g", false},
    {"vortices", "", "wake_count", "%.0f", true},
    {"speed", "m s-1", "speed", "%.4f", true},
    {"heading", "degree", "heading", "%.2f", true},
    {"phi0", "", "phi0", "%.4f", true},
    {"shed", "m2 s-1", "shed_circulation", "%.3e", true},
    {"energy", "J", "kinetic_energy", "%.4g", true},
    {"work", "J", "actuation_work", "%.4g", true},
    {"audit", "J", "energy_audit", "%.1e", true},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns };

static enum status print_fish(const struct info *info) {
    char *name = calloc(info->n_name + 1, 1);
    if (name == NULL) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", info->path);
    const int width = info->n_name > 4 ? (int)info->n_name : 4;
    const int number = variable_number(info, "fish_name", 2);

    const int n_columns = info->n_rows > 0 ? N_COLUMNS : 3;
    fprintf(info->stream, "\n  %-*s", width, "fish");
    for (int c = 0; c < n_columns; c++) fprintf(info->stream, "  %10s", columns[c].head);
    fprintf(info->stream, "\n  %-*s", width, "");
    for (int c = 0; c < n_columns; c++) fprintf(info->stream, "  %10s", columns[c].unit);
    fprintf(info->stream, "\n");
    for (size_t f = 0; f < info->n_fish; f++) {
        nc_get_vara_text(info->file, number, (size_t[]){f, 0}, (size_t[]){1, info->n_name}, name);
        fprintf(info->stream, "  %-*s", width, name);
        for (int c = 0; c < n_columns; c++)
            print_cell(info, columns[c].format,
                       columns[c].with_time ? last_value(info, columns[c].variable, f)
                                            : constant(info, columns[c].variable, f));
        fprintf(info->stream, "\n");
    }
    free(name);
    return STATUS_OK;
}

static void print_school(const struct info *info) {
    fprintf(info->stream, "\n  total circulation     %11.1e m2 s-1\n", last_value(info, "total_circulation", 0));
    if (info->n_fish > 1)
        fprintf(info->stream, "  least distance        %11.4f m\n  polarisation          %11.4f\n",
                last_value(info, "least_distance", 0), last_value(info, "polarisation", 0));
}

static void print_solver(const struct info *info) {
    static const char *const totals[] = {"steps",
                                         "residual_evaluations",
                                         "newton_iterations",
                                         "jacobian_evaluations",
                                         "error_test_failures",
                                         "convergence_failures"};
    const double n_events = last_value(info, "time", 0) / constant(info, "shedding_interval", 0);
    fprintf(info->stream, "\n");
    for (size_t i = 0; i < sizeof totals / sizeof *totals; i++) {
        const double total = last_value(info, totals[i], 0);
        fprintf(info->stream, "  %-20s  %11.0f", totals[i], total);
        if (n_events >= 1) fprintf(info->stream, "   %.2f per event", total / n_events);
        fprintf(info->stream, "\n");
    }
    const double wall = last_value(info, "wall_time", 0);
    fprintf(info->stream, "  %-20s  %11.2f s   %.3g times real time\n", "wall_time", wall,
            last_value(info, "time", 0) / wall);
}

/* What is the same in all files. */
static enum status print_head(const struct info *info) {
    fprintf(info->stream, "%s\n", info->path);
    TRY(print_attribute(info, "case", "title"));
    TRY(print_attribute(info, "program", "source"));
    TRY(print_attribute(info, "history", "history"));
    print_size(info);
    return STATUS_OK;
}

static enum status print_run(const struct info *info) {
    TRY(print_head(info));
    TRY(print_attribute(info, "status", "run_status"));
    print_span(info);
    TRY(print_fish(info));
    if (info->n_rows == 0) return STATUS_OK;
    print_school(info);
    print_solver(info);
    return STATUS_OK;
}

// ---- all kinds of files ----

/* The attribute that holds the schema, the one that holds the case, and the summary. */
static const struct kind {
    const char *schema_name;
    int schema;
    const char *case_name;
    enum status (*print)(const struct info *info);
} kinds[] = {
    [RESULT_RUN] = {"shoal_schema", RESULT_SCHEMA, "case_effective", print_run},
    [RESULT_STUDY] = {"shoal_study", RESULT_STUDY_SCHEMA, "study_case", print_head},
    [RESULT_COMPARISON] = {"shoal_compare", RESULT_COMPARE_SCHEMA, "compare_case", print_head},
};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

static enum status find_kind(const struct info *info, enum result_kind *kind) {
    int schema = 0, k = 0;
    while (k < N_KINDS && nc_get_att_int(info->file, NC_GLOBAL, kinds[k].schema_name, &schema) != NC_NOERR) k++;
    if (k == N_KINDS) {
        return status_fail(STATUS_FILE, "%s: a NetCDF file, but not one of shoal (it has no attribute shoal_schema)",
                           info->path);
    }
    if (schema != kinds[k].schema) {
        return status_fail(STATUS_FILE,
                           "%s: written in schema %d, but this program reads %d: use the one that wrote it", info->path,
                           schema, kinds[k].schema);
    }
    if (is_cut(info)) {
        return status_fail(STATUS_FILE, "%s: the end of the file is missing: was it copied completely?", info->path);
    }
    *kind = (enum result_kind)k;
    return STATUS_OK;
}

enum status result_info(const char *path, int case_only, FILE *stream, enum result_kind *kind) {
    struct info info = {.path = path, .stream = stream};
    TRY(open_file(&info));
    info.n_rows = dimension_length(&info, "time");
    info.n_fish = dimension_length(&info, "fish");
    info.n_name = dimension_length(&info, "name");
    enum status status = find_kind(&info, kind);
    if (status == STATUS_OK) {
        status = case_only ? print_attribute(&info, NULL, kinds[*kind].case_name) : kinds[*kind].print(&info);
    }
    nc_close(info.file);
    return status;
}
