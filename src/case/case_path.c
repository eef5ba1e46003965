/* case_path.c: follows a path such as fish[2].body.modulus word by word along the table of keys, and suggests a key for
 * a word that is unknown. */
#include "case/case_path.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/case_merge.h"
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

/* The smallest distance of a word to any of some words separated by blanks. */
static int distance_to_any(const char *word, const char *words) {
    int distance = INT_MAX;
    while (words && *words) {
        const size_t length = strcspn(words, " ");
        const int one = text_distance(word, strlen(word), words, length);
        if (one < distance) distance = one;
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

/* The word of the table nearest to a word of the user; of equally near ones the least remote. */
static struct candidate find_nearest(const char *section, const char *word) {
    struct candidate best = {{0}, {0}, INT_MAX, INT_MAX};
    for (int i = 0; i < case_table_n; i++) {
        const char *const path = case_table[i].path;
        size_t begin = 0;
        for (size_t end = 1; end <= strlen(path); end++) {
            if (path[end] != '.' && path[end] != '\0') continue;
            struct candidate one = {{0}, {0}, INT_MAX, 0};
            if (end - begin <= WORD && begin <= sizeof one.section) {
                memcpy(one.word, path + begin, end - begin);
                if (begin > 0) memcpy(one.section, path, begin - 1);
                one.distance = text_distance(word, strlen(word), one.word, strlen(one.word));
                const int of_synonym = path[end] == '\0' ? distance_to_any(word, case_table[i].synonyms) : INT_MAX;
                if (of_synonym < one.distance) one.distance = of_synonym;
                one.remoteness = remoteness_of(one.section, section);
                const bool is_nearer = one.distance < best.distance;
                if (is_nearer || (one.distance == best.distance && one.remoteness < best.remoteness)) best = one;
            }
            begin = end + 1;
        }
    }
    return best;
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

/* Add all sections with the word and the remoteness of the best candidate: "fish[0].wave or fish[0].motion". */
static void add_sections(struct text *hint, const struct candidate *best, const char *from, const char *owner) {
    struct text all = {.arena = hint->arena};
    int n = 0;
    for (int i = 0; i < case_table_n; i++) {
        char section[sizeof best->section];
        const char *const dot = strrchr(case_table[i].path, '.');
        if (!dot || strcmp(dot + 1, best->word) != 0) continue;
        snprintf(section, sizeof section, "%.*s", (int)(dot - case_table[i].path), case_table[i].path);
        if (remoteness_of(section, from) != best->remoteness) continue;
        if (n++ > 0) text_add(&all, " or ");
        add_section(&all, section, owner ? owner : "fish[0]");
    }

    if (n > 1) {
        text_add(hint, "%s", all.text);
    } else {
        add_section(hint, best->section, owner);
    }
}

void case_path_unknown(struct yaml_errors *errors, struct yaml_mark mark, const char *path, const char *section,
                       const char *word, const char *owner) {
    struct text hint = {.arena = errors->arena};
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++) {
        if (distance_to_any(word, missing[i].words) == 0) text_add(&hint, "%s", missing[i].instead);
    }

    // "; did you mean 'modulus'?"
    const bool is_searched = errors->n < YAML_ERRORS_KEPT && !hint.text;
    const int length = (int)strnlen(word, WORD), third = length / 3 < 3 ? length / 3 : 3;
    const struct candidate best = is_searched ? find_nearest(section, word) : (struct candidate){.distance = INT_MAX};
    const bool is_near = best.distance <= (length < 4 ? length / 2 : third);
    if (is_near) {
        const bool is_known = strcmp(best.word, word) == 0, is_elsewhere = best.remoteness > 0;
        if (is_known) {
            text_add(&hint, " here; the key belongs to ");
        } else {
            text_add(&hint, "; did you mean '%s'?%s", best.word, is_elsewhere ? " The key belongs to " : "");
        }
        if (is_elsewhere) add_sections(&hint, &best, section, owner);
    }

    // or the words of the section
    const size_t here = section[0] ? strlen(section) + 1 : 0;
    size_t last_length = 0;
    const char *last = "";
    if (is_searched && !is_near) text_add(&hint, "; known keys:");
    for (int i = 0; i < case_table_n && is_searched && !is_near; i++) {
        const char *const key = case_table[i].path;
        if (here > 0 && (strncmp(key, section, here - 1) != 0 || key[here - 1] != '.')) continue;
        const size_t n = strcspn(key + here, ".");
        const bool is_same = n == last_length && strncmp(key + here, last, n) == 0;
        if (!is_same) text_add(&hint, "%s %.*s", last_length ? "," : "", (int)n, key + here);
        last = key + here;
        last_length = n;
    }

    yaml_errors_add(errors, mark, "%.150s: unknown key%s", path, hint.text ? hint.text : "");
}

// ---- paths

bool case_path_has_name(const char *text) {
    if (strncmp(text, "fish[", 5) != 0 || strncmp(text, "fish[*]", 7) == 0) return false;
    const size_t n_digits = strspn(text + 5, "0123456789");
    return n_digits == 0 || text[5 + n_digits] != ']';
}

/* Find the fish of a name; CASE_NO_FISH after adding an error that suggests the nearest name. */
static int fish_of_name(const char *text, size_t length, int n_fish, const char *const *name, struct yaml_mark mark,
                        struct yaml_errors *errors) {
    for (int f = 0; f < n_fish; f++) {
        if (strlen(name[f]) == length && strncmp(text, name[f], length) == 0) return f;
    }

    int nearest = 0, least = INT_MAX;
    for (int f = 0; f < n_fish; f++) {
        const int distance = text_distance(text, length, name[f], strlen(name[f]));
        if (distance < least) {
            least = distance;
            nearest = f;
        }
    }
    const int shown = (int)(length < 40 ? length : 40);
    if (n_fish > 0 && least <= (int)length / 3 + 1) {
        yaml_errors_add(errors, mark, "fish[%.*s]: there is no fish of this name; did you mean fish[%.60s]?", shown,
                        text, name[nearest]);
    } else {
        yaml_errors_add(errors, mark,
                        "fish[%.*s]: there is no fish of this name; write the number of a fish, as in fish[0], its "
                        "name, or fish[*] for every fish",
                        shown, text);
    }
    return CASE_NO_FISH;
}

/* Read "[2]", "[leader]" or "[*]" at text; returns the end of the index, or NULL after an error. A name ends at the
 * first ']'. */
static const char *parse_index(struct case_path *path, const char *text, int n_fish, const char *const *name,
                               struct yaml_mark mark, struct yaml_errors *errors) {
    const size_t length = strspn(text + 1, "0123456789");
    if (strncmp(text, "[*]", 3) == 0) {
        path->fish = CASE_EVERY_FISH;
        return text + 3;
    }

    if (length == 0 || text[1 + length] != ']') {
        const char *const end = strchr(text, ']');
        if (!end || end == text + 1) {
            yaml_errors_add(errors, mark,
                            "fish%.20s: expects the number or the name of a fish, as in fish[0], or fish[*] for every "
                            "fish",
                            text);
            return NULL;
        }
        path->fish = fish_of_name(text + 1, (size_t)(end - text - 1), n_fish, name, mark, errors);
        return path->fish == CASE_NO_FISH ? NULL : end + 1;
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

bool case_path_parse(struct case_path *path, const char *text, int n_fish, const char *const *name,
                     struct yaml_mark mark, struct yaml_errors *errors) {
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

    path->below = parse_index(path, text + 4, n_fish, name, mark, errors);
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
