/* say.c: see say.h. */
#include "app/say.h"

#include <stdarg.h>
#include <stdlib.h>

#include "base/text.h"

void say_line(FILE *stream, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0) return;

    // without memory for the whole line print the beginning
    char beginning[1024], *const line = malloc((size_t)length + 1);
    va_start(arguments, format);
    vsnprintf(line ? line : beginning, line ? (size_t)length + 1 : sizeof beginning, format, arguments);
    va_end(arguments);
    text_print_clean(stream, line ? line : beginning);
    if (!line && (size_t)length >= sizeof beginning) fputc('\n', stream);
    free(line);
}

static enum status page_out_of_memory(void) {
    return status_fail(STATUS_MEMORY, "out of memory: text to print");
}

enum status say_begin(struct say_page *page) {
    *page = (struct say_page){0};
    page->stream = open_memstream(&page->text, &page->n);
    return page->stream ? STATUS_OK : page_out_of_memory();
}

enum status say_end(struct say_page *page, FILE *stream, enum status status) {
    const int failed = fclose(page->stream) != 0;
    if (page->text && stream) text_print_clean(stream, page->text);
    free(page->text);
    *page = (struct say_page){0};
    return status == STATUS_OK && failed ? page_out_of_memory() : status;
}
