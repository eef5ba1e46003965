/* plain_file.h: a text file that gets the final name only when complete. Tested by tests/view/test_page.c. */
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

/* Open a file for writing, with these permissions (0777 of a script). The path must live until plain_file_close. Fails
 * with STATUS_FILE (target_check) or STATUS_MEMORY; no file is then left. */
enum status plain_file_open(struct plain_file *file, const char *path, enum target_kind kind, bool overwrite,
                            unsigned permissions);

/* Close the file and rename the file to the path; after a failure of the caller (status) or of writing, remove the
 * file. Returns status, or STATUS_FILE. */
enum status plain_file_close(struct plain_file *file, enum status status);

#endif
