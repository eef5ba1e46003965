/* school.c: the section "school". */
#include "verify.h"

void verify_school(void) {
}
