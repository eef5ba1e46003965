/* sweep.c: the axes of a study.
 *
 *     - {key: solver.rtol, values: [1e-4, 1e-5]}                                       one key
 *     - {keys: [fish[*].nodes, fish[*].sheet_points], values: [[7, 21], [13, 41]]}     two that change together
 *     - {key: "fish[*].body.modulus", values: [1e5, 1e6], relative_to: first}          results over those at 1e5
 *     - {key: ..., values: ..., refine: true,                                          resolutions
 *        reference: {speed: 1.014, nose: [-1.6, 0.01]},                                reference of errors and orders
 *        expect: {order: 2, within: 0.2, of: [nose, speed]}}
 *
 * Each value is checked as a value of the key, and stored as a string for --set. */
#include "case/sweep.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case/case_merge.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep_error.h"
#include "case/sweep_quantity.h"

enum { MAX_KEYS = 16 /* of one axis */, MIN_LEVELS = 3 /* of an axis of resolutions */ };
static const double max_members = 1e5;

/* An axis being read. */
struct axis {
    const struct case_values *values; /* with the axes read before */
    char name[32];                    /* "sweep[1]" */
    const struct yaml_node *node;
    struct sweep_axis *into;
    bool is_zipped; /* written with "keys" */
    bool is_start;  /* a key sets where or how fast a search starts */
    int n_keys;     /* as written; those that are wrong are NULL */
    const struct key *key[MAX_KEYS];
    struct yaml_errors *errors;
};

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

bool sweep_is_steady(const struct case_values *study) {
    bool is_steady = false;
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

const struct sweep_neighbours *sweep_member_neighbours(const struct case_values *study, int member) {
    const bool has_neighbours = study->n_axes == 1 && study->sweep[0].neighbours;
    return has_neighbours && study->sweep[0].neighbours[member].n > 0 ? &study->sweep[0].neighbours[member] : NULL;
}

bool sweep_member_is_start(const struct case_values *study, int member) {
    bool is_start = false;
    for (int m = 0; m < sweep_n_members(study); m++) {
        const struct sweep_neighbours *const neighbours = sweep_member_neighbours(study, m);
        is_start |= neighbours && neighbours->value[0] == member;
    }
    return is_start;
}

int sweep_find_value(const struct sweep_axis *axis, const char *wanted) {
    double number, value;
    if (strcmp(wanted, "first") == 0) return 0;
    for (int i = 0; i < axis->n_values; i++) {
        const char *const text = axis->value[i * axis->n_keys];
        const bool are_numbers = text_number(text, &value) && text_number(wanted, &number);
        if (are_numbers ? !(fabs(value - number) > 1e-12 * fabs(number)) : strcmp(text, wanted) == 0) return i;
    }
    return -1;
}

int sweep_member_reference(const struct case_values *study, int member) {
    int stride = 1;
    for (int a = study->n_axes - 1; a >= 0; a--) {
        const struct sweep_axis *const axis = &study->sweep[a];
        if (axis->is_relative) return member + (axis->relative_to - sweep_member_value(study, member, a)) * stride;
        stride *= axis->n_values;
    }
    return -1;
}

bool sweep_add_assignment(struct text *text, const struct sweep_axis *axis, int value, int k) {
    const char *const given = axis->value[value * axis->n_keys + k];
    if (!*given) return false;
    text_add(text, "%s%s=%s", text->length > 0 ? ", " : "", axis->key[k].path, given);
    return true;
}

char *sweep_member_text(struct arena *arena, const struct case_values *study, int member) {
    struct text list = {.arena = arena};
    text_add(&list, "%s", "");
    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys; k++) sweep_add_assignment(&list, &study->sweep[a], value, k);
    }
    return list.text;
}

uint64_t sweep_refine_orders(const struct case_values *study) {
    uint64_t all = 0;
    for (int q = 0; q < SWEEP_N_ORDERS; q++) {
        if (sweep_quantities[q].of_steady == sweep_is_steady(study)) all |= UINT64_C(1) << q;
    }
    return all;
}

double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy) {
    const double *const reference = study->sweep[axis].reference;
    return reference ? reference[((long)quantity * study->school.n_fish + fish) * 2 + xy] : NAN;
}

// ---- keys and values of an axis

/* Whether a steady state supplies the value of this key to the search that starts from it: of a fish (CASE_EVERY_FISH:
 * of any) that is free to move; the first fish keeps its position. */
static bool is_start(const struct school_parameters *school, const struct key *key, int fish) {
    const bool is_position = strcmp(key->path, "fish.start.position") == 0;
    if (!is_position && strcmp(key->path, "fish.start.speed") != 0) return false;
    for (int f = is_position ? 1 : 0; f < school->n_fish; f++) {
        const struct motion_parameters *const motion = &school->fish[f].motion;
        const bool is_free = motion->prescribed == PRESCRIBED_NONE || motion->surge == SURGE_FREE;
        if (is_free && (fish == CASE_EVERY_FISH || fish == f)) return true;
    }
    return false;
}

/* Read "key", or "keys"; the row of a wrong key in axis->key is NULL. */
static void axis_read_keys(struct axis *axis) {
    const struct yaml_node *const list = yaml_tree_find(axis->node, "keys"), *const single =
                                                                                 yaml_tree_find(axis->node, "key");
    struct yaml_errors *const errors = axis->errors;
    axis->is_zipped = list != NULL;
    if (list && (list->kind != YAML_LIST || list->n == 0 || list->n > MAX_KEYS)) {
        yaml_errors_add(errors, list->mark, "%s.keys: expects a list of 1 to %d paths", axis->name, MAX_KEYS);
        return;
    }
    if (list && single) yaml_errors_add(errors, single->mark, "%s: takes key or keys, not both", axis->name);

    const struct school_parameters *const school = &axis->values->school;
    const char **name;
    NEW(axis->values->arena, name, school->n_fish);
    for (int f = 0; f < school->n_fish; f++) name[f] = school->fish[f].name ? school->fish[f].name : "";

    axis->n_keys = list ? list->n : 1;
    NEW(axis->values->arena, axis->into->key, axis->n_keys);
    for (int n = 0; n < axis->n_keys; n++) {
        const struct yaml_node *const node = list ? list->entry[n].value : single;
        axis->into->n_keys++;
        if (!node || node->kind != YAML_SCALAR) {
            yaml_errors_add(errors, node ? node->mark : axis->node->mark,
                            "%s.key: expects the path of a key, as in \"fish[*].body.modulus\"", axis->name);
            continue;
        }

        struct case_path path;
        if (!case_path_parse(&path, node->text, school->n_fish, name, node->mark, errors)) continue;
        // a fish has one path in files, its number
        const char *const written =
            path.fish >= 0 ? arena_text(axis->values->arena, "fish[%d].%s", path.fish, path.below) : node->text;

        const struct key *const key = case_table_row(path.pattern);
        if (!key || !case_table_is_value(key) || strcmp(key->path, "format") == 0) {
            yaml_errors_add(errors, node->mark, "%s.key: '%.60s' cannot be swept", axis->name, node->text);
            continue;
        }

        // the keys of a fish replace those of defaults
        if (strncmp(node->text, "defaults.", 9) == 0) {
            yaml_errors_add(errors, node->mark,
                            "%s.key: '%.60s' cannot be swept, as a fish may set the key itself: write fish[*].%.60s",
                            axis->name, node->text, path.pattern + 5);
            continue;
        }

        // refuse a key that replaces all values of another axis, or of this one
        for (int i = 0; i <= axis->values->n_axes; i++) {
            const struct sweep_axis *const other = &axis->values->sweep[i];
            for (int k = 0; k < other->n_keys; k++) {
                if (!other->key[k].path || strcmp(other->key[k].row, key->path) != 0) continue;
                const bool is_of_all = path.fish == CASE_EVERY_FISH || school->n_fish == 1;
                if (!is_of_all && strcmp(other->key[k].path, written) != 0) continue;
                yaml_errors_add(errors, node->mark, "%s.key: sweep[%d] has this key too", axis->name, i);
            }
        }

        axis->key[n] = key;
        axis->is_start |= is_start(school, key, path.fish);
        axis->into->key[n] =
            (struct sweep_key){.path = arena_text(axis->values->arena, "%s", written),
                               .row = key->path,
                               .unit = key->unit,
                               .is_number = key->type == REAL || key->type == INTEGER || key->type == DURATION};
    }
}

/* Read the values: check each value as a value of the key, and store the text. */
static void axis_read_values(struct axis *axis) {
    struct arena *const arena = axis->values->arena;
    const struct yaml_node *const list = yaml_tree_find(axis->node, "values");
    if (!list || list->kind != YAML_LIST || list->n == 0) {
        yaml_errors_add(axis->errors, list ? list->mark : axis->node->mark,
                        "%s.values: expects a list of at least one value, as in [1, 2]", axis->name);
        return;
    }

    NEW(arena, axis->into->value, list->n * axis->n_keys);
    axis->into->n_values = list->n;
    for (int i = 0; i < list->n * axis->n_keys; i++) {
        const int row = i / axis->n_keys, k = i % axis->n_keys;
        const struct yaml_node *const all = list->entry[row].value;
        if (axis->is_zipped && (all->kind != YAML_LIST || all->n != axis->n_keys)) {
            if (k > 0) continue;
            yaml_errors_add(axis->errors, all->mark, "%s.values[%d]: expects a list of %d, one value for each key",
                            axis->name, row, axis->n_keys);
            continue;
        }

        const struct yaml_node *const value = axis->is_zipped ? all->entry[k].value : all;
        const struct key *const key = axis->key[k];
        if (key) {
            union {
                double number[2];
                struct duration duration;
                int integer;
                char *text;
                struct number_list list;
            } field;
            char path[256];
            snprintf(path, sizeof path, "%s.values[%d] (%s)", axis->name, row, key->path);
            const bool is_read = case_value_read(axis->errors->arena, key, &field, value, path, axis->errors);
            // beats are kept as a text
            if (is_read && key->type == DURATION && field.duration.is_in_beats) axis->into->key[k].is_number = false;
        }

        struct text text = {.arena = arena};
        yaml_write_node(&text, value);
        axis->into->value[i] = text.text;
    }
}

// ---- an axis of resolutions

/* Complain unless the values of an axis are different resolutions. */
static void axis_check_levels(const struct axis *axis, const struct yaml_node *node) {
    const struct sweep_axis *const into = axis->into;
    if (!axis->key[0]) return;

    const struct sweep_error_key *const found = sweep_error_find(axis->key[0]->path);
    if (!found || (found->kind == SWEEP_MODEL && strncmp(found->path, "fish.", 5) == 0)) {
        struct text known = {.arena = axis->errors->arena};
        for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
            const char *const path = sweep_error_keys[i].path;
            const bool is_of_fish = strncmp(path, "fish.", 5) == 0;
            if (is_of_fish && sweep_error_keys[i].kind == SWEEP_MODEL) continue;
            text_add(&known, "%s%s%s", i > 0 ? ", " : "", is_of_fish ? "fish[*]" : "", is_of_fish ? path + 4 : path);
        }
        yaml_errors_add(axis->errors, node->mark, "%s.refine: '%.60s' is not a resolution; these are: %s", axis->name,
                        into->key[0].path, known.text);
        return;
    }

    // orders need the sizes of the levels
    if (axis->key[0]->type == DURATION && !into->key[0].is_number) {
        yaml_errors_add(axis->errors, node->mark, "%s.refine: expects values of '%.60s' in s, not in beats", axis->name,
                        into->key[0].path);
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

/* Read the reference of a quantity for one fish: a number, or a point [x, y]; false for anything else. */
static bool axis_read_point(const struct yaml_node *node, bool of_xy, double value[2]) {
    if (of_xy && (node->kind != YAML_LIST || node->n != 2)) return false;
    for (int k = 0; k < 1 + of_xy; k++) {
        const struct yaml_node *const number = of_xy ? node->entry[k].value : node;
        if (number->kind != YAML_SCALAR || !text_number(number->text, &value[k]) || isinf(value[k])) return false;
    }
    return true;
}

static void axis_read_reference(const struct axis *axis, const struct yaml_node *node) {
    char path[64];
    snprintf(path, sizeof path, "%s.reference", axis->name);

    if (node->kind != YAML_MAP || node->n == 0) {
        yaml_errors_add(axis->errors, node->mark, "%s: expects the values of quantities, as in {speed: 1.01}", path);
        return;
    }

    const int n_fish = axis->values->school.n_fish, n = SWEEP_N_ORDERS * n_fish * 2;
    NEW(axis->values->arena, axis->into->reference, n);
    for (int i = 0; i < n; i++) axis->into->reference[i] = NAN;

    for (int i = 0; i < node->n; i++) {
        const struct yaml_entry *const entry = &node->entry[i];
        const struct yaml_node *const list = entry->value;
        const int q = sweep_quantity_read(entry->key, entry->mark, path, SWEEP_N_ORDERS, axis->errors);
        if (q < 0) continue;

        // one value for all fish, or a list of one for each
        const bool of_xy = sweep_quantities[q].of_xy;
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
}

// ---- the sweep

/* Read one axis into an entry that is zero. */
static void axis_read(struct axis *axis) {
    struct yaml_errors *const errors = axis->errors;
    struct sweep_axis *const into = axis->into;
    if (axis->node->kind != YAML_MAP) {
        yaml_errors_add(errors, axis->node->mark, "%s: expects {key: PATH, values: [...]}", axis->name);
        return;
    }

    yaml_tree_check_keys(axis->node, axis->name, "key, keys, values, refine, expect, reference, steady, relative_to",
                         errors);
    axis_read_keys(axis);
    if (axis->n_keys == 0) return;
    axis_read_values(axis);

    // "steady" and "refine", each of one axis of the sweep
    for (int t = 0; t < 2; t++) {
        const bool is_steady = t == 0;
        const char *const trait = is_steady ? "steady" : "refine";
        const struct yaml_node *const node = yaml_tree_find(axis->node, trait);
        char path[64];
        snprintf(path, sizeof path, "%s.%s", axis->name, trait);
        if (!node || !yaml_tree_boolean(node, path, errors)) continue;
        *(is_steady ? &into->steady : &into->refine) = true;
        if (!is_steady) axis_check_levels(axis, node);
        for (int i = 0; i < axis->values->n_axes; i++) {
            const struct sweep_axis *const other = &axis->values->sweep[i];
            if (!(is_steady ? other->steady : other->refine)) continue;
            yaml_errors_add(errors, node->mark, "%s: sweep[%d] is %s already; one axis can be", path, i,
                            is_steady ? "steady" : "refined");
        }
    }

    // the state of another value would replace the start that is swept
    if (into->steady && axis->is_start) {
        NEW(axis->values->arena, into->before, into->n_values);
        for (int i = 0; i < into->n_values; i++) into->before[i] = -1;
    }

    // the value that the results are compared with
    const struct yaml_node *const relative = yaml_tree_find(axis->node, "relative_to");
    if (relative) {
        struct text wanted = {.arena = axis->errors->arena};
        yaml_write_node(&wanted, relative);
        into->is_relative = true;
        into->relative_to = sweep_find_value(into, relative->kind == YAML_SCALAR ? relative->text : wanted.text);
        if (into->relative_to < 0) {
            yaml_errors_add(errors, relative->mark, "%s.relative_to: %.60s is neither `first` nor a value of %.60s",
                            axis->name, wanted.text, into->key[0].path);
        }
    }
    for (int i = 0; i < axis->values->n_axes && relative; i++) {
        if (!axis->values->sweep[i].is_relative) continue;
        yaml_errors_add(errors, relative->mark, "%s.relative_to: sweep[%d] has it already; one axis can", axis->name,
                        i);
    }

    // the expected order
    const struct yaml_node *const expect = yaml_tree_find(axis->node, "expect"), *const reference = yaml_tree_find(
                                                                                     axis->node, "reference");
    char path[64];
    snprintf(path, sizeof path, "%s.expect", axis->name);
    if (expect && !into->refine) yaml_errors_add(errors, expect->mark, "%s: has no effect without refine: true", path);
    if (expect && expect->kind != YAML_MAP) {
        yaml_errors_add(errors, expect->mark, "%s: expects {order: 2, within: 0.2}", path);
    } else if (expect) {
        yaml_tree_check_keys(expect, path, "order, within, of", errors);
        into->order = yaml_tree_positive(expect, path, "order", 0, errors);
        into->within = yaml_tree_positive(expect, path, "within", 0, errors);
        const struct yaml_node *const of = yaml_tree_find(expect, "of");
        if (of) into->order_of = sweep_quantities_read(of, path, SWEEP_N_ORDERS, errors);
    }

    if (reference && !into->refine) {
        yaml_errors_add(errors, reference->mark, "%s.reference: has no effect without refine: true", axis->name);
    }
    if (reference) axis_read_reference(axis, reference);
}

void sweep_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const list = yaml_tree_find(root, "sweep");
    if (list && list->kind != YAML_LIST) {
        yaml_errors_add(errors, list->mark, "sweep: expects a list of axes, each {key: PATH, values: [...]}");
        return;
    }

    if (!list || list->n == 0) return;
    NEW(values->arena, values->sweep, list->n);
    const int n_before = errors->n;
    double n_members = 1;
    for (int i = 0; i < list->n && n_members <= max_members; i++) {
        struct axis axis = {
            .values = values, .node = list->entry[i].value, .into = &values->sweep[i], .errors = errors};
        snprintf(axis.name, sizeof axis.name, "sweep[%d]", i);
        axis_read(&axis);
        n_members *= values->sweep[i].n_values;
        values->n_axes++;
    }

    if (n_members > max_members) {
        yaml_errors_add(errors, list->mark, "sweep: %.0f members or more; the maximum is %.0f", n_members, max_members);
    }

    // the default of expected orders; refuse quantities of runs for steady states, and of steady states for runs
    const uint64_t known = sweep_refine_orders(values);
    const bool is_steady = sweep_is_steady(values);
    const uint64_t standard =
        is_steady ? UINT64_C(1) << SWEEP_STEADY_SPEED : UINT64_C(1) << SWEEP_NOSE | UINT64_C(1) << SWEEP_TAIL;
    const int n_after = errors->n;
    for (int a = 0; a < values->n_axes && n_after == n_before; a++) {
        struct sweep_axis *const axis = &values->sweep[a];
        if (axis->order_of == 0) axis->order_of = standard;
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            if (!(axis->order_of & ~known & UINT64_C(1) << q)) continue;
            yaml_errors_add(errors, list->entry[a].value->mark, "sweep[%d].expect.of: %s is a quantity of %s", a,
                            sweep_quantities[q].name, is_steady ? "runs" : "steady states");
        }
    }

    // do not count the members of axes with missing or too many values
    if (errors->n > n_before) values->n_axes = 0;
}
