/* sections.h: bytes in named sections, each with a checksum, as a checkpoint keeps them. Tested by
 * tests/result/test_checkpoint.c.
 *
 *     "SHOAL\r\n\x1a"  format  0x01020304  size of all  checksum of these 24 bytes
 *     section = name (24 bytes, filled up with zeros)  n  n bytes  checksum of name, n and bytes
 *
 * Numbers are those of the machine, whose order the second one shows: format, order and checksums have 4 bytes, sizes
 * 8. A checksum is the CRC-32 of zlib. The line break in the first word shows a copy that was made as text. */
#ifndef SECTIONS_H
#define SECTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* The first eight bytes. */
#define SECTIONS_MAGIC "SHOAL\r\n\x1a"

enum { SECTIONS_FORMAT = 1, SECTIONS_NAME = 24 /* bytes of a name, the zero included */ };

/* ---- writing: once an allocation has failed, nothing more is added and failed stays true */

struct sections_writer {
    unsigned char *bytes; /* owned */
    size_t n, capacity;
    size_t begin; /* of the open section */
    bool failed;
};

void sections_start(struct sections_writer *writer); /* with a zeroed or an unset writer */
void sections_open(struct sections_writer *writer, const char *name);
void sections_add(struct sections_writer *writer, const void *bytes, size_t n);
void sections_close(struct sections_writer *writer);

/* Complete the bytes, or fail with STATUS_MEMORY. */
enum status sections_finish(struct sections_writer *writer);
void sections_free(struct sections_writer *writer);

/* ---- reading */

/* Where a section is read. */
struct section_reader {
    const unsigned char *next;
    size_t left;    /* bytes */
    bool is_short;  /* more has been asked for than there is */
    uint32_t check; /* its checksum */
};

/* Fail with STATUS_FILE unless these n bytes are whole: the message ("it is cut off", "it is damaged behind byte 28",
 * "it has format 2, and this program reads format 1") says why. */
enum status sections_check(const unsigned char *bytes, size_t n);

/* The section of a name in bytes that have been checked; an empty and short one where there is none. */
struct section_reader sections_find(const unsigned char *bytes, size_t n, const char *name);

/* Take the next n bytes of a section; zeros where it is short. */
void sections_take(struct section_reader *section, void *to, size_t n);

#endif
