/* case_keys.c: prints the table of keys, as text and as JSON. */
#include <string.h>

#include "base/methods.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "case/sweep_quantity.h"

enum { METHOD_BYTES = 200 };

/* Describe a method: "explicit, order 2, fixed or adaptive steps: Heun's method". */
static void describe_method(const struct method_properties *method, char *text, size_t size) {
    const char *const steps = !method->has_fixed_steps      ? "adaptive"
                              : !method->has_adaptive_steps ? "fixed"
                                                            : "fixed or adaptive";
    snprintf(text, size, "%s, order %s%d, %s steps: %s", method->is_implicit ? "implicit" : "explicit",
             method == &methods_table[METHOD_IDA] ? "1 to " : "", method->order, steps, method->help);
}

static void print_text(FILE *stream, const struct key *key, const char *range) {
    const bool is_of_fish = case_table_is_of_fish(key);
    fprintf(stream, "%s%s: %s\n    %s%s%s%s%s; default: %s", is_of_fish ? "fish[i]" : "",
            is_of_fish ? key->path + strlen("fish") : key->path, key->meaning, case_table_type(key),
            *key->unit ? " in " : "", key->unit, *range ? ", " : "", range,
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
}

static void print_json(FILE *stream, const struct key *key, const char *range) {
    fprintf(stream, "{\"path\": \"%s\"", key->path);
    text_print_member(stream, ", ", "type", case_table_type(key));
    text_print_member(stream, ", ", "default", key->initial);
    text_print_member(stream, ", ", "derived", key->derived);
    text_print_member(stream, ", ", "published", key->published);
    text_print_member(stream, ", ", "range", range);
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
}

int case_keys(struct arena *arena, FILE *stream, bool as_json, const char *word) {
    int n = 0;
    for (const struct key *key = case_table; key < case_table + case_table_n; key++) {
        // the word may be in path, synonyms, words or meaning
        bool is_about = !word || text_contains(key->path, word) || text_contains(key->meaning, word) ||
                        (key->synonyms && text_contains(key->synonyms, word));
        for (int i = 0; !is_about && (key->words || key->type == METHOD) && case_table_word(key, i); i++) {
            is_about = text_contains(case_table_word(key, i), word);
        }
        if (!is_about) continue;

        struct text range = {.arena = arena};
        text_add(&range, "%s", "");
        case_table_range(key, &range);
        if (as_json) fprintf(stream, n > 0 ? ",\n " : "[");
        (as_json ? print_json : print_text)(stream, key, range.text);
        n++;
    }
    if (as_json) fprintf(stream, n > 0 ? "]\n" : "[]\n");
    return n;
}
