/* plain_file.h: a file of text that has its name only once it is whole. Tested by tests/view/test_page.c. */
#ifndef PLAIN_FILE_H
#define PLAIN_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"
#include "result/durable.h"
#include "result/target.h"

struct plain_file {
    FILE *stream; /* write here */
    struct durable_part part;
    const char *path;
    enum target_kind kind;
    bool overwrite;
};

/* Open a file for writing, with these permissions (0777 of a script). The path must live until it is closed. Fails with
 * STATUS_FILE (target_check) or STATUS_MEMORY; nothing is then left. */
enum status plain_file_open(struct plain_file *file, const char *path, enum target_kind kind, bool overwrite,
                            unsigned permissions);

/* Close the file and give it its name, unless status says that what should be in it has failed, or writing has; it is
 * then removed. Returns that status, or STATUS_FILE. */
enum status plain_file_close(struct plain_file *file, enum status status);

#endif
