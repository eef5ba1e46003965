/* case_merge.c: reads the case file and its includes, merges the trees and applies assignments. */
#include "case/case_merge.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/version.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/sweep_error.h"

enum { MAX_INCLUDES = 64, MAX_INCLUDE_DEPTH = 8 };

/* The files being read, innermost first, to detect a file that includes itself. */
struct open_file {
    dev_t device;
    ino_t inode;
    int depth;
    const struct open_file *by;
};

// ---- sources

/* Add an empty source. */
static struct yaml_source *add_source(struct case_tree *tree, const char *name) {
    struct yaml_source *source;
    NEW(tree->arena, source, 1);
    GROW(tree->arena, tree->source, tree->n_sources + 1);
    source->rank = tree->n_sources;
    source->name = arena_text(tree->arena, "%s", name);
    tree->source[tree->n_sources++] = source;
    return source;
}

/* Read the file of a source, at most one byte more than the limit for a case file. Fails with STATUS_FILE and the
 * reason as message. */
static enum status read_file(struct case_tree *tree, struct yaml_source *source, struct open_file *self) {
    enum { CAPACITY = YAML_TREE_BYTES + 1 };
    char *text;
    NEW(tree->arena, text, CAPACITY);

    // a FIFO that nobody writes to is empty, and not waited for
    const int file = open(source->name, O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    struct stat facts = {0};
    enum status status = STATUS_OK;
    if (file < 0 || fstat(file, &facts) != 0) {
        status = status_fail(STATUS_FILE, "cannot be read: %s", strerror(errno));
    } else if (S_ISDIR(facts.st_mode)) {
        status = status_fail(STATUS_FILE, "is a folder, not a case file");
    } else if (!S_ISREG(facts.st_mode) || facts.st_size > 0) {
        // a regular file of size 0 is empty, or belongs to the kernel and may block, as /proc/kmsg does: not read
        fcntl(file, F_SETFL, 0);
        ssize_t n;
        do {
            n = read(file, text + source->length, CAPACITY - source->length);
            if (n > 0) source->length += (size_t)n;
        } while ((n > 0 && source->length < CAPACITY) || (n < 0 && errno == EINTR));
        if (n < 0) status = status_fail(STATUS_FILE, "cannot be read: %s", strerror(errno));
    }

    if (file >= 0) {
        self->device = facts.st_dev;
        self->inode = facts.st_ino;
        close(file);
    }
    source->text = GROW(tree->arena, text, source->length + 1);
    return status;
}

// ---- includes

static struct yaml_node *read_source(struct case_tree *tree, const struct yaml_source *source, const char *folder,
                                     const struct open_file *self, struct yaml_errors *errors);

/* Read a file of an include list, and merge it over *base. Its name is relative to the folder, which ends at the last
 * slash, or else to the cases of the installation. */
static void include_file(struct case_tree *tree, const struct yaml_node *node, const char *folder,
                         const struct open_file *by, struct yaml_errors *errors, struct yaml_node **base) {
    if (node->kind != YAML_SCALAR || node->text[0] == '\0') {
        yaml_errors_add(errors, node->mark, "include: expects a list of file names, as in [water.yaml]");
        return;
    }

    if (by->depth == MAX_INCLUDE_DEPTH || tree->n_sources > MAX_INCLUDES) {
        yaml_errors_add(errors, node->mark, "include: more than %d files, or nested more than %d deep", MAX_INCLUDES,
                        MAX_INCLUDE_DEPTH);
        return;
    }

    const char *const slash = node->text[0] == '/' ? NULL : strrchr(folder, '/');
    const char *path = arena_text(tree->arena, "%.*s%s", slash ? (int)(slash - folder) + 1 : 0, folder, node->text);
    char share[PATH_MAX];
    if (node->text[0] != '/' && access(path, F_OK) != 0 && version_share(share)) {
        const char *const shared = arena_text(tree->arena, "%s/cases/%s", share, node->text);
        if (access(shared, F_OK) == 0) path = shared;
    }

    struct yaml_source *const source = add_source(tree, path);
    struct open_file self = {.depth = by->depth + 1, .by = by};
    if (read_file(tree, source, &self) != STATUS_OK) {
        yaml_errors_add(errors, node->mark, "include: %.200s: %s", source->name, status_message());
        return;
    }

    for (const struct open_file *file = by; file; file = file->by) {
        if (file->device != self.device || file->inode != self.inode) continue;
        yaml_errors_add(errors, node->mark, "include: %.200s includes itself", source->name);
        return;
    }

    // results are named after the case that includes the file
    struct yaml_node *const root = read_source(tree, source, source->name, &self, errors);
    if (!root) return;
    yaml_tree_take(root, "name");
    yaml_tree_merge(tree->arena, base, root);
}

/* Parse a source and the included files into a tree; NULL if the source has errors. */
static struct yaml_node *read_source(struct case_tree *tree, const struct yaml_source *source, const char *folder,
                                     const struct open_file *self, struct yaml_errors *errors) {
    struct yaml_node *root, *base = NULL;
    if (yaml_tree_read(tree->arena, &root, source, errors) != STATUS_OK) return NULL;
    if (!root) {
        const struct yaml_mark start = {source, 1, 1};
        yaml_errors_add(errors, start, "the file is empty; a case needs at least format, time and fish");
        return NULL;
    }

    if (root->kind != YAML_MAP) {
        yaml_errors_add(errors, root->mark,
                        "a case file consists of keys with values, such as 'format: 1', with a blank after each ':'");
        return NULL;
    }

    // merge the case over the included files
    const struct yaml_node *const list = yaml_tree_take(root, "include");
    if (!list) return root;
    if (list->kind == YAML_LIST) {
        for (int i = 0; i < list->n; i++) include_file(tree, list->entry[i].value, folder, self, errors, &base);
    } else {
        include_file(tree, list, folder, self, errors, &base);
    }
    yaml_tree_merge(tree->arena, &base, root);
    return base;
}

enum status case_merge_read(struct case_tree *tree, const char *origin, const char *text, size_t length,
                            const char *folder, struct yaml_errors *errors) {
    struct yaml_source *const source = add_source(tree, origin);
    struct open_file self = {0};
    const char *place = origin;
    if (text) {
        char *copy;
        NEW(tree->arena, copy, length + 1);
        memcpy(copy, text, length);
        source->text = copy;
        source->length = length;
        place = arena_text(tree->arena, "%s%s", folder ? folder : "", folder && *folder ? "/" : "");
    } else if (read_file(tree, source, &self) != STATUS_OK) {
        return status_fail(STATUS_FILE, "%s: error: the case file %s", origin, status_message());
    }
    struct yaml_node *const root = read_source(tree, source, place, &self, errors);
    tree->root = errors->n == 0 ? root : NULL;
    return STATUS_OK;
}

// ---- the case that errors are compared with

void case_merge_against(struct case_tree *tree, const char *place, struct yaml_errors *errors) {
    const struct yaml_node *const map = yaml_tree_find(tree->root, "error");
    struct yaml_entry *const entry = map && map->kind == YAML_MAP ? yaml_tree_entry(map, "against", 7) : NULL;
    const struct yaml_node *const node = entry ? entry->value : NULL;
    if (!node || node->kind != YAML_SCALAR || !sweep_error_is_file(node->text)) return;

    // relative to the folder, which ends at the last slash
    const char *const slash = node->text[0] == '/' ? NULL : strrchr(place, '/');
    const char *const path = arena_text(tree->arena, "%.*s%s", slash ? (int)(slash - place) + 1 : 0, place, node->text);
    struct yaml_source *const source = add_source(tree, path);
    struct open_file self = {0};
    if (read_file(tree, source, &self) != STATUS_OK) {
        yaml_errors_add(errors, node->mark, "error.against: %.200s: %s", source->name, status_message());
        return;
    }
    struct yaml_node *const root = read_source(tree, source, source->name, &self, errors);
    if (!root) return;
    yaml_tree_take(root, "error");
    yaml_tree_take(root, "expect");
    if (yaml_tree_take(root, "sweep")) {
        yaml_errors_add(errors, node->mark, "error.against: %.200s has a sweep: name one case", source->name);
    }

    // the name of the file, as for a case that is read by itself
    if (!yaml_tree_find(root, "name")) {
        const char *const start = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
        struct yaml_node *const name = yaml_tree_node(tree->arena, YAML_SCALAR, node->mark);
        name->text = arena_text(tree->arena, "%.*s", (int)(strrchr(start, '.') - start), start);
        yaml_tree_put(tree->arena, root, "name", node->mark, name);
    }
    entry->value = root;
}

// ---- assignments

/* Merge a value into *node at a path of keys; "" is the node itself. */
static void put_at(struct arena *arena, struct yaml_node **node, const char *path, struct yaml_mark mark,
                   struct yaml_node *value) {
    if (*path == '\0') {
        yaml_tree_merge(arena, node, value);
        return;
    }
    if ((*node)->kind != YAML_MAP) return;  // reported when the section is read

    char key[80];
    const size_t length = strcspn(path, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, path);
    if (path[length] == '\0') {
        yaml_tree_put(arena, *node, key, mark, value);
        return;
    }
    if (!yaml_tree_entry(*node, key, length))
        yaml_tree_put(arena, *node, key, mark, yaml_tree_node(arena, YAML_MAP, mark));
    put_at(arena, &yaml_tree_entry(*node, key, length)->value, path + length + 1, mark, value);
}

// the names of the fish
static const char *const *fish_names(const struct case_tree *tree) {
    const struct yaml_node *const school = yaml_tree_find(tree->root, "fish");
    const char **name;
    NEW(tree->arena, name, case_merge_n_fish(tree));
    for (int f = 0; f < case_merge_n_fish(tree); f++) {
        const struct yaml_node *const own = yaml_tree_find(school->entry[f].value, "name");
        name[f] = own && own->kind == YAML_SCALAR ? own->text : case_table_fish_name(tree->arena, f);
    }
    return name;
}

void case_merge_assign(struct case_tree *tree, const char *assignment, struct yaml_errors *errors) {
    struct arena *const arena = tree->arena;
    char *const name = arena_text(arena, "%s", assignment), *const equals = strchr(name, '=');
    struct yaml_source *const source = add_source(tree, arena_text(arena, "--set %s", assignment));
    const struct yaml_mark mark = {source, 1, 1};
    source->one_line = true;
    if (!equals) {
        yaml_errors_add(errors, mark, "expects PATH=VALUE, as in --set time.end=3");
        return;
    }

    // the key
    *equals = '\0';
    struct case_path path;
    const char *const *const names = case_path_has_name(name) ? fish_names(tree) : NULL;
    if (!case_path_parse(&path, name, case_merge_n_fish(tree), names, mark, errors)) return;
    const struct key *const key = case_table_row(path.pattern);
    if (key && key->type == FILES) {
        yaml_errors_add(errors, mark, "%s: is allowed in case files only", name);
        return;
    }

    // the value; nothing after the equals sign is the empty string
    struct yaml_node *value;
    source->text = equals[1 + strspn(equals + 1, " ")] ? equals + 1 : "\"\"";
    source->length = strlen(source->text);
    if (yaml_tree_read(arena, &value, source, errors) != STATUS_OK) return;
    if (!value) {
        yaml_errors_add(errors, mark, "%s: expects a value after the '='", name);
        return;
    }

    // the place: in the case, in one fish or in every fish
    if (path.fish == CASE_NO_FISH) put_at(arena, &tree->root, path.below, value->mark, value);
    const struct yaml_node *const school = yaml_tree_find(tree->root, "fish");
    for (int i = 0; i < case_merge_n_fish(tree) && path.fish != CASE_NO_FISH; i++) {
        if (path.fish != i && path.fish != CASE_EVERY_FISH) continue;
        put_at(arena, &school->entry[i].value, path.below, value->mark, yaml_tree_copy(arena, value));
    }
}

// ---- queries

int case_merge_n_fish(const struct case_tree *tree) {
    const struct yaml_node *const school = yaml_tree_find(tree->root, "fish");
    return school && school->kind == YAML_LIST ? school->n : 0;
}

const struct yaml_node *case_merge_value(const struct case_tree *tree, const char *path, int fish, bool *is_default) {
    *is_default = false;
    if (strncmp(path, "fish.", 5) != 0) return yaml_tree_find(tree->root, path);
    const struct yaml_node *const school = yaml_tree_find(tree->root, "fish");
    const struct yaml_node *const own = yaml_tree_find(school->entry[fish].value, path + 5);
    if (own) return own;
    *is_default = true;
    return yaml_tree_find(yaml_tree_find(tree->root, "defaults.fish"), path + 5);
}

struct yaml_mark case_merge_mark(const struct case_tree *tree, const char *path, int fish) {
    char around[80];
    snprintf(around, sizeof around, "%s", path);

    for (;;) {
        bool is_default;
        const struct yaml_node *const node = case_merge_value(tree, around, fish, &is_default);
        if (node) return node->mark;
        char *const dot = strrchr(around, '.');
        if (!dot) return tree->root->mark;
        *dot = '\0';
        if (strcmp(around, "fish") == 0) return yaml_tree_find(tree->root, "fish")->entry[fish].value->mark;
    }
}
