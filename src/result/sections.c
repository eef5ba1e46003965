/* sections.c: see sections.h. */
#include "result/sections.h"

#include <string.h>
#include <zlib.h>

static const uint32_t order = 0x01020304;
enum {
    FORMAT_AT = sizeof SECTIONS_MAGIC - 1,
    ORDER_AT = FORMAT_AT + 4,
    SIZE_AT = ORDER_AT + 4,
    CHECK_AT = SIZE_AT + 8,
    HEADER_BYTES = CHECK_AT + 4,
    SECTION_HEADER = SECTIONS_NAME + 8 /* size of the header of a section */
};

// ---- writing

void sections_add(struct sections_writer *writer, const void *bytes, size_t n) {
    if (n == 0) return;
    if (writer->capacity - writer->n < n) {
        writer->capacity = 2 * (writer->n + n);
        GROW(writer->arena, writer->bytes, writer->capacity);
    }
    memcpy(writer->bytes + writer->n, bytes, n);
    writer->n += n;
}

void sections_start(struct arena *arena, struct sections_writer *writer) {
    const uint32_t format = SECTIONS_FORMAT;
    const unsigned char size_and_check[HEADER_BYTES - SIZE_AT] = {0};
    *writer = (struct sections_writer){.arena = arena};
    sections_add(writer, SECTIONS_MAGIC, FORMAT_AT);
    sections_add(writer, &format, sizeof format);
    sections_add(writer, &order, sizeof order);
    sections_add(writer, size_and_check, sizeof size_and_check);
}

void sections_open(struct sections_writer *writer, const char *name) {
    char filled[SECTION_HEADER] = {0};
    memcpy(filled, name, strnlen(name, SECTIONS_NAME - 1));
    writer->begin = writer->n;
    sections_add(writer, filled, sizeof filled);
}

void sections_close(struct sections_writer *writer) {
    const uint64_t size = writer->n - writer->begin - SECTION_HEADER;
    memcpy(writer->bytes + writer->begin + SECTIONS_NAME, &size, sizeof size);
    const uint32_t check = (uint32_t)crc32_z(0, writer->bytes + writer->begin, writer->n - writer->begin);
    sections_add(writer, &check, sizeof check);
}

void sections_finish(struct sections_writer *writer) {
    const uint64_t size = writer->n;
    memcpy(writer->bytes + SIZE_AT, &size, sizeof size);
    const uint32_t check = (uint32_t)crc32_z(0, writer->bytes, CHECK_AT);
    memcpy(writer->bytes + CHECK_AT, &check, sizeof check);
}

// ---- reading

/* The section at a place: the size with header and checksum, or 0 if incomplete; *check: the checksum in the file. */
static size_t section_at(const unsigned char *bytes, size_t n, size_t at, uint32_t *check) {
    const size_t around = SECTION_HEADER + sizeof *check;
    uint64_t size;
    if (n - at < around) return 0;
    memcpy(&size, bytes + at + SECTIONS_NAME, sizeof size);
    if (size > n - at - around) return 0;
    memcpy(check, bytes + at + SECTION_HEADER + size, sizeof *check);
    return around + (size_t)size;
}

enum status sections_check(const unsigned char *bytes, size_t n) {
    uint32_t format, found, check;
    uint64_t size;
    if (n < FORMAT_AT || memcmp(bytes, SECTIONS_MAGIC, FORMAT_AT) != 0)
        return status_fail(STATUS_FILE, "not a checkpoint of shoal");
    if (n < HEADER_BYTES) return status_fail(STATUS_FILE, "the file is truncated");

    // the header
    memcpy(&format, bytes + FORMAT_AT, sizeof format);
    memcpy(&found, bytes + ORDER_AT, sizeof found);
    memcpy(&size, bytes + SIZE_AT, sizeof size);
    memcpy(&check, bytes + CHECK_AT, sizeof check);
    if (check != (uint32_t)crc32_z(0, bytes, CHECK_AT)) {
        // with another byte order the checksum fails too
        return status_fail(STATUS_FILE, found == 0x04030201 ? "written on a machine with another byte order"
                                                            : "the first bytes are damaged");
    }
    if (found != order || format != SECTIONS_FORMAT) {
        return status_fail(STATUS_FILE, "format %u, but this program reads format %d", format, SECTIONS_FORMAT);
    }
    if (size != n) {
        return status_fail(STATUS_FILE, "%zu bytes instead of %llu: truncated or extended", n,
                           (unsigned long long)size);
    }

    // the sections
    for (size_t at = HEADER_BYTES; at < n;) {
        const size_t whole = section_at(bytes, n, at, &check);
        if (whole == 0 || check != (uint32_t)crc32_z(0, bytes + at, whole - sizeof check)) {
            return status_fail(STATUS_FILE, "damaged behind byte %zu", at);
        }
        at += whole;
    }

    return STATUS_OK;
}

struct section_reader sections_find(const unsigned char *bytes, size_t n, const char *name) {
    uint32_t check = 0;
    for (size_t at = HEADER_BYTES, whole; at < n; at += whole) {
        whole = section_at(bytes, n, at, &check);
        if (strncmp((const char *)bytes + at, name, SECTIONS_NAME) != 0) continue;
        return (struct section_reader){bytes + at + SECTION_HEADER, whole - SECTION_HEADER - sizeof check, false,
                                       check};
    }
    return (struct section_reader){.is_short = true};
}

void sections_take(struct section_reader *section, void *to, size_t n) {
    if (n > section->left) section->is_short = true;
    if (section->is_short) {
        memset(to, 0, n);
        return;
    }
    memcpy(to, section->next, n);
    section->next += n;
    section->left -= n;
}
