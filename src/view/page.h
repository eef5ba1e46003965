/* page.h: a run as one page of HTML: page.html with the data of the run, without further files. Tested by
 * tests/view/test_page.c and, in a browser, tests/app/test_view.sh.
 *
 * The page stays below 8 MB: for a long run the page has every n-th row, and for long wakes every m-th vortex, with a
 * note. */
#ifndef PAGE_H
#define PAGE_H

#include <stdbool.h>

#include "base/status.h"

/* Write the page of the result file at from to the path to. Fails with STATUS_FILE, also for a school too large for a
 * page, or with STATUS_MEMORY; no file is then left. */
enum status page_write(const char *from, const char *to, bool overwrite);

#endif
