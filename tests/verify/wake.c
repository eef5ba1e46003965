/* wake.c: the section "wake". */
#include "verify.h"

void verify_wake(void) {
}
