/* start.c: the section "start". */
#include "verify.h"

void verify_start(void) {
}
