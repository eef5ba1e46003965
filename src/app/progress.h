/* progress.h: how far a run or a study is, on stderr: on a terminal one line, redrawn; in a log one line per tenth. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "run/simulate_run.h"
#include "steady/steady.h"
#include "study/study.h"

struct progress {
    int terminal;    /* stderr is one */
    double drawn_at; /* wall time of the run when the line was last drawn, s */
    int tenth;       /* of the run that a log last reported */
    int drawn;       /* there is a line on the terminal */
};

/* Start a run. */
void progress_start(struct progress *progress);

/* Report how far it is; data is a struct progress. Fits simulate_options.progress. */
void progress_show(const struct simulate_progress *now, void *data);

/* How far a search for a steady state is. Fits steady_options.progress. */
void progress_steady(const struct steady_progress *now, void *data);

/* The same for the members of a study. Fits study_options.progress. */
void progress_study(const struct study_progress *now, void *data);

/* Clear the line of a terminal, so that what is printed next has a line of its own. */
void progress_end(struct progress *progress);

#endif
