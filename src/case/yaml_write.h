/* yaml_write.h: values written as YAML. Tested by tests/case/test_yaml.c. */
#ifndef YAML_WRITE_H
#define YAML_WRITE_H

#include "base/text.h"
#include "case/yaml_tree.h"

/* Add a string, quoted if YAML needs quotes. */
void yaml_write_scalar(struct text *text, const char *scalar);

/* Add any value on one line: [1, 2] and {a: 1}. */
void yaml_write_node(struct text *text, const struct yaml_node *node);

#endif
