/* case_show.h: a case written out in full. Tested by tests/case/test_case.c. */
#ifndef CASE_SHOW_H
#define CASE_SHOW_H

#include "base/status.h"
#include "case/case_values.h"

/* The complete case with the values of all keys, as a case file from which case_read reads the same bits. The
 * caller frees *text. Fails with STATUS_MEMORY. */
enum status case_show(const struct case_values *values, char **text);

#endif
