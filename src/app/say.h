/* say.h: prints text that may contain names of files or parts of them without their control characters, and lines of
 * progress. Tested by tests/app/test_exits.sh and tests/app/test_command.sh. */
#ifndef SAY_H
#define SAY_H

#include <stdio.h>

#include "base/status.h"
#include "run/simulate_run.h"
#include "steady/steady.h"
#include "study/study.h"

/* Print to a stream (printf format): text_print_clean. */
void say_line(FILE *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Collect text in a stream and print the text at the end. */
struct say_page {
    FILE *stream; /* write here */
    char *text;
    size_t n;
};

/* Begin a page; fails with STATUS_MEMORY. */
enum status say_begin(struct say_page *page);

/* Print the page to a stream (NULL: nowhere), even after a failure of the writer with this status. Returns the status
 * of the writer, or STATUS_MEMORY. */
enum status say_end(struct say_page *page, FILE *stream, enum status status);

/* Progress of a run or a study on stderr: on a terminal one line, redrawn and not wider than the terminal; in a log one
 * line per tenth. */
struct progress {
    int terminal;        /* stderr is a terminal */
    double drawn_at;     /* wall time of the run when the line was last drawn, s */
    int tenth;           /* of the run, as last reported in a log */
    int drawn;           /* the terminal shows a line */
    const char *checked; /* study_progress.checked of the last report */
};

/* Start a run. */
void say_progress_start(struct progress *progress);

/* Report the progress of a run, of a search for a steady state, or of a study; data begins with a struct progress. The
 * signatures fit the member progress of the options. */
void say_progress_run(const struct simulate_progress *now, void *data);
void say_progress_steady(const struct steady_progress *now, void *data);
void say_progress_study(const struct study_progress *now, void *data);

/* Clear the progress line on a terminal before other output. */
void say_progress_end(struct progress *progress);

#endif
