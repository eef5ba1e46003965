/* case_times.h: the shedding interval of a case that does not give one, and the times that fit it. doc/model.md,
 * section 7. Tested by tests/case/test_case_times.c. */
#ifndef CASE_TIMES_H
#define CASE_TIMES_H

#include "case/case_values.h"

/* The beats per second of a fish, or those of its prescribed motion; 0 where it has none. */
double case_times_beat(const struct fish_parameters *fish);

/* Set the shedding interval, where it was not read, to a hundredth of the period of the fastest beat, which then has
 * 100 events; without a beat to 0.01 s. The end of the run, where it is no event then, becomes the next event; the
 * times between outputs and between checkpoints become the nearest multiples of the interval. A time that was not read
 * stays so. */
void case_times_derive(struct case_values *values);

#endif
