/* record_notes.h: attributes of a result file about the whole run: warnings and the closest approach of two bodies.
 * Tested by tests/run/test_simulate.c and tests/library/test_python.sh. */
#ifndef RECORD_NOTES_H
#define RECORD_NOTES_H

#include "result/result_file.h"
#include "run/simulate.h"

/* Write all warnings about the last row and the closest approach of two bodies into the file. Call warn, which may be
 * NULL, for each warning with data. */
void record_notes_write(struct result_file *file, const struct simulation *simulation,
                        void (*warn)(const char *line, void *data), void *data);

#endif
