/* study_file_read.c: reading study.nc back. Declared in study_file.h. */
#include <math.h>
#include <netcdf.h>
#include <stdlib.h>
#include <string.h>

#include "study/study_file.h"

/* An open study.nc. */
struct reading {
    const char *path;
    int file;
    const struct case_values *study;
    struct member_file *member;
    int n_members, n_quantities;
    size_t n_text;  /* length of the dimension text */
    double *buffer; /* one quantity of all members */
};

static enum status no_memory(const char *path) {
    return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
}

static enum status not_whole(const char *path, int code) {
    return status_fail(STATUS_FILE, "%s: not a whole study (%s): make it again with `shoal gather`", path,
                       nc_strerror(code));
}

/* Parse the case of the study. */
static enum status read_study(const char *path, int file, struct case_values *study) {
    size_t length;
    int code = nc_inq_attlen(file, NC_GLOBAL, "study_case", &length);
    if (code != NC_NOERR) return not_whole(path, code);
    char *const text = calloc(length + 1, 1);
    if (!text) return no_memory(path);
    code = nc_get_att_text(file, NC_GLOBAL, "study_case", text);
    const enum status status =
        code == NC_NOERR ? case_parse(study, text, length, path, NULL, 0, NULL) : not_whole(path, code);
    free(text);
    return status;
}

/* One quantity of all members; a file of an earlier version may lack it. */
static void read_quantity(const struct reading *reading, int q) {
    const struct member_file_quantity *const quantity = member_file_quantity(q);
    int number;
    if (nc_inq_varid(reading->file, quantity->name, &number) != NC_NOERR) return;
    if (nc_get_var_double(reading->file, number, reading->buffer) != NC_NOERR) return;
    const double *from = reading->buffer;
    for (int m = 0; m < reading->n_members; m++) {
        for (int f = 0; f < (quantity->of_fish ? reading->study->school.n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) {
                reading->member[m].value[(q * reading->study->school.n_fish + f) * 2 + k] = *from++;
            }
        }
    }
}

/* Room for a member, and how it ended. */
static enum status read_member(const struct reading *reading, int m) {
    struct member_file *const member = &reading->member[m];
    const size_t n_values = (size_t)reading->n_quantities * (size_t)reading->study->school.n_fish * 2;
    member->number = m;
    member->n_fish = reading->study->school.n_fish;
    member->status = calloc(reading->n_text + 1, 1);
    member->value = malloc((n_values + 1) * sizeof *member->value);
    if (!member->status || !member->value) return no_memory(reading->path);
    for (size_t i = 0; i < n_values; i++) member->value[i] = NAN;
    int number;
    int code = nc_inq_varid(reading->file, "status", &number);
    if (code == NC_NOERR) {
        code = nc_get_vara_text(reading->file, number, (size_t[]){(size_t)m, 0}, (size_t[]){1, reading->n_text},
                                member->status);
    }
    return code == NC_NOERR ? STATUS_OK : not_whole(reading->path, code);
}

static size_t length_of(int file, const char *dimension) {
    int number;
    size_t length = 0;
    if (nc_inq_dimid(file, dimension, &number) == NC_NOERR) nc_inq_dimlen(file, number, &length);
    return length;
}

static enum status read_members(struct reading *reading) {
    if (length_of(reading->file, "member") != (size_t)reading->n_members ||
        length_of(reading->file, "fish") != (size_t)reading->study->school.n_fish) {
        return not_whole(reading->path, NC_EDIMSIZE);
    }
    reading->n_text = length_of(reading->file, "text");
    while (member_file_quantity(reading->n_quantities)) reading->n_quantities++;
    reading->member = calloc((size_t)reading->n_members, sizeof *reading->member);
    reading->buffer =
        calloc((size_t)reading->n_members * (size_t)reading->study->school.n_fish * 2, sizeof *reading->buffer);
    if (!reading->member || !reading->buffer) return no_memory(reading->path);
    for (int m = 0; m < reading->n_members; m++) TRY(read_member(reading, m));
    for (int q = 0; q < reading->n_quantities; q++) read_quantity(reading, q);
    return STATUS_OK;
}

enum status study_file_read(const char *path, struct case_values *study, struct member_file **members) {
    struct reading reading = {.path = path, .study = study};
    const int code = nc_open(path, NC_NOWRITE, &reading.file);
    if (code != NC_NOERR) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, nc_strerror(code));
    enum status status = read_study(path, reading.file, study);
    if (status == STATUS_OK) {
        reading.n_members = sweep_n_members(study);
        status = read_members(&reading);
        free(reading.buffer);
        if (status != STATUS_OK) {
            for (int m = 0; reading.member && m < reading.n_members; m++) member_file_free(&reading.member[m]);
            free(reading.member);
            case_free(study);
        }
    }
    nc_close(reading.file);
    if (status == STATUS_OK) *members = reading.member;
    return status;
}
