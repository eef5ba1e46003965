/* text.h: strings that grow, and conversion between numbers and strings. Tested by tests/base/test_text.c.
 *
 * Numbers are written and read with a decimal point, whatever the locale of the process says. */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"

/* A growing string in an arena: begin with {.arena = arena}. */
struct text {
    struct arena *arena;
    char *text; /* ends with a zero; NULL before the first addition */
    size_t length, capacity;
};

/* Append (printf format). */
void text_add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Write, or append, the shortest decimal that reads back as exactly this number. */
enum { TEXT_NUMBER_BYTES = 40 };
void text_of_number(char text[TEXT_NUMBER_BYTES], double number);
void text_add_number(struct text *text, double number);

/* The decimal number of 12 digits if it is at most two roundings from the number, else the number. */
double text_round(double number);

/* Append a word of a command line, quoted for a shell where needed. */
void text_add_word(struct text *text, const char *word);

/* Print a string of JSON with quotes; null if string is NULL. */
void text_print_json(FILE *stream, const char *string);

/* Print a field of comma-separated values in quotes, with quotes in it doubled (RFC 4180). */
void text_print_csv(FILE *stream, const char *string);

/* Print a member of an object of JSON after some text: BEFORE"NAME": string. */
void text_print_member(FILE *stream, const char *before, const char *name, const char *string);

/* Print a string with control characters escaped (\x1b), for terminals. Line breaks and tabs are unchanged. */
void text_print_clean(FILE *stream, const char *string);

/* Number of insertions, deletions, changes and swaps of neighbours between a word of n and one of m characters,
 * whatever the case of the letters; INT_MAX if a word has more than 40 characters. */
int text_distance(const char *a, size_t n, const char *b, size_t m);

/* Whether a text contains a word, whatever the case of the letters. */
bool text_contains(const char *text, const char *word);

/* Read a decimal number; the number must be the whole string. A number too large becomes an infinity. False if the
 * string is not a number; nan, inf and hexadecimal digits are no numbers. */
bool text_number(const char *text, double *number);

/* Write a duration with two digits in the best unit from s to days: "12 min". */
enum { TEXT_DURATION_BYTES = 32 };
void text_duration(char text[TEXT_DURATION_BYTES], double seconds);

/* Write n bytes to a stream in base 64 (RFC 4648, with padding), for files that hold numbers in the middle of text. A
 * failure sets the error indicator of the stream (ferror). */
void text_print_base64(FILE *stream, size_t n, const void *bytes);

#endif
