/* study_file.c: writing study.nc. */
#include "study/study_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "study/study_comparison.h"

enum { MIN_TEXT = 128 /* bytes of the flag of an order */, NAME_BYTES = 256 };

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

static const char *warnings_of(const struct writing *writing, int m) {
    return writing->member[m].warnings ? writing->member[m].warnings : "";
}

/* The length of the longest string in the file. */
static size_t longest_text(const struct writing *writing) {
    size_t max = writing->errors ? ERROR_STUDY_BYTES : MIN_TEXT;
    const struct case_values *const study = writing->study;
    for (int m = 0; m < writing->n_members; m++) {
        if (strlen(writing->member[m].status) > max) max = strlen(writing->member[m].status);
        if (strlen(warnings_of(writing, m)) > max) max = strlen(warnings_of(writing, m));
    }

    for (int a = 0; a < study->n_axes; a++) {
        for (int i = 0; i < study->sweep[a].n_values * study->sweep[a].n_keys; i++) {
            if (strlen(study->sweep[a].value[i]) > max) max = strlen(study->sweep[a].value[i]);
        }
    }

    for (int f = 0; f < writing->n_fish; f++) {
        if (strlen(study->school.fish[f].name) > max) max = strlen(study->school.fish[f].name);
    }

    return max;
}

// ---- definition

/* Define a variable of strings (n, text) or of numbers (n); returns the number of the variable. */
static int define_variable(struct writing *writing, const char *name, enum netcdf_type type, int first_dimension,
                           const char *long_name, const char *units) {
    const struct netcdf_variable variable = {.name = name,
                                             .long_name = long_name,
                                             .units = units,
                                             .type = type,
                                             .n_dimensions = type == NETCDF_TEXT ? 2 : 1,
                                             .dimension = {first_dimension, writing->text_dimension}};
    return netcdf_define_variable(&writing->writer, &variable);
}

static void define_quantity(struct writing *writing, const struct member_file_quantity *quantity) {
    struct netcdf_variable variable = {.name = quantity->name,
                                       .long_name = quantity->long_name,
                                       .units = quantity->unit,
                                       .type = NETCDF_DOUBLE,
                                       .n_dimensions = 1,
                                       .dimension = {writing->member_dimension},
                                       .has_gaps = true};
    if (quantity->of_fish) variable.dimension[variable.n_dimensions++] = writing->fish_dimension;
    if (quantity->of_xy) variable.dimension[variable.n_dimensions++] = writing->xy_dimension;
    netcdf_define_variable(&writing->writer, &variable);
}

/* Whether study.nc contains a quantity. */
static bool has_quantity(const struct case_values *study, const struct member_file_quantity *quantity) {
    if (quantity->of_steady) return sweep_is_steady(study);
    return !quantity->of_comparison || study_comparison_is(study);
}

static void define_key(struct writing *writing, int a, int k) {
    const struct sweep_axis *const axis = &writing->study->sweep[a];
    char name[NAME_BYTES];
    variable_name(axis->key[k].path, name);
    const int number = define_variable(writing, name, axis->key[k].is_number ? NETCDF_DOUBLE : NETCDF_TEXT,
                                       writing->member_dimension, axis->key[k].path, axis->key[k].unit);
    netcdf_write_integer(&writing->writer, number, "axis", a);
    if (k == 0 && axis->refine) netcdf_write_integer(&writing->writer, number, "refine", 1);
}

static void define_all(struct writing *writing) {
    struct netcdf_writer *const writer = &writing->writer;
    const struct case_values *const study = writing->study;
    writing->member_dimension = netcdf_define_dimension(writer, "member", (size_t)writing->n_members);
    writing->fish_dimension = netcdf_define_dimension(writer, "fish", (size_t)writing->n_fish);
    writing->xy_dimension = netcdf_define_dimension(writer, "xy", 2);
    writing->text_dimension = netcdf_define_dimension(writer, "text", writing->n_text);
    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_study", STUDY_FILE_SCHEMA);
    netcdf_write_string(writer, NETCDF_GLOBAL, "study_case", study->merged);

    for (int i = 0; i < N_OWN; i++) {
        define_variable(writing, own[i].name, i == MEMBER ? NETCDF_INT : NETCDF_TEXT,
                        i == FISH_NAME ? writing->fish_dimension : writing->member_dimension, own[i].meaning, "1");
    }

    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++) define_key(writing, a, k);
    }

    for (int q = 0; member_file_quantity(q); q++) {
        if (has_quantity(study, member_file_quantity(q))) define_quantity(writing, member_file_quantity(q));
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

static void write_key(struct writing *writing, int a, int k) {
    const struct sweep_key *const key = &writing->study->sweep[a].key[k];
    char name[NAME_BYTES];
    variable_name(key->path, name);
    for (int m = 0; m < writing->n_members; m++) {
        if (!key->is_number) write_text(writing, name, m, set_text(writing, m, a, k));
        if (!text_number(set_text(writing, m, a, k), &writing->buffer[m])) writing->buffer[m] = NAN;
    }
    if (key->is_number) write_buffer(writing, name);
}

static void write_all(struct writing *writing) {
    const struct case_values *const study = writing->study;
    for (int m = 0; m < writing->n_members; m++) {
        netcdf_write_ints(&writing->writer, netcdf_number(&writing->writer, own[MEMBER].name), (size_t[]){(size_t)m},
                          (size_t[]){1}, &m);
        write_text(writing, own[STATUS].name, m, writing->member[m].status);
        write_text(writing, own[WARNINGS].name, m, warnings_of(writing, m));
    }

    for (int f = 0; f < writing->n_fish; f++) write_text(writing, own[FISH_NAME].name, f, study->school.fish[f].name);
    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++) write_key(writing, a, k);
    }

    for (int q = 0; member_file_quantity(q); q++) {
        if (has_quantity(study, member_file_quantity(q))) write_quantity(writing, q);
    }

    study_orders_write(&writing->writer, study, writing->orders, writing->n_text, writing->text);
    if (writing->errors) error_report_write(&writing->writer, writing->errors, writing->n_text, writing->text);
}

/* Write a temporary file, then rename the file to path. */
static enum status write_file(struct writing *writing, const char *path, const char *command) {
    TRY(target_check(path, TARGET_NETCDF, true));
    TRY(netcdf_create(&writing->writer, path, writing->study->name, command));
    define_all(writing);
    write_all(writing);
    const enum status status = netcdf_publish(&writing->writer, true);
    const enum status finished = netcdf_finish(&writing->writer);
    return status == STATUS_OK ? finished : status;
}

enum status study_file_write(const char *path, const struct case_values *study, const struct member_file *member,
                             const struct study_orders *orders, const struct error_study *errors, const char *command) {
    struct writing writing = {.study = study,
                              .member = member,
                              .orders = orders,
                              .errors = errors,
                              .n_members = sweep_n_members(study),
                              .n_fish = study->school.n_fish};

    writing.n_text = longest_text(&writing);
    writing.buffer = calloc((size_t)writing.n_members * (size_t)writing.n_fish * 2, sizeof *writing.buffer);
    writing.text = calloc(writing.n_text, 1);
    const enum status status = writing.buffer && writing.text
                                   ? write_file(&writing, path, command)
                                   : status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
    free(writing.buffer);
    free(writing.text);

    return status;
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
