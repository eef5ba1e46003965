/* case_keys.c: the table of keys as text and as JSON. */
#include <math.h>
#include <string.h>

#include "base/methods.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"

enum { METHOD_BYTES = 200 };

/* Describe a method: "explicit, order 2, fixed or adaptive steps: Heun's method". */
static void describe_method(const struct method_properties *method, char *text, size_t size) {
    const char *const steps = !method->has_fixed_steps      ? "adaptive"
                              : !method->has_adaptive_steps ? "fixed"
                                                            : "fixed or adaptive";
    snprintf(text, size, "%s, order %s%d, %s steps: %s", method->is_implicit ? "implicit" : "explicit",
             method == &methods_table[METHOD_IDA] ? "1 to " : "", method->order, steps, method->help);
}

/* Whether a word is in path, synonyms, words or meaning of a key. */
static bool is_about(const struct key *key, const char *word) {
    if (!word || text_contains(key->path, word) || text_contains(key->meaning, word)) return true;
    if (key->synonyms && text_contains(key->synonyms, word)) return true;
    for (int i = 0; (key->words || key->type == METHOD) && case_table_word(key, i); i++) {
        if (text_contains(case_table_word(key, i), word)) return true;
    }
    return false;
}

static int keys_print_text(FILE *stream, const char *about) {
    int n = 0;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (!is_about(key, about)) continue;
        n++;
        const bool is_of_fish = case_table_is_of_fish(key);
        struct text range = {0};
        case_table_range(key, &range);
        const bool has_range = range.length > 0;
        fprintf(stream, "%s%s: %s\n    %s%s%s%s%s; default: %s", is_of_fish ? "fish[i]" : "",
                is_of_fish ? key->path + strlen("fish") : key->path, key->meaning, case_table_type(key),
                *key->unit ? " in " : "", key->unit, has_range ? ", " : "", has_range ? range.text : "",
                key->derived   ? key->derived
                : key->initial ? key->initial
                               : "required");
        if (key->published) fprintf(stream, " (preset published: %s)", key->published);
        fprintf(stream, "\n");

        for (int i = 0; i < methods_n && key->type == METHOD; i++) {
            char text[METHOD_BYTES];
            describe_method(&methods_table[i], text, sizeof text);
            fprintf(stream, "    %s: %s\n", methods_table[i].word, text);
        }
        text_free(&range);
    }
    return n;
}

static int keys_print_json(FILE *stream, const char *about) {
    int n = 0;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (!is_about(key, about)) continue;
        struct text range = {0};
        case_table_range(key, &range);
        fprintf(stream, "%s{\"path\": \"%s\"", n++ > 0 ? ",\n " : "[", key->path);
        text_print_member(stream, ", ", "type", case_table_type(key));
        text_print_member(stream, ", ", "default", key->initial);
        text_print_member(stream, ", ", "derived", key->derived);
        text_print_member(stream, ", ", "published", key->published);
        text_print_member(stream, ", ", "range", range.text ? range.text : "");
        text_print_member(stream, ", ", "unit", key->unit);
        text_print_member(stream, ", ", "meaning", key->meaning);

        // "words": the meaning of each method
        for (int i = 0; i < methods_n && key->type == METHOD; i++) {
            char text[METHOD_BYTES];
            describe_method(&methods_table[i], text, sizeof text);
            text_print_member(stream, i > 0 ? ", " : ", \"words\": {", methods_table[i].word, text);
        }
        if (key->type == METHOD) fprintf(stream, "}");

        // "orders" and "quantities": the names of quantities with and without orders of convergence
        for (int q = 0; q < SWEEP_N_QUANTITIES && key->type == EXPECTATIONS; q++) {
            const char *const before = q == 0 ? ", \"orders\": [" : q == SWEEP_N_ORDERS ? "], \"quantities\": [" : ", ";
            fprintf(stream, "%s\"%s\"", before, sweep_quantities[q].name);
        }
        if (key->type == EXPECTATIONS) fprintf(stream, "]");

        fprintf(stream, "}");
        text_free(&range);
    }

    fprintf(stream, n > 0 ? "]\n" : "[]\n");
    return n;
}

int case_keys(FILE *stream, int as_json, const char *word) {
    return as_json ? keys_print_json(stream, word) : keys_print_text(stream, word);
}
