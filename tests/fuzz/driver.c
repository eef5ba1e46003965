/* driver.c: feeds a fuzz target with seeded mutations of files, where there is no libFuzzer.
 *
 *     fuzz_case N SEED FILE...      N inputs, always the same ones for a SEED
 *     fuzz_case 1 - FILE            the file as it is
 *
 * The input that is being tried is kept in fuzz-input of the folder, for one that crashes, or takes 10 s. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"

enum { MAX_BYTES = 1 << 20, MAX_CHANGES = 8, PATIENCE = 10 /* s */ };

struct bytes {
    size_t n;
    uint8_t *byte; /* room for MAX_BYTES */
};

// ---- random numbers (xorshift64*)

static uint64_t state;

static uint64_t next(void) {
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * 2685821657736338717u;
}

static size_t below(size_t n) {
    return n > 0 ? (size_t)(next() >> 11) % n : 0;
}

// ---- changes

static void insert(struct bytes *to, size_t at, const void *from, size_t n) {
    if (to->n + n > MAX_BYTES) return;
    memmove(to->byte + at + n, to->byte + at, to->n - at);
    memcpy(to->byte + at, from, n);
    to->n += n;
}

static void cut(struct bytes *from, size_t at, size_t n) {
    memmove(from->byte + at, from->byte + at + n, from->n - at - n);
    from->n -= n;
}

// words that mean something to YAML, to a case, or to NetCDF
static const char *const words[] = {": ",
                                    "- ",
                                    "[",
                                    "]",
                                    "{",
                                    "}",
                                    ",",
                                    "\n",
                                    "\n  ",
                                    "\"",
                                    "'",
                                    "#",
                                    "&a",
                                    "*a",
                                    "!!int",
                                    "|",
                                    ">",
                                    "%",
                                    "\t",
                                    "null",
                                    "~",
                                    "true",
                                    "1e308",
                                    "-1e-320",
                                    ".inf",
                                    "nan",
                                    "0x1",
                                    "-1",
                                    "0",
                                    "99999999999999999999",
                                    "sweep",
                                    "values",
                                    "key",
                                    "keys",
                                    "zip",
                                    "refine",
                                    "expect",
                                    "reference",
                                    "include",
                                    "defaults",
                                    "preset: published",
                                    "fish[*]",
                                    "fish[0].nodes",
                                    "fish[9]",
                                    "wave",
                                    "control",
                                    "law: heading",
                                    "format: 1",
                                    "\xc3\xa9",
                                    "\xff",
                                    "CDF\x05",
                                    "CDF\x01",
                                    "CDF\x02",
                                    "\x89HDF"};
enum { N_WORDS = sizeof words / sizeof *words };

// a number of a header: big-endian, 4 or 8 bytes
static void set_number(struct bytes *bytes) {
    static const uint64_t numbers[] = {0,
                                       1,
                                       2,
                                       3,
                                       5,
                                       10,
                                       11,
                                       12,
                                       255,
                                       1024,
                                       65536,
                                       0x7fffffff,
                                       0x80000000,
                                       0xffffffff,
                                       (uint64_t)1 << 40,
                                       (uint64_t)1 << 60,
                                       INT64_MAX,
                                       UINT64_MAX};
    const size_t size = next() % 2 ? 8 : 4, at = below(bytes->n) / 4 * 4;
    if (at + size > bytes->n) return;
    const uint64_t number = numbers[below(sizeof numbers / sizeof *numbers)];
    for (size_t i = 0; i < size; i++) bytes->byte[at + i] = (uint8_t)(number >> 8 * (size - 1 - i));
}

static void change(struct bytes *bytes, const struct bytes *other) {
    // headers, and the heads of cases, are worth more than what follows
    const size_t reach = next() % 2 && bytes->n > 4096 ? 4096 : bytes->n;
    const size_t at = below(reach), length = below(next() % 4 ? 16 : 512);
    const size_t n = length < bytes->n - at ? length : bytes->n - at;
    const char *const word = words[below(N_WORDS)];
    if (bytes->n == 0) return;
    switch (next() % 9) {
        case 0: bytes->byte[at] ^= (uint8_t)(1u << next() % 8); break;
        case 1: bytes->byte[at] = (uint8_t)next(); break;
        case 2: insert(bytes, at, word, strlen(word)); break;
        case 3: cut(bytes, at, n); break;
        case 4: {
            uint8_t copy[512];
            memcpy(copy, bytes->byte + at, n);
            insert(bytes, below(bytes->n), copy, n);
            break;
        }
        case 5: bytes->n = at; break;
        case 6: {
            const size_t from = below(other->n), m = length < other->n - from ? length : other->n - from;
            insert(bytes, at, other->byte + from, m);
            break;
        }
        default: set_number(bytes); break;
    }
}

// ---- the inputs

static int read_file(const char *path, struct bytes *bytes) {
    FILE *const file = fopen(path, "rb");
    bytes->byte = malloc(MAX_BYTES);
    if (!file || !bytes->byte) return 0;
    bytes->n = fread(bytes->byte, 1, MAX_BYTES, file);
    fclose(file);
    return 1;
}

static void try(const struct bytes *input) {
    FILE *const kept = fopen("fuzz-input", "wb");
    if (!kept || fwrite(input->byte, 1, input->n, kept) != input->n || fclose(kept) != 0) abort();
    alarm(PATIENCE);
    // of its own length, so that the address sanitizer sees who reads beyond it
    uint8_t *const exact = malloc(input->n + 1);
    if (!exact) abort();
    memcpy(exact, input->byte, input->n);
    uint8_t *const fitting = realloc(exact, input->n > 0 ? input->n : 1);
    LLVMFuzzerTestOneInput(fitting, input->n);
    free(fitting);
}

int main(int argc, char **argv) {
    const int n_files = argc - 3;
    struct bytes *const files = n_files > 0 ? calloc((size_t)n_files, sizeof *files) : NULL;
    struct bytes input = {0, malloc(MAX_BYTES)};
    if (!files || !input.byte) return 2;
    for (int i = 0; i < n_files; i++) {
        if (!read_file(argv[i + 3], &files[i])) return 2;
    }
    const int as_it_is = strcmp(argv[2], "-") == 0;
    state = strtoull(argv[2], NULL, 10) * 2 + 1;
    const long n = atol(argv[1]);
    for (long k = 0; k < n; k++) {
        const struct bytes *const seed = &files[below((size_t)n_files)];
        memcpy(input.byte, seed->byte, seed->n);
        input.n = seed->n;
        const size_t n_changes = as_it_is ? 0 : 1 + below(MAX_CHANGES);
        for (size_t i = 0; i < n_changes; i++) change(&input, &files[below((size_t)n_files)]);
        try(&input);
    }
    remove("fuzz-input");
    printf("%ld inputs\n", n);
    for (int i = 0; i < n_files; i++) free(files[i].byte);
    free(files);
    free(input.byte);
    return 0;
}
