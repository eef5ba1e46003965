/* netcdf.c: attributes that several files have. */
#include "output/netcdf.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/version.h"

int netcdf_text(int file, int variable, const char *name, const char *text) {
    return nc_put_att_text(file, variable, name, strlen(text), text);
}

int netcdf_origin(int file, const char *title, const char *command) {
    char libraries[VERSION_LENGTH], source[2 * VERSION_LENGTH], history[4096], date[32];
    version_libraries(libraries);
    snprintf(source, sizeof source, "%s, %s", version_short(), libraries);
    const time_t now = time(NULL);
    struct tm utc;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    snprintf(history, sizeof history, "%s %s", date, command);
    NETCDF(netcdf_text(file, NC_GLOBAL, "Conventions", "CF-1.10"));
    NETCDF(netcdf_text(file, NC_GLOBAL, "title", title));
    NETCDF(netcdf_text(file, NC_GLOBAL, "history", history));
    return netcdf_text(file, NC_GLOBAL, "source", source);
}
