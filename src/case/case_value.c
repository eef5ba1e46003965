/* case_value.c: reading, writing and releasing each type of the key table. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "case/case_table.h"

enum { MAX_VALUES = 10000 /* of one list */ };

/* A value being read, and the list that errors are added to. */
struct context {
    const struct key *key;
    const char *path;
    const char *unit; /* "" if part of the message */
    struct yaml_errors *errors;
};

void case_value_clear(const struct key *key, void *field) {
    switch (key->type) {
        case REAL: *(double *)field = NAN; break;
        case DURATION: *(struct duration *)field = (struct duration){NAN, NAN}; break;
        case PAIR: ((double *)field)[0] = ((double *)field)[1] = NAN; break;
        case INTEGER: *(int *)field = 0; break;
        case CHOICE:
        case METHOD: *(int *)field = -1; break;
        case STRING: *(char **)field = NULL; break;
        case NUMBERS:
        case PAIRS:
        case ROWS:
        case HEADING: *(struct number_list *)field = (struct number_list){0}; break;
        case FILES:
        case DEFAULTS:
        case AXES:
        case EXPECTATIONS:
        case ERRORS: break;
    }
}

void case_value_free(const struct key *key, void *field) {
    if (key->type == STRING) free(*(char **)field);
    const bool is_list = key->type == NUMBERS || key->type == PAIRS || key->type == ROWS || key->type == HEADING;
    if (is_list) free(((struct number_list *)field)->value);
    case_value_clear(key, field);
}

/* "time.end: expects a number in s, got 'soon'" */
static void report_form(const struct context *context, const struct yaml_node *node, const char *form,
                        const char *unit) {
    char shown[64];
    yaml_errors_add(context->errors, node->mark, "%s: expects %s%s%s, got %s", context->path, form, *unit ? " in " : "",
                    unit, yaml_tree_describe(node, shown, sizeof shown));
}

// ---- numbers

/* "must be above 0 m, got '-1'" */
static void report_range(const struct context *context, const struct yaml_node *node) {
    struct text range = {0};
    case_table_range(context->key, &range);
    const char *const unit = context->key->unit;
    yaml_errors_add(context->errors, node->mark, "%s: must be %s%s%s, got %.40s", context->path,
                    range.text ? range.text : "in range", *unit ? " " : "", unit, node->text);
    if (range.failed) context->errors->out_of_memory = true;
    text_free(&range);
}

static bool is_in(const struct bounds *bounds, double value) {
    if (bounds->is_min_open ? value <= bounds->min : value < bounds->min) return false;
    return bounds->is_max_open ? value < bounds->max : value <= bounds->max;
}

/* Read one number. what: the form for messages, "a number" or "two numbers [x, y]". */
static bool read_any(const struct context *context, const struct yaml_node *node, const char *what, double *value) {
    double number;
    if (node->kind != YAML_SCALAR || !text_number(node->text, &number)) {
        report_form(context, node, what, context->unit);
        return false;
    }

    if (isinf(number)) {
        yaml_errors_add(context->errors, node->mark, "%s: %.40s is too large a number", context->path, node->text);
        return false;
    }

    *value = number;
    return true;
}

/* The same in the range of the key. */
static bool value_read_number(const struct context *context, const struct yaml_node *node, const char *what,
                              double *value) {
    double number;
    if (!read_any(context, node, what, &number)) return false;
    if (!is_in(&context->key->bounds, number)) {
        report_range(context, node);
        return false;
    }
    *value = number;
    return true;
}

/* A number of seconds, or of beats: '3 beats', '1 beat'. */
static void read_duration(const struct context *context, const struct yaml_node *node, struct duration *duration) {
    static const char form[] = "a number in s, or a number of beats as in '3 beats'";
    const char *const word = node->kind == YAML_SCALAR ? strchr(node->text, ' ') : NULL;
    char digits[64];
    if (!word || (strcmp(word, " beats") != 0 && strcmp(word, " beat") != 0) ||
        (size_t)(word - node->text) >= sizeof digits) {
        const struct context in_seconds = {context->key, context->path, "", context->errors};
        value_read_number(&in_seconds, node, form, &duration->seconds);
        return;
    }
    snprintf(digits, sizeof digits, "%.*s", (int)(word - node->text), node->text);
    struct yaml_node number = *node;
    number.text = digits;
    struct key in_beats = *context->key;
    in_beats.unit = "beats";
    const struct context of_number = {&in_beats, context->path, "", context->errors};
    value_read_number(&of_number, &number, form, &duration->beats);
}

/* True for a sign and digits only. */
static bool has_digits_only(const char *text) {
    if (*text == '+' || *text == '-') text++;
    return *text != '\0' && strspn(text, "0123456789") == strlen(text);
}

static void read_integer(const struct context *context, const struct yaml_node *node, int *value) {
    double number;
    if (node->kind != YAML_SCALAR || !has_digits_only(node->text) || !text_number(node->text, &number)) {
        report_form(context, node, "an integer", "");
    } else if (!is_in(&context->key->bounds, number) || number < INT_MIN || number > INT_MAX) {
        report_range(context, node);
    } else {
        *value = (int)number;
    }
}

// ---- words and strings

static void read_choice(const struct context *context, const struct yaml_node *node, int *value) {
    const struct key *const key = context->key;
    for (int i = 0; node->kind == YAML_SCALAR && case_table_word(key, i); i++) {
        if (strcmp(case_table_word(key, i), node->text) == 0) {
            *value = i;
            return;
        }
    }

    char shown[64];
    struct text range = {0};
    case_table_range(key, &range);
    if (range.failed) context->errors->out_of_memory = true;
    yaml_errors_add(context->errors, node->mark, "%s: expects one of %s; got %s", context->path,
                    range.text ? range.text : "", yaml_tree_describe(node, shown, sizeof shown));
    text_free(&range);
}

/* True for strings with characters that end a line or move the cursor. */
static bool has_control(const char *text) {
    for (const char *c = text; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 0x7F) return true;
    }
    return strstr(text, "\xC2\x85") || strstr(text, "\xE2\x80\xA8") || strstr(text, "\xE2\x80\xA9");
}

static enum status value_read_string(const struct context *context, const struct yaml_node *node, char **value) {
    if (node->kind != YAML_SCALAR || node->text[0] == '\0') {
        report_form(context, node, "a string", "");
    } else if (has_control(node->text)) {
        yaml_errors_add(context->errors, node->mark, "%s: must be one line without control characters", context->path);
    } else if ((double)strlen(node->text) > context->key->bounds.max) {
        yaml_errors_add(context->errors, node->mark, "%s: longer than %d bytes", context->path,
                        (int)context->key->bounds.max);
    } else {
        return memory_copy_string(value, node->text, context->path);
    }
    return STATUS_OK;
}

// ---- pairs and lists

/* Read [a, b]. */
static bool read_pair(const struct context *context, const struct yaml_node *node, const char *what, double value[2]) {
    if (node->kind != YAML_LIST || node->n != 2) {
        report_form(context, node, what, context->unit);
        return false;
    }

    double pair[2];

    // the bounds apply to the angles, not to the times
    const bool has_time = context->key->type == HEADING;
    if (!(has_time ? read_any : value_read_number)(context, node->entry[0].value, what, &pair[0])) return false;
    if (!value_read_number(context, node->entry[1].value, what, &pair[1])) return false;
    value[0] = pair[0];
    value[1] = pair[1];
    return true;
}

/* Read a list of numbers or of pairs. */
static enum status value_read_list(const struct context *context, const struct yaml_node *node,
                                   struct number_list *list) {
    char shown[64];
    if (node->kind != YAML_LIST) {
        yaml_errors_add(context->errors, node->mark, "%s: expects a %s, got %s", context->path,
                        case_table_type(context->key), yaml_tree_describe(node, shown, sizeof shown));
        return STATUS_OK;
    }

    if (node->n > MAX_VALUES) {
        yaml_errors_add(context->errors, node->mark, "%s: more than %d values", context->path, MAX_VALUES);
        return STATUS_OK;
    }

    if (node->n == 0) return STATUS_OK;
    double *value;
    TRY(MEMORY_NEW(value, 2 * node->n, context->path));
    const enum key_type type = context->key->type;
    const char *const form = type == NUMBERS ? "a list of numbers"
                             : type == PAIRS ? "a list of pairs [x, y]"
                                             : "a number in degree or a list of [time in s, angle in degree]";
    bool is_good = true;
    for (int i = 0; i < node->n; i++) {
        const struct yaml_node *const one = node->entry[i].value;
        is_good &= type == NUMBERS ? value_read_number(context, one, form, &value[i])
                                   : read_pair(context, one, form, &value[2 * i]);
    }

    if (is_good) {
        *list = (struct number_list){.n = node->n, .value = value};
    } else {
        free(value);
    }
    return STATUS_OK;
}

/* Read a list of rows of numbers, all as long as the first. */
static enum status read_rows(const struct context *context, const struct yaml_node *node, struct number_list *list) {
    if (node->kind == YAML_LIST && node->n == 0) return STATUS_OK;
    const struct yaml_node *const first = node->kind == YAML_LIST ? node->entry[0].value : node;

    if (node->kind != YAML_LIST || first->kind != YAML_LIST || first->n == 0) {
        char shown[64];
        yaml_errors_add(context->errors, first->mark, "%s: expects a %s, got %s", context->path,
                        case_table_type(context->key), yaml_tree_describe(first, shown, sizeof shown));
        return STATUS_OK;
    }

    const int width = first->n;
    if (node->n > MAX_VALUES / width) {
        yaml_errors_add(context->errors, node->mark, "%s: more than %d values", context->path, MAX_VALUES);
        return STATUS_OK;
    }

    double *value;
    TRY(MEMORY_NEW(value, node->n * width, context->path));
    bool is_good = true;
    for (int i = 0; i < node->n; i++) {
        const struct yaml_node *const row = node->entry[i].value;
        bool is_row = row->kind == YAML_LIST && row->n == width;
        if (!is_row) {
            char shown[64];
            yaml_errors_add(context->errors, row->mark, "%s: expects rows of %d numbers as the first, got %s",
                            context->path, width, yaml_tree_describe(row, shown, sizeof shown));
        }
        for (int k = 0; k < width && is_row; k++) {
            is_row = value_read_number(context, row->entry[k].value, "rows of numbers", &value[i * width + k]);
        }
        is_good &= is_row;
    }

    if (is_good) {
        *list = (struct number_list){node->n, value, width};
    } else {
        free(value);
    }
    return STATUS_OK;
}

/* Read a number, or a list of [time, angle]. */
static enum status read_heading(const struct context *context, const struct yaml_node *node, struct number_list *list) {
    if (node->kind == YAML_LIST && node->n == 0) {
        yaml_errors_add(context->errors, node->mark, "%s: expects at least one pair [time in s, angle in degree]",
                        context->path);
        return STATUS_OK;
    }

    if (node->kind == YAML_LIST) return value_read_list(context, node, list);
    double angle;
    if (!value_read_number(context, node, "a number in degree or a list of [time in s, angle in degree]", &angle)) {
        return STATUS_OK;
    }
    double *pair;
    TRY(MEMORY_NEW(pair, 2, context->path));
    pair[1] = angle;
    *list = (struct number_list){.n = 1, .value = pair};
    return STATUS_OK;
}

enum status case_value_read(const struct key *key, void *field, const struct yaml_node *node, const char *path,
                            struct yaml_errors *errors) {
    const char *const unit = key->type == HEADING ? "" : key->unit;
    const struct context context = {key, path, unit, errors};

    switch (key->type) {
        case REAL: value_read_number(&context, node, "a number", field); break;
        case DURATION: read_duration(&context, node, field); break;
        case INTEGER: read_integer(&context, node, field); break;
        case CHOICE:
        case METHOD: read_choice(&context, node, field); break;
        case STRING: return value_read_string(&context, node, field);
        case PAIR: read_pair(&context, node, "two numbers [x, y]", field); break;
        case NUMBERS:
        case PAIRS: return value_read_list(&context, node, field);
        case ROWS: return read_rows(&context, node, field);
        case HEADING: return read_heading(&context, node, field);
        case FILES:
        case DEFAULTS:
        case AXES:
        case EXPECTATIONS:
        case ERRORS: break;
    }

    return STATUS_OK;
}

// ---- writing

static void write_pair(struct text *text, const double pair[2]) {
    text_add(text, "[");
    text_add_number(text, pair[0]);
    text_add(text, ", ");
    text_add_number(text, pair[1]);
    text_add(text, "]");
}

static void value_write_list(struct text *text, const struct number_list *list, bool is_of_pairs) {
    text_add(text, "[");
    for (int i = 0; i < list->n; i++) {
        if (i > 0) text_add(text, ", ");
        if (is_of_pairs) {
            write_pair(text, &list->value[2 * i]);
        } else {
            text_add_number(text, list->value[i]);
        }
    }

    text_add(text, "]");
}

static void value_write_rows(struct text *text, const struct number_list *list) {
    for (int i = 0; i < list->n; i++) {
        text_add(text, i == 0 ? "[" : ", ");
        value_write_list(text, &(struct number_list){.n = list->width, .value = &list->value[i * list->width]}, false);
    }
    text_add(text, list->n > 0 ? "]" : "[]");
}

void case_value_write(struct text *text, const struct key *key, const void *field) {
    switch (key->type) {
        case REAL: text_add_number(text, *(const double *)field); break;
        case DURATION: text_add_number(text, ((const struct duration *)field)->seconds); break;
        case INTEGER: text_add(text, "%d", *(const int *)field); break;
        case CHOICE:
        case METHOD: text_add(text, "%s", case_table_word(key, *(const int *)field)); break;
        case STRING: yaml_write_scalar(text, *(char *const *)field); break;
        case PAIR: write_pair(text, field); break;
        case NUMBERS: value_write_list(text, field, false); break;
        case ROWS: value_write_rows(text, field); break;
        case PAIRS:
        case HEADING: value_write_list(text, field, true); break;
        case FILES:
        case DEFAULTS:
        case AXES:
        case EXPECTATIONS:
        case ERRORS: break;
    }
}
