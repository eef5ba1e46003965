/* case_show.c: prints a case, row by row of the table, and then its sweep. */
#include <math.h>
#include <string.h>

#include "case/case.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep.h"
#include "case/sweep_error.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"
#include "case/yaml_tree.h"

enum { COMMENT_COLUMN = 40 };

/* Add every row of the table that belongs to a fish, or with fish NULL every row that belongs to none. */
static void show_rows(struct text *text, struct case_values *values, struct fish_parameters *fish) {
    const char *before = NULL;
    const int f = fish ? (int)(fish - values->school.fish) : 0;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (case_table_is_of_fish(key) != (fish != NULL)) continue;
        const void *const field = case_table_field(key, values, fish);

        // skip keys that are applied already, and keys without a value
        if (!case_table_is_value(key) || strcmp(key->path, "preset") == 0) continue;
        if (*case_table_state(values, key, f) == KEY_WITHOUT_VALUE) continue;
        if ((key->type == NUMBERS || key->type == PROFILE || key->type == ROWS) &&
            ((const struct number_list *)field)->n == 0)
            continue;

        // the headings of the sections that do not contain the previous key
        const char *const below = key->path + (fish ? strlen("fish.") : 0), *name = below;
        int depth = 0;
        for (const char *dot; (dot = strchr(name, '.')); name = dot + 1, depth++) {
            if (before && strncmp(key->path, before, (size_t)(dot + 1 - key->path)) == 0) continue;
            if (!fish && depth == 0) text_add(text, "\n");
            text_add(text, "%*s%.*s:\n", 2 * depth + (fish ? 4 : 0), "", (int)(dot - name), name);
        }

        // indentation, key, value, unit
        const size_t begin = text->length;
        const bool is_first_of_fish = fish && !before;
        const int indent = 2 * depth + (fish ? 4 : 0);
        text_add(text, "%*s%s%s: ", is_first_of_fish ? indent - 2 : indent, "", is_first_of_fish ? "- " : "", name);
        const struct case_beats *const beats = case_table_in_beats(values, key, f);
        // a time that was rounded is shown in seconds, because the interval that it was rounded to is now given
        const double in_seconds = beats ? text_round(beats->n * case_table_beat(values, key, f)) : 0;
        const bool is_as_given = beats && !beats->is_default && !(fabs(in_seconds - *(const double *)field) > 0);
        if (is_as_given) {
            text_add_number(text, beats->n);
            text_add(text, fabs(beats->n - 1) > 0 ? " beats" : " beat");
        } else {
            case_value_write(text, key, field);
        }
        if (*key->unit) {
            const size_t used = text->length - begin;
            text_add(text, "%*s# ", used < COMMENT_COLUMN ? (int)(COMMENT_COLUMN - used) : 2, "");
            if (is_as_given) {
                case_value_write(text, key, field);
                text_add(text, " ");
            }
            text_add(text, "%s", key->unit);
        }
        text_add(text, "\n");
        before = key->path;
    }
}

/* Add "[a, b]", or "a" without brackets if there is only one. */
static void show_group(struct text *text, const struct sweep_axis *axis, int value) {
    if (axis->n_keys > 1) text_add(text, "[");
    for (int k = 0; k < axis->n_keys; k++) {
        if (k > 0) text_add(text, ", ");
        if (value < 0) {
            yaml_write_scalar(text, axis->key[k].path);
        } else {
            text_add(text, "%s", axis->value[value * axis->n_keys + k]);
        }
    }

    if (axis->n_keys > 1) text_add(text, "]");
}

/* Add "[nose, tail]". */
static void show_quantities(struct text *text, uint64_t all) {
    const char *before = "[";
    for (int q = 0; q < SWEEP_N_QUANTITIES; q++) {
        if (!(all >> q & 1)) continue;
        text_add(text, "%s%s", before, sweep_quantities[q].name);
        before = ", ";
    }
    text_add(text, "]");
}

static void show_axis(struct text *text, const struct case_values *values, int a) {
    const struct sweep_axis *const axis = &values->sweep[a];
    text_add(text, "  - %s: ", axis->n_keys > 1 ? "keys" : "key");
    show_group(text, axis, -1);
    text_add(text, "\n    values: [");
    for (int i = 0; i < axis->n_values; i++) {
        if (i > 0) text_add(text, ", ");
        show_group(text, axis, i);
    }

    text_add(text, "]\n");
    if (axis->steady) text_add(text, "    steady: true\n");
    if (axis->is_relative) {
        text_add(text, "    relative_to: %s\n",
                 axis->relative_to == 0 ? "first" : axis->value[axis->relative_to * axis->n_keys]);
    }
    if (!axis->refine) return;
    text_add(text, "    refine: true\n");

    // the reference values, one for each fish: {speed: [1, 1.1], nose: [[0, 1], [0, 2]]}
    const char *before = "    reference: {";
    for (int q = 0; q < SWEEP_N_ORDERS && axis->reference; q++) {
        const bool of_xy = sweep_quantities[q].of_xy;
        if (isnan(sweep_reference(values, a, q, 0, 0))) continue;
        text_add(text, "%s%s: [", before, sweep_quantities[q].name);
        before = ", ";
        for (int f = 0; f < values->school.n_fish; f++) {
            text_add(text, "%s%s", f > 0 ? ", " : "", of_xy ? "[" : "");
            text_add_number(text, sweep_reference(values, a, q, f, 0));
            if (of_xy) text_add(text, ", ");
            if (of_xy) text_add_number(text, sweep_reference(values, a, q, f, 1));
            if (of_xy) text_add(text, "]");
        }
        text_add(text, "]");
    }
    if (axis->reference) text_add(text, "}\n");

    if (!(axis->order > 0)) return;
    text_add(text, "    expect: {order: ");
    text_add_number(text, axis->order);
    text_add(text, ", within: ");
    text_add_number(text, axis->within);
    text_add(text, ", of: ");
    show_quantities(text, axis->order_of);
    text_add(text, "}\n");
}

static void show_expectation(struct text *text, const struct case_values *values, const struct sweep_expectation *one) {
    text_add(text, one->fails ? "  - {fails: " : "  - {of: ");
    if (one->fails) {
        yaml_write_scalar(text, one->fails);
    } else {
        show_quantities(text, one->of);
    }
    if (one->fish >= 0) {
        text_add(text, ", fish: ");
        yaml_write_scalar(text, values->school.fish[one->fish].name);
    }

    for (int c = 0; c < one->n_where; c++) {
        const struct sweep_condition *const condition = &one->where[c];
        text_add(text, "%s", c == 0 ? ", where: [" : ", ");
        yaml_write_scalar(text, arena_text(text->arena, "%s=%s",
                                           values->sweep[condition->axis].key[condition->key].path, condition->value));
    }

    if (one->n_where > 0) text_add(text, "]");
    const struct {
        const char *name;
        double value;
    } bounds[] = {{"least", one->min}, {"most", one->max}, {"spread", one->spread}, {"ratio", one->ratio}};
    for (int b = 0; b < 4 && !one->fails; b++) {
        if (isinf(bounds[b].value)) continue;
        text_add(text, ", %s: ", bounds[b].name);
        text_add_number(text, bounds[b].value);
    }
    text_add(text, "}\n");
}

char *case_show(struct arena *arena, const struct case_values *values) {
    struct case_values all = *values;  // shallow copy for the offsets of the table
    struct text list = {.arena = arena};
    show_rows(&list, &all, NULL);
    text_add(&list, "\nfish:\n");
    for (int i = 0; i < all.school.n_fish; i++) show_rows(&list, &all, &all.school.fish[i]);

    if (values->n_axes > 0) text_add(&list, "\nsweep:\n");
    for (int i = 0; i < values->n_axes; i++) show_axis(&list, values, i);
    if (values->error) {
        text_add(&list, "\nerror: ");
        sweep_error_write(&list, values->error);
        text_add(&list, "\n");
    }
    if (values->n_expectations > 0) text_add(&list, "\nexpect:\n");
    for (int i = 0; i < values->n_expectations; i++) show_expectation(&list, values, &values->expect[i]);
    return list.text;
}

// ---- a case to start from

const char case_template[] =
    "# A case of shoal: one fish that swims from rest. `shoal keys` explains all keys, `shoal keys WORD` those about "
    "a\n"
    "# word; a key that is not given has its default, which `shoal show` prints.\n"
    "#\n"
    "#   shoal check FILE     errors, warnings, cost        shoal view RESULT.nc   a page for the browser\n"
    "#   shoal run FILE       run it                        shoal steady FILE      its steady state\n"
    "format: 1\n"
    "time:\n"
    "  end: 5                 # s\n"
    "  output_interval: 0.1   # s, between two rows of the result\n"
    "fluid:\n"
    "  density: 1000          # kg m-3\n"
    "  velocity: [0, 0]       # m s-1, of the stream\n"
    "fish:\n"
    "  - name: fish\n"
    "    length: 1            # m\n"
    "    force: pressure      # or reactive: for slender bodies, 0.6 of the time\n"
    "    start:\n"
    "      position: [0, 0]   # m, of the nose\n"
    "      heading: 180       # degree: 0 is along x, 180 to the left\n"
    "      speed: 0           # m s-1\n"
    "    wave:\n"
    "      amplitude: 0.4     # rad, of the angle by which the muscle bends the body\n"
    "      frequency: 1       # Hz\n"
    "    body:\n"
    "      modulus: 1.5e6     # Pa, Young's modulus: stiffer or softer body\n"
    "  # a second fish half a length to the side:\n"
    "  # - {name: other, start: {position: [0, 0.5]}}\n"
    "\n"
    "# a study instead of one run (`shoal study FILE`): a member for each value\n"
    "# sweep: [{key: \"fish[*].wave.frequency\", values: [0.5, 1, 2]}]\n";
