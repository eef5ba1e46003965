/* test_base64.c: the examples of RFC 4648, section 10. */
#include <stdlib.h>
#include <string.h>

#include "base/base64.h"
#include "near.h"

static void is_written_as(const char *bytes, const char *want) {
    char *text = NULL;
    size_t length;
    FILE *const stream = open_memstream(&text, &length);
    assert_non_null(stream);
    base64_write(stream, strlen(bytes), bytes);
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(text, want);
    free(text);
}

static void the_examples_of_the_standard(void **state) {
    (void)state;
    is_written_as("", "");
    is_written_as("f", "Zg==");
    is_written_as("fo", "Zm8=");
    is_written_as("foo", "Zm9v");
    is_written_as("foob", "Zm9vYg==");
    is_written_as("fooba", "Zm9vYmE=");
    is_written_as("foobar", "Zm9vYmFy");
    is_written_as("\xff\xfe\xfd", "//79");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_examples_of_the_standard)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
