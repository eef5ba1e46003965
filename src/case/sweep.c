/* sweep.c: the axes of a study.
 *
 *     - {key: solver.rtol, values: [1e-4, 1e-5]}                                       one key
 *     - {keys: [fish[*].nodes, fish[*].sheet_points], values: [[7, 21], [13, 41]]}     two that change together
 *     - {key: ..., values: ..., refine: true}                                          resolutions: sweep_refine.c
 *
 * Each value is checked as a value of the key, and stored as a string for --set. */
#include "case/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case_path.h"
#include "case/case_value.h"
#include "case/sweep_members.h"
#include "case/sweep_refine.h"
#include "case/yaml_write.h"

static const double max_members = 1e5;

enum { MAX_KEYS = 16 /* of one axis */ };

static enum status sweep_out_of_memory(void) {
    return status_fail(STATUS_MEMORY, "out of memory: the sweep");
}

/* An axis being read. */
struct axis {
    char name[32]; /* "sweep[1]" */
    const struct yaml_node *node;
    struct sweep_axis *into;
    bool is_zipped; /* written with "keys" */
    int n_keys;     /* as written; those that are wrong are NULL */
    const struct key *key[MAX_KEYS];
    struct yaml_errors *errors;
};

void sweep_free(struct case_values *values) {
    for (int i = 0; i < values->n_axes; i++) {
        struct sweep_axis *const axis = &values->sweep[i];
        for (int j = 0; j < axis->n_values * axis->n_keys; j++) free(axis->value[j]);
        for (int j = 0; j < axis->n_keys; j++) free(axis->key[j].path);
        free(axis->value);
        free(axis->key);
        free(axis->reference);
        free(axis->before);
    }

    free(values->sweep);
    values->sweep = NULL;
    values->n_axes = 0;
}

// ---- keys

/* Complain if an earlier key of the sweep is the same. */
static void check_twice(const struct case_values *values, const struct axis *axis, const struct yaml_node *node) {
    for (int i = 0; i <= values->n_axes; i++) {
        const struct sweep_axis *const other = &values->sweep[i];
        for (int k = 0; k < other->n_keys; k++) {
            if (!other->key[k].path || strcmp(other->key[k].path, node->text) != 0) continue;
            yaml_errors_add(axis->errors, node->mark, "%s.key: sweep[%d] has this key too", axis->name, i);
        }
    }
}

/* Find the row of the table that a key of an axis changes; NULL after an error. */
static const struct key *find_key(const struct case_values *values, const struct axis *axis,
                                  const struct yaml_node *node) {
    if (!node || node->kind != YAML_SCALAR) {
        yaml_errors_add(axis->errors, node ? node->mark : axis->node->mark,
                        "%s.key: expects the path of a key, as in \"fish[*].body.modulus\"", axis->name);
        return NULL;
    }

    struct case_path path;
    if (!case_path_parse(&path, node->text, values->school.n_fish, node->mark, axis->errors)) return NULL;
    const struct key *const key = case_table_row(path.pattern);
    const bool is_fixed = !key || !case_table_is_value(key);

    if (is_fixed || strcmp(key->path, "format") == 0) {
        yaml_errors_add(axis->errors, node->mark, "%s.key: '%.60s' cannot be swept", axis->name, node->text);
        return NULL;
    }

    check_twice(values, axis, node);
    return key;
}

static enum status read_key(const struct case_values *values, struct axis *axis, const struct yaml_node *node) {
    const struct key *const key = find_key(values, axis, node);
    struct sweep_key *const swept = &axis->into->key[axis->n_keys];
    axis->key[axis->n_keys++] = key;
    axis->into->n_keys++;
    if (!key) return STATUS_OK;
    swept->row = key->path;
    swept->unit = key->unit;
    swept->is_number = key->type == REAL || key->type == INTEGER || key->type == DURATION;
    swept->path = strdup(node->text);
    return swept->path ? STATUS_OK : sweep_out_of_memory();
}

/* Read "key", or "keys". */
static enum status read_axis_keys(const struct case_values *values, struct axis *axis) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "keys");
    axis->is_zipped = list != NULL;

    if (list && (list->kind != YAML_LIST || list->n == 0 || list->n > MAX_KEYS)) {
        yaml_errors_add(axis->errors, list->mark, "%s.keys: expects a list of 1 to %d paths", axis->name, MAX_KEYS);
        return STATUS_OK;
    }

    const struct yaml_node *const single = yaml_tree_find(axis->node, "key");
    if (list && single) {
        yaml_errors_add(axis->errors, single->mark, "%s: takes key or keys, not both", axis->name);
    }
    axis->into->key = calloc(MAX_KEYS, sizeof *axis->into->key);
    if (!axis->into->key) return sweep_out_of_memory();
    if (!list) return read_key(values, axis, single);
    for (int k = 0; k < list->n; k++) TRY(read_key(values, axis, list->entry[k].value));
    return STATUS_OK;
}

// ---- values

/* Check one value as a value of the key, and store the text. */
static enum status read_value(struct axis *axis, int index, int k, const struct yaml_node *value) {
    if (axis->key[k]) {
        union {
            double number[2];
            struct duration duration;
            int integer;
            char *text;
            struct number_list list;
        } field;
        char path[256];
        snprintf(path, sizeof path, "%s.values[%d] (%s)", axis->name, index, axis->key[k]->path);
        case_value_clear(axis->key[k], &field);
        const enum status status = case_value_read(axis->key[k], &field, value, path, axis->errors);
        // beats are kept as a text
        if (axis->key[k]->type == DURATION && !isnan(field.duration.beats)) axis->into->key[k].is_number = 0;
        case_value_free(axis->key[k], &field);
        TRY(status);
    }

    struct text text = {0};
    yaml_write_node(&text, value);

    if (text.failed) {
        text_free(&text);
        return sweep_out_of_memory();
    }

    axis->into->value[index * axis->n_keys + k] = text.text;
    return STATUS_OK;
}

/* Read the values of an axis. */
static enum status read_values(struct axis *axis) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "values");
    if (!list || list->kind != YAML_LIST || list->n == 0) {
        yaml_errors_add(axis->errors, list ? list->mark : axis->node->mark,
                        "%s.values: expects a list of at least one value, as in [1, 2]", axis->name);
        return STATUS_OK;
    }

    axis->into->value = calloc((size_t)list->n * (size_t)axis->n_keys + 1, sizeof *axis->into->value);
    if (!axis->into->value) return sweep_out_of_memory();
    axis->into->n_values = list->n;

    for (int i = 0; i < list->n; i++) {
        const struct yaml_node *const value = list->entry[i].value;
        if (!axis->is_zipped) {
            TRY(read_value(axis, i, 0, value));
            continue;
        }
        if (value->kind != YAML_LIST || value->n != axis->n_keys) {
            yaml_errors_add(axis->errors, value->mark, "%s.values[%d]: expects a list of %d, one value for each key",
                            axis->name, i, axis->n_keys);
            continue;
        }
        for (int k = 0; k < axis->n_keys; k++) TRY(read_value(axis, i, k, value->entry[k].value));
    }

    return STATUS_OK;
}

// ---- the sweep

/* Read "steady". */
static void read_steady(const struct case_values *values, const struct axis *axis) {
    const struct yaml_node *const steady = yaml_tree_find(axis->node, "steady");
    if (!steady) return;
    const bool is_true = steady->kind == YAML_SCALAR && strcmp(steady->text, "true") == 0;
    const bool is_false = steady->kind == YAML_SCALAR && strcmp(steady->text, "false") == 0;
    if (!is_true && !is_false) {
        yaml_errors_add(axis->errors, steady->mark, "%s.steady: expects true or false", axis->name);
    }
    for (int i = 0; i < values->n_axes && is_true; i++) {
        if (!values->sweep[i].steady) continue;
        yaml_errors_add(axis->errors, steady->mark, "%s.steady: sweep[%d] is steady already; one axis can be",
                        axis->name, i);
    }

    axis->into->steady = is_true;
}

/* Read one axis into an entry that is zero. */
static enum status read_axis(const struct case_values *values, struct axis *axis) {
    if (axis->node->kind != YAML_MAP) {
        yaml_errors_add(axis->errors, axis->node->mark, "%s: expects {key: PATH, values: [...]}", axis->name);
        return STATUS_OK;
    }

    yaml_tree_check_keys(axis->node, axis->name, "key, keys, values, refine, expect, reference, steady", axis->errors);
    TRY(read_axis_keys(values, axis));
    if (axis->n_keys == 0) return STATUS_OK;
    TRY(read_values(axis));
    read_steady(values, axis);
    return sweep_refine_read(values, axis->into, axis->key[0], axis->name, axis->node, axis->errors);
}

enum status sweep_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(root, "sweep");
    if (!list) return STATUS_OK;

    if (list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "sweep: expects a list of axes, each {key: PATH, values: [...]}");
        return STATUS_OK;
    }

    if (list->n == 0) return STATUS_OK;
    values->sweep = calloc((size_t)list->n, sizeof *values->sweep);
    if (!values->sweep) return sweep_out_of_memory();
    const int n_before = errors->n;
    double n_members = 1;

    for (int i = 0; i < list->n && n_members <= max_members; i++) {
        struct axis axis = {.node = list->entry[i].value, .into = &values->sweep[i], .errors = errors};
        snprintf(axis.name, sizeof axis.name, "sweep[%d]", i);
        const enum status status = read_axis(values, &axis);
        n_members *= values->sweep[i].n_values;
        values->n_axes++;
        TRY(status);
    }

    if (n_members > max_members) {
        yaml_errors_add(errors, list->mark, "sweep: %.0f members or more; the maximum is %.0f", n_members, max_members);
    }
    if (errors->n == n_before) sweep_refine_check(values, list, errors);

    // do not count the members of axes with missing or too many values
    if (errors->n > n_before) sweep_free(values);
    return STATUS_OK;
}
