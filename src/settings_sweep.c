/* settings_sweep.c: the axes of a study. Declared in settings_check.h.
 *
 * A value is checked here as if it were given to its key, and kept as the text that --set will get. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "settings_check.h"
#include "settings_value.h"

static const double most_cases = 1e6;

static enum status no_memory(void) {
    return status_fail(STATUS_MEMORY, "no memory for the sweep");
}

/* The place in the file where one axis is read from, and what is known about it. */
struct axis {
    char name[32]; /* "sweep[1]" */
    const struct yaml_node *node;
    const struct key *key;
};

void settings_sweep_free(struct settings *settings) {
    for (int i = 0; i < settings->n_axes; i++) {
        struct settings_axis *const axis = &settings->sweep[i];
        for (int j = 0; j < axis->n_values; j++) free(axis->value[j]);
        free(axis->value);
        free(axis->key);
    }
    free(settings->sweep);
    settings->sweep = NULL;
    settings->n_axes = 0;
}

/* Check a value as one of the key of the axis. */
static enum status check_value(const struct axis *axis, int index, const struct yaml_node *value,
                               struct yaml_errors *errors) {
    union {
        double number[2];
        int whole;
        char *text;
        struct settings_list list;
    } field;
    char path[256];
    snprintf(path, sizeof path, "%s.values[%d] (%s)", axis->name, index, axis->key->path);
    settings_value_clear(axis->key, &field);
    const enum status status = settings_value_read(axis->key, &field, value, path, errors);
    settings_value_free(axis->key, &field);
    return status;
}

/* Read the values of an axis. */
static enum status read_values(struct settings_axis *into, const struct axis *axis, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "values");
    if (!list || list->kind != YAML_LIST || list->n == 0) {
        yaml_errors_add(errors, list ? list->mark : axis->node->mark,
                        "%s.values: expects a list of at least one value, as in [1, 2]", axis->name);
        return STATUS_OK;
    }
    into->value = calloc((size_t)list->n, sizeof *into->value);
    if (!into->value) return no_memory();
    for (int i = 0; i < list->n; i++) {
        const struct yaml_node *const value = list->entry[i].value;
        if (axis->key) TRY(check_value(axis, i, value, errors));
        struct yaml_text text = {0};
        yaml_text_add_node(&text, value);
        if (text.failed) {
            yaml_text_free(&text);
            return no_memory();
        }
        into->value[into->n_values++] = text.text;
    }
    return STATUS_OK;
}

/* Find the row of the table that an axis changes; NULL after an error. */
static const struct key *find_key(const struct settings *settings, const struct axis *axis,
                                  const struct yaml_node *node, struct yaml_errors *errors) {
    if (!node || node->kind != YAML_SCALAR) {
        yaml_errors_add(errors, node ? node->mark : axis->node->mark,
                        "%s.key: expects the path of a key, as in \"fish[*].body.modulus\"", axis->name);
        return NULL;
    }
    struct settings_path path;
    if (!settings_path_parse(&path, node->text, settings->n_fish, node->mark, errors)) return NULL;
    const struct key *const key = settings_table_row(path.pattern);
    const bool is_fixed = !key || key->type == FILES || key->type == DEFAULTS || key->type == AXES;
    if (is_fixed || strcmp(key->path, "format") == 0) {
        yaml_errors_add(errors, node->mark, "%s.key: '%.60s' is not a value that can be swept", axis->name, node->text);
        return NULL;
    }
    for (int i = 0; i < settings->n_axes; i++) {
        if (settings->sweep[i].key && strcmp(settings->sweep[i].key, node->text) == 0) {
            yaml_errors_add(errors, node->mark, "%s.key: sweep[%d] has this key too", axis->name, i);
        }
    }
    return key;
}

/* Read one axis into an entry that is zero. */
static enum status read_axis(const struct settings *settings, struct settings_axis *into, struct axis *axis,
                             struct yaml_errors *errors) {
    if (axis->node->kind != YAML_MAP) {
        yaml_errors_add(errors, axis->node->mark, "%s: expects {key: PATH, values: [...]}", axis->name);
        return STATUS_OK;
    }
    for (int i = 0; i < axis->node->n; i++) {
        const struct yaml_entry *const entry = &axis->node->entry[i];
        if (strcmp(entry->key, "key") == 0 || strcmp(entry->key, "values") == 0) continue;
        yaml_errors_add(errors, entry->mark, "%s.%.40s: unknown key; known here: key, values", axis->name, entry->key);
    }
    const struct yaml_node *const node = yaml_tree_find(axis->node, "key");
    axis->key = find_key(settings, axis, node, errors);
    if (axis->key && !(into->key = strdup(node->text))) return no_memory();
    return read_values(into, axis, errors);
}

enum status settings_sweep_read(struct settings *settings, const struct settings_tree *tree,
                                struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(tree->root, "sweep");
    if (!list) return STATUS_OK;
    if (list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "sweep: expects a list of axes, each {key: PATH, values: [...]}");
        return STATUS_OK;
    }
    if (list->n == 0) return STATUS_OK;
    settings->sweep = calloc((size_t)list->n, sizeof *settings->sweep);
    if (!settings->sweep) return no_memory();
    double n_cases = 1;
    for (int i = 0; i < list->n && n_cases <= most_cases; i++) {
        struct axis axis = {{0}, list->entry[i].value, NULL};
        snprintf(axis.name, sizeof axis.name, "sweep[%d]", i);
        const enum status status = read_axis(settings, &settings->sweep[i], &axis, errors);
        n_cases *= settings->sweep[i].n_values;
        settings->n_axes++;
        TRY(status);
    }
    if (n_cases > most_cases) {
        yaml_errors_add(errors, list->mark, "sweep: %.0f cases; the most is %.0f", n_cases, most_cases);
    }
    return STATUS_OK;
}
