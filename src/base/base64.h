/* base64.h: bytes as text, for files that hold numbers in the middle of text. Tested by tests/base/test_base64.c. */
#ifndef BASE64_H
#define BASE64_H

#include <stddef.h>
#include <stdio.h>

/* Write n bytes to a stream in base 64 (RFC 4648, with padding). A failure sets the error indicator of the stream
 * (ferror). */
void base64_write(FILE *stream, size_t n, const void *bytes);

#endif
