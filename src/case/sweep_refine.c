/* sweep_refine.c: the keys of an axis of resolutions besides the values.
 *
 *     refine: true
 *     reference: {speed: 1.014, nose: [-1.6, 0.01]}       given values, the reference of errors and orders
 *     expect: {order: 2, within: 0.2, of: [nose, speed]}
 */
#include "case/sweep_refine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep_error.h"
#include "case/sweep_members.h"
#include "case/sweep_quantity.h"

enum { MIN_LEVELS = 3 };

/* An axis being read. */
struct reading {
    const struct case_values *values;
    struct sweep_axis *into;
    const char *name; /* "sweep[1]" */
    struct yaml_errors *errors;
};

/* Complain unless the values of an axis are different resolutions. */
static void check_refine(const struct reading *axis, const struct key *key, const struct yaml_node *node) {
    const struct sweep_axis *const into = axis->into;
    if (!key) return;

    if (!sweep_error_find(key->path)) {
        struct text known = {0};
        for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
            const char *const path = sweep_error_keys[i].path;
            const int is_of_fish = strncmp(path, "fish.", 5) == 0;
            text_add(&known, "%s%s%s", i > 0 ? ", " : "", is_of_fish ? "fish[*]" : "", is_of_fish ? path + 4 : path);
        }
        yaml_errors_add(axis->errors, node->mark, "%s.refine: '%.60s' is not a resolution; these are: %s", axis->name,
                        into->key[0].path, known.text ? known.text : "");
        if (known.failed) axis->errors->out_of_memory = true;
        text_free(&known);
        return;
    }

    int n_different = 0;
    for (int i = 0; i < into->n_values; i++) {
        int is_new = 1;
        for (int j = 0; j < i; j++) {
            const char *const one = into->value[i * into->n_keys], *const other = into->value[j * into->n_keys];
            double a, b;
            if (one && other && text_number(one, &a) && text_number(other, &b) && a == b) is_new = 0;
        }
        n_different += is_new;
    }

    if (n_different < MIN_LEVELS || n_different < into->n_values) {
        yaml_errors_add(axis->errors, node->mark, "%s.refine: expects at least %d values, all different", axis->name,
                        MIN_LEVELS);
    }
}

/* Read a positive number of a map. */
static double read_positive(const struct reading *axis, const struct yaml_node *map, const char *name) {
    const struct yaml_node *const node = yaml_tree_find(map, name);
    double number;
    if (node && node->kind == YAML_SCALAR && text_number(node->text, &number) && number > 0) return number;
    yaml_errors_add(axis->errors, node ? node->mark : map->mark, "%s.expect.%s: expects a number above 0", axis->name,
                    name);
    return NAN;
}

/* Read "refine". */
static void read_refine(const struct reading *axis, const struct key *key, const struct yaml_node *refine) {
    const bool is_true = refine->kind == YAML_SCALAR && strcmp(refine->text, "true") == 0;
    const bool is_false = refine->kind == YAML_SCALAR && strcmp(refine->text, "false") == 0;
    if (!is_true && !is_false) {
        yaml_errors_add(axis->errors, refine->mark, "%s.refine: expects true or false", axis->name);
    }
    axis->into->refine = is_true;
    if (!is_true) return;
    check_refine(axis, key, refine);

    for (int i = 0; i < axis->values->n_axes; i++) {
        if (!axis->values->sweep[i].refine) continue;
        yaml_errors_add(axis->errors, refine->mark, "%s.refine: sweep[%d] is refined already; one axis can be",
                        axis->name, i);
    }
}

/* Read "expect". */
static void read_expect(const struct reading *axis, const struct yaml_node *expect) {
    if (expect->kind != YAML_MAP) {
        yaml_errors_add(axis->errors, expect->mark, "%s.expect: expects {order: 2, within: 0.2}", axis->name);
        return;
    }

    char path[64];
    snprintf(path, sizeof path, "%s.expect", axis->name);
    yaml_tree_check_keys(expect, path, "order, within, of", axis->errors);
    axis->into->order = read_positive(axis, expect, "order");
    axis->into->within = read_positive(axis, expect, "within");
    const struct yaml_node *const of = yaml_tree_find(expect, "of");
    if (of) axis->into->order_of = sweep_quantities_read(of, path, SWEEP_N_ORDERS, axis->errors);
}

// ---- the reference

/* Read one value of a quantity: one or two numbers; false for anything else. */
static bool read_value(const struct yaml_node *node, int of_xy, double value[2]) {
    if (of_xy && (node->kind != YAML_LIST || node->n != 2)) return false;
    for (int k = 0; k < 1 + of_xy; k++) {
        const struct yaml_node *const number = of_xy ? node->entry[k].value : node;
        if (number->kind != YAML_SCALAR || !text_number(number->text, &value[k]) || isinf(value[k])) return false;
    }
    return true;
}

/* Read the value of a quantity for all fish, or a list of one for each. */
static bool read_values(const struct reading *axis, const struct yaml_node *node, int q) {
    const int n_fish = axis->values->school.n_fish, of_xy = sweep_quantities[q].of_xy;
    double *const to = axis->into->reference + (long)q * n_fish * 2, one[2];
    const bool is_one = read_value(node, of_xy, one);
    if (!is_one && (node->kind != YAML_LIST || node->n != n_fish)) return false;
    for (int f = 0; f < n_fish; f++) {
        if (!read_value(is_one ? node : node->entry[f].value, of_xy, to + 2 * f)) return false;
    }
    return true;
}

/* Read "reference". */
static enum status read_reference(const struct reading *axis, const struct yaml_node *node) {
    char path[64];
    snprintf(path, sizeof path, "%s.reference", axis->name);

    if (node->kind != YAML_MAP || node->n == 0) {
        yaml_errors_add(axis->errors, node->mark, "%s: expects the values of quantities, as in {speed: 1.01}", path);
        return STATUS_OK;
    }

    const size_t n = (size_t)SWEEP_N_ORDERS * (size_t)axis->values->school.n_fish * 2;
    axis->into->reference = malloc((n + 1) * sizeof *axis->into->reference);
    if (!axis->into->reference) return status_fail(STATUS_MEMORY, "out of memory: the sweep");
    for (size_t i = 0; i < n; i++) axis->into->reference[i] = NAN;

    for (int i = 0; i < node->n; i++) {
        const struct yaml_entry *const entry = &node->entry[i];
        const int q = sweep_quantity_read(entry->key, entry->mark, path, SWEEP_N_ORDERS, axis->errors);
        if (q < 0 || read_values(axis, entry->value, q)) continue;
        yaml_errors_add(axis->errors, entry->value->mark, "%s.%s: expects %s%s", path, entry->key,
                        sweep_quantities[q].of_xy ? "[x, y]" : "a number",
                        axis->values->school.n_fish > 1 ? ", or a list of one for each fish" : "");
    }

    return STATUS_OK;
}

double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy) {
    const double *const reference = study->sweep[axis].reference;
    return reference ? reference[((long)quantity * study->school.n_fish + fish) * 2 + xy] : NAN;
}

// ---- all

uint64_t sweep_refine_orders(const struct case_values *study) {
    uint64_t all = 0;
    for (int q = 0; q < SWEEP_N_ORDERS; q++) {
        const int of_steady = (sweep_quantities[q].traits & SWEEP_OF_STEADY) != 0;
        if (of_steady == sweep_is_steady(study)) all |= UINT64_C(1) << q;
    }
    return all;
}

void sweep_refine_check(struct case_values *values, const struct yaml_node *sweep, struct yaml_errors *errors) {
    const uint64_t known = sweep_refine_orders(values);
    const uint64_t standard = UINT64_C(1) << SWEEP_NOSE | UINT64_C(1) << SWEEP_TAIL;

    for (int a = 0; a < values->n_axes; a++) {
        struct sweep_axis *const axis = &values->sweep[a];
        if (axis->order_of == 0 && axis->order > 0) {
            axis->order_of = sweep_is_steady(values) ? UINT64_C(1) << SWEEP_STEADY_SPEED : standard;
        }
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            if (!(axis->order_of & ~known & UINT64_C(1) << q)) continue;
            yaml_errors_add(errors, sweep->entry[a].value->mark, "sweep[%d].expect.of: %s is a quantity of %s", a,
                            sweep_quantities[q].name, sweep_is_steady(values) ? "runs" : "steady states");
        }
    }
}

enum status sweep_refine_read(const struct case_values *values, struct sweep_axis *into, const struct key *key,
                              const char *name, const struct yaml_node *node, struct yaml_errors *errors) {
    const struct reading axis = {values, into, name, errors};
    const struct yaml_node *const refine = yaml_tree_find(node, "refine"),
                                  *const expect = yaml_tree_find(node, "expect"),
                                  *const reference = yaml_tree_find(node, "reference");
    into->order = into->within = NAN;
    if (refine) read_refine(&axis, key, refine);
    const struct yaml_node *const ignored[] = {expect, reference};

    for (int i = 0; i < 2; i++) {
        if (!ignored[i] || into->refine) continue;
        yaml_errors_add(errors, ignored[i]->mark, "%s.%s: has no effect without refine: true", name,
                        i == 0 ? "expect" : "reference");
    }

    if (expect) read_expect(&axis, expect);
    return reference ? read_reference(&axis, reference) : STATUS_OK;
}
