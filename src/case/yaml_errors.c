/* yaml_errors.c: errors sorted by place, each with the source line and a caret. */
#include "case/yaml_errors.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum { EXCERPT = 100 /* characters of a source line that are shown */ };

void yaml_errors_add(struct yaml_errors *errors, struct yaml_mark mark, const char *format, ...) {
    errors->n++;
    if (errors->n > YAML_ERRORS_KEPT) return;
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    errors->kept[errors->n - 1].mark = mark;
    errors->kept[errors->n - 1].text = strdup(text);
    if (!errors->kept[errors->n - 1].text) errors->out_of_memory = true;
}

void yaml_errors_free(struct yaml_errors *errors) {
    for (int i = 0; i < errors->n && i < YAML_ERRORS_KEPT; i++) free(errors->kept[i].text);
    *errors = (struct yaml_errors){0};
}

/* True if a is to be listed before b. */
static bool is_before(struct yaml_mark a, struct yaml_mark b) {
    if (a.source->rank != b.source->rank) return a.source->rank < b.source->rank;
    if (a.line != b.line) return a.line < b.line;
    return a.column < b.column;
}

/* The order in which the kept errors are listed; errors at one place keep the order of detection. */
static int sort_errors(const struct yaml_errors *errors, int order[YAML_ERRORS_KEPT]) {
    int n = 0;
    for (; n < errors->n && n < YAML_ERRORS_KEPT; n++) {
        int i = n;
        for (; i > 0 && is_before(errors->kept[n].mark, errors->kept[order[i - 1]].mark); i--) order[i] = order[i - 1];
        order[i] = n;
    }
    return n;
}

/* The bytes of one character of UTF-8, at most up to end. */
static size_t character_size(const char *from, const char *end) {
    size_t size = 1;
    while (from + size < end && ((unsigned char)from[size] & 0xC0) == 0x80) size++;
    return size;
}

/* Find the line of a mark: the bytes from *from up to the returned end. */
static const char *line_of(struct yaml_mark mark, const char **from) {
    const char *place = mark.source->text;
    const char *const end = place + mark.source->length;
    if (mark.source->length >= 3 && memcmp(place, "\xEF\xBB\xBF", 3) == 0) place += 3;  // the mark of UTF-8

    for (int line = 1; line < mark.line && place < end; place++) {
        const bool return_only = *place == '\r' && !(place + 1 < end && place[1] == '\n');
        if (*place == '\n' || return_only) line++;
    }

    *from = place;
    while (place < end && *place != '\n' && *place != '\r') place++;
    return place;
}

/* Add the source line and a caret under the mark; of a long line only the neighbourhood of the mark. */
static void add_excerpt(struct text *list, struct yaml_mark mark) {
    const char *from, *const end = line_of(mark, &from);
    int column = 1;

    for (; column < mark.column - EXCERPT / 2; column++) {
        if (from >= end) return;
        from += character_size(from, end);
    }

    if (from >= end) return;
    text_add(list, "\n");

    for (int shown = 0; from < end && shown < EXCERPT; shown++) {
        const size_t size = character_size(from, end);
        const bool visible = (unsigned char)*from >= ' ' && *from != 0x7F && (size > 1 || (unsigned char)*from < 0x80);
        text_add(list, "%.*s", visible ? (int)size : 1, visible ? from : " ");
        from += size;
    }

    text_add(list, "\n%*s", mark.column - column + 1, "^");
}

/* Add one error with the place. */
static void add_error(struct text *list, struct yaml_mark mark, const char *word, const char *text) {
    if (list->length > 0) text_add(list, "\n");
    if (mark.source->one_line) {
        text_add(list, "%s: %s: %s", mark.source->name, word, text);
    } else {
        text_add(list, "%s:%d:%d: %s: %s", mark.source->name, mark.line, mark.column, word, text);
        add_excerpt(list, mark);
    }
}

char *yaml_errors_list(const struct yaml_errors *errors, const char *word) {
    int order[YAML_ERRORS_KEPT];
    const int n = errors->out_of_memory ? 0 : sort_errors(errors, order);
    struct text list = {0};
    text_add(&list, "%s", "");
    for (int i = 0; i < n && i < YAML_ERRORS_SHOWN; i++) {
        add_error(&list, errors->kept[order[i]].mark, word, errors->kept[order[i]].text);
    }
    if (errors->n > YAML_ERRORS_SHOWN) text_add(&list, "\n... and %d more", errors->n - YAML_ERRORS_SHOWN);
    if (errors->out_of_memory || list.failed) text_free(&list);
    return list.text;
}

enum status yaml_errors_status(const struct yaml_errors *errors) {
    if (errors->n == 0) return STATUS_OK;
    char *const list = yaml_errors_list(errors, "error");
    if (!list) return status_fail(STATUS_MEMORY, "out of memory: the list of errors of the case");
    const enum status status = status_fail(STATUS_CASE, "%s", list);
    free(list);
    return status;
}
