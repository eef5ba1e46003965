/* yaml_tree.c: a tree from the events of libyaml; limits and refused constructs. */
#include "case/yaml_tree.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/memory.h"
#include "base/text.h"

// ---- errors: sorted by place, each with the source line and a caret

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

/* The order in which the kept errors are listed; errors at one place keep the order of detection. */
static int sort_errors(const struct yaml_errors *errors, int order[YAML_ERRORS_KEPT]) {
    int n = 0;
    for (; n < errors->n && n < YAML_ERRORS_KEPT; n++) {
        const struct yaml_mark mark = errors->kept[n].mark;
        int i = n;
        for (; i > 0; i--) {
            const struct yaml_mark before = errors->kept[order[i - 1]].mark;
            const int rank = mark.source->rank - before.source->rank, line = mark.line - before.line;
            if ((rank ? rank : line ? line : mark.column - before.column) >= 0) break;
            order[i] = order[i - 1];
        }
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

enum status yaml_errors_list(const struct yaml_errors *errors, const char *word, char **text) {
    int order[YAML_ERRORS_KEPT];
    const int n = errors->out_of_memory ? 0 : sort_errors(errors, order);
    struct text list = {.failed = errors->out_of_memory};
    for (int i = 0; i < n && i < YAML_ERRORS_SHOWN; i++) {
        add_error(&list, errors->kept[order[i]].mark, word, errors->kept[order[i]].text);
    }
    if (errors->n > YAML_ERRORS_SHOWN) text_add(&list, "\n... and %d more", errors->n - YAML_ERRORS_SHOWN);
    return text_take(&list, text, "the list of errors of the case");
}

enum status yaml_errors_status(const struct yaml_errors *errors) {
    if (errors->n == 0 && !errors->out_of_memory) return STATUS_OK;
    char *list;
    TRY(yaml_errors_list(errors, "error", &list));
    const enum status status = status_fail(STATUS_CASE, "%s", list);
    free(list);
    return status;
}

struct reader {
    yaml_parser_t parser;
    const struct yaml_source *source;
    struct yaml_errors *errors;
};

static const char what[] = "the tree of a case file"; /* in messages on memory */

// ---- the tree

static enum status create_node(struct yaml_node **node, enum yaml_kind kind, struct yaml_mark mark) {
    TRY(MEMORY_NEW(*node, 1, what));
    (*node)->kind = kind;
    (*node)->mark = mark;
    return STATUS_OK;
}

enum status yaml_tree_map(struct yaml_node **node, struct yaml_mark mark) {
    return create_node(node, YAML_MAP, mark);
}

void yaml_tree_free(struct yaml_node *node) {
    if (!node) return;
    for (int i = 0; i < node->n; i++) {
        free(node->entry[i].key);
        yaml_tree_free(node->entry[i].value);
    }
    free(node->entry);
    free(node->text);
    free(node);
}

/* Append an entry with a copy of the key (NULL in a list). Takes ownership of the value, also on failure. */
static enum status append_node(struct yaml_node *node, const char *key, struct yaml_mark mark,
                               struct yaml_node *value) {
    char *own_key = NULL;
    enum status status = key ? memory_copy_string(&own_key, key, what) : STATUS_OK;
    if (status == STATUS_OK && node->n == node->capacity) {
        status = MEMORY_RESIZE(node->entry, 2 * node->capacity + 4, what);
        if (status == STATUS_OK) node->capacity = 2 * node->capacity + 4;
    }

    if (status == STATUS_OK) {
        node->entry[node->n++] = (struct yaml_entry){own_key, mark, value};
    } else {
        free(own_key);
        yaml_tree_free(value);
    }
    return status;
}

enum status yaml_tree_copy(struct yaml_node **copy, const struct yaml_node *node) {
    TRY(create_node(copy, node->kind, node->mark));
    enum status status = node->text ? memory_copy_string(&(*copy)->text, node->text, what) : STATUS_OK;
    for (int i = 0; i < node->n && status == STATUS_OK; i++) {
        struct yaml_node *value;
        status = yaml_tree_copy(&value, node->entry[i].value);
        if (status == STATUS_OK) status = append_node(*copy, node->entry[i].key, node->entry[i].mark, value);
    }

    if (status != STATUS_OK) yaml_tree_free(*copy);
    return status;
}

struct yaml_entry *yaml_tree_entry(const struct yaml_node *map, const char *key, size_t length) {
    if (!map || map->kind != YAML_MAP) return NULL;
    for (int i = 0; i < map->n; i++) {
        if (strlen(map->entry[i].key) == length && memcmp(map->entry[i].key, key, length) == 0) return &map->entry[i];
    }
    return NULL;
}

const struct yaml_node *yaml_tree_find(const struct yaml_node *map, const char *path) {
    while (map) {
        const size_t length = strcspn(path, ".");
        const struct yaml_entry *const entry = yaml_tree_entry(map, path, length);
        map = entry ? entry->value : NULL;
        if (path[length] == '\0') break;
        path += length + 1;
    }
    return map;
}

enum status yaml_tree_put(struct yaml_node *map, const char *key, struct yaml_mark mark, struct yaml_node *value) {
    struct yaml_entry *const entry = yaml_tree_entry(map, key, strlen(key));
    if (!entry) return append_node(map, key, mark, value);
    entry->mark = mark;
    return yaml_tree_merge(&entry->value, value);
}

enum status yaml_tree_merge(struct yaml_node **base, struct yaml_node *over) {
    if (!*base || (*base)->kind != YAML_MAP || over->kind != YAML_MAP) {
        yaml_tree_free(*base);
        *base = over;
        return STATUS_OK;
    }

    enum status status = STATUS_OK;
    for (int i = 0; i < over->n && status == STATUS_OK; i++) {
        struct yaml_node *const value = over->entry[i].value;
        over->entry[i].value = NULL;
        status = yaml_tree_put(*base, over->entry[i].key, over->entry[i].mark, value);
    }

    (*base)->mark = over->mark;
    yaml_tree_free(over);
    return status;
}

const char *yaml_tree_describe(const struct yaml_node *node, char *buffer, size_t size) {
    if (node->kind == YAML_MAP) return "a map of keys";
    if (node->kind == YAML_LIST) {
        snprintf(buffer, size, "a list of %d", node->n);
        return buffer;
    }

    if (node->text[0] == '\0') return "nothing";
    const int shown = 40;
    snprintf(buffer, size, "'%.*s%s'", shown, node->text, strlen(node->text) > (size_t)shown ? "..." : "");
    return buffer;
}

// ---- errors of libyaml

static struct yaml_mark mark_at(const struct reader *reader, yaml_mark_t mark) {
    return (struct yaml_mark){reader->source, (int)mark.line + 1, (int)mark.column + 1};
}

/* Remedies for the most frequent errors of libyaml. */
static const char *remedy(const char *problem) {
    static const char *const remedies[][2] = {
        {"did not find expected key",
         "the indentation of this line differs from the lines above, or a quote or bracket is open"},
        {"did not find expected '-' indicator", "every entry of this list must begin with '- ' in the same column"},
        {"mapping values are not allowed in this context",
         "a key is not allowed here: check the indentation, and quote strings that contain ': '"},
        {"could not find expected ':'", "a key ends with ':' and a blank"},
        {"did not find expected ',' or ']'", "a list that begins with '[' needs ',' between values and ends with ']'"},
        {"did not find expected ',' or '}'",
         "a map that begins with '{' needs ',' between keys and ends with '}'; a string with brackets needs quotes"},
        {"found unexpected end of stream", "the quote that begins here is not closed"},
        {"found character that cannot start any token", "quote strings that begin with this character"},
    };
    for (size_t i = 0; i < sizeof remedies / sizeof *remedies; i++) {
        if (strcmp(problem, remedies[i][0]) == 0) return remedies[i][1];
    }
    return "this is not valid YAML";
}

/* Add the error of libyaml to the list. */
static enum status report_parser(struct reader *reader) {
    const yaml_parser_t *const parser = &reader->parser;
    if (parser->error == YAML_MEMORY_ERROR) return memory_check(NULL, what);
    const char *const problem = parser->problem ? parser->problem : "not readable";
    struct yaml_mark mark = mark_at(reader, parser->problem_mark);

    // a tab in the indentation of the line
    const char *place = mark.source->text, *const end = place + mark.source->length;
    for (int line = 1; line < mark.line && place < end; place++) line += *place == '\n';
    while (place < end && *place == ' ') place++;
    if (place < end && *place == '\t') {
        mark.column = 1;
        yaml_errors_add(reader->errors, mark, "the line is indented with a tab; use blanks");
        return STATUS_CASE;
    }

    if (!parser->context) {
        yaml_errors_add(reader->errors, mark, "%s (%s)", remedy(problem), problem);
        return STATUS_CASE;
    }

    // for a bracket or quote that is not closed, report the opening, not the end of the file
    const struct yaml_mark begin = mark_at(reader, parser->context_mark);
    if (strcmp(problem, "found unexpected end of stream") == 0) mark = begin;
    yaml_errors_add(reader->errors, mark, "%s (%s, line %d: %s)", remedy(problem), parser->context, begin.line,
                    problem);
    return STATUS_CASE;
}

static enum status next_event(struct reader *reader, yaml_event_t *event) {
    return yaml_parser_parse(&reader->parser, event) ? STATUS_OK : report_parser(reader);
}

// ---- from events to nodes

static enum status read_node(struct reader *reader, const yaml_event_t *event, int depth, struct yaml_node **node);

/* Refuse the anchor and the tag of a node; reading continues. */
static void refuse_extras(struct reader *reader, struct yaml_mark mark, const unsigned char *anchor,
                          const unsigned char *tag) {
    if (anchor) {
        yaml_errors_add(reader->errors, mark,
                        "anchors ('&') are not used in case files; put shared values under defaults");
    }
    if (tag) yaml_errors_add(reader->errors, mark, "tags ('!') are not used in case files; the key decides the type");
}

static enum status read_scalar(struct reader *reader, const yaml_event_t *event, struct yaml_node **node) {
    const struct yaml_mark mark = mark_at(reader, event->start_mark);
    const char *const text = (const char *)event->data.scalar.value;
    refuse_extras(reader, mark, event->data.scalar.anchor, event->data.scalar.tag);
    if (strlen(text) != event->data.scalar.length) {
        yaml_errors_add(reader->errors, mark, "a string cannot contain a zero byte");
    }
    TRY(create_node(node, YAML_SCALAR, mark));
    return memory_copy_string(&(*node)->text, text, what);
}

static enum status yaml_read_list(struct reader *reader, int depth, struct yaml_node *list) {
    for (;;) {
        yaml_event_t event;
        TRY(next_event(reader, &event));
        if (event.type == YAML_SEQUENCE_END_EVENT) {
            yaml_event_delete(&event);
            return STATUS_OK;
        }
        struct yaml_node *value = NULL;
        enum status status = read_node(reader, &event, depth, &value);
        yaml_event_delete(&event);
        if (status == STATUS_OK) {
            status = append_node(list, NULL, value->mark, value);
        } else {
            yaml_tree_free(value);
        }
        TRY(status);
    }
}

/* Read a value and append the value under the key, unless the key is refused. */
static enum status yaml_read_value(struct reader *reader, int depth, struct yaml_node *map,
                                   const struct yaml_node *key) {
    yaml_event_t event;
    TRY(next_event(reader, &event));
    struct yaml_node *value = NULL;
    const enum status status = read_node(reader, &event, depth, &value);
    yaml_event_delete(&event);

    const struct yaml_entry *const twin = yaml_tree_entry(map, key->text, strlen(key->text));
    const bool is_merge = strcmp(key->text, "<<") == 0;
    if (status == STATUS_OK && !is_merge && !twin) return append_node(map, key->text, key->mark, value);

    // discard the value
    yaml_tree_free(value);
    if (status == STATUS_OK && is_merge) {
        yaml_errors_add(reader->errors, key->mark,
                        "merge keys ('<<') are not used in case files; put shared values under defaults");
    } else if (status == STATUS_OK) {
        yaml_errors_add(reader->errors, key->mark, "the key '%.40s' is here twice; the first is on line %d: remove one",
                        key->text, twin->mark.line);
    }
    return status;
}

static enum status read_map(struct reader *reader, int depth, struct yaml_node *map) {
    for (;;) {
        yaml_event_t event;
        TRY(next_event(reader, &event));
        const struct yaml_mark mark = mark_at(reader, event.start_mark);
        const yaml_event_type_t type = event.type;
        struct yaml_node *key = NULL;
        enum status status = type == YAML_SCALAR_EVENT ? read_scalar(reader, &event, &key) : STATUS_OK;
        yaml_event_delete(&event);
        if (type == YAML_MAPPING_END_EVENT) return STATUS_OK;
        if (type != YAML_SCALAR_EVENT) {
            yaml_errors_add(reader->errors, mark, "a key must be a plain word, without brackets or braces");
            return STATUS_CASE;
        }
        if (status == STATUS_OK && map->n == YAML_TREE_KEYS) {
            yaml_errors_add(reader->errors, mark, "more than %d keys in one map", YAML_TREE_KEYS);
            status = STATUS_CASE;
        }
        if (status == STATUS_OK) status = yaml_read_value(reader, depth, map, key);
        yaml_tree_free(key);
        TRY(status);
    }
}

/* Read the node that begins with an event. *node is set also on failure. */
static enum status read_node(struct reader *reader, const yaml_event_t *event, int depth, struct yaml_node **node) {
    const struct yaml_mark mark = mark_at(reader, event->start_mark);
    if (event->type == YAML_SCALAR_EVENT) return read_scalar(reader, event, node);

    if (event->type == YAML_ALIAS_EVENT) {
        yaml_errors_add(reader->errors, mark, "aliases ('*') are not used in case files; write the value");
        return STATUS_CASE;
    }

    if (depth == YAML_TREE_DEPTH) {
        yaml_errors_add(reader->errors, mark, "nested deeper than %d levels", YAML_TREE_DEPTH);
        return STATUS_CASE;
    }

    const bool is_map = event->type == YAML_MAPPING_START_EVENT;
    TRY(create_node(node, is_map ? YAML_MAP : YAML_LIST, mark));

    if (is_map) {
        refuse_extras(reader, mark, event->data.mapping_start.anchor, event->data.mapping_start.tag);
        return read_map(reader, depth + 1, *node);
    }

    refuse_extras(reader, mark, event->data.sequence_start.anchor, event->data.sequence_start.tag);
    return yaml_read_list(reader, depth + 1, *node);
}

/* Read the only document of a stream. */
static enum status read_document(struct reader *reader, struct yaml_node **root) {
    enum { BEGIN, INSIDE, AFTER } stage = BEGIN;
    for (;;) {
        yaml_event_t event;
        TRY(next_event(reader, &event));
        const yaml_event_type_t type = event.type;
        const struct yaml_mark mark = mark_at(reader, event.start_mark);
        enum status status = STATUS_OK;
        if (type == YAML_DOCUMENT_START_EVENT) {
            if (stage == AFTER)
                yaml_errors_add(reader->errors, mark, "a second document ('---') begins here; keep one");
            if (stage == AFTER) status = STATUS_CASE;
            stage = INSIDE;
        } else if (type == YAML_DOCUMENT_END_EVENT) {
            stage = AFTER;
        } else if (stage == INSIDE) {
            status = read_node(reader, &event, 0, root);
        }
        yaml_event_delete(&event);
        TRY(status);
        if (type == YAML_STREAM_END_EVENT) return STATUS_OK;
    }
}

// ---- checks before parsing

/* The code point of the character at text and its size in bytes; -1 for invalid UTF-8. */
static long code_point(const unsigned char *text, size_t left, size_t *size) {
    const unsigned char first = text[0];
    *size = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    if (*size == 0 || *size > left) return -1;
    static const unsigned char payload[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
    long code = first & payload[*size];

    for (size_t i = 1; i < *size; i++) {
        if ((text[i] & 0xC0) != 0x80) return -1;
        code = code << 6 | (text[i] & 0x3F);
    }

    const bool overlong = (*size == 3 && code < 0x800) || (*size == 4 && code < 0x10000);
    return overlong || (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF ? -1 : code;
}

/* The size of a byte order mark, written by some editors and not skipped by libyaml. */
static size_t mark_size(const struct yaml_source *source) {
    return source->length >= 3 && memcmp(source->text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

/* Refuse invalid UTF-8 and control characters: one error at the first place. */
static enum status check_characters(const struct yaml_source *source, struct yaml_errors *errors) {
    const unsigned char *const text = (const unsigned char *)source->text;
    struct yaml_mark mark = {source, 1, 1};

    for (size_t i = mark_size(source), size; i < source->length; i += size) {
        const long code = code_point(text + i, source->length - i, &size);
        const bool is_control = (code < ' ' && code != '\t' && code != '\n' && code != '\r') ||
                                (code >= 0x7F && code < 0xA0 && code != 0x85) || code == 0xFFFE || code == 0xFFFF;
        if (code < 0 || is_control) {
            yaml_errors_add(errors, mark,
                            code < 0 ? "not valid UTF-8 (byte 0x%02X); is this a case file?"
                                     : "not a text file (control character 0x%02X); is this a case file?",
                            text[i]);
            return STATUS_CASE;
        }
        mark.column++;
        if (code == '\n') mark = (struct yaml_mark){source, mark.line + 1, 1};
    }

    return STATUS_OK;
}

/* Parse a source that has passed the checks of size and characters. */
static enum status read_text(struct yaml_node **root, const struct yaml_source *source, struct yaml_errors *errors) {
    struct reader reader = {.source = source, .errors = errors};
    if (!yaml_parser_initialize(&reader.parser)) return memory_check(NULL, what);
    yaml_parser_set_encoding(&reader.parser, YAML_UTF8_ENCODING);
    const size_t skipped = mark_size(source);
    yaml_parser_set_input_string(&reader.parser, (const unsigned char *)source->text + skipped,
                                 source->length - skipped);
    const enum status status = read_document(&reader, root);
    yaml_parser_delete(&reader.parser);
    return status;
}

enum status yaml_tree_read(struct yaml_node **root, const struct yaml_source *source, struct yaml_errors *errors) {
    *root = NULL;
    const struct yaml_mark start = {source, 1, 1};
    const int n_errors = errors->n;

    if (source->length > YAML_TREE_BYTES) {
        yaml_errors_add(errors, start, "larger than %d MiB; is this a case file?", YAML_TREE_BYTES >> 20);
        return STATUS_CASE;
    }

    TRY(check_characters(source, errors));
    enum status status = read_text(root, source, errors);
    if (status == STATUS_OK && errors->n > n_errors) status = STATUS_CASE;

    if (status != STATUS_OK) {
        yaml_tree_free(*root);
        *root = NULL;
    }

    return status;
}

void yaml_tree_check_keys(const struct yaml_node *map, const char *path, const char *known,
                          struct yaml_errors *errors) {
    for (int i = 0; i < map->n; i++) {
        const struct yaml_entry *const entry = &map->entry[i];
        const size_t length = strlen(entry->key);
        bool is_known = false;
        for (const char *word = known; *word && !is_known; word += strspn(word, ", ")) {
            const size_t n = strcspn(word, ",");
            is_known = n == length && strncmp(word, entry->key, n) == 0;
            word += n;
        }
        if (is_known) continue;
        yaml_errors_add(errors, entry->mark, "%s.%.40s: unknown key; known keys: %s", path, entry->key, known);
    }
}

bool yaml_tree_boolean(const struct yaml_node *node, const char *path, struct yaml_errors *errors) {
    const char *const word = node->kind == YAML_SCALAR ? node->text : "";
    const bool is_true = strcmp(word, "true") == 0;
    if (!is_true && strcmp(word, "false") != 0) yaml_errors_add(errors, node->mark, "%s: expects true or false", path);
    return is_true;
}

double yaml_tree_positive(const struct yaml_node *map, const char *path, const char *key, double standard,
                          struct yaml_errors *errors) {
    const struct yaml_node *const node = yaml_tree_find(map, key);
    double number;
    if (!node && !(standard == 0)) return standard;
    if (node && node->kind == YAML_SCALAR && text_number(node->text, &number) && number > 0 && isfinite(number)) {
        return number;
    }
    yaml_errors_add(errors, node ? node->mark : map->mark, "%s.%s: expects a number above 0", path, key);
    return NAN;
}

// ---- writing

/* True for the characters that are never special in YAML. */
static bool is_ordinary(char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return letter || (c >= '0' && c <= '9') || (c != '\0' && strchr("_./+-", c));
}

/* True if a string needs no quotes in YAML, also inside [ ] and { }. */
static bool is_plain(const char *scalar) {
    if (!is_ordinary(*scalar) || strcmp(scalar, "-") == 0 || strncmp(scalar, "- ", 2) == 0) return false;
    if (strncmp(scalar, "---", 3) == 0 || strncmp(scalar, "...", 3) == 0) return false;
    for (const char *c = scalar; *c; c++) {
        const bool inner_blank = *c == ' ' && c[1] != '\0';
        if (!is_ordinary(*c) && !inner_blank) return false;
    }
    return true;
}

void yaml_write_scalar(struct text *text, const char *scalar) {
    if (is_plain(scalar)) {
        text_add(text, "%s", scalar);
        return;
    }

    text_add(text, "\"");
    for (const char *c = scalar; *c; c++) {
        const unsigned char byte = (unsigned char)*c;
        if (*c == '"' || *c == '\\') {
            text_add(text, "\\%c", *c);
        } else if (byte < ' ' || byte == 0x7F) {
            text_add(text, "\\x%02X", byte);
        } else {
            text_add(text, "%c", *c);
        }
    }

    text_add(text, "\"");
}

void yaml_write_node(struct text *text, const struct yaml_node *node) {
    if (node->kind == YAML_SCALAR) {
        yaml_write_scalar(text, node->text);
        return;
    }

    text_add(text, node->kind == YAML_LIST ? "[" : "{");
    for (int i = 0; i < node->n; i++) {
        if (i > 0) text_add(text, ", ");
        if (node->kind == YAML_MAP) {
            yaml_write_scalar(text, node->entry[i].key);
            text_add(text, ": ");
        }
        yaml_write_node(text, node->entry[i].value);
    }

    text_add(text, node->kind == YAML_LIST ? "]" : "}");
}
