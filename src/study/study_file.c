/* study_file.c: writing study.nc. */
#include "study/study_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "output/netcdf.h"
#include "output/result_table.h"

enum { SHORTEST_TEXT = 64 /* an objection to an order */, NAME_BYTES = 256 };

/* The variables of its own; those of the swept keys and the quantities follow. */
enum { MEMBER, STATUS, FISH_NAME, N_OWN };
static const struct own {
    const char *name, *dimension, *meaning;
} own[N_OWN] = {
    {"member", "member", "number of the member"},
    {"status", "member", "how the member ended"},
    {"fish_name", "fish", "name of the fish"},
};

/* A study.nc on its way. */
struct writing {
    int file;
    const struct case_values *study;
    const struct member_file *member;
    const struct study_file_orders *orders;
    int n_members, n_fish;
    size_t n_text; /* length of the dimension text */
    int member_dimension, fish_dimension, xy_dimension, text_dimension;
    double *buffer; /* one quantity of all members */
    char *text;     /* one text */
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

/* The text that member m sets a key to. */
static const char *set_text(const struct writing *writing, int m, int axis, int key) {
    const struct sweep_axis *const swept = &writing->study->sweep[axis];
    return swept->value[sweep_member_value(writing->study, m, axis) * swept->n_keys + key];
}

/* The longest text that the file has to hold. */
static size_t longest_text(const struct writing *writing) {
    size_t most = SHORTEST_TEXT;
    const struct case_values *const study = writing->study;
    for (int m = 0; m < writing->n_members; m++) {
        if (strlen(writing->member[m].status) > most) most = strlen(writing->member[m].status);
    }
    for (int a = 0; a < study->n_axes; a++) {
        for (int i = 0; i < study->sweep[a].n_values * study->sweep[a].n_keys; i++) {
            if (strlen(study->sweep[a].value[i]) > most) most = strlen(study->sweep[a].value[i]);
        }
    }
    for (int f = 0; f < writing->n_fish; f++) {
        if (strlen(study->school.fish[f].name) > most) most = strlen(study->school.fish[f].name);
    }
    return most;
}

static int define_attributes(const struct writing *writing, const char *command) {
    const int schema = RESULT_STUDY_SCHEMA, file = writing->file;
    NETCDF(netcdf_origin(file, writing->study->name, command));
    NETCDF(nc_put_att_int(file, NC_GLOBAL, "shoal_study", NC_INT, 1, &schema));
    return netcdf_text(file, NC_GLOBAL, "study_case", writing->study->merged);
}

/* One variable of texts (n, text), or of numbers over the members. */
static int define(const struct writing *writing, const char *name, nc_type type, int first_dimension,
                  const char *long_name, const char *unit, int *variable) {
    const int dimensions[] = {first_dimension, writing->text_dimension};
    NETCDF(nc_def_var(writing->file, name, type, type == NC_CHAR ? 2 : 1, dimensions, variable));
    NETCDF(netcdf_text(writing->file, *variable, "long_name", long_name));
    if (type == NC_CHAR) return netcdf_text(writing->file, *variable, "_Encoding", "utf-8");
    return netcdf_text(writing->file, *variable, "units", *unit ? unit : "1");
}

static int define_quantity(const struct writing *writing, const struct member_file_quantity *quantity) {
    int dimensions[3] = {writing->member_dimension}, n = 1, variable;
    if (quantity->of_fish) dimensions[n++] = writing->fish_dimension;
    if (quantity->of_xy) dimensions[n++] = writing->xy_dimension;
    const double fill = NAN;
    NETCDF(nc_def_var(writing->file, quantity->name, NC_DOUBLE, n, dimensions, &variable));
    NETCDF(netcdf_text(writing->file, variable, "long_name", quantity->long_name));
    NETCDF(netcdf_text(writing->file, variable, "units", quantity->unit));
    return nc_put_att_double(writing->file, variable, _FillValue, NC_DOUBLE, 1, &fill);
}

static int define_key(const struct writing *writing, int a, int k) {
    const struct sweep_axis *const axis = &writing->study->sweep[a];
    char name[NAME_BYTES];
    int variable;
    variable_name(axis->key[k].path, name);
    NETCDF(define(writing, name, axis->key[k].is_number ? NC_DOUBLE : NC_CHAR, writing->member_dimension,
                  axis->key[k].path, axis->key[k].unit, &variable));
    NETCDF(nc_put_att_int(writing->file, variable, "axis", NC_INT, 1, &a));
    if (k > 0 || !axis->refine) return NC_NOERR;
    const int yes = 1;
    return nc_put_att_int(writing->file, variable, "refine", NC_INT, 1, &yes);
}

static int define_all(struct writing *writing, const char *command) {
    const int file = writing->file;
    int variable;
    NETCDF(nc_def_dim(file, "member", (size_t)writing->n_members, &writing->member_dimension));
    NETCDF(nc_def_dim(file, "fish", (size_t)writing->n_fish, &writing->fish_dimension));
    NETCDF(nc_def_dim(file, "xy", 2, &writing->xy_dimension));
    NETCDF(nc_def_dim(file, "text", writing->n_text, &writing->text_dimension));
    NETCDF(define_attributes(writing, command));
    for (int i = 0; i < N_OWN; i++) {
        NETCDF(define(writing, own[i].name, i == MEMBER ? NC_INT : NC_CHAR,
                      i == FISH_NAME ? writing->fish_dimension : writing->member_dimension, own[i].meaning, "1",
                      &variable));
    }
    for (int a = 0; a < writing->study->n_axes; a++) {
        for (int k = 0; k < writing->study->sweep[a].n_keys; k++) NETCDF(define_key(writing, a, k));
    }
    for (int q = 0; member_file_quantity(q); q++) NETCDF(define_quantity(writing, member_file_quantity(q)));
    const int of_orders[] = {writing->fish_dimension, writing->xy_dimension, writing->text_dimension};
    NETCDF(study_file_orders_define(file, writing->study, writing->orders, of_orders));
    return nc_enddef(file);
}

static int variable_number(const struct writing *writing, const char *name) {
    int number = -1;
    nc_inq_varid(writing->file, name, &number);
    return number;
}

static int write_text(const struct writing *writing, const char *name, int row, const char *text) {
    memset(writing->text, 0, writing->n_text);
    memcpy(writing->text, text, strlen(text));
    return nc_put_vara_text(writing->file, variable_number(writing, name), (size_t[]){(size_t)row, 0},
                            (size_t[]){1, writing->n_text}, writing->text);
}

static int write_quantity(const struct writing *writing, int q) {
    const struct member_file_quantity *const quantity = member_file_quantity(q);
    double *to = writing->buffer;
    for (int m = 0; m < writing->n_members; m++) {
        for (int f = 0; f < (quantity->of_fish ? writing->n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) *to++ = member_file_value(&writing->member[m], q, f, k);
        }
    }
    return nc_put_var_double(writing->file, variable_number(writing, quantity->name), writing->buffer);
}

static int write_key(const struct writing *writing, int a, int k) {
    const struct sweep_key *const key = &writing->study->sweep[a].key[k];
    char name[NAME_BYTES];
    variable_name(key->path, name);
    for (int m = 0; m < writing->n_members; m++) {
        if (!key->is_number) NETCDF(write_text(writing, name, m, set_text(writing, m, a, k)));
        if (!text_number(set_text(writing, m, a, k), &writing->buffer[m])) writing->buffer[m] = NAN;
    }
    return key->is_number ? nc_put_var_double(writing->file, variable_number(writing, name), writing->buffer)
                          : NC_NOERR;
}

static int write_all(struct writing *writing, const char *command) {
    NETCDF(define_all(writing, command));
    for (int m = 0; m < writing->n_members; m++) {
        NETCDF(nc_put_var1_int(writing->file, variable_number(writing, own[MEMBER].name), (size_t[]){(size_t)m}, &m));
        NETCDF(write_text(writing, own[STATUS].name, m, writing->member[m].status));
    }
    for (int f = 0; f < writing->n_fish; f++) {
        NETCDF(write_text(writing, own[FISH_NAME].name, f, writing->study->school.fish[f].name));
    }
    for (int a = 0; a < writing->study->n_axes; a++) {
        for (int k = 0; k < writing->study->sweep[a].n_keys; k++) NETCDF(write_key(writing, a, k));
    }
    for (int q = 0; member_file_quantity(q); q++) NETCDF(write_quantity(writing, q));
    return study_file_orders_write(writing->file, writing->study, writing->orders, writing->n_text);
}

/* Write under a temporary name, and give it its own. */
static enum status write_file(struct writing *writing, const char *path, const char *temporary, const char *command) {
    int code = nc_create(temporary, NC_CLOBBER | NC_64BIT_DATA, &writing->file);
    if (code == NC_NOERR) {
        code = write_all(writing, command);
        const int closed = nc_close(writing->file);
        if (code == NC_NOERR) code = closed;
    }
    if (code == NC_NOERR && rename(temporary, path) == 0) return STATUS_OK;
    unlink(temporary);
    return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room and run `shoal gather` on its folder", path,
                       code == NC_NOERR ? "no renaming there" : nc_strerror(code));
}

enum status study_file_write(const char *path, const struct case_values *study, const struct member_file *member,
                             const struct study_file_orders *orders, const char *command) {
    struct writing writing = {.study = study,
                              .member = member,
                              .orders = orders,
                              .n_members = sweep_n_members(study),
                              .n_fish = study->school.n_fish};
    writing.n_text = longest_text(&writing);
    writing.buffer = calloc((size_t)writing.n_members * (size_t)writing.n_fish * 2, sizeof *writing.buffer);
    writing.text = calloc(writing.n_text, 1);
    const size_t size = strlen(path) + 8;
    char *const temporary = calloc(size, 1);
    enum status status = STATUS_MEMORY;
    if (writing.buffer && writing.text && temporary) {
        snprintf(temporary, size, "%s.part", path);
        status = write_file(&writing, path, temporary, command);
    } else {
        status_fail(STATUS_MEMORY, "out of memory: %s", path);
    }
    free(writing.buffer);
    free(writing.text);
    free(temporary);
    return status;
}

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
        snprintf(listed->dimensions, sizeof listed->dimensions, "member, fish%s", quantity->of_xy ? ", xy" : "");
        return 1;
    }
    return study_file_orders_listed(k, listed);
}
