/* text.c: strings that grow, and numbers that ignore the locale. */
#include "base/text.h"

#include <float.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_add(struct text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0) return;

    // enlarge for the addition and a zero
    if (text->length + (size_t)length >= text->capacity) {
        text->capacity = 2 * (text->length + (size_t)length) + 64;
        GROW(text->arena, text->text, text->capacity);
    }

    va_start(arguments, format);
    vsnprintf(text->text + text->length, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text->length += (size_t)length;
}

void text_print_json(FILE *stream, const char *string) {
    if (!string) {
        fputs("null", stream);
        return;
    }

    fputc('"', stream);
    for (; *string; string++) {
        if ((unsigned char)*string < ' ') {
            fprintf(stream, "\\u%04x", *string);
        } else {
            if (*string == '"' || *string == '\\') fputc('\\', stream);
            fputc(*string, stream);
        }
    }

    fputc('"', stream);
}

void text_print_member(FILE *stream, const char *before, const char *name, const char *string) {
    fprintf(stream, "%s\"%s\": ", before, name);
    text_print_json(stream, string);
}

void text_print_csv(FILE *stream, const char *string) {
    fputc('"', stream);
    for (; *string; string++) {
        if (*string == '"') fputc('"', stream);
        fputc(*string, stream);
    }
    fputc('"', stream);
}

void text_print_clean(FILE *stream, const char *string) {
    for (const unsigned char *c = (const unsigned char *)string; *c; c++) {
        // U+0080 to U+009F are control characters too
        const bool is_second = c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0;
        const bool is_control = (*c < ' ' && *c != '\n' && *c != '\t') || *c == 0x7f;
        if (is_second) fprintf(stream, "\\x%02x", *c++);

        if (is_second || is_control) {
            fprintf(stream, "\\x%02x", *c);
        } else {
            fputc(*c, stream);
        }
    }
}

/* Switch this thread to the "C" locale; pass the result to restore_locale. */
static locale_t use_c_locale(locale_t *c_locale) {
    *c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return uselocale(*c_locale);
}

static void restore_locale(locale_t before, locale_t c_locale) {
    uselocale(before);
    if (c_locale) freelocale(c_locale);
}

void text_of_number(char text[TEXT_NUMBER_BYTES], double number) {
    locale_t c_locale;
    const locale_t before = use_c_locale(&c_locale);
    for (int precision = 15; precision <= 17; precision++) {
        snprintf(text, TEXT_NUMBER_BYTES, "%.*g", precision, number);
        if (strtod(text, NULL) == number) break;
    }
    restore_locale(before, c_locale);
}

void text_add_number(struct text *text, double number) {
    char digits[TEXT_NUMBER_BYTES];
    text_of_number(digits, number);
    text_add(text, "%s", digits);
}

double text_round(double number) {
    // with the decimal point of any locale
    char digits[40];
    snprintf(digits, sizeof digits, "%.12g", number);
    const double decimal = strtod(digits, NULL);
    return fabs(decimal - number) <= 2 * DBL_EPSILON * fabs(number) ? decimal : number;
}

void text_add_word(struct text *text, const char *word) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=@_";
    if (*word && word[strspn(word, plain)] == '\0') {
        text_add(text, "%s", word);
        return;
    }

    // between quotes only a quote ends the word
    text_add(text, "'");
    for (const char *at = word; *at;) {
        const size_t n = strcspn(at, "'");
        text_add(text, "%.*s%s", (int)n, at, at[n] ? "'\\''" : "");
        at += n + (at[n] != '\0');
    }
    text_add(text, "'");
}

bool text_number(const char *text, double *number) {
    // an optional sign, digits with at most one point, and an optional exponent
    static const char digits[] = "0123456789";
    const char *at = text + (*text == '+' || *text == '-');
    const size_t n = strspn(at, digits), n_after = at[n] == '.' ? strspn(at + n + 1, digits) : 0;
    at += n + (at[n] == '.') + n_after;
    if (n + n_after == 0) return false;
    if (*at == 'e' || *at == 'E') {
        at += 1 + (at[1] == '+' || at[1] == '-');
        if (strspn(at, digits) == 0) return false;
        at += strspn(at, digits);
    }
    if (*at != '\0') return false;

    locale_t c_locale;
    const locale_t before = use_c_locale(&c_locale);
    *number = strtod(text, NULL);
    restore_locale(before, c_locale);
    return true;
}

void text_duration(char text[TEXT_DURATION_BYTES], double seconds) {
    static const struct {
        double seconds;
        const char *name;
    } units[] = {{86400, "days"}, {3600, "h"}, {60, "min"}, {0, "s"}};
    int i = 0;
    while (seconds < 1.5 * units[i].seconds) i++;

    // two significant digits, without an exponent below 1e9
    char digits[TEXT_DURATION_BYTES];
    snprintf(digits, sizeof digits, "%.1e", seconds / fmax(units[i].seconds, 1));
    snprintf(text, TEXT_DURATION_BYTES, "%.9g %s", strtod(digits, NULL), units[i].name);
}

void text_print_base64(FILE *stream, size_t n, const void *bytes) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *const from = bytes;
    for (size_t i = 0; i < n; i += 3) {
        const unsigned second = i + 1 < n ? from[i + 1] : 0, third = i + 2 < n ? from[i + 2] : 0;
        const unsigned all = (unsigned)from[i] << 16 | second << 8 | third;
        fputc(letters[all >> 18], stream);
        fputc(letters[all >> 12 & 63], stream);
        fputc(i + 1 < n ? letters[all >> 6 & 63] : '=', stream);
        fputc(i + 2 < n ? letters[all & 63] : '=', stream);
    }
}

static char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

int text_distance(const char *a, size_t n, const char *b, size_t m) {
    enum { WORD = 40 };
    if (n > WORD || m > WORD) return INT_MAX;
    int d[WORD + 1][WORD + 1];
    for (size_t i = 0; i <= n; i++) d[i][0] = (int)i;
    for (size_t j = 0; j <= m; j++) d[0][j] = (int)j;

    for (size_t i = 1; i <= n; i++) {
        for (size_t j = 1; j <= m; j++) {
            const int change = d[i - 1][j - 1] + (lower_case(a[i - 1]) != lower_case(b[j - 1]));
            const int gap = (d[i - 1][j] < d[i][j - 1] ? d[i - 1][j] : d[i][j - 1]) + 1;
            d[i][j] = change < gap ? change : gap;
            const bool is_swap = i > 1 && j > 1 && lower_case(a[i - 1]) == lower_case(b[j - 2]) &&
                                 lower_case(a[i - 2]) == lower_case(b[j - 1]);
            if (is_swap && d[i - 2][j - 2] + 1 < d[i][j]) d[i][j] = d[i - 2][j - 2] + 1;
        }
    }

    return d[n][m];
}

bool text_contains(const char *text, const char *word) {
    for (; *text; text++) {
        size_t i = 0;
        while (word[i] && lower_case(text[i]) == lower_case(word[i])) i++;
        if (!word[i]) return true;
    }
    return !*word;
}
