/* sweep.c: the axes of a study.
 *
 *     - {key: solver.rtol, values: [1e-4, 1e-5]}                                       one key
 *     - {keys: [fish[*].nodes, fish[*].sheet_points], values: [[7, 21], [13, 41]]}     two that change together
 *     - {key: ..., values: ..., refine: true,                                          resolutions
 *        reference: {speed: 1.014, nose: [-1.6, 0.01]},                                reference of errors and orders
 *        expect: {order: 2, within: 0.2, of: [nose, speed]}}
 *
 * Each value is checked as a value of the key, and stored as a string for --set. */
#include "case/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/sweep_error.h"

enum { MAX_KEYS = 16 /* of one axis */, MIN_LEVELS = 3 /* of an axis of resolutions */ };
static const double max_members = 1e5;

/* An axis being read. */
struct axis {
    const struct case_values *values; /* with the axes read before */
    char name[32];                    /* "sweep[1]" */
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

// ---- members: counting through the axes, the last one fastest

enum status sweep_refuse(const struct case_values *values) {
    if (values->n_axes == 0) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "error: sweep: this case has a sweep of %d ax%cs: use `shoal study`, or remove the sweep with "
                       "--set 'sweep=[]'",
                       values->n_axes, values->n_axes == 1 ? 'i' : 'e');
}

int sweep_n_members(const struct case_values *study) {
    int n = 1;
    for (int a = 0; a < study->n_axes; a++) n *= study->sweep[a].n_values;
    return n;
}

int sweep_member_value(const struct case_values *study, int member, int axis) {
    for (int a = study->n_axes - 1; a > axis; a--) member /= study->sweep[a].n_values;
    return member % study->sweep[axis].n_values;
}

int sweep_is_steady(const struct case_values *study) {
    int is_steady = 0;
    for (int a = 0; a < study->n_axes; a++) is_steady |= study->sweep[a].steady;
    return is_steady;
}

int sweep_member_before(const struct case_values *study, int member) {
    int stride = 1;
    for (int a = study->n_axes - 1; a >= 0; a--) {
        const struct sweep_axis *const axis = &study->sweep[a];
        const int value = sweep_member_value(study, member, a), before = axis->before ? axis->before[value] : value - 1;
        if (axis->steady) return before >= 0 ? member - (value - before) * stride : -1;
        stride *= study->sweep[a].n_values;
    }
    return -1;
}

void sweep_add_assignment(struct text *text, const struct sweep_axis *axis, int value, int k) {
    text_add(text, "%s=%s", axis->key[k].path, axis->value[value * axis->n_keys + k]);
}

enum status sweep_member_text(const struct case_values *study, int member, char **text) {
    struct text list = {0};
    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            if (list.length > 0) text_add(&list, ", ");
            sweep_add_assignment(&list, &study->sweep[a], value, k);
        }
    }

    return text_take(&list, text, "the values of a member");
}

uint64_t sweep_refine_orders(const struct case_values *study) {
    uint64_t all = 0;
    for (int q = 0; q < SWEEP_N_ORDERS; q++) {
        const int of_steady = sweep_quantities[q].of_steady;
        if (of_steady == sweep_is_steady(study)) all |= UINT64_C(1) << q;
    }
    return all;
}

double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy) {
    const double *const reference = study->sweep[axis].reference;
    return reference ? reference[((long)quantity * study->school.n_fish + fish) * 2 + xy] : NAN;
}

// ---- keys and values of an axis

/* Read the path of a key; the row in axis->key is NULL after an error. */
static enum status axis_read_key(struct axis *axis, const struct yaml_node *node) {
    struct sweep_key *const swept = &axis->into->key[axis->n_keys];
    const struct key **const row = &axis->key[axis->n_keys++];
    axis->into->n_keys++;

    if (!node || node->kind != YAML_SCALAR) {
        yaml_errors_add(axis->errors, node ? node->mark : axis->node->mark,
                        "%s.key: expects the path of a key, as in \"fish[*].body.modulus\"", axis->name);
        return STATUS_OK;
    }

    struct case_path path;
    if (!case_path_parse(&path, node->text, axis->values->school.n_fish, node->mark, axis->errors)) return STATUS_OK;
    const struct key *const key = case_table_row(path.pattern);
    if (!key || !case_table_is_value(key) || strcmp(key->path, "format") == 0) {
        yaml_errors_add(axis->errors, node->mark, "%s.key: '%.60s' cannot be swept", axis->name, node->text);
        return STATUS_OK;
    }

    // refuse a key that another axis, or this one, has too
    for (int i = 0; i <= axis->values->n_axes; i++) {
        const struct sweep_axis *const other = &axis->values->sweep[i];
        for (int k = 0; k < other->n_keys; k++) {
            if (!other->key[k].path || strcmp(other->key[k].path, node->text) != 0) continue;
            yaml_errors_add(axis->errors, node->mark, "%s.key: sweep[%d] has this key too", axis->name, i);
        }
    }

    *row = key;
    swept->row = key->path;
    swept->unit = key->unit;
    swept->is_number = key->type == REAL || key->type == INTEGER || key->type == DURATION;
    return memory_copy_string(&swept->path, node->text, "the sweep");
}

/* Read "key", or "keys". */
static enum status axis_read_keys(struct axis *axis) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "keys"), *const single =
                                                                                 yaml_tree_find(axis->node, "key");
    axis->is_zipped = list != NULL;

    if (list && (list->kind != YAML_LIST || list->n == 0 || list->n > MAX_KEYS)) {
        yaml_errors_add(axis->errors, list->mark, "%s.keys: expects a list of 1 to %d paths", axis->name, MAX_KEYS);
        return STATUS_OK;
    }

    if (list && single) {
        yaml_errors_add(axis->errors, single->mark, "%s: takes key or keys, not both", axis->name);
    }
    TRY(MEMORY_NEW(axis->into->key, MAX_KEYS, "the sweep"));
    if (!list) return axis_read_key(axis, single);
    for (int k = 0; k < list->n; k++) TRY(axis_read_key(axis, list->entry[k].value));
    return STATUS_OK;
}

/* Check one value as a value of the key, and store the text. */
static enum status axis_read_value(struct axis *axis, int index, int k, const struct yaml_node *value) {
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
    return text_take(&text, &axis->into->value[index * axis->n_keys + k], "the sweep");
}

static enum status axis_read_values(struct axis *axis) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "values");
    if (!list || list->kind != YAML_LIST || list->n == 0) {
        yaml_errors_add(axis->errors, list ? list->mark : axis->node->mark,
                        "%s.values: expects a list of at least one value, as in [1, 2]", axis->name);
        return STATUS_OK;
    }

    TRY(MEMORY_NEW(axis->into->value, list->n * axis->n_keys, "the sweep"));
    axis->into->n_values = list->n;

    for (int i = 0; i < list->n; i++) {
        const struct yaml_node *const value = list->entry[i].value;
        if (!axis->is_zipped) {
            TRY(axis_read_value(axis, i, 0, value));
            continue;
        }
        if (value->kind != YAML_LIST || value->n != axis->n_keys) {
            yaml_errors_add(axis->errors, value->mark, "%s.values[%d]: expects a list of %d, one value for each key",
                            axis->name, i, axis->n_keys);
            continue;
        }
        for (int k = 0; k < axis->n_keys; k++) TRY(axis_read_value(axis, i, k, value->entry[k].value));
    }

    return STATUS_OK;
}

// ---- an axis of resolutions

/* Complain unless the values of an axis are different resolutions. */
static void axis_check_levels(const struct axis *axis, const struct yaml_node *node) {
    const struct sweep_axis *const into = axis->into;
    if (!axis->key[0]) return;

    if (!sweep_error_find(axis->key[0]->path)) {
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

    bool are_different = into->n_values >= MIN_LEVELS;
    for (int i = 0; i < into->n_values; i++) {
        for (int j = 0; j < i; j++) {
            const char *const one = into->value[i * into->n_keys], *const other = into->value[j * into->n_keys];
            double a, b;
            if (one && other && text_number(one, &a) && text_number(other, &b) && a == b) are_different = false;
        }
    }

    if (!are_different) {
        yaml_errors_add(axis->errors, node->mark, "%s.refine: expects at least %d values, all different", axis->name,
                        MIN_LEVELS);
    }
}

/* Read the boolean "steady" or "refine", which one axis of the sweep can have. */
static bool axis_read_trait(const struct axis *axis, const char *trait, const struct yaml_node *node) {
    const bool is_steady = strcmp(trait, "steady") == 0;
    char path[64];
    snprintf(path, sizeof path, "%s.%s", axis->name, trait);
    if (!yaml_tree_boolean(node, path, axis->errors)) return false;

    if (!is_steady) axis_check_levels(axis, node);
    for (int i = 0; i < axis->values->n_axes; i++) {
        const struct sweep_axis *const other = &axis->values->sweep[i];
        if (!(is_steady ? other->steady : other->refine)) continue;
        yaml_errors_add(axis->errors, node->mark, "%s: sweep[%d] is %s already; one axis can be", path, i,
                        is_steady ? "steady" : "refined");
    }
    return true;
}

static void axis_read_expect(const struct axis *axis, const struct yaml_node *expect) {
    char path[64];
    snprintf(path, sizeof path, "%s.expect", axis->name);
    if (expect->kind != YAML_MAP) {
        yaml_errors_add(axis->errors, expect->mark, "%s: expects {order: 2, within: 0.2}", path);
        return;
    }

    yaml_tree_check_keys(expect, path, "order, within, of", axis->errors);
    axis->into->order = yaml_tree_positive(expect, path, "order", 0, axis->errors);
    axis->into->within = yaml_tree_positive(expect, path, "within", 0, axis->errors);
    const struct yaml_node *const of = yaml_tree_find(expect, "of");
    if (of) axis->into->order_of = sweep_quantities_read(of, path, SWEEP_N_ORDERS, axis->errors);
}

/* Read the reference of a quantity for one fish: a number, or a point [x, y]; false for anything else. */
static bool axis_read_point(const struct yaml_node *node, int of_xy, double value[2]) {
    if (of_xy && (node->kind != YAML_LIST || node->n != 2)) return false;
    for (int k = 0; k < 1 + of_xy; k++) {
        const struct yaml_node *const number = of_xy ? node->entry[k].value : node;
        if (number->kind != YAML_SCALAR || !text_number(number->text, &value[k]) || isinf(value[k])) return false;
    }
    return true;
}

static enum status axis_read_reference(const struct axis *axis, const struct yaml_node *node) {
    char path[64];
    snprintf(path, sizeof path, "%s.reference", axis->name);

    if (node->kind != YAML_MAP || node->n == 0) {
        yaml_errors_add(axis->errors, node->mark, "%s: expects the values of quantities, as in {speed: 1.01}", path);
        return STATUS_OK;
    }

    const int n_fish = axis->values->school.n_fish, n = SWEEP_N_ORDERS * n_fish * 2;
    TRY(MEMORY_NEW(axis->into->reference, n, "the sweep"));
    for (int i = 0; i < n; i++) axis->into->reference[i] = NAN;

    for (int i = 0; i < node->n; i++) {
        const struct yaml_entry *const entry = &node->entry[i];
        const struct yaml_node *const list = entry->value;
        const int q = sweep_quantity_read(entry->key, entry->mark, path, SWEEP_N_ORDERS, axis->errors);
        if (q < 0) continue;

        // one value for all fish, or a list of one for each
        const int of_xy = sweep_quantities[q].of_xy;
        double *const to = axis->into->reference + (long)q * n_fish * 2, one[2];
        const bool is_one = axis_read_point(list, of_xy, one);
        bool is_good = is_one || (list->kind == YAML_LIST && list->n == n_fish);
        for (int f = 0; f < n_fish && is_good; f++) {
            is_good = axis_read_point(is_one ? list : list->entry[f].value, of_xy, to + 2 * f);
        }
        if (is_good) continue;
        yaml_errors_add(axis->errors, list->mark, "%s.%s: expects %s%s", path, entry->key,
                        of_xy ? "[x, y]" : "a number", n_fish > 1 ? ", or a list of one for each fish" : "");
    }

    return STATUS_OK;
}

// ---- the sweep

/* Read one axis into an entry that is zero. */
static enum status axis_read(struct axis *axis) {
    if (axis->node->kind != YAML_MAP) {
        yaml_errors_add(axis->errors, axis->node->mark, "%s: expects {key: PATH, values: [...]}", axis->name);
        return STATUS_OK;
    }

    yaml_tree_check_keys(axis->node, axis->name, "key, keys, values, refine, expect, reference, steady", axis->errors);
    TRY(axis_read_keys(axis));
    if (axis->n_keys == 0) return STATUS_OK;
    TRY(axis_read_values(axis));

    const struct yaml_node *const steady = yaml_tree_find(axis->node, "steady"),
                                  *const refine = yaml_tree_find(axis->node, "refine"),
                                  *const expect = yaml_tree_find(axis->node, "expect"),
                                  *const reference = yaml_tree_find(axis->node, "reference");
    axis->into->order = axis->into->within = NAN;
    if (steady) axis->into->steady = axis_read_trait(axis, "steady", steady);
    if (refine) axis->into->refine = axis_read_trait(axis, "refine", refine);
    if (expect && !axis->into->refine) {
        yaml_errors_add(axis->errors, expect->mark, "%s.expect: has no effect without refine: true", axis->name);
    }
    if (reference && !axis->into->refine) {
        yaml_errors_add(axis->errors, reference->mark, "%s.reference: has no effect without refine: true", axis->name);
    }
    if (expect) axis_read_expect(axis, expect);
    return reference ? axis_read_reference(axis, reference) : STATUS_OK;
}

/* Set the default of expected orders without `of`. Refuse quantities of runs if members are steady states, and
 * quantities of steady states if members are runs. */
static void sweep_check_orders(struct case_values *values, const struct yaml_node *sweep, struct yaml_errors *errors) {
    const uint64_t known = sweep_refine_orders(values);
    const bool is_steady = sweep_is_steady(values);
    const uint64_t standard =
        is_steady ? UINT64_C(1) << SWEEP_STEADY_SPEED : UINT64_C(1) << SWEEP_NOSE | UINT64_C(1) << SWEEP_TAIL;

    for (int a = 0; a < values->n_axes; a++) {
        struct sweep_axis *const axis = &values->sweep[a];
        if (axis->order_of == 0 && axis->order > 0) axis->order_of = standard;
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            if (!(axis->order_of & ~known & UINT64_C(1) << q)) continue;
            yaml_errors_add(errors, sweep->entry[a].value->mark, "sweep[%d].expect.of: %s is a quantity of %s", a,
                            sweep_quantities[q].name, is_steady ? "runs" : "steady states");
        }
    }
}

enum status sweep_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(root, "sweep");
    if (list && list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "sweep: expects a list of axes, each {key: PATH, values: [...]}");
        return STATUS_OK;
    }

    if (!list || list->n == 0) return STATUS_OK;
    TRY(MEMORY_NEW(values->sweep, list->n, "the sweep"));
    const int n_before = errors->n;
    double n_members = 1;

    for (int i = 0; i < list->n && n_members <= max_members; i++) {
        struct axis axis = {
            .values = values, .node = list->entry[i].value, .into = &values->sweep[i], .errors = errors};
        snprintf(axis.name, sizeof axis.name, "sweep[%d]", i);
        const enum status status = axis_read(&axis);
        n_members *= values->sweep[i].n_values;
        values->n_axes++;
        TRY(status);
    }

    if (n_members > max_members) {
        yaml_errors_add(errors, list->mark, "sweep: %.0f members or more; the maximum is %.0f", n_members, max_members);
    }
    if (errors->n == n_before) sweep_check_orders(values, list, errors);

    // do not count the members of axes with missing or too many values
    if (errors->n > n_before) sweep_free(values);
    return STATUS_OK;
}
