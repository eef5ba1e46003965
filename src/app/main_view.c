/* main_view.c: results for other programs to show. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "base/text.h"
#include "output/page.h"
#include "output/target.h"
#include "output/vtk.h"

/* Add the name of a file without its folders and its ending. */
static void add_stem(struct text *text, const char *path) {
    const char *const slash = strrchr(path, '/'), *const name = slash ? slash + 1 : path,
                      *const dot = strrchr(name, '.');
    text_add(text, "%.*s", (int)(dot && dot > name ? (size_t)(dot - name) : strlen(name)), name);
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
    if (status == STATUS_OK && !request->quiet) printf("%s\n", path.text);
    text_free(&path);
    return status;
}

enum status main_export(const struct request *request) {
    char *list = NULL;
    if (!request->vtk) return status_fail(STATUS_CASE, "export: to what? give --vtk FOLDER; see shoal export --help");
    TRY(vtk_export(request->positional, request->vtk, request->force, &list));
    if (!request->quiet) printf("%s\n", list);
    free(list);
    return STATUS_OK;
}
