/* yaml_write.c: strings with quotes where YAML needs quotes. */
#include "case/yaml_write.h"

#include <stdbool.h>
#include <string.h>

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
