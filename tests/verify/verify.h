/* verify.h: checks against classical results. `make verify` runs every section in a separate process; each check prints
 * one row and adds the row to a table, from which scripts/verify.py writes the report and doc/verification.md.
 *
 *     section --> rows: quantity | source | reference | obtained | error | bound | order
 *             \-> points of figures: figure | series | x | y
 */
#ifndef VERIFY_H
#define VERIFY_H

#include "steady/steady_problem.h"

/* The sections, in the order of doc/verification.md; one file each. */
void verify_theory(void);
void verify_rod(void);
void verify_force(void);
void verify_sheet(void);
void verify_wake(void);
void verify_plate(void);
void verify_school(void);
void verify_interval(void);
void verify_symmetry(void);
void verify_start(void);
void verify_energy(void);
void verify_momentum(void);
void verify_fish(void);
void verify_control(void);
void verify_pressure(void);
void verify_depth(void);
void verify_encounters(void);
void verify_skin(void);
void verify_elastic(void);
void verify_coupled(void);
void verify_steady(void);
void verify_static(void);
void verify_tandem(void);
void verify_growth(void);
void verify_walls(void);
void verify_validation(void);

/* Only the checks that take seconds are wanted: `make test` runs those. */
int verify_is_fast(void);

/* A check: |obtained - reference| <= bound; or, relative, |obtained - reference| <= bound |reference|. source: origin
 * of the reference. */
void verify_value(const char *quantity, const char *source, double reference, double obtained, double bound);
void verify_relative(const char *quantity, const char *source, double reference, double obtained, double bound);

/* A check: |obtained| <= bound, for a reference of zero. */
void verify_zero(const char *quantity, const char *source, double obtained, double bound);

/* A check: an observed order of convergence between least and most. */
void verify_order(const char *quantity, const char *source, double order, double least, double most);

/* A validation: the ratio of the result to a measured or more accurate value is between least and most, which contain
 * what the source says of its error or its range. */
void verify_ratio(const char *quantity, const char *source, double reference, double obtained, double least,
                  double most);

/* A regression: as verify_ratio, but least and most are drawn round the result that the program had. They show that it
 * has changed, and say nothing about the water; the ratio itself is the validation. The table says "regression". */
void verify_regression(const char *quantity, const char *source, double reference, double obtained, double least,
                       double most);

/* No check: a number that the reader wants to see. */
void verify_show(const char *quantity, const char *source, double obtained);

/* A point of a figure; scripts/verify.py knows how each figure is drawn. */
void verify_point(const char *figure, const char *series, double x, double y);

/* The observed order from three errors, or values, at refinement ratio two: log2(|e1| / |e2|) and
 * log2(|v1 - v2| / |v2 - v3|). */
double verify_order_of_errors(double coarse, double fine);
double verify_order_of_values(double coarse, double middle, double fine);

/* The slope of the line through the logarithms of n points. */
double verify_slope(int n, const double *x, const double *y);

/* A text (printf format) that lives until the next one is made. */
const char *verify_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The line that gives a text the model of the article where it does not say otherwise. */
#define VERIFY_ARTICLE "include: [tests/verify/data/article.yaml]\n"

/* The keys of a fish with the pressure of attached flow as in linear theory: full suction, and the friction of a
 * laminar boundary layer on a plate. */
#define VERIFY_ATTACHED "force: pressure, pressure: {span: infinite, suction_limit: 0}, drag: {skin: laminar}"

/* Open a case given as text (printf format), with at most 16 kB; the section ends with the message where that fails.
 * The simulation lives until the end of the section; where there are many, simulate_free releases each earlier. */
struct simulation *verify_open(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Open a case of cases/, with n assignments "path=value". */
struct simulation *verify_open_case(const char *name, int n, const char *const *assignments);

/* A search for the steady state of a case. */
struct verify_search {
    struct case_values values;
    struct simulation *simulation;
    struct steady_problem problem;
};

/* Open a case given as text, as verify_open, for steady_search_run. */
void verify_search_open(struct verify_search *search, const char *text);

/* The section ends with the message unless the status is STATUS_OK. */
void verify_ok(enum status status);

/* Step until the time has come; the section ends with the message where that fails. */
void verify_run(struct simulation *simulation, double t);

#endif
