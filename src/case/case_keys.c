/* case_keys.c: the table of keys as text and as JSON. */
#include "case/case_keys.h"

#include <string.h>

#include "case/case_table.h"

/* What stands in the column "default". */
static const char *initial_text(const struct key *key) {
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

static void print_text(FILE *stream) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        struct text range = {0};
        case_table_range(key, &range);
        const bool has_range = range.length > 0;
        fprintf(stream, "%s%s: %s\n    %s%s%s%s%s; default: %s", fish_mark(key), fish_rest(key), key->meaning,
                case_table_type(key), *key->unit ? " in " : "", key->unit, has_range ? ", " : "",
                has_range ? range.text : "", initial_text(key));
        if (key->published) fprintf(stream, " (preset published: %s)", key->published);
        fprintf(stream, "\n");
        text_free(&range);
    }
}

/* Print a string of JSON, or null. */
static void print_string(FILE *stream, const char *name, const char *text) {
    fprintf(stream, ", \"%s\": ", name);
    if (!text) {
        fprintf(stream, "null");
        return;
    }
    fputc('"', stream);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') fputc('\\', stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
}

static void print_json(FILE *stream) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        struct text range = {0};
        case_table_range(key, &range);
        fprintf(stream, "%s{\"path\": \"%s\"", k > 0 ? ",\n " : "[", key->path);
        print_string(stream, "type", case_table_type(key));
        print_string(stream, "default", key->initial);
        print_string(stream, "derived", key->derived);
        print_string(stream, "published", key->published);
        print_string(stream, "range", range.text ? range.text : "");
        print_string(stream, "unit", key->unit);
        print_string(stream, "meaning", key->meaning);
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
