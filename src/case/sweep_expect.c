/* sweep_expect.c: expectations, read and matched with members.
 *
 *     - {of: speed, fish: leader, least: 0.99, most: 1.01}                 every value
 *     - {of: [nose, tail], spread: 1e-5}                                   all values together
 *     - {of: steps, where: ["solver.method=ida"], ratio: 1.5}              of some members
 *     - {fails: unstable, where: ["solver.method=euler"]}                  that are not complete, with reason
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "case/sweep.h"

/* An expectation being read. */
struct reading {
    const struct case_values *values;
    char name[32]; /* "expect[1]" */
    const struct yaml_node *node;
    struct sweep_expectation *into;
    struct yaml_errors *errors;
};

void sweep_expect_free(struct case_values *values) {
    for (int i = 0; i < values->n_expectations; i++) {
        struct sweep_expectation *const one = &values->expect[i];
        for (int c = 0; c < one->n_where; c++) free(one->where[c].value);
        free(one->where);
        free(one->fails);
    }

    free(values->expect);
    values->expect = NULL;
    values->n_expectations = 0;
}

// ---- members

/* True if two strings are the same number, or the same but for blanks and quotes. */
static bool are_same(const char *one, const char *other) {
    double a, b;
    if (text_number(one, &a) && text_number(other, &b)) return a == b;
    for (;; one++, other++) {
        one += strspn(one, " \"'");
        other += strspn(other, " \"'");
        if (*one != *other) return false;
        if (*one == '\0') return true;
    }
}

int sweep_expects_of(const struct case_values *study, const struct sweep_expectation *one, int member) {
    for (int c = 0; c < one->n_where; c++) {
        // several values of one key are alternatives
        int is_met = 0;
        for (int d = 0; d < one->n_where && !is_met; d++) {
            const struct sweep_condition *const condition = &one->where[d];
            if (condition->axis != one->where[c].axis || condition->key != one->where[c].key) continue;
            const struct sweep_axis *const axis = &study->sweep[condition->axis];
            const int value = sweep_member_value(study, member, condition->axis);
            is_met = are_same(axis->value[value * axis->n_keys + condition->key], condition->value);
        }
        if (!is_met) return 0;
    }

    return 1;
}

/* Find the key of the sweep that a condition "path=value" is about; false if there is none. */
static bool expect_find_key(const struct case_values *values, const char *text, size_t length,
                            struct sweep_condition *condition) {
    for (int a = 0; a < values->n_axes; a++) {
        for (int k = 0; k < values->sweep[a].n_keys; k++) {
            const char *const path = values->sweep[a].key[k].path;
            if (!path || strlen(path) != length || strncmp(path, text, length) != 0) continue;
            *condition = (struct sweep_condition){.axis = a, .key = k};
            return true;
        }
    }

    return false;
}

/* Read "where". */
static enum status read_where(const struct reading *reading, const struct yaml_node *list) {
    if (list->kind != YAML_LIST) {
        yaml_errors_add(reading->errors, list->mark, "%s.where: expects a list, as in [\"solver.method=ida\"]",
                        reading->name);
        return STATUS_OK;
    }

    TRY(MEMORY_NEW(reading->into->where, list->n, "the expectations"));

    for (int i = 0; i < list->n; i++) {
        const struct yaml_node *const node = list->entry[i].value;
        const char *const equals = node->kind == YAML_SCALAR ? strchr(node->text, '=') : NULL;
        struct sweep_condition *const condition = &reading->into->where[reading->into->n_where];
        if (!equals || !expect_find_key(reading->values, node->text, (size_t)(equals - node->text), condition)) {
            yaml_errors_add(reading->errors, node->mark,
                            "%s.where: expects PATH=VALUE with a key of the sweep, as in \"solver.method=ida\"",
                            reading->name);
            continue;
        }
        TRY(memory_copy_string(&condition->value, equals + 1, "the expectations"));
        reading->into->n_where++;
    }

    return STATUS_OK;
}

// ---- quantities and bounds

/* Read a number of the expectation; NaN if absent. */
static double expect_read_number(const struct reading *reading, const char *name, double min) {
    const struct yaml_node *const node = yaml_tree_find(reading->node, name);
    double number;
    if (!node) return NAN;
    if (node->kind == YAML_SCALAR && text_number(node->text, &number) && isfinite(number) && number >= min)
        return number;
    yaml_errors_add(reading->errors, node->mark, "%s.%s: expects a number%s", reading->name, name,
                    min == 0   ? " from 0 on"
                    : min == 1 ? " from 1 on"
                               : "");
    return NAN;
}

/* Read "fish". */
static void expect_read_fish(const struct reading *reading, const struct yaml_node *node) {
    for (int f = 0; f < reading->values->school.n_fish; f++) {
        const char *const name = reading->values->school.fish[f].name;
        if (node->kind == YAML_SCALAR && name && strcmp(name, node->text) == 0) reading->into->fish = f;
    }
    if (reading->into->fish >= 0) return;
    yaml_errors_add(reading->errors, node->mark, "%s.fish: expects the name of a fish", reading->name);
}

/* Read the quantities and the bounds. */
static void read_bounds(const struct reading *reading, const struct yaml_node *of) {
    struct sweep_expectation *const into = reading->into;
    if (of) into->of = sweep_quantities_read(of, reading->name, SWEEP_N_QUANTITIES, reading->errors);
    into->min = expect_read_number(reading, "least", -INFINITY);
    into->max = expect_read_number(reading, "most", -INFINITY);
    into->spread = expect_read_number(reading, "spread", 0);
    into->ratio = expect_read_number(reading, "ratio", 1);
    const bool has_bound = yaml_tree_find(reading->node, "least") || yaml_tree_find(reading->node, "most") ||
                           yaml_tree_find(reading->node, "spread") || yaml_tree_find(reading->node, "ratio");

    if (!of || !has_bound) {
        yaml_errors_add(reading->errors, reading->node->mark,
                        "%s: expects of, and at least one of least, most, spread, ratio", reading->name);
    }

    // refuse keys that the quantity does not have
    for (int q = 0; q < SWEEP_N_QUANTITIES; q++) {
        const struct sweep_quantity *const quantity = &sweep_quantities[q];
        if (!(into->of >> q & 1)) continue;
        if (into->fish >= 0 && !quantity->of_fish) {
            yaml_errors_add(reading->errors, reading->node->mark, "%s.fish: %s has no value for each fish",
                            reading->name, quantity->name);
        }
        if (quantity->of_xy && !(isnan(into->min) && isnan(into->max) && isnan(into->ratio))) {
            yaml_errors_add(reading->errors, reading->node->mark, "%s: %s is a point, of which only spread is known",
                            reading->name, quantity->name);
        }
    }
}

/* Read "fails". */
static enum status read_fails(const struct reading *reading, const struct yaml_node *fails) {
    if (fails->kind != YAML_SCALAR || !*fails->text) {
        yaml_errors_add(reading->errors, fails->mark, "%s.fails: expects words of the reason, as in unstable",
                        reading->name);
        return STATUS_OK;
    }
    yaml_tree_check_keys(reading->node, reading->name, "fails, where", reading->errors);
    return memory_copy_string(&reading->into->fails, fails->text, "the expectations");
}

/* Read one expectation into an entry that is zero. */
static enum status read_expectation(const struct reading *reading) {
    reading->into->fish = -1;
    if (reading->node->kind != YAML_MAP) {
        yaml_errors_add(reading->errors, reading->node->mark, "%s: expects {of: QUANTITY, least: ..., most: ...}",
                        reading->name);
        return STATUS_OK;
    }

    const struct yaml_node *const fails = yaml_tree_find(reading->node, "fails"),
                                  *const fish = yaml_tree_find(reading->node, "fish"),
                                  *const where = yaml_tree_find(reading->node, "where");
    if (fails) {
        TRY(read_fails(reading, fails));
    } else {
        yaml_tree_check_keys(reading->node, reading->name, "of, fish, where, least, most, spread, ratio, fails",
                             reading->errors);
        if (fish) expect_read_fish(reading, fish);
        read_bounds(reading, yaml_tree_find(reading->node, "of"));
    }

    if (!where) return STATUS_OK;
    const int n_before = reading->errors->n;
    TRY(read_where(reading, where));
    if (reading->errors->n > n_before) return STATUS_OK;
    for (int m = 0; m < sweep_n_members(reading->values); m++) {
        if (sweep_expects_of(reading->values, reading->into, m)) return STATUS_OK;
    }
    yaml_errors_add(reading->errors, where->mark, "%s.where: no member of the sweep has these values", reading->name);
    return STATUS_OK;
}

enum status sweep_expect_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(root, "expect");

    // a member, or a run with --set 'sweep=[]', expects nothing
    if (!list || (values->n_axes == 0 && yaml_tree_find(root, "sweep"))) return STATUS_OK;

    if (list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "expect: expects a list, as in [{of: QUANTITY, least: ...}]");
        return STATUS_OK;
    }

    if (values->n_axes == 0) yaml_errors_add(errors, list->mark, "expect: has no effect without a sweep");
    TRY(MEMORY_NEW(values->expect, list->n, "the expectations"));

    for (int i = 0; i < list->n; i++) {
        struct reading reading = {
            .values = values, .node = list->entry[i].value, .into = &values->expect[i], .errors = errors};
        snprintf(reading.name, sizeof reading.name, "expect[%d]", i);
        values->n_expectations++;
        TRY(read_expectation(&reading));
    }

    return STATUS_OK;
}
