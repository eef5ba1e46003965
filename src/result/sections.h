/* sections.h: the format of checkpoints: bytes in named sections, each with a checksum. Tested by
 * tests/result/test_checkpoint.c.
 *
 *     "SHOAL\r\n\x1a"  format  0x01020304  size of all  checksum of these 24 bytes
 *     section = name (24 bytes, filled up with zeros)  n  n bytes  checksum of name, n and bytes
 *
 * Numbers have the byte order of the machine, which the second number shows. Format, order and checksums have 4 bytes,
 * sizes 8. A checksum is the CRC-32 of zlib. The line break in the first word reveals a copy in text mode. */
#ifndef SECTIONS_H
#define SECTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/status.h"

/* The first eight bytes. */
#define SECTIONS_MAGIC "SHOAL\r\n\x1a"

enum { SECTIONS_FORMAT = 1, SECTIONS_NAME = 24 /* bytes of a name, the zero included */ };

/* ---- writing: start, sections of open, add..., close, then finish */

struct sections_writer {
    struct arena *arena;
    unsigned char *bytes;
    size_t n, capacity;
    size_t begin; /* of the open section */
};

void sections_start(struct arena *arena, struct sections_writer *writer);
void sections_open(struct sections_writer *writer, const char *name);
void sections_add(struct sections_writer *writer, const void *bytes, size_t n);
void sections_close(struct sections_writer *writer);
void sections_finish(struct sections_writer *writer);

/* ---- reading */

/* The reading position in a section. */
struct section_reader {
    const unsigned char *next;
    size_t left;    /* bytes */
    bool is_short;  /* more has been asked for than there is */
    uint32_t check; /* checksum of the section */
};

/* Fail with STATUS_FILE unless these n bytes are complete and undamaged. The message is the reason: "the file is
 * truncated", "damaged behind byte 28", "format 2, but this program reads format 1". */
enum status sections_check(const unsigned char *bytes, size_t n);

/* The section of a name in checked bytes; an empty, short section if the name is missing. */
struct section_reader sections_find(const unsigned char *bytes, size_t n, const char *name);

/* Take the next n bytes of a section; zeros beyond the end. */
void sections_take(struct section_reader *section, void *to, size_t n);

#endif
