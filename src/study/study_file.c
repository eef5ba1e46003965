/* study_file.c: writing and reading study.nc. */
#include "study/study_file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "case/sweep.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "study/study_comparison.h"

enum { NAME_BYTES = 256 };

/* The variables of study.nc that precede the swept keys and the quantities. */
enum { MEMBER, STATUS, WARNINGS, FISH_NAME, N_OWN };
static const struct own {
    const char *name, *dimension, *meaning;
} own[N_OWN] = {
    {"member", "member", "number of the member"},
    {"status", "member", "status of the member at the end"},
    {"warnings", "member", "warnings about the result of the member, one per line"},
    {"fish_name", "fish", "name of the fish"},
};

/* An open study.nc. */
struct writing {
    struct netcdf_writer writer;
    const struct case_values *study;
    const struct member_file *member;
    const struct study_orders *orders;
    const struct error_study *errors; /* NULL: none */
    int n_members, n_fish;
    size_t n_text; /* length of the dimension text */
    int member_dimension, fish_dimension, xy_dimension, text_dimension;
    double *buffer; /* one quantity of all members */
    char *text;     /* one string, of n_text bytes */
};

/* The name of the variable of a swept key: "fish[*].body.modulus" becomes fish_body_modulus. */
static void variable_name(const char *path, char name[NAME_BYTES]) {
    int n = 0;
    for (; *path && n < NAME_BYTES - 1; path++) {
        if (*path == '[' || *path == ']' || *path == '*') continue;
        name[n++] = *path;
        if (*path == '.') name[n - 1] = '_';
    }
    name[n] = '\0';
}

/* The value of a key in member m. */
static const char *set_text(const struct writing *writing, int m, int axis, int key) {
    const struct sweep_axis *const swept = &writing->study->sweep[axis];
    return swept->value[sweep_member_value(writing->study, m, axis) * swept->n_keys + key];
}

/* The length of the longest string in the file. */
static size_t longest_text(const struct writing *writing) {
    const struct case_values *const study = writing->study;
    size_t max = ERROR_BUDGET_BYTES;  // the reason of a flag

    for (int m = 0; m < writing->n_members; m++) {
        const struct member_file *const member = &writing->member[m];
        const size_t of_status = strlen(member->status), of_warnings = member->warnings ? strlen(member->warnings) : 0;
        if (of_status > max) max = of_status;
        if (of_warnings > max) max = of_warnings;
        for (int a = 0; a < study->n_axes; a++) {
            for (int k = 0; k < study->sweep[a].n_keys; k++) {
                const size_t of_key = strlen(set_text(writing, m, a, k));
                if (of_key > max) max = of_key;
            }
        }
    }

    for (int f = 0; f < writing->n_fish; f++) {
        if (strlen(study->school.fish[f].name) > max) max = strlen(study->school.fish[f].name);
    }

    return max;
}

// ---- definition

/* Define a variable of strings (n, text) or of numbers (n); returns the number of the variable. */
static int study_file_define_variable(struct writing *writing, const char *name, enum netcdf_type type,
                                      int first_dimension, const char *long_name, const char *units) {
    const struct netcdf_variable variable = {.name = name,
                                             .long_name = long_name,
                                             .units = units,
                                             .type = type,
                                             .n_dimensions = type == NETCDF_TEXT ? 2 : 1,
                                             .dimension = {first_dimension, writing->text_dimension}};
    return netcdf_define_variable(&writing->writer, &variable);
}

/* Whether study.nc contains a quantity. */
static bool has_quantity(const struct case_values *study, const struct member_file_quantity *quantity) {
    if (quantity->of_steady) return sweep_is_steady(study);
    return !quantity->of_comparison || study_comparison_is(study);
}

static void study_file_define_all(struct writing *writing) {
    struct netcdf_writer *const writer = &writing->writer;
    const struct case_values *const study = writing->study;
    writing->member_dimension = netcdf_define_dimension(writer, "member", (size_t)writing->n_members);
    writing->fish_dimension = netcdf_define_dimension(writer, "fish", (size_t)writing->n_fish);
    writing->xy_dimension = netcdf_define_dimension(writer, "xy", 2);
    writing->text_dimension = netcdf_define_dimension(writer, "text", writing->n_text);
    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_study", STUDY_FILE_SCHEMA);
    netcdf_write_string(writer, NETCDF_GLOBAL, "study_case", study->merged);

    for (int i = 0; i < N_OWN; i++) {
        study_file_define_variable(writing, own[i].name, i == MEMBER ? NETCDF_INT : NETCDF_TEXT,
                                   i == FISH_NAME ? writing->fish_dimension : writing->member_dimension, own[i].meaning,
                                   "1");
    }

    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            const struct sweep_key *const key = &study->sweep[a].key[k];
            char name[NAME_BYTES];
            variable_name(key->path, name);
            const int number = study_file_define_variable(writing, name, key->is_number ? NETCDF_DOUBLE : NETCDF_TEXT,
                                                          writing->member_dimension, key->path, key->unit);
            netcdf_write_integer(writer, number, "axis", a);
            if (k == 0 && study->sweep[a].refine) netcdf_write_integer(writer, number, "refine", 1);
        }
    }

    for (int q = 0; member_file_quantity(q); q++) {
        const struct member_file_quantity *const quantity = member_file_quantity(q);
        if (!has_quantity(study, quantity)) continue;
        struct netcdf_variable variable = {.name = quantity->name,
                                           .long_name = quantity->long_name,
                                           .units = quantity->unit,
                                           .type = NETCDF_DOUBLE,
                                           .n_dimensions = 1,
                                           .dimension = {writing->member_dimension},
                                           .has_gaps = true};
        if (quantity->of_fish) variable.dimension[variable.n_dimensions++] = writing->fish_dimension;
        if (quantity->of_xy) variable.dimension[variable.n_dimensions++] = writing->xy_dimension;
        netcdf_define_variable(writer, &variable);
    }

    const int of_orders[] = {writing->fish_dimension, writing->xy_dimension, writing->text_dimension};
    study_orders_define(writer, study, writing->orders, of_orders);
    const int of_errors[] = {writing->fish_dimension, writing->text_dimension};
    if (writing->errors) error_report_define(writer, writing->errors, of_errors);
    netcdf_end_definitions(writer);
}

// ---- writing

static void write_text(struct writing *writing, const char *name, int row, const char *text) {
    memset(writing->text, 0, writing->n_text);
    memcpy(writing->text, text, strlen(text));
    netcdf_write_text(&writing->writer, netcdf_number(&writing->writer, name), (size_t[]){(size_t)row, 0},
                      (size_t[]){1, writing->n_text}, writing->text);
}

/* Write the buffer to a whole variable. */
static void write_buffer(struct writing *writing, const char *name) {
    netcdf_write_doubles(&writing->writer, netcdf_number(&writing->writer, name), NULL, NULL, writing->buffer);
}

static void write_quantity(struct writing *writing, int q) {
    const struct member_file_quantity *const quantity = member_file_quantity(q);
    double *to = writing->buffer;
    for (int m = 0; m < writing->n_members; m++) {
        for (int f = 0; f < (quantity->of_fish ? writing->n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) *to++ = member_file_value(&writing->member[m], q, f, k);
        }
    }
    write_buffer(writing, quantity->name);
}

static void study_file_write_key(struct writing *writing, int a, int k) {
    const struct sweep_key *const key = &writing->study->sweep[a].key[k];
    char name[NAME_BYTES];
    variable_name(key->path, name);
    for (int m = 0; m < writing->n_members; m++) {
        if (!key->is_number) write_text(writing, name, m, set_text(writing, m, a, k));
        if (!text_number(set_text(writing, m, a, k), &writing->buffer[m])) writing->buffer[m] = NAN;
    }
    if (key->is_number) write_buffer(writing, name);
}

static void study_file_write_all(struct writing *writing) {
    const struct case_values *const study = writing->study;
    for (int m = 0; m < writing->n_members; m++) {
        netcdf_write_ints(&writing->writer, netcdf_number(&writing->writer, own[MEMBER].name), (size_t[]){(size_t)m},
                          (size_t[]){1}, &m);
        write_text(writing, own[STATUS].name, m, writing->member[m].status);
        write_text(writing, own[WARNINGS].name, m, writing->member[m].warnings ? writing->member[m].warnings : "");
    }

    for (int f = 0; f < writing->n_fish; f++) write_text(writing, own[FISH_NAME].name, f, study->school.fish[f].name);
    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++) study_file_write_key(writing, a, k);
    }

    for (int q = 0; member_file_quantity(q); q++) {
        if (has_quantity(study, member_file_quantity(q))) write_quantity(writing, q);
    }

    study_orders_write(&writing->writer, study, writing->orders, writing->n_text, writing->text);
    if (writing->errors) error_report_write(&writing->writer, writing->errors, writing->n_text, writing->text);
}

enum status study_file_write(struct arena *arena, const char *path, const struct case_values *study,
                             const struct member_file *member, const struct study_orders *orders,
                             const struct error_study *errors, const char *command) {
    struct writing writing = {.study = study,
                              .member = member,
                              .orders = orders,
                              .errors = errors,
                              .n_members = sweep_n_members(study),
                              .n_fish = study->school.n_fish};

    writing.n_text = longest_text(&writing);
    NEW(arena, writing.buffer, writing.n_members * writing.n_fish * 2);
    NEW(arena, writing.text, writing.n_text);

    // write a temporary file, then rename the file to path; no memory of the arena is requested while the file is open
    TRY(target_check(path, TARGET_NETCDF, true));
    TRY(netcdf_create(&writing.writer, path, study->name, command));
    study_file_define_all(&writing);
    study_file_write_all(&writing);
    const enum status published = netcdf_publish(&writing.writer, true);
    const enum status finished = netcdf_finish(&writing.writer);
    return published == STATUS_OK ? finished : published;
}

// ---- the list of variables

int study_file_listed(int i, struct result_listed *listed) {
    *listed = (struct result_listed){.unit = "1", .type = "int"};
    if (i < N_OWN) {
        listed->name = own[i].name;
        if (i != MEMBER) listed->type = "char", listed->unit = "";
        listed->meaning = own[i].meaning;
        snprintf(listed->dimensions, sizeof listed->dimensions, "%s%s", own[i].dimension, i == MEMBER ? "" : ", text");
        return 1;
    }

    int k = i - N_OWN;
    for (int q = 0; member_file_quantity(q); q++) {
        const struct member_file_quantity *const quantity = member_file_quantity(q);
        if (!quantity->is_computed || k-- > 0) continue;
        *listed = (struct result_listed){
            .name = quantity->name, .unit = quantity->unit, .type = "double", .meaning = quantity->long_name};
        snprintf(listed->dimensions, sizeof listed->dimensions, "member%s%s", quantity->of_fish ? ", fish" : "",
                 quantity->of_xy ? ", xy" : "");
        return 1;
    }

    int n_orders = 0;
    for (struct result_listed other; study_orders_listed(n_orders, &other);) n_orders++;
    return k < n_orders ? study_orders_listed(k, listed) : error_report_listed(k - n_orders, listed);
}

// ---- reading

enum { MAX_MEMBERS = 100000 };

/* An open study.nc. */
struct reading {
    struct netcdf_reader reader;
    const struct case_values *study;
    struct member_file *member;
    size_t n_members, n_text; /* lengths of dimensions */
    double *buffer;           /* one quantity of all members */
};

/* Read one quantity of all members; quantities of comparisons exist in comparisons only. */
static enum status study_file_read_quantity(const struct reading *reading, int q) {
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
static enum status study_file_read_string(const struct reading *reading, const char *name, size_t m, char **string) {
    TRY(MEMORY_NEW(*string, reading->n_text + 1, "study.nc"));
    const struct netcdf_slice slice[] = {{"member", m, 1}, {"text", 0, reading->n_text}, {NULL}};
    return netcdf_read_text(&reading->reader, name, slice, *string);
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
    TRY(MEMORY_NEW(reading->member, reading->n_members, "the members of study.nc"));
    TRY(MEMORY_NEW(reading->buffer, reading->n_members * n_fish * 2, "the members of study.nc"));

    for (size_t m = 0; m < reading->n_members; m++) {
        struct member_file *const member = &reading->member[m];
        member->number = (int)m;
        TRY(member_file_create_values(member, reading->study->school.n_fish));
        TRY(study_file_read_string(reading, "status", m, &member->status));
        TRY(study_file_read_string(reading, "warnings", m, &member->warnings));
    }
    for (int q = 0; member_file_quantity(q); q++) TRY(study_file_read_quantity(reading, q));

    return STATUS_OK;
}

enum status study_file_read(const char *path, struct case_values *study, struct member_file **members, int *n_members) {
    struct reading reading = {.study = study};
    char *text = NULL;
    TRY(netcdf_open(&reading.reader, path));
    enum status status = netcdf_read_string(&reading.reader, "study_case", &text);
    if (status == STATUS_OK) status = case_parse(study, text, strlen(text), path, NULL, 0, NULL);
    free(text);

    if (status == STATUS_OK) {
        reading.n_members = (size_t)sweep_n_members(study);
        status = read_members(&reading);
        free(reading.buffer);
        for (size_t m = 0; status != STATUS_OK && reading.member && m < reading.n_members; m++) {
            member_file_free(&reading.member[m]);
        }
        if (status != STATUS_OK) free(reading.member);
        if (status != STATUS_OK) case_free(study);
    }

    netcdf_close(&reading.reader);
    if (status == STATUS_OK) {
        *members = reading.member;
        *n_members = (int)reading.n_members;
    }
    if (status == STATUS_OK || status == STATUS_MEMORY) return status;
    return status_fail(STATUS_FILE, "%s; write study.nc again with `shoal gather`", status_message());
}
