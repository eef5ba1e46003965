/* case_keys.c: the table of keys as text, as JSON and as a JSON schema. */
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

// ---- JSON schema: sections become objects, keys become properties

static void print_bound(FILE *stream, const char *name, double value) {
    if (isinf(value)) return;
    struct text number = {0};
    text_add_number(&number, value);
    fprintf(stream, ", \"%s\": %s", name, number.text ? number.text : "0");
    text_free(&number);
}

/* A number within the bounds of a key; an array of such numbers, n of them (0: any number). */
static void print_number(FILE *stream, const struct key *key, const char *type) {
    const struct bounds *const bounds = &key->bounds;
    fprintf(stream, "\"type\": \"%s\"", type);
    print_bound(stream, bounds->is_min_open ? "exclusiveMinimum" : "minimum", bounds->min);
    print_bound(stream, bounds->is_max_open ? "exclusiveMaximum" : "maximum", bounds->max);
}

static void print_list(FILE *stream, const struct key *key, int n) {
    fprintf(stream, "\"type\": \"array\", ");
    if (n > 0) fprintf(stream, "\"minItems\": %d, \"maxItems\": %d, ", n, n);
    fprintf(stream, "\"items\": {");
    print_number(stream, key, "number");
    fprintf(stream, "}");
}

// true and false without quotes are no strings to a reader of YAML
static void print_words(FILE *stream, const struct key *key) {
    fprintf(stream, "\"enum\": [");
    for (int i = 0; case_table_word(key, i); i++) {
        const char *const word = case_table_word(key, i);
        if (i > 0) fputs(", ", stream);
        text_print_json(stream, word);
        if (strcmp(word, "true") == 0 || strcmp(word, "false") == 0) fprintf(stream, ", %s", word);
    }
    fputc(']', stream);
}

/* The form of the keys with nested keys. */
static const char files[] = "\"type\": [\"string\", \"array\"], \"items\": {\"type\": \"string\"}";
static const char defaults[] =
    "\"type\": \"object\", \"additionalProperties\": false, \"properties\": {\"fish\": {\"$ref\": "
    "\"#/definitions/fish\"}}";
static const char axes[] =
    "\"type\": \"array\", \"items\": {\"type\": \"object\", \"additionalProperties\": false, \"required\": "
    "[\"values\"], \"properties\": {\"key\": {\"type\": \"string\"}, \"keys\": {\"type\": \"array\", \"items\": "
    "{\"type\": \"string\"}}, \"values\": {\"type\": \"array\", \"minItems\": 1}, \"refine\": {\"type\": \"boolean\"}, "
    "\"steady\": {\"type\": \"boolean\"}, \"expect\": {\"type\": \"object\"}, \"reference\": {\"type\": \"object\"}}}";
static const char errors[] =
    "\"type\": \"object\", \"additionalProperties\": false, \"properties\": {\"of\": {\"type\": [\"string\", "
    "\"array\"], "
    "\"items\": {\"type\": \"string\"}}, \"within\": {\"type\": \"number\", \"exclusiveMinimum\": 0}, \"most\": "
    "{\"type\": "
    "\"number\", \"exclusiveMinimum\": 0}, \"confirm\": {\"type\": \"boolean\"}, \"keys\": {\"type\": [\"string\", "
    "\"array\", \"object\"]}}";
static const char expectations[] = "\"type\": \"array\", \"items\": {\"type\": \"object\"}";

static void print_type(FILE *stream, const struct key *key) {
    switch (key->type) {
        case REAL: print_number(stream, key, "number"); break;
        case DURATION:
            fputs("\"anyOf\": [{", stream);
            print_number(stream, key, "number");
            fputs("}, {\"type\": \"string\", \"pattern\": \"^[0-9.eE+-]+ beats?$\"}]", stream);
            break;
        case INTEGER: print_number(stream, key, "integer"); break;
        case CHOICE:
        case METHOD: print_words(stream, key); break;
        case STRING: fputs("\"type\": [\"string\", \"number\"]", stream); break;
        case PAIR: print_list(stream, key, 2); break;
        case NUMBERS: print_list(stream, key, 0); break;
        case PAIRS:
        case ROWS:
            fputs("\"type\": \"array\", \"items\": {", stream);
            print_list(stream, key, key->type == PAIRS ? 2 : 0);
            fputs("}", stream);
            break;
        case HEADING:
            fputs("\"anyOf\": [{", stream);
            print_number(stream, key, "number");
            // the bounds apply to the angle, not to the time
            fputs("}, {\"type\": \"array\", \"items\": {\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, ",
                  stream);
            fputs("\"items\": [{\"type\": \"number\"}, {", stream);
            print_number(stream, key, "number");
            fputs("}]}}]", stream);
            break;
        case FILES: fputs(files, stream); break;
        case DEFAULTS: fputs(defaults, stream); break;
        case AXES: fputs(axes, stream); break;
        case EXPECTATIONS: fputs(expectations, stream); break;
        case ERRORS: fputs(errors, stream); break;
    }
}

static void print_key(FILE *stream, const struct key *key) {
    struct text meaning = {0};
    const char *const standard = key->derived ? key->derived : key->initial ? key->initial : "none: it is required";
    text_add(&meaning, "%s%s%s%s; default: %s", key->meaning, *key->unit ? " [" : "", key->unit, *key->unit ? "]" : "",
             standard);
    fputs("{\"description\": ", stream);
    text_print_json(stream, meaning.text ? meaning.text : "");
    fputs(", ", stream);
    print_type(stream, key);
    fputs("}", stream);
    text_free(&meaning);
}

/* The word after a section ("": the top, without fish) in the path of a key; NULL if the key is not in the section. */
static const char *word_in(const struct key *key, const char *section, size_t length) {
    if (length == 0) return case_table_is_of_fish(key) ? NULL : key->path;
    return strncmp(key->path, section, length) == 0 && key->path[length] == '.' ? key->path + length + 1 : NULL;
}

/* True if no previous key has the same word in the section. */
static bool is_first(const struct key *key, const char *section, size_t length) {
    const char *const word = word_in(key, section, length);
    const size_t n = strcspn(word, ".");
    for (const struct key *before = case_table; before < key; before++) {
        const char *const other = word_in(before, section, length);
        if (other && strcspn(other, ".") == n && strncmp(other, word, n) == 0) return false;
    }
    return true;
}

/* The object of a section: the keys, and each subsection at the place of the first key of the subsection. */
static void print_section(FILE *stream, const char *section, size_t length, int depth) {
    fputs("{\"type\": \"object\", \"additionalProperties\": false, \"properties\": {", stream);
    const char *comma = "";

    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        const char *const word = word_in(key, section, length);
        if (!word || !is_first(key, section, length)) continue;
        const size_t n = strcspn(word, ".");
        fprintf(stream, "%s\n%*s\"%.*s\": ", comma, 2 * depth, "", (int)n, word);
        comma = ",";
        if (word[n] == '.') {
            print_section(stream, key->path, (size_t)(word - key->path) + n, depth + 1);
        } else {
            print_key(stream, key);
        }
    }

    if (length == 0) {
        fputs(",\n  \"fish\": {\"description\": \"the fish of the school\", \"type\": \"array\", ", stream);
        fputs("\"items\": {\"$ref\": \"#/definitions/fish\"}}", stream);
    }

    fputs("}}", stream);
}

void case_schema(FILE *stream) {
    fputs(
        "{\"$schema\": \"http://json-schema.org/draft-07/schema#\", \"title\": \"a case of shoal\",\n"
        "\"definitions\": {\"fish\": ",
        stream);
    print_section(stream, "fish", strlen("fish"), 1);
    fputs("},\n\"allOf\": [", stream);
    print_section(stream, "", 0, 1);
    fputs("]}\n", stream);
}
