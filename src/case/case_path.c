/* case_path.c: a path word by word along the table of keys. */
#include "case/case_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case_suggest.h"
#include "case/case_table.h"

void case_path_unknown(struct yaml_errors *errors, struct yaml_mark mark, const char *path, const char *section,
                       const char *word, const char *owner) {
    struct text hint = {0};
    if (errors->n < YAML_ERRORS_KEPT) case_suggest(&hint, section, word, owner);
    yaml_errors_add(errors, mark, "%.150s: unknown key%s", path, hint.text ? hint.text : "");
    if (hint.failed) errors->out_of_memory = true;
    text_free(&hint);
}

/* Read "[2]" or "[*]" at text; returns the end of the index, or NULL after an error. */
static const char *parse_index(struct case_path *path, const char *text, int n_fish, struct yaml_mark mark,
                               struct yaml_errors *errors) {
    const size_t length = strspn(text + 1, "0123456789");
    if (strncmp(text, "[*]", 3) == 0) {
        path->fish = CASE_EVERY_FISH;
        return text + 3;
    }

    if (length == 0 || text[1 + length] != ']') {
        yaml_errors_add(errors, mark,
                        "fish%.20s: expects the number of a fish, as in fish[0], or fish[*] for every fish", text);
        return NULL;
    }

    const long index = length < 9 ? strtol(text + 1, NULL, 10) : CASE_MAX_FISH;
    if (index >= n_fish) {
        yaml_errors_add(errors, mark, "fish[%.*s]: there is no such fish; the case has %d, the last is fish[%d]",
                        (int)(length < 20 ? length : 20), text + 1, n_fish, n_fish - 1);
        return NULL;
    }

    path->fish = (int)index;
    return text + 2 + length;
}

/* Check the words of a path below a section of the table one by one. text: the whole path, for messages; owner: as in
 * case_suggest.h. */
static bool check_words(struct case_path *path, const char *words, const char *text, const char *owner,
                        struct yaml_mark mark, struct yaml_errors *errors) {
    for (;;) {
        const size_t length = strcspn(words, "."), used = strlen(path->pattern);
        char section[sizeof path->pattern], word[sizeof path->pattern];
        snprintf(section, sizeof section, "%s", path->pattern);
        snprintf(word, sizeof word, "%.*s", (int)(length < 50 ? length : 50), words);
        snprintf(path->pattern + used, sizeof path->pattern - used, "%s%s", used > 0 ? "." : "", word);
        const struct key *const key = case_table_row(path->pattern);
        if (!key && !case_table_is_section(path->pattern)) {
            case_path_unknown(errors, mark, text, section, word, owner);
            return false;
        }
        words += length;
        if (*words == '\0') return true;
        if (key) {
            yaml_errors_add(errors, mark, "%.150s: %s is a value and has no keys", text, path->pattern);
            return false;
        }
        words++;
    }
}

/* Refuse a path "fish." without the number of a fish in brackets. */
static void complain_of_fish(const char *words, const char *text, struct yaml_mark mark, struct yaml_errors *errors) {
    const size_t digits = strspn(words, "0123456789*");
    if (digits > 0 && (words[digits] == '.' || words[digits] == '\0')) {
        yaml_errors_add(errors, mark, "%.150s: write fish[%.*s]%.80s", text, (int)(digits < 20 ? digits : 20), words,
                        words + digits);
    } else {
        yaml_errors_add(errors, mark, "%.150s: write fish[0].%.80s for one fish, or fish[*].%.80s for every fish", text,
                        words, words);
    }
}

bool case_path_parse(struct case_path *path, const char *text, int n_fish, struct yaml_mark mark,
                     struct yaml_errors *errors) {
    *path = (struct case_path){{0}, CASE_NO_FISH, text};
    if (strncmp(text, "fish.", 5) == 0) {
        complain_of_fish(text + 5, text, mark, errors);
        return false;
    }

    if (strncmp(text, "defaults.fish.", 14) == 0) {
        snprintf(path->pattern, sizeof path->pattern, "fish");
        return check_words(path, text + 14, text, "defaults.fish", mark, errors);
    }

    if (strcmp(text, "defaults.fish") == 0 || strncmp(text, "fish[", 5) == 0) {
        snprintf(path->pattern, sizeof path->pattern, "fish");
    }
    if (strcmp(text, "defaults.fish") == 0) return true;
    if (strncmp(text, "fish[", 5) != 0) return check_words(path, text, text, NULL, mark, errors);

    path->below = parse_index(path, text + 4, n_fish, mark, errors);
    if (!path->below) return false;
    if (*path->below == '\0') return true;

    if (*path->below != '.') {
        yaml_errors_add(errors, mark, "%.150s: expects a '.' after the ']'", text);
        return false;
    }

    char owner[32];
    snprintf(owner, sizeof owner, "%.*s", (int)(path->below - text), text);
    path->below++;
    return check_words(path, path->below, text, owner, mark, errors);
}
