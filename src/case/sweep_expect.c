/* sweep_expect.c: reads expectations and compares them with the members of a study.
 *
 *     - {of: speed, fish: leader, least: 0.99, most: 1.01}                 every value
 *     - {of: [nose, tail], spread: 1e-5}                                   all values together
 *     - {of: steps, where: ["solver.method=ida"], ratio: 1.5}              of some members
 *     - {fails: unstable, where: ["solver.method=euler"]}                  that are not complete, with reason */
#include "case/sweep_expect.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "case/sweep_quantity.h"

/* An expectation being read. */
struct reading {
    const struct case_values *values;
    char name[32]; /* "expect[1]" */
    const struct yaml_node *node;
    struct sweep_expectation *into;
    struct yaml_errors *errors;
};

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

bool sweep_expects_of(const struct case_values *study, const struct sweep_expectation *one, int member) {
    for (int c = 0; c < one->n_where; c++) {
        // several values of one key are alternatives
        bool is_met = false;
        for (int d = 0; d < one->n_where && !is_met; d++) {
            const struct sweep_condition *const condition = &one->where[d];
            if (condition->axis != one->where[c].axis || condition->key != one->where[c].key) continue;
            const struct sweep_axis *const axis = &study->sweep[condition->axis];
            const int value = sweep_member_value(study, member, condition->axis);
            is_met = are_same(axis->value[value * axis->n_keys + condition->key], condition->value);
        }
        if (!is_met) return false;
    }

    return true;
}

/* Read "where". */
static void read_where(const struct reading *reading, const struct yaml_node *list) {
    const struct case_values *const values = reading->values;
    struct sweep_expectation *const into = reading->into;
    if (list->kind != YAML_LIST) {
        yaml_errors_add(reading->errors, list->mark, "%s.where: expects a list, as in [\"solver.method=ida\"]",
                        reading->name);
        return;
    }

    const int n_before = reading->errors->n;
    NEW(values->arena, into->where, list->n);
    for (int i = 0; i < list->n; i++) {
        // find the key of the sweep in "path=value"
        const struct yaml_node *const node = list->entry[i].value;
        const char *const equals = node->kind == YAML_SCALAR ? strchr(node->text, '=') : NULL;
        struct sweep_condition *const condition = &into->where[into->n_where];
        bool is_known = false;
        for (int a = 0; a < values->n_axes && equals && !is_known; a++) {
            for (int k = 0; k < values->sweep[a].n_keys && !is_known; k++) {
                const char *const path = values->sweep[a].key[k].path;
                const size_t length = (size_t)(equals - node->text);
                is_known = path && strlen(path) == length && strncmp(path, node->text, length) == 0;
                if (is_known) *condition = (struct sweep_condition){a, k, arena_text(values->arena, "%s", equals + 1)};
            }
        }
        into->n_where += is_known;
        if (is_known) continue;
        yaml_errors_add(reading->errors, node->mark,
                        "%s.where: expects PATH=VALUE with a key of the sweep, as in \"solver.method=ida\"",
                        reading->name);
    }

    if (reading->errors->n > n_before) return;
    for (int m = 0; m < sweep_n_members(values); m++) {
        if (sweep_expects_of(values, into, m)) return;
    }
    yaml_errors_add(reading->errors, list->mark, "%s.where: no member of the sweep has these values", reading->name);
}

// ---- quantities and bounds

/* Read a bound of the expectation, at least min; if it is absent, `none`. */
static double expect_read_bound(const struct reading *reading, const char *name, double min, double none) {
    const struct yaml_node *const node = yaml_tree_find(reading->node, name);
    double number;
    if (!node) return none;
    if (node->kind == YAML_SCALAR && text_number(node->text, &number) && isfinite(number) && number >= min)
        return number;
    yaml_errors_add(reading->errors, node->mark, "%s.%s: expects a number%s", reading->name, name,
                    min == 0   ? " from 0 on"
                    : min == 1 ? " from 1 on"
                               : "");
    return none;
}

/* Read the quantities, the fish and the bounds. */
static void read_bounds(const struct reading *reading) {
    struct sweep_expectation *const into = reading->into;
    const struct yaml_node *const of = yaml_tree_find(reading->node, "of"), *const fish =
                                                                                yaml_tree_find(reading->node, "fish");
    yaml_tree_check_keys(reading->node, reading->name, "of, fish, where, least, most, spread, ratio, fails",
                         reading->errors);
    if (fish && fish->kind == YAML_SCALAR) {
        into->fish = school_find_fish(&reading->values->school, fish->text, strlen(fish->text));
    }
    if (fish && into->fish < 0) {
        yaml_errors_add(reading->errors, fish->mark, "%s.fish: expects the name of a fish", reading->name);
    }

    if (of) into->of = sweep_quantities_read(of, reading->name, SWEEP_N_QUANTITIES, reading->errors);
    into->min = expect_read_bound(reading, "least", -INFINITY, -INFINITY);
    into->max = expect_read_bound(reading, "most", -INFINITY, INFINITY);
    into->spread = expect_read_bound(reading, "spread", 0, INFINITY);
    into->ratio = expect_read_bound(reading, "ratio", 1, INFINITY);
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
        if (quantity->of_xy && !(isinf(into->min) && isinf(into->max) && isinf(into->ratio))) {
            yaml_errors_add(reading->errors, reading->node->mark, "%s: %s is a point, of which only spread is known",
                            reading->name, quantity->name);
        }
    }
}

void sweep_expect_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(root, "expect");

    // a member, or a run with --set 'sweep=[]', expects nothing
    if (!list || (values->n_axes == 0 && yaml_tree_find(root, "sweep"))) return;
    if (list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "expect: expects a list, as in [{of: QUANTITY, least: ...}]");
        return;
    }

    if (values->n_axes == 0) yaml_errors_add(errors, list->mark, "expect: has no effect without a sweep");
    NEW(values->arena, values->expect, list->n);
    for (int i = 0; i < list->n; i++) {
        const struct yaml_node *const node = list->entry[i].value;
        struct reading reading = {.values = values, .node = node, .into = &values->expect[i], .errors = errors};
        snprintf(reading.name, sizeof reading.name, "expect[%d]", i);
        values->n_expectations++;
        reading.into->fish = -1;
        if (node->kind != YAML_MAP) {
            yaml_errors_add(errors, node->mark, "%s: expects {of: QUANTITY, least: ..., most: ...}", reading.name);
            continue;
        }

        const struct yaml_node *const fails = yaml_tree_find(node, "fails"), *const where =
                                                                                 yaml_tree_find(node, "where");
        if (!fails) {
            read_bounds(&reading);
        } else if (fails->kind != YAML_SCALAR || !*fails->text) {
            yaml_errors_add(errors, fails->mark, "%s.fails: expects words of the reason, as in unstable", reading.name);
        } else {
            yaml_tree_check_keys(node, reading.name, "fails, where", errors);
            reading.into->fails = arena_text(values->arena, "%s", fails->text);
        }
        if (where) read_where(&reading, where);
    }
}
