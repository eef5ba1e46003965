/* main_view.c: shoal view and export: results for other programs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/say.h"
#include "base/text.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "view/page.h"
#include "view/vtk.h"

/* Add the name of a file without folders and ending. */
static void add_stem(struct text *text, const char *path) {
    const char *const slash = strrchr(path, '/'), *const name = slash ? slash + 1 : path,
                      *const dot = strrchr(name, '.');
    text_add(text, "%.*s", (int)(dot && dot > name ? (size_t)(dot - name) : strlen(name)), name);
}

/* Print a note on rows that are missing because the file is truncated. */
static void note_missing(const char *path) {
    struct netcdf_rows rows;
    if (netcdf_read_rows(path, &rows) != STATUS_OK || rows.n == 0 || rows.n == rows.n_counted) return;
    say_line(stderr, "shoal: note: %s: the last %llu of %llu rows are missing: the file was cut off\n", path,
             (unsigned long long)(rows.n_counted - rows.n), (unsigned long long)rows.n_counted);
}

enum status main_view(const struct request *request) {
    struct text path = {0};
    if (request->output) TRY(target_refuse_input(request->output, request->positional));
    if (request->output) {
        text_add(&path, "%s", request->output);
    } else {
        add_stem(&path, request->positional);
        text_add(&path, ".html");
    }

    const enum status status = path.failed ? status_fail(STATUS_MEMORY, "out of memory: a file name")
                                           : page_write(request->positional, path.text, request->force);
    if (status == STATUS_OK) note_missing(request->positional);
    if (status == STATUS_OK && !request->quiet) say_line(stdout, "%s\n", path.text);
    text_free(&path);
    return status;
}

enum status main_export(const struct request *request) {
    char *list = NULL;
    if (!request->vtk)
        return status_fail(STATUS_CASE, "export: choose a format: --vtk FOLDER; see shoal export --help");
    TRY(vtk_export(request->positional, request->vtk, request->force, &list));
    note_missing(request->positional);
    if (!request->quiet) say_line(stdout, "%s\n", list);
    free(list);
    return STATUS_OK;
}
