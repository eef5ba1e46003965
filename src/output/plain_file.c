/* plain_file.c: written beside its place, and renamed. */
#include "output/plain_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "output/netcdf.h"

static enum status failed(const char *path) {
    return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place with -o", path,
                       strerror(errno));
}

enum status plain_file_open(struct plain_file *file, const char *path, bool overwrite) {
    enum { ENDING = 32 };
    *file = (struct plain_file){.path = path, .overwrite = overwrite};
    TRY(netcdf_check_target(path, overwrite));
    const size_t size = strlen(path) + ENDING;
    file->temporary = malloc(size);
    if (!file->temporary) return status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
    snprintf(file->temporary, size, "%s.%ld.part", path, (long)getpid());
    file->stream = fopen(file->temporary, "w");
    if (file->stream) return STATUS_OK;
    const enum status status = failed(path);
    free(file->temporary);
    return status;
}

/* Give the whole file its name; a link, unlike a renaming, replaces nothing that came in the meantime. A file system
 * without links has to do with the renaming. */
static int give_name(const struct plain_file *file) {
    if (!file->overwrite) {
        if (link(file->temporary, file->path) == 0) return unlink(file->temporary);
        if (errno == EEXIST) return -1;
    }
    return rename(file->temporary, file->path);
}

enum status plain_file_close(struct plain_file *file, enum status status) {
    errno = 0;
    const int broken = fflush(file->stream) != 0 || ferror(file->stream);
    if (status == STATUS_OK && broken) status = failed(file->path);
    if (fclose(file->stream) != 0 && status == STATUS_OK) status = failed(file->path);
    if (status == STATUS_OK && give_name(file) != 0) status = failed(file->path);
    if (status != STATUS_OK) unlink(file->temporary);
    free(file->temporary);
    return status;
}
