/* result_info.h: the summary of the file of a run. Tested by tests/result/test_result_info.c. */
#ifndef RESULT_INFO_H
#define RESULT_INFO_H

#include <stdio.h>

#include "base/status.h"

/* Print the status of a run, the last values of every fish, and the effort of the solver. Fails with STATUS_FILE or
 * STATUS_MEMORY. */
enum status result_info(const char *path, FILE *stream);

#endif
