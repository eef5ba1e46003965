/* sweep_error.c: see sweep_error.h. */
#include "case/sweep_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "case/sweep.h"

/* The table that studies of convergence, error bars and doc/studies.md share. */
const struct sweep_error_key sweep_error_keys[SWEEP_N_ERROR_KEYS] = {
    {"fish.nodes", NULL, SWEEP_POINTS, {1 / 1.5, 1 / 2.0}, 1.4, 2},
    {"fish.sheet_points", NULL, SWEEP_POINTS, {1 / 1.4, 1 / 2.0}, 1.4, 1},
    {"time.shedding_interval", NULL, SWEEP_SPACING, {2, 4}, 0.5, 1},  // of a sheet: see sweep_error_order
    {"solver.rtol", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"solver.step", NULL, SWEEP_SPACING, {2, 4}, 0.5, 1},  // of the first order: see sweep_error_order
    {"wake.tolerance", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"wake.merge", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"wake.lifetime", "wake.decay", SWEEP_DURATION, {1 / 2.0, 0}, 2, 1},
    {"wake.smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, 1},
    {"sheet.smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, 1},
    {"wake.taper", "wake.taper_beside", SWEEP_MODEL, {0, 0}, 0.5, 1},
};

const struct sweep_error_key *sweep_error_find(const char *path) {
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        if (strcmp(sweep_error_keys[i].path, path) == 0) return &sweep_error_keys[i];
    }
    return NULL;
}

double sweep_error_order(const struct case_values *values, const struct sweep_error_key *key) {
    if (strcmp(key->path, "solver.step") == 0) return methods_table[values->solver.method].order;

    // continuous shedding is of second order, towards a wake that is wrong next to the edge (doc/numerics.md, 5)
    const int is_interval = strcmp(key->path, "time.shedding_interval") == 0;
    if (is_interval && values->school.wake.shedding == SHEDDING_CONTINUOUS) return 2;
    return key->order;
}

// ---- reading

void sweep_error_free(struct case_values *values) {
    struct sweep_error *const error = values->error;
    if (!error) return;
    for (int i = 0; i < error->n_of; i++) free(error->of[i]);
    for (int i = 0; i < error->n_keys; i++) free(error->levels[i].value);
    free(error->of);
    free(error->levels);
    free(error);
    values->error = NULL;
}

static enum status read_of(struct sweep_error *error, const struct yaml_node *of, struct yaml_errors *errors) {
    const int n = of->kind == YAML_LIST ? of->n : 1;
    TRY(MEMORY_NEW(error->of, n, "the errors of a study"));

    for (int i = 0; i < n; i++) {
        const struct yaml_node *const name = of->kind == YAML_LIST ? of->entry[i].value : of;
        if (name->kind != YAML_SCALAR || !*name->text) {
            yaml_errors_add(errors, name->mark, "error.of: expects the name of a quantity, or a list of names");
            continue;
        }
        TRY(memory_copy_string(&error->of[error->n_of++], name->text, "the errors of a study"));
    }

    if (n == 0) yaml_errors_add(errors, of->mark, "error.of: expects the name of a quantity, or a list of names");
    return STATUS_OK;
}

/* The row of a key: "nodes", "fish.nodes" or "fish[*].nodes"; NULL after an error. */
static const struct sweep_error_key *error_find_key(const char *name, struct yaml_mark mark,
                                                    struct yaml_errors *errors) {
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        const char *const path = sweep_error_keys[i].path, *const last = strrchr(path, '.') + 1;
        const int is_of_every = strncmp(path, "fish.", 5) == 0 && strncmp(name, "fish[*].", 8) == 0;
        if (strcmp(name, path) == 0 || strcmp(is_of_every ? name + 8 : name, last) == 0) return &sweep_error_keys[i];
    }

    struct text known = {0};
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        text_add(&known, "%s%s", i > 0 ? ", " : "", strrchr(sweep_error_keys[i].path, '.') + 1);
    }
    yaml_errors_add(errors, mark, "error.keys: '%.60s' is not a numerical key; these are: %s", name,
                    known.text ? known.text : "");
    if (known.failed) errors->out_of_memory = true;
    text_free(&known);
    return NULL;
}

/* Read the levels of one key: a list of numbers, or default. */
static enum status read_levels(struct sweep_error_levels *levels, const struct yaml_node *node,
                               struct yaml_errors *errors) {
    if (node->kind == YAML_SCALAR && strcmp(node->text, "default") == 0) return STATUS_OK;
    int is_wrong = node->kind != YAML_LIST || node->n < 2, are_wrong_points = 0;
    TRY(MEMORY_NEW(levels->value, node->n, "the errors of a study"));

    for (int i = 0; i < node->n && !is_wrong; i++) {
        const struct yaml_node *const number = node->entry[i].value;
        is_wrong = number->kind != YAML_SCALAR || !text_number(number->text, &levels->value[i]) ||
                   !(levels->value[i] > 0) || !isfinite(levels->value[i]);
        are_wrong_points |=
            !is_wrong && levels->key->kind == SWEEP_POINTS && fabs(rint(levels->value[i]) - levels->value[i]) > 0;
        for (int j = 0; j < i && !is_wrong; j++) is_wrong = !(fabs(levels->value[j] - levels->value[i]) > 0);
        levels->n++;
    }

    if (is_wrong) {
        yaml_errors_add(errors, node->mark, "error.keys: expects 'default', or at least two different levels above 0");
    } else if (are_wrong_points) {
        yaml_errors_add(errors, node->mark, "error.keys: levels of '%s' are integers", levels->key->path);
    } else if (node->n > SWEEP_ERROR_LEVELS) {
        yaml_errors_add(errors, node->mark, "error.keys: more than %d levels of '%s'", SWEEP_ERROR_LEVELS,
                        levels->key->path);
    }
    return STATUS_OK;
}

/* Read "keys": default, a list of keys, or a map of levels. */
static enum status read_keys(struct sweep_error *error, const struct yaml_node *keys, struct yaml_errors *errors) {
    if (keys->kind == YAML_SCALAR && strcmp(keys->text, "default") == 0) return STATUS_OK;
    if (keys->kind == YAML_SCALAR || keys->n == 0) {
        yaml_errors_add(errors, keys->mark,
                        "error.keys: expects 'default', a list of keys, or levels, as in {nodes: [13, 17, 25, 35]}");
        return STATUS_OK;
    }

    TRY(MEMORY_NEW(error->levels, keys->n, "the errors of a study"));

    for (int i = 0; i < keys->n; i++) {
        const struct yaml_entry *const entry = &keys->entry[i];
        const int is_map = keys->kind == YAML_MAP;
        if (!is_map && entry->value->kind != YAML_SCALAR) {
            yaml_errors_add(errors, entry->value->mark, "error.keys: expects the name of a key");
            continue;
        }
        const struct sweep_error_key *const key =
            error_find_key(is_map ? entry->key : entry->value->text, is_map ? entry->mark : entry->value->mark, errors);
        for (int j = 0; j < error->n_keys && key; j++) {
            if (error->levels[j].key != key) continue;
            yaml_errors_add(errors, entry->value->mark, "error.keys: '%s' is there twice", key->path);
        }
        if (!key) continue;
        error->levels[error->n_keys].key = key;
        if (is_map) TRY(read_levels(&error->levels[error->n_keys], entry->value, errors));
        error->n_keys++;
    }

    return STATUS_OK;
}

enum status sweep_error_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const map = yaml_tree_find(root, "error");

    // as for a member of such a study
    const int is_none = map && map->kind == YAML_SCALAR && strcmp(map->text, "none") == 0;
    if (!map || is_none || (map->kind == YAML_MAP && map->n == 0)) return STATUS_OK;

    if (map->kind != YAML_MAP) {
        yaml_errors_add(errors, map->mark, "error: expects {of: QUANTITY}");
        return STATUS_OK;
    }

    yaml_tree_check_keys(map, "error", "of, within, keys, confirm, most", errors);
    TRY(MEMORY_NEW(values->error, 1, "the errors of a study"));
    struct sweep_error *const error = values->error;
    error->within = yaml_tree_positive(map, "error", "within", NAN, errors);
    error->most = yaml_tree_positive(map, "error", "most", SWEEP_ERROR_MOST, errors);
    if (values->n_axes > 0 && !isnan(error->within)) {
        yaml_errors_add(errors, map->mark, "error.within: refines one case: remove within or sweep");
    }
    for (int a = 0; a < values->n_axes; a++) {
        if (!values->sweep[a].refine) continue;
        yaml_errors_add(errors, map->mark, "error: replaces the refined axis sweep[%d]: remove error or refine", a);
    }
    const struct yaml_node *const of = yaml_tree_find(map, "of"), *const keys = yaml_tree_find(map, "keys"),
                                  *const confirm = yaml_tree_find(map, "confirm");
    if (!of) yaml_errors_add(errors, map->mark, "error.of: is required: a quantity, or a list of quantities");
    if (of) TRY(read_of(error, of, errors));
    if (keys) TRY(read_keys(error, keys, errors));
    error->confirm = !confirm || yaml_tree_boolean(confirm, "error.confirm", errors);
    return STATUS_OK;
}

void sweep_error_write(struct text *text, const struct sweep_error *error) {
    text_add(text, "{of: [");
    for (int i = 0; i < error->n_of; i++) {
        if (i > 0) text_add(text, ", ");
        yaml_write_scalar(text, error->of[i]);
    }

    text_add(text, "]");
    if (!isnan(error->within)) {
        text_add(text, ", within: ");
        text_add_number(text, error->within);
    }

    if (fabs(error->most - SWEEP_ERROR_MOST) > 0) {
        text_add(text, ", most: ");
        text_add_number(text, error->most);
    }

    if (!error->confirm) text_add(text, ", confirm: false");
    for (int i = 0; i < error->n_keys; i++) {
        text_add(text, "%s%s: ", i == 0 ? ", keys: {" : ", ", strrchr(error->levels[i].key->path, '.') + 1);
        if (error->levels[i].n == 0) text_add(text, "default");
        for (int k = 0; k < error->levels[i].n; k++) {
            text_add(text, k > 0 ? ", " : "[");
            text_add_number(text, error->levels[i].value[k]);
        }
        if (error->levels[i].n > 0) text_add(text, "]");
    }

    text_add(text, error->n_keys > 0 ? "}}" : "}");
}
