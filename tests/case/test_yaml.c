/* test_yaml.c: The tree that is read from YAML knows the place of every value, what the subset lacks is refused, and
 * values that are written read back the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/yaml_tree.h"
#include "near.h"

// ---- the fixture

struct fixture {
    struct arena *arena;
    struct yaml_source source;
    struct yaml_errors errors;
    struct yaml_node *root;
    enum status status;
};

/* Parse some bytes as the file "x.yaml", until the end of the test. */
static void read_bytes(struct fixture *fixture, const char *text, size_t length) {
    *fixture = (struct fixture){.arena = arena_create(test_arena(), "a tree"),
                                .source = {.name = "x.yaml", .text = text, .length = length}};
    fixture->errors.arena = fixture->arena;
    fixture->status = yaml_tree_read(fixture->arena, &fixture->root, &fixture->source, &fixture->errors);
}

static void read_text(struct fixture *fixture, const char *text) {
    read_bytes(fixture, text, strlen(text));
}

/* The text of a tree on one line; valid until the next call. */
static const char *flow(const struct yaml_node *node) {
    static char line[1000];
    struct text text = {.arena = test_arena()};
    yaml_write_node(&text, node);
    snprintf(line, sizeof line, "%s", text.text);
    return line;
}

static void reads_as(const char *text, const char *want) {
    struct fixture f;
    read_text(&f, text);
    assert_int_equal(f.status, STATUS_OK);
    assert_string_equal(flow(f.root), want);
}

static void is_refused(const char *text, size_t length, const char *want) {
    struct fixture f;
    read_bytes(&f, text, length);
    assert_int_equal(f.status, STATUS_CASE);
    assert_null(f.root);
    assert_int_equal(yaml_errors_status(&f.errors), STATUS_CASE);
    if (!strstr(status_message(), want)) {
        fail_msg("the message of '%.60s' is\n%.600s\nwithout %s", text, status_message(), want);
    }
}

// ---- reading

TEST(maps_lists_and_scalars_become_a_tree) {
    reads_as("time: {end: 3}\nfish:\n  - nodes: 7\n  - [a, b]\n", "{time: {end: 3}, fish: [{nodes: 7}, [a, b]]}");
}

TEST(block_and_flow_read_the_same) {
    reads_as("a:\n  b: 1\n  c:\n  - 2\n  - x y\n", "{a: {b: 1, c: [2, x y]}}");
    reads_as("{a: {b: 1, c: [2, x y]}}", "{a: {b: 1, c: [2, x y]}}");
}

TEST(scalars_are_texts_whatever_they_look_like) {
    reads_as("[no, 1e5, 0x10, 2001-01-01, .nan, 012]", "[no, 1e5, 0x10, 2001-01-01, .nan, 012]");
    reads_as("a:\nb: ~\nc: 'no'\n", "{a: \"\", b: \"~\", c: no}");
}

TEST(keys_and_values_know_their_places) {
    struct fixture f;
    read_text(&f, "# comment\nfish:\n  - größe: ä\n    nodes: 7\n");
    const struct yaml_node *const fish = yaml_tree_find(f.root, "fish")->entry[0].value;
    const struct yaml_entry *const nodes = yaml_tree_entry(fish, "nodes", 5);
    assert_int_equal(nodes->mark.line, 4);
    assert_int_equal(nodes->mark.column, 5);
    assert_int_equal(nodes->value->mark.column, 12);
    assert_int_equal(fish->entry[0].value->mark.column, 12);  // counted in characters, not bytes
    assert_ptr_equal(nodes->mark.source, &f.source);
}

TEST(a_text_without_values_has_no_root) {
    static const char *const strings[] = {"", "\n\n", "# nothing\n", "---\n...\n"};
    for (size_t i = 0; i < sizeof strings / sizeof *strings; i++) {
        struct fixture f;
        read_text(&f, strings[i]);
        assert_int_equal(f.status, STATUS_OK);
        if (f.root) assert_string_equal(f.root->text, "");
    }
}

TEST(a_mark_of_utf8_and_crlf_are_accepted) {
    reads_as(
        "\xEF\xBB\xBF"
        "a: 1\r\nb: 2\r\n",
        "{a: 1, b: 2}");
}

TEST(depth_32_is_read_and_33_refused) {
    char text[128];
    for (int depth = 32; depth <= 33; depth++) {
        memset(text, '[', (size_t)depth);
        memset(text + depth, ']', (size_t)depth);
        text[2 * depth] = '\0';
        if (depth == 32) {
            reads_as(text, text);
        } else {
            is_refused(text, strlen(text), "x.yaml:1:33: error: nested deeper than 32 levels");
        }
    }
}

TEST(what_is_not_in_the_subset_is_refused_with_its_place) {
    static const char *const cases[][2] = {
        {"a: &x 1\n", "x.yaml:1:4: error: anchors"},
        {"a: &x [1]\n", "x.yaml:1:4: error: anchors"},
        {"a: *x\n", "x.yaml:1:4: error: aliases"},
        {"a: !!str 1\n", "x.yaml:1:4: error: tags"},
        {"a: !x {b: 1}\n", "x.yaml:1:4: error: tags"},
        {"a: 1\n<<: {b: 1}\n", "x.yaml:2:1: error: merge keys"},
        {"a: 1\nb: 2\na: 3\n", "x.yaml:3:1: error: the key 'a' is here twice; the first is on line 1: remove one"},
        {"a: 1\n---\nb: 2\n", "x.yaml:2:1: error: a second document"},
        {"[a]: 1\n", "x.yaml:1:1: error: a key must be a plain word"},
        {"? {a: 1}\n: 1\n", "x.yaml:1:3: error: a key must be a plain word"},
        {"a:\n\tb: 1\n", "x.yaml:2:1: error: the line is indented with a tab; use blanks"},
        {"a: 1\n  b: 2\n", "x.yaml:2:4: error: a key is not allowed here"},
        {"a: [1, 2\nb: 3\n", "needs ',' between values and ends with ']'"},
        {"a: \"b\nc: 1\n", "x.yaml:1:4: error: the quote that begins here is not closed"},
        {"a: \"b\\0c\"\n", "x.yaml:1:4: error: a string cannot contain a zero byte"},
        {"a: 1\nb: \x01\n", "x.yaml:2:4: error: not a text file (control character 0x01)"},
        {"a: \xFF\n", "x.yaml:1:4: error: not valid UTF-8 (byte 0xFF)"},
        {"a: \xC3", "x.yaml:1:4: error: not valid UTF-8 (byte 0xC3)"},
        {"a: \xED\xA0\x80\n", "x.yaml:1:4: error: not valid UTF-8"},
        {"a: \xC0\x80\n", "x.yaml:1:4: error: not valid UTF-8"},
        {"a: \xF4\x90\x80\x80\n", "x.yaml:1:4: error: not valid UTF-8"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) is_refused(cases[i][0], strlen(cases[i][0]), cases[i][1]);
    is_refused("a: \0", 4, "x.yaml:1:4: error: not a text file (control character 0x00)");
}

TEST(all_refusals_of_a_text_are_listed) {
    struct fixture f;
    read_text(&f, "a: &x 1\na: !y 2\n<<: 3\n");
    assert_int_equal(f.errors.n, 4);
}

TEST(more_than_256_keys_or_4_mib_are_refused) {
    char keys[4000];
    size_t length = 0;
    for (int i = 0; i <= 256; i++) length += (size_t)snprintf(keys + length, sizeof keys - length, "k%d: 1\n", i);
    is_refused(keys, length, "x.yaml:257:1: error: more than 256 keys in one map");
    char *const large = arena_new(test_arena(), YAML_TREE_BYTES + 1, 1);
    memset(large, '\n', YAML_TREE_BYTES + 1);
    is_refused(large, YAML_TREE_BYTES + 1, "x.yaml:1:1: error: larger than 4 MiB");
}

// ---- the tree

TEST(find_follows_a_path_of_keys) {
    struct fixture f;
    read_text(&f, "a: {b: {c: 1}}\nab: 2\n");
    assert_string_equal(yaml_tree_find(f.root, "a.b.c")->text, "1");
    assert_string_equal(yaml_tree_find(f.root, "ab")->text, "2");
    assert_null(yaml_tree_find(f.root, "a.c"));
    assert_null(yaml_tree_find(f.root, "ab.c"));
    assert_null(yaml_tree_find(NULL, "a"));
}

TEST(merging_joins_maps_and_replaces_the_rest) {
    struct fixture base, over;
    read_text(&base, "a: {x: 1, y: [1, 2]}\nb: 1\nc: {z: 1}\n");
    read_text(&over, "a: {y: [3], w: 2}\nc: 5\nd: 6\n");
    yaml_tree_merge(base.arena, &base.root, over.root);
    assert_string_equal(flow(base.root), "{a: {x: 1, y: [3], w: 2}, b: 1, c: 5, d: 6}");
}

TEST(a_copy_is_equal_and_its_own) {
    struct fixture f;
    read_text(&f, "a: [1, {b: c}]\n");
    const struct yaml_node *const copy = yaml_tree_copy(test_arena(), f.root);
    arena_free(f.arena);
    assert_string_equal(flow(copy), "{a: [1, {b: c}]}");
}

TEST(a_key_is_taken_out_of_a_map_with_its_value) {
    struct fixture f;
    read_text(&f, "a: 1\nb: [2]\nc: 3\n");
    assert_string_equal(flow(yaml_tree_take(f.root, "b")), "[2]");
    assert_string_equal(flow(f.root), "{a: 1, c: 3}");
    assert_null(yaml_tree_take(f.root, "b"));
    assert_string_equal(flow(yaml_tree_take(f.root, "c")), "3");
    assert_string_equal(flow(f.root), "{a: 1}");
}

// ---- errors

TEST(errors_are_listed_by_place_with_a_caret) {
    struct fixture f;
    read_text(&f, "a: 1\nb: größe 2\n");
    const struct yaml_mark late = {&f.source, 2, 10}, early = {&f.source, 1, 4};
    yaml_errors_add(&f.errors, late, "b: the second");
    yaml_errors_add(&f.errors, early, "a: the %s", "first");
    assert_int_equal(yaml_errors_status(&f.errors), STATUS_CASE);
    assert_string_equal(status_message(),
                        "x.yaml:1:4: error: a: the first\na: 1\n   ^\n"
                        "x.yaml:2:10: error: b: the second\nb: größe 2\n         ^");
}

TEST(twenty_errors_are_listed_and_the_rest_counted) {
    struct fixture f;
    read_text(&f, "a: 1\n");
    const struct yaml_mark mark = {&f.source, 1, 1};
    for (int i = 0; i < 100; i++) yaml_errors_add(&f.errors, mark, "wrong");
    yaml_errors_status(&f.errors);
    int n = 0;
    for (const char *c = status_message(); (c = strstr(c, "error: wrong")); c++) n++;
    assert_int_equal(n, 20);
    assert_non_null(strstr(status_message(), "\n... and 80 more"));
}

TEST(of_a_long_line_the_neighbourhood_is_shown) {
    static char text[3000];
    memset(text, 'x', sizeof text - 1);
    text[1500] = 'Y';
    struct yaml_source source = {"x.yaml", text, sizeof text - 1, 0, false};
    struct yaml_errors errors = {.arena = test_arena()};
    yaml_errors_add(&errors, (struct yaml_mark){&source, 1, 1501}, "here");
    yaml_errors_status(&errors);
    const char *const line = strchr(status_message(), '\n') + 1;
    const char *const caret = strchr(line, '\n') + 1;
    assert_int_equal(caret - line, 101);
    assert_int_equal(line[strspn(caret, " ")], 'Y');
}

TEST(a_place_after_the_end_is_harmless) {
    struct yaml_source source = {"x.yaml", "a", 1, 0, false};
    struct yaml_errors errors = {.arena = test_arena()};
    yaml_errors_add(&errors, (struct yaml_mark){&source, 9, 900}, "here");
    assert_int_equal(yaml_errors_status(&errors), STATUS_CASE);
    assert_string_equal(status_message(), "x.yaml:9:900: error: here");
}

// ---- writing

TEST(strings_of_any_kind_are_written_so_that_they_read_back) {
    static const char *const strings[] = {"eel", "a b",  "a: b", "#x",   "x #y", "",      " a", "a ",        "-",
                                          "- a", "---",  "...",  "a,b",  "[a]",  "{",     "*a", "&a",        "!a",
                                          "'a'", "a\"b", "a\\b", "a\nb", "a\tb", "größe", "?a", "fish[*].x", "%a",
                                          "@a",  "`a",   "|",    ">",    "a:",   "<<",    "~",  "a?b",       "\x7f"};
    for (size_t i = 0; i < sizeof strings / sizeof *strings; i++) {
        struct text text = {.arena = test_arena()};
        text_add(&text, "[");
        yaml_write_scalar(&text, strings[i]);
        text_add(&text, "]\n");
        struct fixture f;
        read_text(&f, text.text);
        assert_int_equal(f.status, STATUS_OK);
        assert_string_equal(f.root->entry[0].value->text, strings[i]);
    }
}
