/* yaml_text.c: text that grows, numbers without a locale, quotes where they are needed. */
#include "yaml_text.h"

#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "yaml_tree.h"

/* Make room for more bytes and a zero. */
static bool grow(struct yaml_text *text, size_t more) {
    if (text->failed) return false;
    if (text->length + more < text->capacity) return true;
    const size_t capacity = 2 * (text->length + more) + 64;
    char *const grown = realloc(text->text, capacity);
    if (!grown) {
        text->failed = true;
        return false;
    }
    text->text = grown;
    text->capacity = capacity;
    return true;
}

void yaml_text_add(struct yaml_text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0 || !grow(text, (size_t)length)) return;
    va_start(arguments, format);
    vsnprintf(text->text + text->length, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text->length += (size_t)length;
}

void yaml_text_free(struct yaml_text *text) {
    free(text->text);
    *text = (struct yaml_text){0};
}

/* Take the "C" locale for this thread; hand the result to restore_locale. */
static locale_t take_c_locale(locale_t *c_locale) {
    *c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return uselocale(*c_locale);
}

static void restore_locale(locale_t before, locale_t c_locale) {
    uselocale(before);
    if (c_locale) freelocale(c_locale);
}

void yaml_text_add_number(struct yaml_text *text, double number) {
    locale_t c_locale;
    const locale_t before = take_c_locale(&c_locale);
    char digits[40];
    for (int precision = 15; precision <= 17; precision++) {
        snprintf(digits, sizeof digits, "%.*g", precision, number);
        if (strtod(digits, NULL) == number) break;
    }
    restore_locale(before, c_locale);
    yaml_text_add(text, "%s", digits);
}

/* Skip decimal digits and count them. */
static int skip_digits(const char **text) {
    int n = 0;
    for (; **text >= '0' && **text <= '9'; (*text)++) n++;
    return n;
}

/* True for: sign, digits with a point among them, exponent; no more and no less. */
static bool is_number(const char *text) {
    if (*text == '+' || *text == '-') text++;
    int n = skip_digits(&text);
    if (*text == '.') {
        text++;
        n += skip_digits(&text);
    }
    if (n == 0) return false;
    if (*text == 'e' || *text == 'E') {
        text++;
        if (*text == '+' || *text == '-') text++;
        if (skip_digits(&text) == 0) return false;
    }
    return *text == '\0';
}

bool yaml_text_number(const char *text, double *number) {
    if (!is_number(text)) return false;
    locale_t c_locale;
    const locale_t before = take_c_locale(&c_locale);
    *number = strtod(text, NULL);
    restore_locale(before, c_locale);
    return true;
}

/* True for the characters that mean nothing to YAML, in any place. */
static bool is_ordinary(char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return letter || (c >= '0' && c <= '9') || (c != '\0' && strchr("_./+-", c));
}

/* True if a text can stand in YAML without quotes, also inside [ ] and { }. */
static bool is_plain(const char *scalar) {
    if (!is_ordinary(*scalar) || strcmp(scalar, "-") == 0 || strncmp(scalar, "- ", 2) == 0) return false;
    if (strncmp(scalar, "---", 3) == 0 || strncmp(scalar, "...", 3) == 0) return false;
    for (const char *c = scalar; *c; c++) {
        const bool inner_blank = *c == ' ' && c[1] != '\0';
        if (!is_ordinary(*c) && !inner_blank) return false;
    }
    return true;
}

void yaml_text_add_scalar(struct yaml_text *text, const char *scalar) {
    if (is_plain(scalar)) {
        yaml_text_add(text, "%s", scalar);
        return;
    }
    yaml_text_add(text, "\"");
    for (const char *c = scalar; *c; c++) {
        const unsigned char byte = (unsigned char)*c;
        if (*c == '"' || *c == '\\') {
            yaml_text_add(text, "\\%c", *c);
        } else if (byte < ' ' || byte == 0x7F) {
            yaml_text_add(text, "\\x%02X", byte);
        } else {
            yaml_text_add(text, "%c", *c);
        }
    }
    yaml_text_add(text, "\"");
}

void yaml_text_add_node(struct yaml_text *text, const struct yaml_node *node) {
    if (node->kind == YAML_SCALAR) {
        yaml_text_add_scalar(text, node->text);
        return;
    }
    yaml_text_add(text, node->kind == YAML_LIST ? "[" : "{");
    for (int i = 0; i < node->n; i++) {
        if (i > 0) yaml_text_add(text, ", ");
        if (node->kind == YAML_MAP) {
            yaml_text_add_scalar(text, node->entry[i].key);
            yaml_text_add(text, ": ");
        }
        yaml_text_add_node(text, node->entry[i].value);
    }
    yaml_text_add(text, node->kind == YAML_LIST ? "]" : "}");
}
