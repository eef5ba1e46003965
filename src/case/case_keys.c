/* case_keys.c: the table of keys as text and as JSON. */
#include "case/case_keys.h"

#include <string.h>

#include "base/methods.h"
#include "case/case_table.h"
#include "case/sweep_quantity.h"

enum { METHOD_BYTES = 200 };

/* The text of the column "default". */
static const char *default_text(const struct key *key) {
    if (key->derived) return key->derived;
    return key->initial ? key->initial : "required";
}

/* The path of a key as a user writes it. */
static const char *fish_mark(const struct key *key) {
    return case_table_is_of_fish(key) ? "fish[i]" : "";
}

static const char *fish_rest(const struct key *key) {
    return case_table_is_of_fish(key) ? key->path + strlen("fish") : key->path;
}

/* Describe a method: "explicit, order 2, fixed or adaptive steps: Heun's method". */
static void describe_method(const struct method_properties *method, char *text, size_t size) {
    const char *const steps = !method->has_fixed_steps      ? "adaptive"
                              : !method->has_adaptive_steps ? "fixed"
                                                            : "fixed or adaptive";
    snprintf(text, size, "%s, order %s%d, %s steps: %s", method->is_implicit ? "implicit" : "explicit",
             method == &methods_table[METHOD_IDA] ? "1 to " : "", method->order, steps, method->help);
}

static void print_methods(FILE *stream) {
    for (int i = 0; i < methods_n; i++) {
        char text[METHOD_BYTES];
        describe_method(&methods_table[i], text, sizeof text);
        fprintf(stream, "    %s: %s\n", methods_table[i].word, text);
    }
}

static void print_text(FILE *stream) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        struct text range = {0};
        case_table_range(key, &range);
        const bool has_range = range.length > 0;
        fprintf(stream, "%s%s: %s\n    %s%s%s%s%s; default: %s", fish_mark(key), fish_rest(key), key->meaning,
                case_table_type(key), *key->unit ? " in " : "", key->unit, has_range ? ", " : "",
                has_range ? range.text : "", default_text(key));
        if (key->published) fprintf(stream, " (preset published: %s)", key->published);
        fprintf(stream, "\n");
        if (key->type == METHOD) print_methods(stream);
        text_free(&range);
    }
}

/* Print a member of an object of JSON: a string, or null. */
static void print_string(FILE *stream, const char *before, const char *name, const char *text) {
    fprintf(stream, "%s\"%s\": ", before, name);
    text_print_json(stream, text);
}

/* Add "words", the meaning of each method, to a key. */
static void print_words(FILE *stream) {
    fprintf(stream, ", \"words\": {");
    for (int i = 0; i < methods_n; i++) {
        char text[METHOD_BYTES];
        describe_method(&methods_table[i], text, sizeof text);
        print_string(stream, i > 0 ? ", " : "", methods_table[i].word, text);
    }
    fprintf(stream, "}");
}

/* Add "orders" and "quantities", all names with and without orders of convergence, to a key. */
static void print_quantities(FILE *stream) {
    for (int q = 0; q < SWEEP_N_QUANTITIES; q++) {
        const char *const before = q == 0 ? ", \"orders\": [" : q == SWEEP_N_ORDERS ? "], \"quantities\": [" : ", ";
        fprintf(stream, "%s\"%s\"", before, sweep_quantities[q].name);
    }
    fprintf(stream, "]");
}

static void print_json(FILE *stream) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        struct text range = {0};
        case_table_range(key, &range);
        fprintf(stream, "%s{\"path\": \"%s\"", k > 0 ? ",\n " : "[", key->path);
        print_string(stream, ", ", "type", case_table_type(key));
        print_string(stream, ", ", "default", key->initial);
        print_string(stream, ", ", "derived", key->derived);
        print_string(stream, ", ", "published", key->published);
        print_string(stream, ", ", "range", range.text ? range.text : "");
        print_string(stream, ", ", "unit", key->unit);
        print_string(stream, ", ", "meaning", key->meaning);
        if (key->type == METHOD) print_words(stream);
        if (key->type == EXPECTATIONS) print_quantities(stream);
        fprintf(stream, "}");
        text_free(&range);
    }

    fprintf(stream, "]\n");
}

void case_keys(FILE *stream, int as_json) {
    if (as_json) {
        print_json(stream);
    } else {
        print_text(stream);
    }
}
