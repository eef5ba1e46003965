/* yaml_text.h: a text that grows, and values written as YAML; numbers as text and back. Tested by tests/test_yaml.c.
 *
 * Numbers are written and read with a decimal point whatever the locale of the process is. */
#ifndef YAML_TEXT_H
#define YAML_TEXT_H

#include <stdbool.h>
#include <stddef.h>

struct yaml_node;

/* Zero it to begin. Once an allocation has failed, nothing more is added and failed stays true. */
struct yaml_text {
    char *text; /* ends with a zero; NULL before the first addition */
    size_t length, capacity;
    bool failed;
};

void yaml_text_add(struct yaml_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Add the shortest text that reads back as exactly this number. */
void yaml_text_add_number(struct yaml_text *text, double number);

/* Add a text value, in quotes where YAML needs them. */
void yaml_text_add_scalar(struct yaml_text *text, const char *scalar);

/* Add any value on one line: [1, 2] and {a: 1}. */
void yaml_text_add_node(struct yaml_text *text, const struct yaml_node *node);

/* Release the text and zero it. */
void yaml_text_free(struct yaml_text *text);

/* Read a decimal number; all of the text must belong to it. Too large a number becomes an infinity. False if the text
 * is no number; nan, inf and hexadecimal digits are none. */
bool yaml_text_number(const char *text, double *number);

#endif
