/* case_fixture.h: What the tests of cases share: texts with and without sweeps, their parsing, and the comparison of
 * two cases. */
#ifndef CASE_FIXTURE_H
#define CASE_FIXTURE_H

#include <string.h>

#include "case/case.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"
#include "near.h"

static const char minimal[] = "format: 1\ntime: {end: 3}\nfish: [{}]\n";

/* A sweep, one with keys that change together, one with a reference, and one with expectations. */
static const char swept[] =
    "format: 1\ntime: {end: 1}\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - {key: 'fish[*].body.modulus', values: [1e4, 1e6, 1.0e+8]}\n"
    "  - {key: 'fish[1].start.position', values: [[0, 1], [0, 2]]}\n"
    "  - {key: sheet.kutta, values: [edge, rate]}\n";

static const char zipped[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - {key: time.shedding_interval, values: [0.1, 0.05, 0.025], refine: true, expect: {order: 2, within: 0.2}}\n"
    "  - {keys: ['fish[*].nodes', 'fish[1].name'], values: [[7, thin], [9, 'a: b']]}\n";

static const char refined[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - key: solver.rtol\n"
    "    values: [1e-3, 1e-4, 1e-5]\n"
    "    refine: true\n"
    "    reference: {speed: 1.25, nose: [[1, 2], [3, 4]], com: [5, 6], mean_heading: [7, 8]}\n"
    "    expect: {order: 0.8, within: 0.2, of: [speed, com]}\n";

static const char stated[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{name: a}, {name: 'b: c'}]\n"
    "sweep:\n"
    "  - {keys: [solver.method, solver.rtol], values: [[ida, 1e-3], [rk4, 1e-4], [ida, 1e-4]]}\n"
    "  - {key: 'fish[1].start.position', values: [[0, 1], [0, 2]]}\n"
    "expect:\n"
    "  - {of: speed, fish: 'b: c', least: 1, most: 2, ratio: 3}\n"
    "  - {of: [nose, tail], spread: 0, where: ['solver.rtol=0.0001', 'fish[1].start.position=[0,2]']}\n"
    "  - {of: steps, least: -1, where: [solver.method=ida]}\n"
    "  - {fails: 'is: unstable', where: [solver.rtol=1e-3, 'fish[1].start.position=[0, 2]', solver.method=rk4,\n"
    "      solver.method=ida]}\n";

/* The values until the end of the test. */
static inline struct case_values kept(struct case_values values) {
    arena_move(values.arena, test_arena());
    return values;
}

/* Parse a case that must be good, with up to three assignments (NULL: none). Released at the end of the test. */
static inline struct case_values parse_with(const char *text, const char *first, const char *second,
                                            const char *third) {
    const char *const assignments[] = {first, second, third};
    int n = 0;
    while (n < 3 && assignments[n]) n++;
    struct case_values values;
    const enum status status = case_parse(&values, text, strlen(text), "cases/x.yaml", NULL, n, assignments);
    if (status != STATUS_OK) fail_msg("%s", status_message());
    return kept(values);
}

static inline struct case_values parse(const char *text) {
    return parse_with(text, NULL, NULL, NULL);
}

/* The same for a file, and for a member of a study. */
static inline struct case_values read_file(const char *path) {
    struct case_values values;
    if (case_read(&values, path, 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    return kept(values);
}

static inline struct case_values member_of(const struct case_values *study, int member) {
    struct case_values values;
    if (case_member(&values, study, member) != STATUS_OK) fail_msg("%s", status_message());
    return kept(values);
}

/* The fields of two axes are the same. */
static inline void axes_are_equal(const struct case_values *one, const struct case_values *other, int i) {
    const struct sweep_axis *const a = &one->sweep[i], *const b = &other->sweep[i];
    assert_int_equal(a->n_keys, b->n_keys);
    for (int k = 0; k < a->n_keys; k++) assert_string_equal(a->key[k].path, b->key[k].path);
    assert_int_equal(a->refine, b->refine);
    assert_memory_equal(&a->order, &b->order, sizeof(double));
    assert_memory_equal(&a->within, &b->within, sizeof(double));
    assert_int_equal(a->order_of, b->order_of);
    assert_int_equal(a->reference != NULL, b->reference != NULL);
    for (int k = 0; a->reference && k < SWEEP_N_ORDERS * one->school.n_fish * 2; k++) {
        assert_true(a->reference[k] == b->reference[k] || (isnan(a->reference[k]) && isnan(b->reference[k])));
    }
    assert_int_equal(a->n_values, b->n_values);
    for (int j = 0; j < a->n_values * a->n_keys; j++) assert_string_equal(a->value[j], b->value[j]);
}

/* The fields of two expectations are the same. */
static inline void expectations_are_equal(const struct sweep_expectation *a, const struct sweep_expectation *b) {
    assert_int_equal(a->of, b->of);
    assert_int_equal(a->fails != NULL, b->fails != NULL);
    if (a->fails) assert_string_equal(a->fails, b->fails);
    assert_int_equal(a->fish, b->fish);
    assert_int_equal(a->n_where, b->n_where);
    for (int c = 0; c < a->n_where; c++) {
        assert_int_equal(a->where[c].axis, b->where[c].axis);
        assert_int_equal(a->where[c].key, b->where[c].key);
        assert_string_equal(a->where[c].value, b->where[c].value);
    }
    const double from[] = {a->min, a->max, a->spread, a->ratio}, to[] = {b->min, b->max, b->spread, b->ratio};
    for (int k = 0; k < 4; k++) assert_true(from[k] == to[k] || (isnan(from[k]) && isnan(to[k])));
}

/* Every value of two cases is the same, bit for bit: written as text with all digits they are. */
static inline void are_equal(struct case_values *one, struct case_values *other) {
    assert_int_equal(one->school.n_fish, other->school.n_fish);
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (strcmp(key->path, "preset") == 0 || strcmp(key->path, "output.file") == 0) continue;
        for (int i = 0; i < (case_table_is_of_fish(key) ? one->school.n_fish : 1); i++) {
            struct text a = {.arena = test_arena()}, b = {.arena = test_arena()};
            text_add(&a, "%s: ", key->path);
            text_add(&b, "%s: ", key->path);
            case_value_write(&a, key, case_table_field(key, one, &one->school.fish[i]));
            case_value_write(&b, key, case_table_field(key, other, &other->school.fish[i]));
            assert_string_equal(a.text, b.text);
        }
    }
    assert_int_equal(one->n_axes, other->n_axes);
    for (int i = 0; i < one->n_axes; i++) axes_are_equal(one, other, i);
    assert_int_equal(one->n_expectations, other->n_expectations);
    for (int i = 0; i < one->n_expectations; i++) expectations_are_equal(&one->expect[i], &other->expect[i]);
}

#endif
