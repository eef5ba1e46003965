/* case_value.c: reads and writes a value of each type in the table of keys. */
#include "case/case_value.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case/case_table.h"

enum { MAX_VALUES = 10000 /* of one list */ };

/* A value being read, and the list that errors are added to. */
struct context {
    struct arena *arena; /* of the value */
    const struct key *key;
    const char *path;
    const char *unit; /* "" if part of the message */
    struct yaml_errors *errors;
};

/* "fish[0].length: expects a number in m, got 'long'" */
static void report_form(const struct context *context, const struct yaml_node *node, const char *form,
                        const char *unit) {
    char shown[64];
    yaml_errors_add(context->errors, node->mark, "%s: expects %s%s%s, got %s", context->path, form, *unit ? " in " : "",
                    unit, yaml_tree_describe(node, shown, sizeof shown));
}

// ---- numbers

/* Read one number, an integer for a key of integers. form: for messages, "a number" or "two numbers [x, y]".
 * is_bounded: the number must be in the range of the key. */
static bool read_number(const struct context *context, const struct yaml_node *node, const char *form, bool is_bounded,
                        double *value) {
    const struct bounds *const bounds = &context->key->bounds;
    const bool is_integer = context->key->type == INTEGER;
    double number;
    bool has_form = node->kind == YAML_SCALAR && text_number(node->text, &number);
    if (has_form && is_integer) {
        const char *const digits = node->text + (*node->text == '+' || *node->text == '-');
        has_form = digits[strspn(digits, "0123456789")] == '\0';
    }
    if (!has_form) {
        report_form(context, node, form, context->unit);
        return false;
    }

    if (isinf(number) && !is_integer) {
        yaml_errors_add(context->errors, node->mark, "%s: %.40s is too large a number", context->path, node->text);
        return false;
    }

    const bool is_low = bounds->is_min_open ? number <= bounds->min : number < bounds->min;
    const bool is_high = bounds->is_max_open ? number >= bounds->max : number > bounds->max;
    if (is_bounded && (is_low || is_high || (is_integer && (number < INT_MIN || number > INT_MAX)))) {
        struct text range = {.arena = context->errors->arena};
        case_table_range(context->key, &range);
        const char *const unit = context->key->unit;
        yaml_errors_add(context->errors, node->mark, "%s: must be %s%s%s, got %.40s", context->path,
                        range.text ? range.text : "in range", *unit ? " " : "", unit, node->text);
        return false;
    }

    *value = number;
    return true;
}

/* Turn the number before the word beat into a number: '3', '0.5' or '1/50'. */
static bool read_fraction(const char *text, size_t length, double *number) {
    char part[2][64] = {"", "1"};
    const char *const slash = memchr(text, '/', length);
    const size_t before = slash ? (size_t)(slash - text) : length, after = slash ? length - before - 1 : 0;
    if (before >= sizeof part[0] || after >= sizeof part[1]) return false;
    snprintf(part[0], sizeof part[0], "%.*s", (int)before, text);
    if (slash) snprintf(part[1], sizeof part[1], "%.*s", (int)after, slash + 1);
    double numerator, denominator;
    if (!text_number(part[0], &numerator) || !text_number(part[1], &denominator) || !(denominator > 0)) return false;
    *number = numerator / denominator;
    return true;
}

/* A number of seconds, or of beats: '3 beats', '1/50 beat'. */
static bool read_duration(const struct context *context, const struct yaml_node *node, struct duration *duration) {
    static const char form[] = "a number in s, or beats as in '20 beats' or '1/50 beat'";
    const char *const word = node->kind == YAML_SCALAR ? strchr(node->text, ' ') : NULL;
    double beats;
    struct context of_number = *context;
    of_number.unit = "";
    if (!word || (strcmp(word, " beats") != 0 && strcmp(word, " beat") != 0) ||
        !read_fraction(node->text, (size_t)(word - node->text), &beats)) {
        duration->is_in_beats = false;
        return read_number(&of_number, node, form, true, &duration->time);
    }

    char digits[TEXT_NUMBER_BYTES];
    text_of_number(digits, beats);
    struct yaml_node number = *node;
    number.text = digits;
    struct key in_beats = *context->key;
    in_beats.unit = "beats";
    of_number.key = &in_beats;
    duration->is_in_beats = true;
    return read_number(&of_number, &number, form, true, &duration->time);
}

// ---- words and strings

static bool read_word(const struct context *context, const struct yaml_node *node, int *value) {
    for (int i = 0; node->kind == YAML_SCALAR && case_table_word(context->key, i); i++) {
        if (strcmp(case_table_word(context->key, i), node->text) == 0) {
            *value = i;
            return true;
        }
    }

    char shown[64];
    struct text range = {.arena = context->errors->arena};
    case_table_range(context->key, &range);
    yaml_errors_add(context->errors, node->mark, "%s: expects one of %s; got %s", context->path,
                    range.text ? range.text : "", yaml_tree_describe(node, shown, sizeof shown));
    return false;
}

static bool read_string(const struct context *context, const struct yaml_node *node, char **value) {
    const char *const text = node->kind == YAML_SCALAR ? node->text : "";

    // refuse characters that end a line or move the cursor
    bool has_control = strstr(text, "\xC2\x85") || strstr(text, "\xE2\x80\xA8") || strstr(text, "\xE2\x80\xA9");
    for (const char *c = text; *c; c++) has_control |= (unsigned char)*c < ' ' || *c == 0x7F;

    if (*text == '\0') {
        report_form(context, node, "a string", "");
    } else if (has_control) {
        yaml_errors_add(context->errors, node->mark, "%s: must be one line without control characters", context->path);
    } else if ((double)strlen(text) > context->key->bounds.max) {
        yaml_errors_add(context->errors, node->mark, "%s: longer than %d bytes", context->path,
                        (int)context->key->bounds.max);
    } else {
        *value = arena_text(context->arena, "%s", text);
        return true;
    }
    return false;
}

// ---- pairs and lists

/* Read a list of n numbers. The bounds of a heading apply to the angle, not to the time, and those of a profile to the
 * value, not to the distance. of_row, of_number: the forms of the list and of a number, for messages. */
static bool read_row(const struct context *context, const struct yaml_node *node, const char *of_row,
                     const char *of_number, int n, double *value) {
    if (node->kind != YAML_LIST || node->n != n) {
        report_form(context, node, of_row, of_row == of_number ? context->unit : "");
        return false;
    }
    for (int k = 0; k < n; k++) {
        const bool is_place = (context->key->type == HEADING || context->key->type == PROFILE) && k == 0;
        if (!read_number(context, node->entry[k].value, of_number, !is_place, &value[k])) return false;
    }
    return true;
}

/* Read a list of numbers, of pairs, or of rows as long as the first. A heading may be one number: (0, angle); a profile
 * has pairs if its first entry is a list. */
static bool read_list(const struct context *context, const struct yaml_node *node, struct number_list *list) {
    const enum key_type type = context->key->type;
    const bool is_list = node->kind == YAML_LIST;
    char form[80] = "a number in degree or a list of [time in s, angle in degree]";
    if (is_list && node->n == 0) {
        if (type != HEADING) {
            *list = (struct number_list){0};
            return true;
        }
        yaml_errors_add(context->errors, node->mark, "%s: expects at least one pair [time in s, angle in degree]",
                        context->path);
        return false;
    }
    if (!is_list && type == HEADING) {
        double angle;
        if (!read_number(context, node, form, true, &angle)) return false;
        *list = (struct number_list){.n = 1};
        NEW(context->arena, list->value, 2);
        list->value[1] = angle;
        return true;
    }

    const struct yaml_node *const first = is_list ? node->entry[0].value : node;
    if (!is_list || (type == ROWS && (first->kind != YAML_LIST || first->n == 0))) {
        char shown[64];
        yaml_errors_add(context->errors, first->mark, "%s: expects a %s, got %s", context->path,
                        case_table_type(context->key), yaml_tree_describe(first, shown, sizeof shown));
        return false;
    }

    const bool are_numbers = type == NUMBERS || (type == PROFILE && first->kind != YAML_LIST);
    const int width = are_numbers ? 1 : type == ROWS ? first->n : 2;
    if (node->n > MAX_VALUES / (type == ROWS ? width : 1)) {
        yaml_errors_add(context->errors, node->mark, "%s: more than %d values", context->path, MAX_VALUES);
        return false;
    }

    const char *of_number = form;
    if (are_numbers) of_number = "a list of numbers";
    if (type == PAIRS) of_number = "a list of pairs [x, y]";
    if (type == PROFILE && !are_numbers) of_number = "a list of pairs [distance over length, value]";
    if (type == ROWS) {
        of_number = "rows of numbers";
        snprintf(form, sizeof form, "rows of %d numbers as the first", width);
    }

    double *value;
    NEW(context->arena, value, node->n * width);
    bool is_good = true;
    for (int i = 0; i < node->n; i++) {
        const struct yaml_node *const one = node->entry[i].value;
        is_good &= are_numbers
                       ? read_number(context, one, of_number, true, &value[i])
                       : read_row(context, one, type == ROWS ? form : of_number, of_number, width, &value[i * width]);
    }
    const bool has_width = type == ROWS || (type == PROFILE && !are_numbers);
    if (is_good) *list = (struct number_list){node->n, value, has_width ? width : 0};
    return is_good;
}

bool case_value_read(struct arena *arena, const struct key *key, void *field, const struct yaml_node *node,
                     const char *path, struct yaml_errors *errors) {
    const struct context context = {arena, key, path, key->type == HEADING ? "" : key->unit, errors};
    static const char of_pair[] = "two numbers [x, y]";
    double number[2];

    switch (key->type) {
        case REAL: return read_number(&context, node, "a number", true, field);
        case DURATION: return read_duration(&context, node, field);
        case INTEGER:
            if (!read_number(&context, node, "an integer", true, number)) return false;
            *(int *)field = (int)number[0];
            return true;
        case CHOICE:
        case METHOD: return read_word(&context, node, field);
        case STRING: return read_string(&context, node, field);
        case PAIR:
            if (!read_row(&context, node, of_pair, of_pair, 2, number)) return false;
            memcpy(field, number, sizeof number);
            return true;
        case NUMBERS:
        case PAIRS:
        case PROFILE:
        case ROWS:
        case HEADING: return read_list(&context, node, field);
        case FILES:
        case DEFAULTS:
        case AXES:
        case EXPECTATIONS:
        case ERRORS: break;
    }
    return false;
}

// ---- writing

static void write_row(struct text *text, int n, const double *value) {
    text_add(text, "[");
    for (int i = 0; i < n; i++) {
        if (i > 0) text_add(text, ", ");
        text_add_number(text, value[i]);
    }
    text_add(text, "]");
}

void case_value_write(struct text *text, const struct key *key, const void *field) {
    const struct number_list *const list = field;
    const int width = key->type == ROWS ? list->width : 2;
    switch (key->type) {
        case REAL:
        case DURATION: text_add_number(text, *(const double *)field); break;
        case INTEGER: text_add(text, "%d", *(const int *)field); break;
        case CHOICE:
        case METHOD: text_add(text, "%s", case_table_word(key, *(const int *)field)); break;
        case STRING: yaml_write_scalar(text, *(char *const *)field ? *(char *const *)field : ""); break;
        case PAIR: write_row(text, 2, field); break;
        case NUMBERS: write_row(text, list->n, list->value); break;
        case PROFILE:
            if (list->width != 2) {
                write_row(text, list->n, list->value);
                break;
            }
            /* fall through */
        case PAIRS:
        case ROWS:
        case HEADING:
            text_add(text, "[");
            for (int i = 0; i < list->n; i++) {
                if (i > 0) text_add(text, ", ");
                write_row(text, width, &list->value[i * width]);
            }
            text_add(text, "]");
            break;
        case FILES:
        case DEFAULTS:
        case AXES:
        case EXPECTATIONS:
        case ERRORS: break;
    }
}
