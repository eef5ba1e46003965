/* say.h: printing without control characters, which file names and the contents of files can have. Tested
 * by tests/app/test_exits.sh. */
#ifndef SAY_H
#define SAY_H

#include <stdio.h>

#include "base/status.h"

/* Print to a stream (printf format): text_print_clean. */
void say_line(FILE *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Collect text in a stream and print the text at the end. */
struct say_page {
    FILE *stream; /* write here */
    char *text;
    size_t n;
};

/* Begin a page; fails with STATUS_MEMORY. */
enum status say_begin(struct say_page *page);

/* Print the page to a stream (NULL: nowhere), even after a failure of the writer with this status. Returns the status
 * of the writer, or STATUS_MEMORY. */
enum status say_end(struct say_page *page, FILE *stream, enum status status);

#endif
