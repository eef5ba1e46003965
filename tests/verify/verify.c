/* verify.c: the program of one section: verify SECTION [--fast] [-o TABLE]. Exit code 0, or 3 if a bound is missed. */
#include "verify.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct arena *arena; /* of the simulations of the section */
static int fast, n_checks, n_missed;
static FILE *table;
static const char *section;

static const struct {
    const char *name;
    void (*run)(void);
} sections[] = {{"theory", verify_theory},
                {"rod", verify_rod},
                {"force", verify_force},
                {"sheet", verify_sheet},
                {"wake", verify_wake},
                {"plate", verify_plate},
                {"school", verify_school},
                {"interval", verify_interval},
                {"symmetry", verify_symmetry},
                {"start", verify_start},
                {"energy", verify_energy},
                {"momentum", verify_momentum},
                {"fish", verify_fish},
                {"control", verify_control},
                {"pressure", verify_pressure},
                {"depth", verify_depth},
                {"encounters", verify_encounters},
                {"skin", verify_skin},
                {"elastic", verify_elastic},
                {"coupled", verify_coupled},
                {"steady", verify_steady},
                {"static", verify_static},
                {"tandem", verify_tandem},
                {"growth", verify_growth},
                {"walls", verify_walls},
                {"validation", verify_validation}};

int verify_is_fast(void) {
    return fast;
}

// one row: on the screen in columns, in the table with tabs; an empty text in place of a missing number
static void row(const char *quantity, const char *source, const char *reference, const char *obtained,
                const char *error, const char *bound, const char *order, const char *verdict) {
    printf("%-8s %-58s %14s %14s %10s %12s %s\n", section, quantity, reference, obtained, error, bound, verdict);
    fflush(stdout);
    if (!table) return;
    fprintf(table, "row\t%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n", section, quantity, source, reference, obtained, error,
            bound, order, verdict);
}

static const char *judge(int passed) {
    n_checks++;
    if (!passed) n_missed++;
    return passed ? "ok" : "MISSED";
}

static void compare(const char *quantity, const char *source, double reference, double obtained, double error,
                    double bound, const char *unit) {
    char texts[4][32];
    snprintf(texts[0], sizeof texts[0], "%.10g", reference);
    snprintf(texts[1], sizeof texts[1], "%.10g", obtained);
    snprintf(texts[2], sizeof texts[2], "%.1e%s", error, unit);
    snprintf(texts[3], sizeof texts[3], "%.1e%s", bound, unit);
    row(quantity, source, texts[0], texts[1], texts[2], texts[3], "", judge(error <= bound));
}

void verify_value(const char *quantity, const char *source, double reference, double obtained, double bound) {
    compare(quantity, source, reference, obtained, fabs(obtained - reference), bound, "");
}

void verify_relative(const char *quantity, const char *source, double reference, double obtained, double bound) {
    compare(quantity, source, reference, obtained, fabs(obtained / reference - 1), bound, " rel");
}

void verify_zero(const char *quantity, const char *source, double obtained, double bound) {
    compare(quantity, source, 0, obtained, fabs(obtained), bound, "");
}

void verify_order(const char *quantity, const char *source, double order, double least, double most) {
    char obtained[32], bounds[64];
    snprintf(obtained, sizeof obtained, "%.2f", order);
    snprintf(bounds, sizeof bounds, "%.2f to %.2f", least, most);
    row(quantity, source, "", "", "", bounds, obtained, judge(order >= least && order <= most));
    printf("%-8s %-58s order %s\n", "", "", obtained);
}

static void check_ratio(const char *quantity, const char *source, double reference, double obtained, double least,
                        double most, const char *kind) {
    char texts[4][48];
    const double ratio = obtained / reference;
    snprintf(texts[0], sizeof texts[0], "%.4g", reference);
    snprintf(texts[1], sizeof texts[1], "%.4g", obtained);
    snprintf(texts[2], sizeof texts[2], "x %.3f", ratio);
    snprintf(texts[3], sizeof texts[3], "x %.2f to %.2f%s", least, most, kind);
    row(quantity, source, texts[0], texts[1], texts[2], texts[3], "", judge(ratio >= least && ratio <= most));
}

void verify_ratio(const char *quantity, const char *source, double reference, double obtained, double least,
                  double most) {
    check_ratio(quantity, source, reference, obtained, least, most, "");
}

void verify_regression(const char *quantity, const char *source, double reference, double obtained, double least,
                       double most) {
    check_ratio(quantity, source, reference, obtained, least, most, " (regression)");
}

void verify_show(const char *quantity, const char *source, double obtained) {
    char text[32];
    snprintf(text, sizeof text, "%.6g", obtained);
    row(quantity, source, "", text, "", "", "", "");
}

void verify_point(const char *figure, const char *series, double x, double y) {
    if (table) fprintf(table, "point\t%s\t%s\t%.17g\t%.17g\n", figure, series, x, y);
}

double verify_order_of_errors(double coarse, double fine) {
    return log2(fabs(coarse / fine));
}

double verify_order_of_values(double coarse, double middle, double fine) {
    return log2(fabs((coarse - middle) / (middle - fine)));
}

double verify_slope(int n, const double *x, const double *y) {
    double mean[2] = {0}, square = 0, product = 0;
    for (int i = 0; i < n; i++) {
        mean[0] += log(x[i]) / n;
        mean[1] += log(y[i]) / n;
    }
    for (int i = 0; i < n; i++) {
        square += (log(x[i]) - mean[0]) * (log(x[i]) - mean[0]);
        product += (log(x[i]) - mean[0]) * (log(y[i]) - mean[1]);
    }
    return product / square;
}

const char *verify_text(const char *format, ...) {
    static char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

static _Noreturn void give_up(void) {
    fprintf(stderr, "verify %s: %s\n", section, status_message());
    exit(1);
}

void verify_ok(enum status status) {
    if (status != STATUS_OK) give_up();
}

static struct simulation *start(struct case_values *values) {
    struct simulation *simulation;
    if (simulate_start(arena, &simulation, values, NULL) != STATUS_OK) give_up();
    case_free(values);
    return simulation;
}

struct simulation *verify_open(const char *format, ...) {
    char text[16384] = "";
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    // other includes are those of a case of cases/
    const char *const folder = strstr(text, VERIFY_ARTICLE) ? "." : "cases";
    struct case_values values;
    if (case_parse(&values, text, (size_t)length, "verify", folder, 0, NULL) != STATUS_OK) give_up();
    return start(&values);
}

struct simulation *verify_open_case(const char *name, int n, const char *const *assignments) {
    char path[256];
    struct case_values values;
    snprintf(path, sizeof path, "cases/%s", name);
    if (case_read(&values, path, n, assignments) != STATUS_OK) give_up();
    return start(&values);
}

void verify_search_open(struct verify_search *search, const char *text) {
    search->simulation = verify_open("%s", text);
    verify_ok(case_parse(&search->values, text, strlen(text), "verify", ".", 0, NULL));
    arena_move(search->values.arena, arena);
    verify_ok(steady_problem_create(&search->problem, &search->values.steady, search->simulation));
}

void verify_run(struct simulation *simulation, double t) {
    while (simulation->state->t < t - simulation->school->interval / 2) {
        if (simulate_step(simulation) != STATUS_OK) give_up();
    }
}

int main(int argc, char **argv) {
    void (*run)(void) = NULL;
    for (int i = 1; i < argc; i++) {
        for (size_t s = 0; s < sizeof sections / sizeof *sections; s++) {
            if (strcmp(argv[i], sections[s].name) == 0) {
                run = sections[s].run;
                section = sections[s].name;
            }
        }
        if (strcmp(argv[i], "--fast") == 0) fast = 1;
        if (strcmp(argv[i], "-o") == 0 && i + 1 < argc) table = fopen(argv[++i], "w");
    }
    if (!run) {
        fprintf(stderr, "usage: verify SECTION [--fast] [-o TABLE]\n");
        return 2;
    }
    arena = arena_create(NULL, "a section");
    run();
    arena_free(arena);
    if (table) fclose(table);
    printf("%s: %d checks, %d missed\n", section, n_checks, n_missed);
    return n_missed > 0 ? 3 : 0;
}
