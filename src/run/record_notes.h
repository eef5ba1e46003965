/* record_notes.h: what a result file says about the run as a whole: warnings, and how close two bodies have come.
 * Tested by tests/run/test_simulate.c and tests/library/test_python.sh. */
#ifndef RECORD_NOTES_H
#define RECORD_NOTES_H

#include "result/result_file.h"
#include "run/simulate.h"

/* Put all warnings about what the last row holds into the file, and where two bodies have been closest. warn is told
 * each warning with its data; it may be NULL. */
void record_notes_write(struct result_file *file, const struct simulation *simulation,
                        void (*warn)(const char *line, void *data), void *data);

#endif
