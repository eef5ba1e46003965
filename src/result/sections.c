/* sections.c: see sections.h. */
#include "result/sections.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/memory.h"

static const uint32_t order = 0x01020304;
enum {
    FORMAT_AT = sizeof SECTIONS_MAGIC - 1,
    ORDER_AT = FORMAT_AT + 4,
    SIZE_AT = ORDER_AT + 4,
    CHECK_AT = SIZE_AT + 8,
    HEADER_BYTES = CHECK_AT + 4,
    SECTION_HEADER = SECTIONS_NAME + 8 /* size of the header of a section */
};

static uint32_t checksum(const unsigned char *bytes, size_t n) {
    return (uint32_t)crc32_z(crc32_z(0, NULL, 0), bytes, n);
}

// ---- writing

void sections_add(struct sections_writer *writer, const void *bytes, size_t n) {
    if (writer->failed || n == 0) return;
    if (writer->capacity - writer->n < n) {
        const size_t capacity = 2 * (writer->n + n);
        unsigned char *const more = realloc(writer->bytes, capacity);
        if (!more) {
            writer->failed = true;
            return;
        }
        writer->bytes = more;
        writer->capacity = capacity;
    }

    memcpy(writer->bytes + writer->n, bytes, n);
    writer->n += n;
}

void sections_start(struct sections_writer *writer) {
    const uint32_t format = SECTIONS_FORMAT;
    const unsigned char size_and_check[HEADER_BYTES - SIZE_AT] = {0};
    *writer = (struct sections_writer){0};
    sections_add(writer, SECTIONS_MAGIC, FORMAT_AT);
    sections_add(writer, &format, sizeof format);
    sections_add(writer, &order, sizeof order);
    sections_add(writer, size_and_check, sizeof size_and_check);
}

void sections_open(struct sections_writer *writer, const char *name) {
    char filled[SECTIONS_NAME] = {0};
    const uint64_t size = 0;
    memcpy(filled, name, strnlen(name, SECTIONS_NAME - 1));
    writer->begin = writer->n;
    sections_add(writer, filled, sizeof filled);
    sections_add(writer, &size, sizeof size);
}

void sections_close(struct sections_writer *writer) {
    if (writer->failed) return;
    const uint64_t size = writer->n - writer->begin - SECTION_HEADER;
    memcpy(writer->bytes + writer->begin + SECTIONS_NAME, &size, sizeof size);
    const uint32_t check = checksum(writer->bytes + writer->begin, writer->n - writer->begin);
    sections_add(writer, &check, sizeof check);
}

enum status sections_finish(struct sections_writer *writer) {
    if (writer->failed) return memory_check(NULL, "a checkpoint");
    const uint64_t size = writer->n;
    memcpy(writer->bytes + SIZE_AT, &size, sizeof size);
    const uint32_t check = checksum(writer->bytes, CHECK_AT);
    memcpy(writer->bytes + CHECK_AT, &check, sizeof check);
    return STATUS_OK;
}

void sections_free(struct sections_writer *writer) {
    free(writer->bytes);
    *writer = (struct sections_writer){0};
}

// ---- reading

static uint32_t number_at(const unsigned char *bytes) {
    uint32_t number;
    memcpy(&number, bytes, sizeof number);
    return number;
}

static uint64_t size_at(const unsigned char *bytes) {
    uint64_t size;
    memcpy(&size, bytes, sizeof size);
    return size;
}

// The size of the section at a place, with header and checksum; 0 if incomplete.
static size_t whole_section(const unsigned char *bytes, size_t n, size_t at) {
    const size_t around = SECTION_HEADER + sizeof(uint32_t);
    if (n - at < around) return 0;
    const uint64_t size = size_at(bytes + at + SECTIONS_NAME);
    return size <= n - at - around ? around + (size_t)size : 0;
}

static enum status check_header(const unsigned char *bytes, size_t n) {
    if (n < FORMAT_AT || memcmp(bytes, SECTIONS_MAGIC, FORMAT_AT) != 0)
        return status_fail(STATUS_FILE, "not a checkpoint of shoal");
    if (n < HEADER_BYTES) return status_fail(STATUS_FILE, "the file is truncated");
    const uint32_t found = number_at(bytes + ORDER_AT), format = number_at(bytes + FORMAT_AT);

    if (number_at(bytes + CHECK_AT) != checksum(bytes, CHECK_AT)) {
        // with another byte order the checksum fails too
        return status_fail(STATUS_FILE, found == 0x04030201 ? "written on a machine with another byte order"
                                                            : "the first bytes are damaged");
    }

    if (found != order || format != SECTIONS_FORMAT) {
        return status_fail(STATUS_FILE, "format %u, but this program reads format %d", format, SECTIONS_FORMAT);
    }
    if (size_at(bytes + SIZE_AT) == n) return STATUS_OK;
    return status_fail(STATUS_FILE, "%zu bytes instead of %llu: truncated or extended", n,
                       (unsigned long long)size_at(bytes + SIZE_AT));
}

enum status sections_check(const unsigned char *bytes, size_t n) {
    TRY(check_header(bytes, n));
    for (size_t at = HEADER_BYTES; at < n;) {
        const size_t size = whole_section(bytes, n, at);
        const size_t checked = size - sizeof(uint32_t);
        if (size == 0 || number_at(bytes + at + checked) != checksum(bytes + at, checked)) {
            return status_fail(STATUS_FILE, "damaged behind byte %zu", at);
        }
        at += size;
    }

    return STATUS_OK;
}

struct section_reader sections_find(const unsigned char *bytes, size_t n, const char *name) {
    for (size_t at = HEADER_BYTES; at < n; at += whole_section(bytes, n, at)) {
        const size_t size = whole_section(bytes, n, at) - SECTION_HEADER - sizeof(uint32_t);
        if (strncmp((const char *)bytes + at, name, SECTIONS_NAME) != 0) continue;
        return (struct section_reader){bytes + at + SECTION_HEADER, size, false,
                                       number_at(bytes + at + SECTION_HEADER + size)};
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
