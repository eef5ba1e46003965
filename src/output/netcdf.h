/* netcdf.h: what the writers of all files share. Only files of store include it. Tested by tests/output/test_result_file.c and
 * tests/study/test_study_file.c. */
#ifndef NETCDF_H
#define NETCDF_H

#include <netcdf.h>

/* Leave with NetCDF's error code. */
#define NETCDF(call)                                     \
    do {                                                 \
        const int netcdf_code = (call);                  \
        if (netcdf_code != NC_NOERR) return netcdf_code; \
    } while (0)

/* An attribute that is a text, of a variable or NC_GLOBAL. NetCDF's error code. */
int netcdf_text(int file, int variable, const char *name, const char *text);

/* The attributes that say where a file comes from: Conventions, title, history (now, and the command line), source (this
 * version and its libraries). NetCDF's error code. */
int netcdf_origin(int file, const char *title, const char *command);

#endif
