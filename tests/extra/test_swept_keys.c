/* test_swept_keys.c: An error study along each key of the table; tests/study/test_error_plan.c tests its plan. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "case/case_value.h"
#include "case_fixture.h"
#include "study/error_plan.h"
#include "study/study_file.h"

/* The value of a key as YAML. */
static const char *written(const struct key *key, struct case_values *values) {
    struct text text = {.arena = test_arena()};
    const void *const field = case_table_field(key, values, &values->school.fish[0]);
    if (key->type == STRING && !*(char *const *)field) return "a";
    case_value_write(&text, key, field);
    return text.text;
}

/* Another value of a key as YAML: number i of some that may be valid; NULL after the last. */
static const char *other_value(const struct key *key, struct case_values *values, int i) {
    static const char *const texts[] = {"x", "[]", "[0.5, 0.5]", "[[0.1, 0.1]]", "[0.1]"};
    static const double factors[] = {2, 0.5, 4, 0.1};
    if (key->type == CHOICE || key->type == METHOD) return case_table_word(key, i);
    if (key->type > INTEGER) return i < 5 ? texts[i] : NULL;
    double now = NAN;
    const char *const text = written(key, values), *const rest = strchr(text, ' ');
    text_number(arena_text(test_arena(), "%.*s", (int)strcspn(text, " "), text), &now);
    if (i >= 4) return i == 4 ? "1" : i == 5 ? "2" : i == 6 ? "0.5" : NULL;
    return arena_text(test_arena(), "%.12g%s", now * factors[i], rest ? rest : "");
}

/* Every key of the table is swept: each column of the axis has another name, so that study.nc can be written, or the
 * plan refuses the key. */
TEST(every_key_can_be_swept) {
    static const char text[] =
        "format: 1\ntime: {end: 0.4, shedding_interval: 0.02, output_interval: 0.08, checkpoint_interval: 0.2}\n"
        "output: {wake_interval: 0.08}\nwake: {taper: 0.1, lifetime: 0.2}\n"
        "fish: [{force: reactive, nodes: 9, sheet_points: 17}, {force: reactive, nodes: 9, sheet_points: 17, start: "
        "{position: [9, 0]}}]\n";
    static const char *const must[] = {"time.end",          "time.output_interval", "time.checkpoint_interval",
                                       "fish.sheet_points", "output.wake_interval", "wake.taper_beside",
                                       "wake.decay",        "steady.multipliers",   "fish.drag.skin"};
    char path[] = "/tmp/shoal-study-XXXXXX";
    close(mkstemp(path));
    int n_planned = 0, n_must = 0;
    for (int k = 0; k < 2 * case_table_n; k++) {
        // of all fish in a steady state, of one fish in a run
        const bool is_steady = k % 2 == 1;
        const struct key *const key = &case_table[k / 2];
        if (!case_table_is_value(key) || strcmp(key->path, "format") == 0) continue;
        const bool is_of_fish = case_table_is_of_fish(key);
        const char *const place = !is_of_fish ? "" : is_steady ? "fish[*]" : "fish[1]";
        const char *const path_of_key = arena_text(test_arena(), "%s%s", place, key->path + (is_of_fish ? 4 : 0));
        const char *value;
        struct case_values values = parse(text);
        for (int i = 0; (value = other_value(key, &values, i)); i++) {
            struct error_sweep *sweep;
            struct case_values study;
            const char *const sweeps[] = {
                arena_text(test_arena(), "sweep=[{key: \"%s\", values: [%s, %s]}]", path_of_key, written(key, &values),
                           value),
                is_steady ? "error={of: steady_speed, models: true}" : "error={of: speed, models: true}"};
            if (strcmp(value, written(key, &values)) == 0) continue;
            if (case_parse(&study, text, strlen(text), "x.yaml", NULL, 2, sweeps) != STATUS_OK) continue;
            kept(study);
            if (error_plan_create(test_arena(), &sweep, &study, NULL) != STATUS_OK) continue;
            struct member_file *members;
            const int n = sweep_n_members(&sweep->study);
            NEW(test_arena(), members, n);
            for (int m = 0; m < n; m++) {
                member_file_create_values(test_arena(), &members[m], 2);
                members[m].status = "complete";
            }
            convergence_sweep_judge(sweep, members);
            const struct convergence_orders none = {0};
            if (study_file_write(test_arena(), path, &sweep->study, members, &none, sweep, "test") != STATUS_OK) {
                fail_msg("%s: %s", sweeps[0], status_message());
            }
            n_planned++;
            for (size_t w = 0; w < sizeof must / sizeof *must; w++) n_must += strcmp(must[w], key->path) == 0;

            // each point has the swept value
            for (int p = 0; p < 2; p++) {
                struct case_values point = member_of(&sweep->study, sweep->point[p].base);
                const int f = is_steady ? 0 : 1;
                struct text is = {.arena = test_arena()}, was = {.arena = test_arena()};
                case_value_write(&is, key, case_table_field(key, &point, &point.school.fish[f]));
                struct case_values one = parse_with(
                    text, arena_text(test_arena(), "%s=%s", path_of_key, p == 0 ? written(key, &values) : value), NULL,
                    NULL);
                case_value_write(&was, key, case_table_field(key, &one, &one.school.fish[f]));
                if (strcmp(is.text, was.text) != 0) fail_msg("%s: %s is not %s", sweeps[0], is.text, was.text);
            }
            break;
        }
    }
    unlink(path);
    assert_int_equal(n_must, 18);
    ABOVE(n_planned, 120);
}
