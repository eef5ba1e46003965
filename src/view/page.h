/* page.h: makes one page of HTML from a run, page.html with the data. Tested by tests/view/test_page.c and, in a
 * browser, tests/extra/test_view.sh.
 *
 * The page stays below 8 MB. Of a long run it therefore holds only every n-th row, and of long wakes every m-th vortex,
 * with a note that says so. */
#ifndef PAGE_H
#define PAGE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"

/* Write the page of the result file at from to the path to. Fails with STATUS_FILE, also for a school too large for a
 * page, or with STATUS_MEMORY; no file is then left. */
enum status page_write(struct arena *arena, const char *from, const char *to, bool overwrite);

#endif
