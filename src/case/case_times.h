/* case_times.h: the default shedding interval, and times rounded to events. doc/model.md,
 * section 7. Tested by tests/case/test_case_times.c. */
#ifndef CASE_TIMES_H
#define CASE_TIMES_H

#include "case/case_values.h"

/* The frequency of the beat of a fish, or of the prescribed motion [Hz]; 0 without a beat. */
double case_times_beat(const struct fish_parameters *fish);

/* Set a shedding interval that was not read to 1/100 of the period of the fastest beat, or to 0.01 s without a beat.
 * Then round the end of the run up to an event, and the output and checkpoint intervals to the nearest multiples of the
 * shedding interval. Times that were not read are left unset. */
void case_times_derive(struct case_values *values);

#endif
