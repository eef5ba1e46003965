/* result_reader.h: reads the file of a run row by row, and checks every variable against the table. Tested by
 * tests/view/test_page.c. */
#ifndef RESULT_READER_H
#define RESULT_READER_H

#include "result/netcdf.h"
#include "result/result_table.h"

struct result_reader {
    struct netcdf_reader file;
    size_t length[RESULT_N_DIMENSIONS]; /* of the dimensions; length[TIME] is the number of rows */
    char *title, *run_status;           /* case and run_status */
    char **name;                        /* of the fish                                 (FISH) */
    int *n_nodes, *n_sheet;             /* of each fish                                (FISH) */
    bool *has_mean_section;             /* edge_thickness is a mean over the edge      (FISH) */
    double *wake_part;                  /* lifetime of its wake over wake_lifetime     (FISH) */
    bool has_pressure;                  /* a fish has force: pressure */
    double wall_y[2];                   /* of the walls, m                             (length[WALL]) */
    double *scratch;                    /* (2 FISH) */
};

/* Refuse a file that is not of a run, or of another schema, with STATUS_FILE. */
enum status result_reader_check(const struct netcdf_reader *file);

/* Open the file of a run that has at least one row, until the arena is freed. Fails with STATUS_FILE, also for the file
 * of a study, or with STATUS_MEMORY. The path must outlive the arena. */
enum status result_reader_open(struct arena *arena, struct result_reader **reader, const char *path);

/* The number of values of a variable of the table, per row if the variable has rows. */
size_t result_reader_n(const struct result_reader *reader, const char *name);

/* Read a row of a variable, or all of one that has none; slots that a fish does not use are NaN. */
enum status result_reader_row(const struct result_reader *reader, const char *name, size_t row, double *values);

/* The same in a new array. */
enum status result_reader_new(struct arena *arena, const struct result_reader *reader, const char *name, size_t row,
                              double **values);

/* The name of fish f in the file of a run, with or without rows, in the arena of the file. */
enum status result_reader_name(const struct netcdf_reader *file, size_t f, char **name);

/* Whether the wake was written in a row, or there was none to write: *has_wake. */
enum status result_reader_has_wake(const struct result_reader *reader, size_t row, bool *has_wake);

#endif
