/* test_table.c: A printed table grows row by row, and its columns are aligned. */
#include <math.h>

#include "base/table.h"
#include "near.h"

TEST(a_table_grows_by_rows_and_has_no_blanks_at_the_end) {
    struct arena *const arena = arena_create(NULL, "a table");
    struct table *const table = table_create(arena, 1);
    table_column(table, "quantity", NULL);
    table_column(table, "", "m s-1");
    table_column(table, "status", NULL);
    table_cell(table, "speed of %d", 2);
    table_number(table, "%.1f", 1.25);
    table_row(table);
    table_cell(table, "cost");
    table_number(table, "%.3f", NAN);
    table_cell(table, "failed");
    table_row(table);
    char written[128] = "";
    FILE *const stream = fmemopen(written, sizeof written, "w");
    assert_non_null(stream);
    table_print(table, stream);
    fclose(stream);
    assert_string_equal(written,
                        "quantity           status\n            m s-1\nspeed of 2    1.2\ncost            -  failed\n");
    arena_free(arena);
}
