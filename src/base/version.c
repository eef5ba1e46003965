/* version.c: see version.h. It is the only file to which the Makefile passes SHOAL_VERSION and SHOAL_COMMIT, so that a
 * commit recompiles nothing else. */
#define _GNU_SOURCE  // dladdr
#include "base/version.h"

#include <dlfcn.h>
#include <klu.h>
#include <lapacke.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <unistd.h>
#include <yaml.h>

const char *version_short(void) {
    return "shoal " SHOAL_VERSION " (commit " SHOAL_COMMIT ")";
}

void version_processor(char text[VERSION_LENGTH]) {
#if defined(__x86_64__)
    snprintf(text, VERSION_LENGTH, "x86-64 with%s%s%s%s", __builtin_cpu_supports("sse4.1") ? " sse4.1" : "",
             __builtin_cpu_supports("fma") ? " fma" : "", __builtin_cpu_supports("avx2") ? " avx2" : "",
             __builtin_cpu_supports("avx512f") ? " avx512f" : "");
#elif defined(__aarch64__)
    snprintf(text, VERSION_LENGTH, "arm64");
#else
    snprintf(text, VERSION_LENGTH, "neither x86-64 nor arm64");
#endif
}

void version_libraries(char text[VERSION_LENGTH]) {
    char sundials[32] = "unknown";
    SUNDIALSGetVersion(sundials, sizeof sundials);
    int suitesparse[3];
    SuiteSparse_version(suitesparse);
    lapack_int lapack[3];
    LAPACKE_ilaver(&lapack[0], &lapack[1], &lapack[2]);

    // "4.9.0 of Aug  7 2022 23:41:41 $": print the number only
    const char *netcdf = nc_inq_libvers();
    const int netcdf_length = (int)strcspn(netcdf, " ");

    snprintf(text, VERSION_LENGTH,
             "SUNDIALS %s, KLU %d.%d.%d (SuiteSparse %d.%d.%d), LAPACK %d.%d.%d, NetCDF %.*s, libyaml %s", sundials,
             KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION, suitesparse[0], suitesparse[1], suitesparse[2],
             (int)lapack[0], (int)lapack[1], (int)lapack[2], netcdf_length, netcdf, yaml_get_version_string());
}

bool version_share(char share[PATH_MAX]) {
    static const char *const places[] = {"..", "../share/shoal", "../../share/shoal"};
    const char *binaries[2] = {NULL, NULL};

    // the program, and the library in another program
    char program[PATH_MAX];
    Dl_info library;
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    binaries[0] = program;
    if (dladdr((const void *)version_short, &library) != 0) binaries[1] = library.dli_fname;

    // the folder with cases/demo.yaml near one of them
    for (int i = 0; i < 6; i++) {
        char folder[PATH_MAX], file[PATH_MAX];
        const char *const binary = binaries[i / 3], *const slash = binary ? strrchr(binary, '/') : NULL;
        if (!slash) continue;
        const int n = snprintf(folder, sizeof folder, "%.*s/%s", (int)(slash - binary), binary, places[i % 3]);
        if (n >= PATH_MAX || snprintf(file, sizeof file, "%s/cases/demo.yaml", folder) >= PATH_MAX) continue;
        if (access(file, R_OK) == 0 && realpath(folder, share)) return true;
    }
    return false;
}
