/* version.h: which versions of the program and of its libraries are running, on which processor, and where they are
 * installed. Tested by tests/result/test_result_file.c. */
#ifndef VERSION_H
#define VERSION_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

enum { VERSION_LENGTH = 256 }; /* bytes of the longest string below */

/* "shoal 0.1.0 (commit 0123456789ab)" */
const char *version_short(void);

/* Write "SUNDIALS 6.4.1, KLU 1.3.9 (SuiteSparse 5.12.0), NetCDF 4.9.0, libyaml 0.2.5": the loaded libraries; the
 * version of KLU is known at compile time only. */
void version_libraries(char text[VERSION_LENGTH]);

/* Write "x86-64 with fma avx2": instruction sets of the processor that select code in libraries. On another processor
 * the last bits of a sine may differ. */
void version_processor(char text[VERSION_LENGTH]);

/* The folder with the cases and scripts that belong to this program or library: the top of the source tree, or
 * share/shoal of the installation. False if there is none. */
bool version_share(char share[PATH_MAX]);

#endif
