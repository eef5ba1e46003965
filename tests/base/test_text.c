/* test_text.c: Numbers become text and are read back without a lost bit, and words are quoted as shells, JSON and
 * tables of text need it. */
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/text.h"
#include "failing_malloc.h"
#include "near.h"

TEST(numbers_are_decimal_and_whole_strings) {
    static const char *const good[] = {"0", "-1", "+2.5", "1.", ".5", "1e5", "1.0e+5", "2.0E5", "1e-320", "007"};
    static const double values[] = {0, -1, 2.5, 1, 0.5, 1e5, 1e5, 2e5, 1e-320, 7};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        double number = -7;
        assert_true(text_number(good[i], &number));
        NEAR(number, values[i], 0, 0);
    }
    static const char *const bad[] = {"",    " 1",  "1 ",   "1 m",   ".",   "e5",    "1e", "1e+",   "--1",     "0x10",
                                      "nan", "inf", ".inf", "1_000", "1,5", "1.2.3", "+",  "1e5.0", "Infinity"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double number;
        if (text_number(bad[i], &number)) fail_msg("'%s' was read as a number", bad[i]);
    }
    double large;
    assert_true(text_number("1e999", &large));
    assert_true(isinf(large));
}

TEST(control_characters_are_printed_as_numbers) {
    char text[256] = "";
    FILE *const stream = fmemopen(text, sizeof text - 1, "w");
    text_print_clean(stream,
                     "a\x1b[31m\a\b\r\x7f\n\tb\xc2\x9b"
                     "1m \xc2\x80 \xc2\x9f \xc3\xa9 \xe2\x82\xac \xc2\xa0 \xff");
    fclose(stream);
    assert_string_equal(text,
                        "a\\x1b[31m\\x07\\x08\\x0d\\x7f\n\tb\\xc2\\x9b1m \\xc2\\x80 \\xc2\\x9f \xc3\xa9 "
                        "\xe2\x82\xac \xc2\xa0 \xff");
}

TEST(a_written_number_reads_back_bit_for_bit) {
    static const double numbers[] = {
        0,      -0.0, 1, 0.1, 1.0 / 3, 1e23, 5e-324, 1.7976931348623157e308, 0.30000000000000004, 123456789012345678.0,
        -2.5e-7};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct text text = {.arena = test_arena()};
        text_add_number(&text, numbers[i]);
        double back;
        assert_true(text_number(text.text, &back));
        assert_memory_equal(&back, &numbers[i], sizeof back);
    }
}

TEST(a_number_is_written_with_no_more_digits_than_needed) {
    struct text text = {.arena = test_arena()};
    text_add_number(&text, 0.1);
    text_add(&text, " ");
    text_add_number(&text, 1e6);
    assert_string_equal(text.text, "0.1 1000000");
}

TEST(letters_that_change_places_are_one_slip) {
    static const struct {
        const char *a, *b;
        int distance;
    } words[] = {{"run", "rnu", 1},      {"wave", "Wave", 0}, {"wave", "waves", 1}, {"wave", "ave", 1},
                 {"nodes", "ndoess", 2}, {"", "abc", 3},      {"abcd", "dcba", 3},  {"heading", "healing", 1}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const char *const a = words[i].a, *const b = words[i].b;
        assert_int_equal(text_distance(a, strlen(a), b, strlen(b)), words[i].distance);
        assert_int_equal(text_distance(b, strlen(b), a, strlen(a)), words[i].distance);
    }
}

TEST(a_decimal_loses_the_rounding_of_an_operation) {
    NEAR(text_round(3 * 0.1), 0.3, 0, 0);
    NEAR(text_round(1e-5 / 100), 1e-7, 0, 0);
    NEAR(text_round(-7 * 0.1), -0.7, 0, 0);
    NEAR(text_round(1.0 / 3), 1.0 / 3, 0, 0);
    NEAR(text_round(0.1 * (1 + 1e-15)), 0.1 * (1 + 1e-15), 0, 0);
    NEAR(text_round(0), 0, 0, 0);
    assert_true(isnan(text_round(NAN)));
    assert_true(isinf(text_round(INFINITY)));
}

TEST(a_word_is_quoted_where_a_shell_would_change_it) {
    static const char *const words[][2] = {{"run", "run"},
                                           {"time.end=0.5", "time.end=0.5"},
                                           {"/a/b-1_2,3:%@+.nc", "/a/b-1_2,3:%@+.nc"},
                                           {"", "''"},
                                           {"my file.nc", "'my file.nc'"},
                                           {"fish[0].start.position=[0, 0.5]", "'fish[0].start.position=[0, 0.5]'"},
                                           {"it's", "'it'\\''s'"},
                                           {"'",
                                            "''\\''"
                                            "'"},
                                           {"$HOME\n~", "'$HOME\n~'"},
                                           {"~", "'~'"},
                                           {"a;b", "'a;b'"}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct text text = {.arena = test_arena()};
        text_add_word(&text, words[i][0]);
        assert_string_equal(text.text, words[i][1]);
    }
}

TEST(a_text_of_an_arena_grows_and_is_released_with_the_arena) {
    const int n_before = n_live;
    struct arena *const arena = arena_create(NULL, "a test");
    struct text text = {.arena = arena};
    for (int i = 0; i < 100; i++) text_add(&text, "%03d ", i);
    assert_int_equal(text.length, 400);
    assert_string_equal(text.text + 396, "099 ");
    arena_free(arena);
    assert_int_equal(n_live, n_before);
}

TEST(the_locale_does_not_matter) {
    static const char *const with_comma[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "nl_NL.UTF-8"};
    const char *found = NULL;
    for (size_t i = 0; !found && i < sizeof with_comma / sizeof *with_comma; i++) {
        found = setlocale(LC_NUMERIC, with_comma[i]);
    }
    if (!found) skip();
    double number = 0;
    struct text text = {.arena = test_arena()};
    const bool is_number = text_number("2.5", &number);
    text_add_number(&text, 0.5);
    setlocale(LC_NUMERIC, "C");
    assert_true(is_number);
    NEAR(number, 2.5, 0, 0);
    assert_string_equal(text.text, "0.5");
}

TEST(a_duration_has_at_least_one_and_a_half_units) {
    static const struct {
        double seconds;
        const char *want;
    } durations[] = {{0.02, "0.02 s"}, {89, "89 s"},         {90, "1.5 min"},
                     {5400, "1.5 h"},  {129600, "1.5 days"}, {238 * 86400., "240 days"}};
    for (int i = 0; i < 6; i++) {
        char text[TEXT_DURATION_BYTES];
        text_duration(text, durations[i].seconds);
        assert_string_equal(text, durations[i].want);
    }
}

TEST(a_string_of_json_has_no_bare_quote_or_control_character) {
    char written[64] = "";
    FILE *const stream = fmemopen(written, sizeof written, "w");
    assert_non_null(stream);
    text_print_json(stream, "a \"fish\" \\ \n\x01\xc3\xa9");
    text_print_json(stream, NULL);
    fclose(stream);
    assert_string_equal(written, "\"a \\\"fish\\\" \\\\ \\u000a\\u0001\xc3\xa9\"null");
}

TEST(a_field_of_a_table_keeps_quotes_and_commas) {
    char written[64] = "";
    FILE *const stream = fmemopen(written, sizeof written, "w");
    assert_non_null(stream);
    text_print_csv(stream, "a \"fish\", \n");
    text_print_csv(stream, "");
    fclose(stream);
    assert_string_equal(written, "\"a \"\"fish\"\", \n\"\"\"");
}

// ---- the examples of RFC 4648, section 10

static void is_written_as(const char *bytes, const char *want) {
    char *text = NULL;
    size_t length;
    FILE *const stream = open_memstream(&text, &length);
    assert_non_null(stream);
    text_print_base64(stream, strlen(bytes), bytes);
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(text, want);
    free(text);
}

TEST(the_examples_of_the_standard) {
    is_written_as("", "");
    is_written_as("f", "Zg==");
    is_written_as("fo", "Zm8=");
    is_written_as("foo", "Zm9v");
    is_written_as("foob", "Zm9vYg==");
    is_written_as("fooba", "Zm9vYmE=");
    is_written_as("foobar", "Zm9vYmFy");
    is_written_as("\xff\xfe\xfd", "//79");
}

TEST(a_text_doubles_its_memory) {
    struct arena *const arena = test_arena();
    struct text text = {.arena = arena};
    const int most = 20;
    n_until_failure = most;
    for (int i = 0; i < 4000; i++) text_add(&text, "%04d ", i);
    const int n_allocations = most - n_until_failure;
    n_until_failure = -1;
    assert_in_range(n_allocations, 1, 9);  // 20,000 bytes
    assert_int_equal(text.length, 20000);
    assert_int_equal(strlen(text.text), 20000);
}
