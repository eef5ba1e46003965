/* result_mark.c: the checksum of a result file's bytes, brought up to date as the file grows. */
#include "result/result_mark.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>
#include <zlib.h>

#include "result/netcdf.h"

enum { BLOCK = 1 << 16 };

// add the bytes of a file up to a place; errno or 0
static int add_bytes(int descriptor, uint64_t begin, uint64_t end, struct result_checksum *checksum) {
    unsigned char block[BLOCK];
    if (checksum->done == 0) *checksum = (struct result_checksum){begin, (uint32_t)crc32_z(0, NULL, 0)};

    while (checksum->done < end) {
        const uint64_t left = end - checksum->done;
        const ssize_t n = pread(descriptor, block, left < BLOCK ? (size_t)left : BLOCK, (off_t)checksum->done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n < 0 ? errno : EIO;
        checksum->value = (uint32_t)crc32_z(checksum->value, block, (size_t)n);
        checksum->done += (uint64_t)n;
    }

    return 0;
}

enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum,
                             struct result_mark *mark) {
    struct netcdf_rows rows;
    TRY(netcdf_read_rows(path, &rows));

    if (rows.bytes == 0 || n_rows < 0 || rows.n < (uint64_t)n_rows) {
        return status_fail(STATUS_FILE, "%s: has %llu rows, but the checkpoint requires %ld", path,
                           (unsigned long long)rows.n, n_rows);
    }

    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    int code = descriptor < 0 ? errno : 0;

    if (code == 0) {
        code = add_bytes(descriptor, rows.begin, rows.begin_of_rows + (uint64_t)n_rows * rows.bytes, checksum);
        close(descriptor);
    }

    *mark = (struct result_mark){n_rows, checksum->value};
    return code == 0 ? STATUS_OK : status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(code));
}

// Read the case and the run_status of a result.
static enum status check_attributes(const char *path, const char *effective, int *is_complete) {
    struct netcdf_reader reader;
    char *found = NULL, *run_status = NULL;
    TRY(netcdf_open(&reader, path));
    enum status status = netcdf_read_string(&reader, "case_effective", &found);
    if (status == STATUS_OK) status = netcdf_read_string(&reader, "run_status", &run_status);
    const size_t n_missing = reader.n_missing;
    netcdf_close(&reader);

    if (status == STATUS_OK) {
        *is_complete = strcmp(run_status, "complete") == 0 && n_missing == 0;
        if (strcmp(found, effective) != 0) {
            status = status_fail(STATUS_FILE, "%s is the result of another case than the checkpoint", path);
        }
    }

    free(found);
    free(run_status);
    return status;
}

enum status result_mark_check(const char *path, const struct result_mark *mark, const char *effective,
                              struct result_checksum *checksum, int *is_complete) {
    struct result_mark found;
    TRY(check_attributes(path, effective, is_complete));
    *checksum = (struct result_checksum){0};
    TRY(result_mark_take(path, mark->n_rows, checksum, &found));
    if (found.check == mark->check) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: the rows do not match the checkpoint: changed or damaged since", path);
}
