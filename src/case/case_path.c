/* case_path.c: suggestions for an unknown word; a path word by word along the table of keys. */
#include "case/case_path.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/case_table.h"

// ---- suggestions: the key of the table with the smallest edit distance

enum { WORD = 40 /* no key has a longer word */ };

/* One word of a path of the table: "body" or "modulus" of "fish.body.modulus". */
struct candidate {
    char word[WORD + 1];
    char section[80]; /* "fish.body"; "" at the top */
    int distance;     /* edits from the word of the user */
    int remoteness;   /* 0: same section, 1: subsection, 2: both in a fish, 3: elsewhere */
};

/* Words for quantities that are no keys, and the keys to use instead. */
static const struct {
    const char *words, *instead;
} missing[] = {
    {"kinematic_viscosity dynamic_viscosity mu reynolds reynolds_number",
     "; the friction is set by drag.tangential of a fish, or by fluid.viscosity with 'drag.skin: boundary_layer' or "
     "'laminar'"},
};

static int case_path_smaller(int a, int b) {
    return a < b ? a : b;
}

/* The smallest distance of a word to any of some words separated by blanks. */
static int distance_to_any(const char *word, const char *words) {
    int distance = INT_MAX;
    while (words && *words) {
        const size_t length = strcspn(words, " ");
        distance = case_path_smaller(distance, text_distance(word, strlen(word), words, length));
        words += length + strspn(words + length, " ");
    }
    return distance;
}

/* True if a section is "fish" or a subsection of "fish". */
static bool is_in_fish(const char *section) {
    return strncmp(section, "fish", 4) == 0 && (section[4] == '\0' || section[4] == '.');
}

/* The remoteness of one section from another: see struct candidate. */
static int remoteness_of(const char *section, const char *from) {
    const size_t here = strlen(from);
    if (strcmp(section, from) == 0) return 0;
    if (strncmp(section, from, here) == 0 && (here == 0 || section[here] == '.')) return 1;
    return is_in_fish(section) && is_in_fish(from) ? 2 : 3;
}

/* Compare the word of a path that ends at end with the best candidate; keep the nearer one. */
static void keep_nearer(struct candidate *best, const struct key *key, size_t end, const char *section,
                        const char *word) {
    size_t begin = end;
    while (begin > 0 && key->path[begin - 1] != '.') begin--;
    struct candidate one = {{0}, {0}, INT_MAX, 0};
    if (end - begin > WORD || begin > sizeof one.section) return;
    memcpy(one.word, key->path + begin, end - begin);
    if (begin > 0) memcpy(one.section, key->path, begin - 1);

    one.distance = text_distance(word, strlen(word), one.word, strlen(one.word));
    const bool is_leaf = key->path[end] == '\0';
    if (is_leaf) one.distance = case_path_smaller(one.distance, distance_to_any(word, key->synonyms));
    one.remoteness = remoteness_of(one.section, section);
    const bool is_nearer = one.distance < best->distance;
    if (is_nearer || (one.distance == best->distance && one.remoteness < best->remoteness)) *best = one;
}

/* Add a section as users write it: "fish[2].body" or "time". */
static void add_section(struct text *hint, const char *section, const char *owner) {
    if (section[0] == '\0') {
        text_add(hint, "the top of the file");
    } else if (is_in_fish(section)) {
        const char *const rest = section + strlen("fish");
        if (owner) {
            text_add(hint, "%s%s", owner, rest);
        } else {
            text_add(hint, "a fish, as fish[0]%s, or to defaults.fish%s for every fish", rest, rest);
        }
    } else {
        text_add(hint, "%s", section);
    }
}

/* List the words of a section. */
static void add_words(struct text *hint, const char *section) {
    const size_t here = section[0] ? strlen(section) + 1 : 0;
    size_t last_length = 0;
    const char *last = "";
    text_add(hint, "; known keys:");

    for (int i = 0; i < case_table_n; i++) {
        const char *const path = case_table[i].path;
        if (here > 0 && (strncmp(path, section, here - 1) != 0 || path[here - 1] != '.')) continue;
        const size_t length = strcspn(path + here, ".");
        const bool is_same = length == last_length && strncmp(path + here, last, length) == 0;
        if (!is_same) text_add(hint, "%s %.*s", last_length ? "," : "", (int)length, path + here);
        last = path + here;
        last_length = length;
    }
}

/* Copy the section of row i of the table if the row has the word and the section this remoteness; returns the length,
 * else 0. */
static size_t section_with(char *section, size_t size, int i, const char *word, const char *from, int remoteness) {
    const char *const dot = strrchr(case_table[i].path, '.');
    if (!dot || strcmp(dot + 1, word) != 0) return 0;
    snprintf(section, size, "%.*s", (int)(dot - case_table[i].path), case_table[i].path);
    return remoteness_of(section, from) == remoteness ? strlen(section) : 0;
}

/* Add all sections with the word and the remoteness of the best candidate: "fish[0].wave or fish[0].motion". */
static void add_sections(struct text *hint, const struct candidate *best, const char *from, const char *owner) {
    char section[sizeof best->section];
    int n = 0;
    for (int i = 0; i < case_table_n; i++) {
        n += section_with(section, sizeof section, i, best->word, from, best->remoteness) > 0;
    }
    if (n < 2) {
        add_section(hint, best->section, owner);
        return;
    }

    for (int i = 0, k = 0; i < case_table_n; i++) {
        if (section_with(section, sizeof section, i, best->word, from, best->remoteness) == 0) continue;
        if (k++ > 0) text_add(hint, " or ");
        add_section(hint, section, owner ? owner : "fish[0]");
    }
}

/* Add a suggestion such as "; did you mean 'modulus'?". Arguments as of case_path_unknown. */
static void suggest_key(struct text *hint, const char *section, const char *word, const char *owner) {
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++) {
        if (distance_to_any(word, missing[i].words) > 0) continue;
        text_add(hint, "%s", missing[i].instead);
        return;
    }

    struct candidate best = {{0}, {0}, INT_MAX, INT_MAX};

    for (int i = 0; i < case_table_n; i++) {
        const char *const path = case_table[i].path;
        for (size_t end = 1; end <= strlen(path); end++) {
            if (path[end] == '.' || path[end] == '\0') keep_nearer(&best, &case_table[i], end, section, word);
        }
    }

    const int length = (int)strnlen(word, WORD);
    const int allowed = length < 4 ? length / 2 : case_path_smaller(3, length / 3);

    if (best.distance > allowed) {
        add_words(hint, section);
        return;
    }

    const bool is_known = strcmp(best.word, word) == 0, is_elsewhere = best.remoteness > 0;
    if (is_known) {
        text_add(hint, " here; the key belongs to ");
    } else {
        text_add(hint, "; did you mean '%s'?%s", best.word, is_elsewhere ? " The key belongs to " : "");
    }
    if (is_elsewhere) add_sections(hint, &best, section, owner);
}

// ---- paths

void case_path_unknown(struct yaml_errors *errors, struct yaml_mark mark, const char *path, const char *section,
                       const char *word, const char *owner) {
    struct text hint = {0};
    if (errors->n < YAML_ERRORS_KEPT) suggest_key(&hint, section, word, owner);
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

/* Check the words of a path below a section of the table one by one. text: the whole path, for messages. */
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

bool case_path_parse(struct case_path *path, const char *text, int n_fish, struct yaml_mark mark,
                     struct yaml_errors *errors) {
    *path = (struct case_path){{0}, CASE_NO_FISH, text};
    if (strncmp(text, "fish.", 5) == 0) {
        const char *const words = text + 5;
        const size_t digits = strspn(words, "0123456789*");
        if (digits > 0 && (words[digits] == '.' || words[digits] == '\0')) {
            yaml_errors_add(errors, mark, "%.150s: write fish[%.*s]%.80s", text, (int)(digits < 20 ? digits : 20),
                            words, words + digits);
        } else {
            yaml_errors_add(errors, mark, "%.150s: write fish[0].%.80s for one fish, or fish[*].%.80s for every fish",
                            text, words, words);
        }
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
