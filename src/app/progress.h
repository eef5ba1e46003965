/* progress.h: progress of a run or a study on stderr: on a terminal one line, redrawn and not
 * wider than the terminal; in a log one line per tenth. Tested by tests/app/test_command.sh. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "run/simulate_run.h"
#include "steady/steady.h"
#include "study/study.h"

struct progress {
    int terminal;    /* stderr is a terminal */
    double drawn_at; /* wall time of the run when the line was last drawn, s */
    int tenth;       /* of the run, as last reported in a log */
    int drawn;       /* the terminal shows a line */
};

/* Start a run. */
void progress_start(struct progress *progress);

/* Report the progress of a run; data is a struct progress. The signature fits simulate_options.progress. */
void progress_show(const struct simulate_progress *now, void *data);

/* Report the progress of a search for a steady state. The signature fits steady_options.progress. */
void progress_steady(const struct steady_progress *now, void *data);

/* Report the progress of a study. The signature fits study_options.progress. */
void progress_study(const struct study_progress *now, void *data);

/* Clear the progress line on a terminal before other output. */
void progress_end(struct progress *progress);

#endif
