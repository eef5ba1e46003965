/* test_bad_cases.c: Each case of tests/case/bad_cases.txt is refused with the messages that stand below it there, and
 * each message shows its place in the file. test_bad.sh has the files that a table cannot hold, and the exit code. To
 * write the messages again (then read the difference!):
 *
 *     build/tests/case/test_bad_cases --write
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "case_fixture.h"
#include "near.h"

static const char table[] = "tests/case/bad_cases.txt";
/* What "=== NAME" stands for. */
static const char first_lines[] = "format: 1\ntime: {end: 1}\n";

/* A case of the table. */
struct bad_case {
    const char *path;        /* NAME.yaml */
    struct text entry;       /* the lines of the table from the name up to "----" */
    struct text file, wants; /* the case; its messages, without the places */
    const char *got;         /* what the program says; NULL: it takes the case */
};

/* Cut the next line off a text; NULL at its end. */
static char *next_line(char **rest) {
    char *const line = *rest, *const end = strchr(line, '\n');
    if (!end) return NULL;
    *end = '\0';
    *rest = end + 1;
    return line;
}

/* Read a whole file. */
static char *content(const char *path) {
    FILE *const file = fopen(path, "r");
    if (!file) fail_msg("%s cannot be read", path);
    struct text text = {.arena = test_arena()};
    char line[4096];
    while (fgets(line, sizeof line, file)) text_add(&text, "%s", line);
    fclose(file);
    return text.text;
}

/* The cases of the table, and the text before the first one; the number of cases. */
static int read_table(struct bad_case **cases, struct text *begin) {
    enum { MOST = 1000 };
    NEW(test_arena(), *cases, MOST);
    *begin = (struct text){.arena = test_arena()};
    struct bad_case *last = NULL;
    bool in_messages = false;
    int n = 0;
    char *rest = content(table), *line, name[100];
    while ((line = next_line(&rest))) {
        if (sscanf(line, "==== %99s", name) == 1 || sscanf(line, "=== %99s", name) == 1) {
            assert_in_range(n, 0, MOST - 1);
            last = &(*cases)[n++];
            last->path = arena_text(test_arena(), "%s.yaml", name);
            last->entry.arena = last->file.arena = last->wants.arena = test_arena();
            text_add(&last->entry, "%s\n", line);
            text_add(&last->file, "%s", line[3] == '=' ? "" : first_lines);
            in_messages = false;
        } else if (!last) {
            text_add(begin, "%s\n", line);
        } else if (strcmp(line, "----") == 0) {
            in_messages = true;
        } else if (!in_messages) {
            text_add(&last->entry, "%s\n", line);
            text_add(&last->file, "%s\n", line);
        } else if (*line) {
            text_add(&last->wants, "%s\n", line);
        }
    }
    return n;
}

/* The place of a message of this case: line and column from 1 on; false if the message is about another file. */
static bool place_of(const struct bad_case *bad, const char *message, int *line, int *column) {
    const size_t length = strlen(bad->path);
    return strncmp(message, bad->path, length) == 0 && sscanf(message + length, ":%d:%d:", line, column) == 2;
}

/* The messages with their places: of the line of the case up to 100 characters, 50 before the column, and a mark
 * below. */
static const char *shown(const struct bad_case *bad) {
    struct text all = {.arena = test_arena()};
    char *messages = arena_text(test_arena(), "%s", bad->wants.text), *message;
    while ((message = next_line(&messages))) {
        text_add(&all, "%s\n", message);
        int at, column;
        if (!place_of(bad, message, &at, &column)) continue;
        char *lines = arena_text(test_arena(), "%s", bad->file.text), *line = "";
        for (int i = 0; i < at && line; i++) line = next_line(&lines);
        assert_non_null(line);
        const int start = column > 51 ? column - 51 : 0;
        for (char *tab = line; (tab = strchr(tab, '\t'));) *tab = ' ';
        text_add(&all, "%.100s\n%*s\n", line + start, column - start, "^");
    }
    return all.text;
}

/* What the program says about a case whose file is in the working directory; NULL if it takes the case. */
static const char *said(const struct bad_case *bad) {
    struct case_values values;
    const enum status status = case_read(&values, bad->path, 0, NULL);
    if (status == STATUS_OK) case_free(&values);
    return status == STATUS_CASE ? arena_text(test_arena(), "%s\n", status_message()) : NULL;
}

/* Write the files of all cases into a new folder, which becomes the working directory. */
static void write_files(int n, const struct bad_case *cases, char folder[]) {
    assert_true(mkdtemp(folder) && chdir(folder) == 0);
    for (int i = 0; i < n; i++) {
        FILE *const file = fopen(cases[i].path, "w");
        assert_non_null(file);
        if (cases[i].file.text) fputs(cases[i].file.text, file);
        assert_int_equal(fclose(file), 0);
    }
}

/* Read the table, and let the program say something about each case. Returns the number of cases. */
static int read_and_ask(struct bad_case **cases, struct text *begin) {
    char folder[] = "/tmp/shoal-bad-XXXXXX", before[4096];
    assert_non_null(getcwd(before, sizeof before));
    const int n = read_table(cases, begin);
    write_files(n, *cases, folder);
    for (int i = 0; i < n; i++) (*cases)[i].got = said(&(*cases)[i]);
    for (int i = 0; i < n; i++) remove((*cases)[i].path);
    assert_int_equal(chdir(before), 0);
    assert_int_equal(rmdir(folder), 0);
    return n;
}

TEST(each_bad_case_has_its_messages) {
    struct bad_case *cases;
    struct text begin;
    const int n = read_and_ask(&cases, &begin);
    int n_wrong = 0;
    for (int i = 0; i < n; i++) {
        const char *const got = cases[i].got, *const want = shown(&cases[i]);
        if (got && strcmp(got, want) == 0) continue;
        n_wrong++;
        print_error("%s says\n%s\ninstead of\n%s\n", cases[i].path, got ? got : "nothing", want);
    }
    ABOVE(n, 150);
    assert_int_equal(n_wrong, 0);
}

static int write_table(void) {
    struct bad_case *cases;
    struct text all;
    const int n = read_and_ask(&cases, &all);
    for (int i = 0; i < n; i++) {
        const char *const got = cases[i].got;
        text_add(&all, "%s----\n", cases[i].entry.text);
        char *lines = arena_text(test_arena(), "%s", got ? got : ""), *line;
        while ((line = next_line(&lines))) {
            text_add(&all, "%s\n", line);
            int at, column;
            if (place_of(&cases[i], line, &at, &column) && next_line(&lines)) next_line(&lines);
        }
        if (i < n - 1) text_add(&all, "\n");
    }
    FILE *const file = fopen(table, "w");
    assert_non_null(file);
    fputs(all.text, file);
    return fclose(file);
}

int main(int argc, char **argv) {
    return argc > 1 && strcmp(argv[1], "--write") == 0 ? write_table() : near_run();
}
