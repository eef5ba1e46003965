/* page.h: a run as one page of HTML to look at in a browser: page.html with the data of the run in it, which needs
 * nothing else. Tested by tests/view/test_page.c and, in a browser, tests/app/test_view.sh.
 *
 * The page stays below 8 MB: of a long run it has every n-th row, and of long wakes every m-th vortex, and says so. */
#ifndef PAGE_H
#define PAGE_H

#include <stdbool.h>

#include "base/status.h"

/* Write the page of the result file at from to the path to. Fails with STATUS_FILE, also where the school is too large
 * for a page, or with STATUS_MEMORY; nothing is then left. */
enum status page_write(const char *from, const char *to, bool overwrite);

#endif
