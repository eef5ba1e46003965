/* plain_file.c: a stream over a file in the making. */
#include "result/plain_file.h"

#include <errno.h>
#include <string.h>

static enum status failed(const char *path, int code) {
    return target_failed(path, code, strerror(code));
}

enum status plain_file_open(struct plain_file *file, const char *path, enum target_kind kind, bool overwrite,
                            unsigned permissions) {
    *file = (struct plain_file){.path = path, .kind = kind, .overwrite = overwrite};
    TRY(target_check(path, kind, overwrite));
    int code = durable_begin(&file->part, path, permissions);

    if (code == 0) {
        file->stream = fdopen(file->part.descriptor, "w");
        if (file->stream) return STATUS_OK;
        code = errno;
    }

    durable_end(&file->part);
    return failed(path, code);
}

enum status plain_file_close(struct plain_file *file, enum status status) {
    errno = 0;
    const bool is_broken = fflush(file->stream) != 0 || ferror(file->stream);
    if (status == STATUS_OK && is_broken) status = failed(file->path, errno);
    if (status == STATUS_OK) status = target_check(file->path, file->kind, file->overwrite);

    if (status == STATUS_OK) {
        const int code = durable_publish(&file->part, file->overwrite);
        if (code != 0) status = failed(file->path, code);
    }

    // the stream owns the descriptor
    const bool is_open = fclose(file->stream) != 0;
    file->part.descriptor = -1;
    if (is_open && status == STATUS_OK) status = failed(file->path, errno);
    durable_end(&file->part);
    return status;
}
