/* version.h: the version of the program and of its libraries. Tested by tests/result/test_result_file.c. */
#ifndef VERSION_H
#define VERSION_H

#include <stddef.h>

enum { VERSION_LENGTH = 256 }; /* bytes of the longest string below */

/* "shoal 0.1.0 (commit 0123456789ab)" */
const char *version_short(void);

/* Write "SUNDIALS 6.4.1, KLU 1.3.9 (SuiteSparse 5.12.0), NetCDF 4.9.0, libyaml 0.2.5": the libraries as loaded, except
 * that KLU knows its version at compile time only. */
void version_libraries(char text[VERSION_LENGTH]);

/* Write "x86-64 with fma avx2": what a processor has that libraries choose their code by. On another one the last bits
 * of a sine may differ. */
void version_processor(char text[VERSION_LENGTH]);

#endif
