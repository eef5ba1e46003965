/* base64.c: three bytes as four letters. */
#include "base/base64.h"

void base64_write(FILE *stream, size_t n, const void *bytes) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *const from = bytes;
    for (size_t i = 0; i < n; i += 3) {
        const unsigned second = i + 1 < n ? from[i + 1] : 0, third = i + 2 < n ? from[i + 2] : 0;
        const unsigned all = (unsigned)from[i] << 16 | second << 8 | third;
        fputc(letters[all >> 18], stream);
        fputc(letters[all >> 12 & 63], stream);
        fputc(i + 1 < n ? letters[all >> 6 & 63] : '=', stream);
        fputc(i + 2 < n ? letters[all & 63] : '=', stream);
    }
}
