/* study_file_read.c: reading study.nc. Declared in study_file.h. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "case/sweep.h"
#include "result/netcdf.h"
#include "study/study_file.h"

enum { MAX_MEMBERS = 100000 };

/* An open study.nc. */
struct reading {
    struct netcdf_reader reader;
    const struct case_values *study;
    struct member_file *member;
    size_t n_members, n_text; /* lengths of dimensions */
    double *buffer;           /* one quantity of all members */
};

static enum status out_of_memory(const char *path) {
    return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
}

/* Parse the case of the study. */
static enum status read_study(const struct netcdf_reader *reader, struct case_values *study) {
    char *text;
    TRY(netcdf_read_string(reader, "study_case", &text));
    const enum status status = case_parse(study, text, strlen(text), reader->path, NULL, 0, NULL);
    free(text);
    return status;
}

/* Read one quantity of all members; files of earlier versions may lack the quantity. */
static enum status read_quantity(const struct reading *reading, int q) {
    const struct member_file_quantity *const quantity = member_file_quantity(q);
    if (!netcdf_has(&reading->reader, quantity->name)) return STATUS_OK;
    const int n_fish = reading->study->school.n_fish;
    const struct netcdf_slice slice[] = {{"member", 0, reading->n_members},
                                         {quantity->of_fish ? "fish" : NULL, 0, (size_t)n_fish},
                                         {quantity->of_xy ? "xy" : NULL, 0, 2},
                                         {NULL}};
    TRY(netcdf_read_doubles(&reading->reader, quantity->name, slice, reading->buffer));
    const double *from = reading->buffer;
    for (size_t m = 0; m < reading->n_members; m++) {
        for (int f = 0; f < (quantity->of_fish ? n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) {
                *member_file_place(&reading->member[m], q, f, k) = *from++;
            }
        }
    }

    return STATUS_OK;
}

/* Read a string of a member; the caller frees the string. */
static enum status read_string(const struct reading *reading, const char *name, size_t m, char **string) {
    *string = calloc(reading->n_text + 1, 1);
    if (!*string) return out_of_memory(reading->reader.path);
    const struct netcdf_slice slice[] = {{"member", m, 1}, {"text", 0, reading->n_text}, {NULL}};
    return netcdf_read_text(&reading->reader, name, slice, *string);
}

/* Allocate a member and read status and warnings; files of earlier versions have no warnings. */
static enum status read_member(const struct reading *reading, size_t m) {
    struct member_file *const member = &reading->member[m];
    member->number = (int)m;
    TRY(member_file_create_values(member, reading->study->school.n_fish));
    TRY(read_string(reading, "status", m, &member->status));
    if (!netcdf_has(&reading->reader, "warnings")) return STATUS_OK;
    return read_string(reading, "warnings", m, &member->warnings);
}

static enum status read_members(struct reading *reading) {
    const size_t n_fish = (size_t)reading->study->school.n_fish;
    const struct netcdf_reader *const reader = &reading->reader;
    size_t length;

    if (reading->study->error) {
        // an error study with refinement has a variable number of members
        TRY(netcdf_read_length(reader, "member", 1, MAX_MEMBERS, &reading->n_members));
    } else {
        TRY(netcdf_read_length(reader, "member", reading->n_members, reading->n_members, &length));
    }

    TRY(netcdf_read_length(reader, "fish", n_fish, n_fish, &length));
    TRY(netcdf_read_length(reader, "text", 1, INT_MAX, &reading->n_text));
    reading->member = calloc(reading->n_members, sizeof *reading->member);
    reading->buffer = calloc(reading->n_members * n_fish * 2, sizeof *reading->buffer);
    if (!reading->member || !reading->buffer) return out_of_memory(reader->path);
    for (size_t m = 0; m < reading->n_members; m++) TRY(read_member(reading, m));
    for (int q = 0; member_file_quantity(q); q++) TRY(read_quantity(reading, q));

    return STATUS_OK;
}

static enum status read_all(struct reading *reading, struct case_values *study) {
    TRY(read_study(&reading->reader, study));
    reading->n_members = (size_t)sweep_n_members(study);
    const enum status status = read_members(reading);
    free(reading->buffer);
    if (status == STATUS_OK) return STATUS_OK;
    for (size_t m = 0; reading->member && m < reading->n_members; m++) member_file_free(&reading->member[m]);
    free(reading->member);
    case_free(study);
    return status;
}

enum status study_file_read(const char *path, struct case_values *study, struct member_file **members, int *n_members) {
    struct reading reading = {.study = study};
    TRY(netcdf_open(&reading.reader, path));
    const enum status status = read_all(&reading, study);
    netcdf_close(&reading.reader);
    if (status == STATUS_OK) {
        *members = reading.member;
        *n_members = (int)reading.n_members;
    }
    if (status == STATUS_OK || status == STATUS_MEMORY) return status;
    return status_fail(STATUS_FILE, "%s; write study.nc again with `shoal gather`", status_message());
}
