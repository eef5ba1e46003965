/* say.h: what the program prints has no control characters: names of files and what files hold may be anybody's. Tested
 * by tests/app/test_exits.sh. */
#ifndef SAY_H
#define SAY_H

#include <stdio.h>

#include "base/status.h"

/* Print to a stream (printf format): text_print_clean. */
void say_line(FILE *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Collect what functions write to a stream, and print it to standard output at the end. */
struct say_page {
    FILE *stream; /* write here */
    char *text;
    size_t n;
};

/* Begin a page; fails with STATUS_MEMORY. */
enum status say_begin(struct say_page *page);

/* Print the page, also where a function that should write it has failed with this status. Returns that status, or
 * STATUS_MEMORY. */
enum status say_end(struct say_page *page, enum status status);

#endif
