/* text.h: strings that grow, and numbers as strings and back. Tested by tests/base/test_text.c.
 *
 * Numbers are written and read with a decimal point whatever the locale of the process is. */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Zero it to begin. Once an allocation has failed, nothing more is added and failed stays true. */
struct text {
    char *text; /* ends with a zero; NULL before the first addition */
    size_t length, capacity;
    bool failed;
};

/* Append (printf format). */
void text_add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Append the shortest decimal that reads back as exactly this number. */
void text_add_number(struct text *text, double number);

/* Print a string of JSON, in its quotes; null where string is NULL. */
void text_print_json(FILE *stream, const char *string);

/* Print a string; a control character, which would command a terminal, as \x1b. Line breaks and tabs stay. */
void text_print_clean(FILE *stream, const char *string);

/* Release the string and zero it. */
void text_free(struct text *text);

/* Read a decimal number, which must be the whole string. One that is too large becomes an infinity. False if the string
 * is not a number; nan, inf and hexadecimal digits are not. */
bool text_number(const char *text, double *number);

#endif
