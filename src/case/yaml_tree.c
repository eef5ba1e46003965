/* yaml_tree.c: builds a tree from the events of libyaml, within limits, and refuses what a case may not contain. */
#include "case/yaml_tree.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <yaml.h>

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
    errors->kept[errors->n - 1].text = arena_text(errors->arena, "%s", text);
}

/* The size of a byte order mark, written by some editors and not skipped by libyaml. */
static size_t mark_size(const struct yaml_source *source) {
    return source->length >= 3 && memcmp(source->text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

/* The bytes of one character of UTF-8, at most up to end. */
static size_t character_size(const char *from, const char *end) {
    size_t size = 1;
    while (from + size < end && ((unsigned char)from[size] & 0xC0) == 0x80) size++;
    return size;
}

/* Add the source line of a mark and a caret under the mark; of a long line only the neighbourhood of the mark. */
static void add_excerpt(struct text *list, struct yaml_mark mark) {
    // find the line
    const char *from = mark.source->text;
    const char *end = from + mark.source->length;
    from += mark_size(mark.source);
    for (int line = 1; line < mark.line && from < end; from++) {
        const bool return_only = *from == '\r' && !(from + 1 < end && from[1] == '\n');
        if (*from == '\n' || return_only) line++;
    }
    const char *stop = from;
    while (stop < end && *stop != '\n' && *stop != '\r') stop++;
    end = stop;

    // begin half an excerpt before the mark
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

char *yaml_errors_list(struct arena *arena, const struct yaml_errors *errors, const char *word) {
    // sort the kept errors by place; errors at one place keep the order of detection
    int order[YAML_ERRORS_KEPT], n = 0;
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

    struct text list = {.arena = arena};
    for (int i = 0; i < n && i < YAML_ERRORS_SHOWN; i++) {
        const struct yaml_mark mark = errors->kept[order[i]].mark;
        const char *const text = errors->kept[order[i]].text;
        if (i > 0) text_add(&list, "\n");
        if (mark.source->one_line) {
            text_add(&list, "%s: %s: %s", mark.source->name, word, text);
        } else {
            text_add(&list, "%s:%d:%d: %s: %s", mark.source->name, mark.line, mark.column, word, text);
            add_excerpt(&list, mark);
        }
    }
    if (errors->n > YAML_ERRORS_SHOWN) text_add(&list, "\n... and %d more", errors->n - YAML_ERRORS_SHOWN);
    text_add(&list, "%s", "");
    return list.text;
}

enum status yaml_errors_status(const struct yaml_errors *errors) {
    if (errors->n == 0) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s", yaml_errors_list(errors->arena, errors, "error"));
}

// ---- the tree

struct yaml_node *yaml_tree_node(struct arena *arena, enum yaml_kind kind, struct yaml_mark mark) {
    struct yaml_node *node;
    NEW(arena, node, 1);
    node->kind = kind;
    node->mark = mark;
    return node;
}

/* Append an entry with a copy of the key (NULL in a list). */
static void append_node(struct arena *arena, struct yaml_node *node, const char *key, struct yaml_mark mark,
                        struct yaml_node *value) {
    if (node->n == node->capacity) {
        node->capacity = 2 * node->capacity + 4;
        GROW(arena, node->entry, node->capacity);
    }
    node->entry[node->n++] = (struct yaml_entry){key ? arena_text(arena, "%s", key) : NULL, mark, value};
}

struct yaml_node *yaml_tree_copy(struct arena *arena, const struct yaml_node *node) {
    struct yaml_node *const copy = yaml_tree_node(arena, node->kind, node->mark);
    copy->text = node->text ? arena_text(arena, "%s", node->text) : NULL;
    for (int i = 0; i < node->n; i++) {
        append_node(arena, copy, node->entry[i].key, node->entry[i].mark, yaml_tree_copy(arena, node->entry[i].value));
    }
    return copy;
}

struct yaml_entry *yaml_tree_entry(const struct yaml_node *map, const char *key, size_t length) {
    if (!map || map->kind != YAML_MAP) return NULL;
    for (int i = 0; i < map->n; i++) {
        // most keys differ in the first letter
        const char *const own = map->entry[i].key;
        if (length > 0 && *own != *key) continue;
        if (strncmp(own, key, length) == 0 && own[length] == '\0') return &map->entry[i];
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

void yaml_tree_put(struct arena *arena, struct yaml_node *map, const char *key, struct yaml_mark mark,
                   struct yaml_node *value) {
    struct yaml_entry *const entry = yaml_tree_entry(map, key, strlen(key));
    if (entry) {
        entry->mark = mark;
        yaml_tree_merge(arena, &entry->value, value);
    } else {
        append_node(arena, map, key, mark, value);
    }
}

void yaml_tree_merge(struct arena *arena, struct yaml_node **base, struct yaml_node *over) {
    if (!*base || (*base)->kind != YAML_MAP || over->kind != YAML_MAP) {
        *base = over;
        return;
    }
    for (int i = 0; i < over->n; i++) {
        yaml_tree_put(arena, *base, over->entry[i].key, over->entry[i].mark, over->entry[i].value);
    }
    (*base)->mark = over->mark;
}

struct yaml_node *yaml_tree_take(struct yaml_node *map, const char *key) {
    struct yaml_entry *const entry = yaml_tree_entry(map, key, strlen(key));
    if (!entry) return NULL;
    struct yaml_node *const value = entry->value;
    map->n--;
    memmove(entry, entry + 1, (size_t)(&map->entry[map->n] - entry) * sizeof *entry);
    return value;
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

// ---- events of libyaml

/* The parser holds one event at a time. Its own arena releases it, also if memory is lacking. */
struct reader {
    yaml_parser_t parser;
    yaml_event_t event;
    const struct yaml_source *source;
    struct arena *arena; /* of the nodes */
    struct yaml_errors *errors;
};

static void release_reader(void *object) {
    struct reader *const reader = object;
    yaml_event_delete(&reader->event);
    yaml_parser_delete(&reader->parser);
}

static struct yaml_mark mark_at(const struct reader *reader, yaml_mark_t mark) {
    return (struct yaml_mark){reader->source, (int)mark.line + 1, (int)mark.column + 1};
}

/* Replace the event by the next one, or add the error of libyaml to the list, with a remedy for the most frequent ones.
 */
static enum status next_event(struct reader *reader) {
    yaml_event_delete(&reader->event);
    if (yaml_parser_parse(&reader->parser, &reader->event)) return STATUS_OK;

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
    const yaml_parser_t *const parser = &reader->parser;
    if (parser->error == YAML_MEMORY_ERROR) arena_lack(reader->arena, 0);
    const char *const problem = parser->problem ? parser->problem : "not readable";
    const char *remedy = "this is not valid YAML";
    for (size_t i = 0; i < sizeof remedies / sizeof *remedies; i++) {
        if (strcmp(problem, remedies[i][0]) == 0) remedy = remedies[i][1];
    }

    // a tab in the indentation of the line
    struct yaml_mark mark = mark_at(reader, parser->problem_mark);
    const char *place = mark.source->text, *const end = place + mark.source->length;
    for (int line = 1; line < mark.line && place < end; place++) line += *place == '\n';
    while (place < end && *place == ' ') place++;
    if (place < end && *place == '\t') {
        mark.column = 1;
        yaml_errors_add(reader->errors, mark, "the line is indented with a tab; use blanks");
        return STATUS_CASE;
    }

    if (!parser->context) {
        yaml_errors_add(reader->errors, mark, "%s (%s)", remedy, problem);
        return STATUS_CASE;
    }

    // for a bracket or quote that is not closed, report the opening, not the end of the file
    const struct yaml_mark begin = mark_at(reader, parser->context_mark);
    if (strcmp(problem, "found unexpected end of stream") == 0) mark = begin;
    yaml_errors_add(reader->errors, mark, "%s (%s, line %d: %s)", remedy, parser->context, begin.line, problem);
    return STATUS_CASE;
}

// ---- from events to nodes

/* Refuse the anchor and the tag of a node; reading continues. */
static void refuse_extras(struct reader *reader, const unsigned char *anchor, const unsigned char *tag) {
    const struct yaml_mark mark = mark_at(reader, reader->event.start_mark);
    if (anchor) {
        yaml_errors_add(reader->errors, mark,
                        "anchors ('&') are not used in case files; put shared values under defaults");
    }
    if (tag) yaml_errors_add(reader->errors, mark, "tags ('!') are not used in case files; the key decides the type");
}

static struct yaml_node *read_scalar(struct reader *reader) {
    const yaml_event_t *const event = &reader->event;
    const char *const text = (const char *)event->data.scalar.value;
    struct yaml_node *const node = yaml_tree_node(reader->arena, YAML_SCALAR, mark_at(reader, event->start_mark));
    refuse_extras(reader, event->data.scalar.anchor, event->data.scalar.tag);
    if (strlen(text) != event->data.scalar.length) {
        yaml_errors_add(reader->errors, node->mark, "a string cannot contain a zero byte");
    }
    node->text = arena_text(reader->arena, "%s", text);
    return node;
}

static enum status read_node(struct reader *reader, int depth, struct yaml_node **node);

/* Read the next key of a map, at the present event, and the value; a refused key is left out. */
static enum status read_entry(struct reader *reader, int depth, struct yaml_node *map) {
    const struct yaml_mark mark = mark_at(reader, reader->event.start_mark);
    if (reader->event.type != YAML_SCALAR_EVENT) {
        yaml_errors_add(reader->errors, mark, "a key must be a plain word, without brackets or braces");
        return STATUS_CASE;
    }

    const char *const key = read_scalar(reader)->text;
    if (map->n == YAML_TREE_KEYS) {
        yaml_errors_add(reader->errors, mark, "more than %d keys in one map", YAML_TREE_KEYS);
        return STATUS_CASE;
    }

    struct yaml_node *value;
    TRY(next_event(reader));
    TRY(read_node(reader, depth, &value));
    const struct yaml_entry *const twin = yaml_tree_entry(map, key, strlen(key));
    if (strcmp(key, "<<") == 0) {
        yaml_errors_add(reader->errors, mark,
                        "merge keys ('<<') are not used in case files; put shared values under defaults");
    } else if (twin) {
        yaml_errors_add(reader->errors, mark, "the key '%.40s' is here twice; the first is on line %d: remove one", key,
                        twin->mark.line);
    } else {
        append_node(reader->arena, map, key, mark, value);
    }
    return STATUS_OK;
}

/* Read the node that begins with the present event. */
static enum status read_node(struct reader *reader, int depth, struct yaml_node **node) {
    const yaml_event_t *const event = &reader->event;
    const struct yaml_mark mark = mark_at(reader, event->start_mark);
    if (event->type == YAML_SCALAR_EVENT) {
        *node = read_scalar(reader);
        return STATUS_OK;
    }

    if (event->type == YAML_ALIAS_EVENT) {
        yaml_errors_add(reader->errors, mark, "aliases ('*') are not used in case files; write the value");
        return STATUS_CASE;
    }

    if (depth == YAML_TREE_DEPTH) {
        yaml_errors_add(reader->errors, mark, "nested deeper than %d levels", YAML_TREE_DEPTH);
        return STATUS_CASE;
    }

    const bool is_map = event->type == YAML_MAPPING_START_EVENT;
    *node = yaml_tree_node(reader->arena, is_map ? YAML_MAP : YAML_LIST, mark);
    if (is_map) {
        refuse_extras(reader, event->data.mapping_start.anchor, event->data.mapping_start.tag);
    } else {
        refuse_extras(reader, event->data.sequence_start.anchor, event->data.sequence_start.tag);
    }

    for (;;) {
        TRY(next_event(reader));
        if (event->type == YAML_MAPPING_END_EVENT || event->type == YAML_SEQUENCE_END_EVENT) return STATUS_OK;
        if (is_map) {
            TRY(read_entry(reader, depth + 1, *node));
        } else {
            struct yaml_node *value;
            TRY(read_node(reader, depth + 1, &value));
            append_node(reader->arena, *node, NULL, value->mark, value);
        }
    }
}

// ---- a source

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

/* Refuse a long source, and invalid UTF-8 and control characters: one error at the first place. */
static enum status check_source(const struct yaml_source *source, struct yaml_errors *errors) {
    const unsigned char *const text = (const unsigned char *)source->text;
    struct yaml_mark mark = {source, 1, 1};
    if (source->length > YAML_TREE_BYTES) {
        yaml_errors_add(errors, mark, "larger than %d MiB; is this a case file?", YAML_TREE_BYTES >> 20);
        return STATUS_CASE;
    }

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

enum status yaml_tree_read(struct arena *arena, struct yaml_node **root, const struct yaml_source *source,
                           struct yaml_errors *errors) {
    *root = NULL;
    const int n_errors = errors->n;
    TRY(check_source(source, errors));

    struct arena *const of_reader = arena_create(arena, "the reader of a case file");
    struct reader *reader;
    NEW(of_reader, reader, 1);
    *reader = (struct reader){.source = source, .arena = arena, .errors = errors};
    if (!yaml_parser_initialize(&reader->parser)) arena_lack(arena, 0);
    arena_defer(of_reader, release_reader, reader);
    yaml_parser_set_encoding(&reader->parser, YAML_UTF8_ENCODING);
    const size_t skipped = mark_size(source);
    yaml_parser_set_input_string(&reader->parser, (const unsigned char *)source->text + skipped,
                                 source->length - skipped);

    // the only document of the source
    enum status status = STATUS_OK;
    bool has_begun = false, has_ended = false, is_at_end = false;
    while (status == STATUS_OK && !is_at_end) {
        status = next_event(reader);
        if (status != STATUS_OK) break;
        switch (reader->event.type) {
            case YAML_STREAM_END_EVENT: is_at_end = true; break;
            case YAML_DOCUMENT_START_EVENT:
                has_begun = true;
                if (!has_ended) break;
                yaml_errors_add(errors, mark_at(reader, reader->event.start_mark),
                                "a second document ('---') begins here; keep one");
                status = STATUS_CASE;
                break;
            case YAML_DOCUMENT_END_EVENT: has_ended = true; break;
            default:
                if (has_begun && !has_ended) status = read_node(reader, 0, root);
        }
    }
    arena_free(of_reader);
    if (errors->n == n_errors) return STATUS_OK;
    *root = NULL;
    return STATUS_CASE;
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
    return standard;
}

// ---- writing

void yaml_write_scalar(struct text *text, const char *scalar) {
    // a string of ordinary characters needs no quotes in YAML, not even inside [ ] and { }
    static const char ordinary[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+- ";
    const size_t length = strlen(scalar);
    const bool is_indicator = strcmp(scalar, "-") == 0 || strncmp(scalar, "- ", 2) == 0 ||
                              strncmp(scalar, "---", 3) == 0 || strncmp(scalar, "...", 3) == 0;
    if (length > 0 && strspn(scalar, ordinary) == length && *scalar != ' ' && scalar[length - 1] != ' ' &&
        !is_indicator) {
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
