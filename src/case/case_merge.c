/* case_merge.c: read the case file and the includes, merge the trees, apply assignments. */
#include "case/case_merge.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/text.h"
#include "base/version.h"
#include "case/case_path.h"
#include "case/case_table.h"

enum { MAX_INCLUDES = 64, MAX_INCLUDE_DEPTH = 8 };

/* The files being read, innermost first, to detect a file that includes itself. */
struct open_file {
    dev_t device;
    ino_t inode;
    int depth;
    const struct open_file *by;
};

static const char what[] = "reading the case file"; /* in messages on memory */

// ---- sources

/* Add an empty source, owned by the tree. */
static enum status merge_add_source(struct case_tree *tree, const char *name, struct yaml_source **source) {
    TRY(MEMORY_RESIZE(tree->source, tree->n_sources + 1, what));
    TRY(MEMORY_NEW(*source, 1, what));
    (*source)->rank = tree->n_sources;
    tree->source[tree->n_sources++] = *source;
    TRY(memory_copy_string(&(*source)->own_name, name, what));
    (*source)->name = (*source)->own_name;
    return STATUS_OK;
}

void case_merge_free(struct case_tree *tree) {
    yaml_tree_free(tree->root);
    for (int i = 0; i < tree->n_sources; i++) {
        free(tree->source[i]->own_name);
        free(tree->source[i]->own_text);
        free(tree->source[i]);
    }
    free(tree->source);
    *tree = (struct case_tree){0};
}

/* Read the file at path into a source, at most one byte more than the limit for a case file. Fails with STATUS_FILE and
 * the reason as message, or with STATUS_MEMORY. */
static enum status read_file(const char *path, struct yaml_source *source, struct open_file *self) {
    // a FIFO that nobody writes to is empty, and not waited for
    const int file = open(path, O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    const size_t capacity = YAML_TREE_BYTES + 1;
    struct stat facts;
    enum status status = STATUS_OK;
    if (file < 0 || fstat(file, &facts) != 0) {
        status = status_fail(STATUS_FILE, "cannot be read: %s", strerror(errno));
        goto close_file;
    }

    fcntl(file, F_SETFL, 0);
    self->device = facts.st_dev;
    self->inode = facts.st_ino;
    if (S_ISDIR(facts.st_mode)) {
        status = status_fail(STATUS_FILE, "is a folder, not a case file");
        goto close_file;
    }

    status = MEMORY_NEW(source->own_text, capacity, what);
    if (status != STATUS_OK) goto close_file;
    ssize_t n;
    do {
        n = read(file, source->own_text + source->length, capacity - source->length);
        if (n > 0) source->length += (size_t)n;
    } while ((n > 0 && source->length < capacity) || (n < 0 && errno == EINTR));
    if (n < 0) status = status_fail(STATUS_FILE, "cannot be read: %s", strerror(errno));

    // a failure leaves the text as it is
    char *const fitting = n < 0 ? NULL : realloc(source->own_text, source->length + 1);
    if (fitting) source->own_text = fitting;
    source->text = source->own_text;
close_file:
    if (file >= 0) close(file);
    return status;
}

// ---- includes

static enum status read_source(struct case_tree *tree, const struct yaml_source *source, const char *folder,
                               const struct open_file *self, struct yaml_errors *errors, struct yaml_node **root);

/* Use the file of the same name among the cases of the installation if the path does not exist. */
static void use_shared(const char *name, struct text *path) {
    char share[PATH_MAX];
    if (name[0] == '/' || path->failed || access(path->text, F_OK) == 0 || !version_share(share)) return;
    struct text shared = {0};
    text_add(&shared, "%s/cases/%s", share, name);
    if (shared.failed || access(shared.text, F_OK) != 0) {
        text_free(&shared);
        return;
    }
    text_free(path);
    *path = shared;
}

/* Remove the name of an included case: results are named after the case that includes it. */
static void remove_name(struct yaml_node *root) {
    struct yaml_entry *const entry = yaml_tree_entry(root, "name", strlen("name"));
    if (!entry) return;
    yaml_tree_free(entry->value);
    free(entry->key);
    memmove(entry, entry + 1, (size_t)(&root->entry[--root->n] - entry) * sizeof *entry);
}

/* Read the file of an entry of an include list, relative to the folder, which ends at the last slash, or to the cases
 * of the installation; merge the file over *base. */
static enum status include_file(struct case_tree *tree, const struct yaml_node *node, const char *folder,
                                const struct open_file *by, struct yaml_errors *errors, struct yaml_node **base) {
    if (node->kind != YAML_SCALAR || node->text[0] == '\0') {
        yaml_errors_add(errors, node->mark, "include: expects a list of file names, as in [water.yaml]");
        return STATUS_OK;
    }

    if (by->depth == MAX_INCLUDE_DEPTH || tree->n_sources > MAX_INCLUDES) {
        yaml_errors_add(errors, node->mark, "include: more than %d files, or nested more than %d deep", MAX_INCLUDES,
                        MAX_INCLUDE_DEPTH);
        return STATUS_OK;
    }

    struct text path = {0};
    const char *const slash = node->text[0] == '/' ? NULL : strrchr(folder, '/');
    text_add(&path, "%.*s%s", slash ? (int)(slash - folder) + 1 : 0, folder, node->text);
    use_shared(node->text, &path);
    struct yaml_source *source = NULL;
    enum status status = path.failed ? memory_check(NULL, what) : merge_add_source(tree, path.text, &source);
    text_free(&path);
    TRY(status);

    struct open_file self = {.depth = by->depth + 1, .by = by};
    status = read_file(source->name, source, &self);
    if (status == STATUS_FILE) {
        yaml_errors_add(errors, node->mark, "include: %.200s: %s", source->name, status_message());
        return STATUS_OK;
    }

    TRY(status);
    for (const struct open_file *file = by; file; file = file->by) {
        if (file->device != self.device || file->inode != self.inode) continue;
        yaml_errors_add(errors, node->mark, "include: %.200s includes itself", source->name);
        return STATUS_OK;
    }

    struct yaml_node *root = NULL;
    TRY(read_source(tree, source, source->name, &self, errors, &root));
    if (root) remove_name(root);
    return root ? yaml_tree_merge(base, root) : STATUS_OK;
}

/* Remove the include list from *root, read the files and merge *root over them. */
static enum status read_includes(struct case_tree *tree, const char *folder, const struct open_file *self,
                                 struct yaml_errors *errors, struct yaml_node **root) {
    struct yaml_entry *const entry = yaml_tree_entry(*root, "include", strlen("include"));
    if (!entry) return STATUS_OK;
    struct yaml_node *const list = entry->value;
    free(entry->key);
    memmove(entry, entry + 1, (size_t)(&(*root)->entry[--(*root)->n] - entry) * sizeof *entry);

    struct yaml_node *base = NULL;
    enum status status = STATUS_OK;

    if (list->kind == YAML_LIST) {
        for (int i = 0; i < list->n && status == STATUS_OK; i++) {
            status = include_file(tree, list->entry[i].value, folder, self, errors, &base);
        }
    } else {
        status = include_file(tree, list, folder, self, errors, &base);
    }
    yaml_tree_free(list);

    if (status == STATUS_OK && base) {
        status = yaml_tree_merge(&base, *root);
        *root = base;
    } else {
        yaml_tree_free(base);
    }
    return status;
}

/* Parse a source and the included files into a tree; *root stays NULL if the source has errors. */
static enum status read_source(struct case_tree *tree, const struct yaml_source *source, const char *folder,
                               const struct open_file *self, struct yaml_errors *errors, struct yaml_node **root) {
    const enum status status = yaml_tree_read(root, source, errors);
    if (status == STATUS_CASE) return STATUS_OK;
    TRY(status);

    if (!*root) {
        const struct yaml_mark start = {source, 1, 1};
        yaml_errors_add(errors, start, "the file is empty; a case needs at least format, time and fish");
        return STATUS_OK;
    }

    if ((*root)->kind != YAML_MAP) {
        yaml_errors_add(errors, (*root)->mark,
                        "a case file consists of keys with values, such as 'format: 1', with a blank after each ':'");
        yaml_tree_free(*root);
        *root = NULL;
        return STATUS_OK;
    }

    return read_includes(tree, folder, self, errors, root);
}

/* Read the case file and the included files. */
static enum status merge_read_case(struct case_tree *tree, const char *folder, const struct open_file *self,
                                   struct yaml_errors *errors) {
    struct yaml_node *root = NULL;
    const enum status status = read_source(tree, tree->source[0], folder, self, errors, &root);
    if (status == STATUS_OK && errors->n == 0) {
        tree->root = root;
    } else {
        yaml_tree_free(root);
    }
    return status;
}

enum status case_merge_read_file(struct case_tree *tree, const char *path, struct yaml_errors *errors) {
    struct yaml_source *source;
    TRY(merge_add_source(tree, path, &source));
    struct open_file self = {0};
    const enum status status = read_file(path, source, &self);
    if (status == STATUS_FILE) return status_fail(STATUS_FILE, "%s: error: the case file %s", path, status_message());
    TRY(status);
    return merge_read_case(tree, path, &self, errors);
}

enum status case_merge_read_text(struct case_tree *tree, const char *text, size_t length, const char *origin,
                                 const char *folder, struct yaml_errors *errors) {
    struct yaml_source *source;
    TRY(merge_add_source(tree, origin, &source));
    TRY(MEMORY_NEW(source->own_text, length + 1, what));
    memcpy(source->own_text, text, length);
    source->text = source->own_text;
    source->length = length;
    struct text place = {0};
    text_add(&place, "%s%s", folder ? folder : "", folder && *folder ? "/" : "");
    const struct open_file self = {0};
    const enum status status =
        place.failed ? memory_check(NULL, what) : merge_read_case(tree, place.text, &self, errors);
    text_free(&place);
    return status;
}

// ---- assignments

/* Merge a value into *node at a path of keys; "" is the node itself. Takes ownership of the value. */
static enum status put_at(struct yaml_node **node, const char *path, struct yaml_mark mark, struct yaml_node *value) {
    if (*path == '\0') return yaml_tree_merge(node, value);
    if ((*node)->kind != YAML_MAP) {  // reported when the section is read
        yaml_tree_free(value);
        return STATUS_OK;
    }
    char key[80];
    const size_t length = strcspn(path, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, path);
    if (path[length] == '\0') return yaml_tree_put(*node, key, mark, value);

    if (!yaml_tree_entry(*node, key, length)) {
        struct yaml_node *map;
        enum status status = yaml_tree_map(&map, mark);
        if (status == STATUS_OK) status = yaml_tree_put(*node, key, mark, map);
        if (status != STATUS_OK) {
            yaml_tree_free(value);
            return status;
        }
    }

    return put_at(&yaml_tree_entry(*node, key, length)->value, path + length + 1, mark, value);
}

/* Put a value at a path, in one fish or in every fish. Takes ownership of the value. */
static enum status put_node(struct case_tree *tree, const struct case_path *path, struct yaml_node *value) {
    if (path->fish == CASE_NO_FISH) return put_at(&tree->root, path->below, value->mark, value);
    struct yaml_entry *const school = yaml_tree_entry(tree->root, "fish", 4);
    enum status status = STATUS_OK;
    for (int i = 0; i < case_merge_n_fish(tree) && status == STATUS_OK; i++) {
        if (path->fish != i && path->fish != CASE_EVERY_FISH) continue;
        struct yaml_node *copy;
        status = yaml_tree_copy(&copy, value);
        if (status == STATUS_OK) status = put_at(&school->value->entry[i].value, path->below, value->mark, copy);
    }

    yaml_tree_free(value);
    return status;
}

/* Apply the assignment name=text. */
static enum status assign(struct case_tree *tree, char *name, const char *text, struct yaml_source *source,
                          struct yaml_errors *errors) {
    const struct yaml_mark mark = {source, 1, 1};
    struct case_path path;
    if (!case_path_parse(&path, name, case_merge_n_fish(tree), mark, errors)) return STATUS_OK;
    const struct key *const key = case_table_row(path.pattern);

    if (key && key->type == FILES) {
        yaml_errors_add(errors, mark, "%s: is allowed in case files only", name);
        return STATUS_OK;
    }

    // nothing after the equals sign is the empty string
    TRY(memory_copy_string(&source->own_text, text[strspn(text, " ")] ? text : "\"\"", what));
    source->text = source->own_text;
    source->length = strlen(source->text);
    struct yaml_node *value = NULL;
    const enum status status = yaml_tree_read(&value, source, errors);
    if (status == STATUS_CASE) return STATUS_OK;
    TRY(status);
    if (value) return put_node(tree, &path, value);
    yaml_errors_add(errors, mark, "%s: expects a value after the '='", name);
    return STATUS_OK;
}

enum status case_merge_assign(struct case_tree *tree, const char *assignment, struct yaml_errors *errors) {
    char *name;
    TRY(memory_copy_string(&name, assignment, what));
    struct text title = {0};
    text_add(&title, "--set %s", assignment);
    struct yaml_source *source = NULL;
    enum status status = title.failed ? memory_check(NULL, what) : merge_add_source(tree, title.text, &source);
    text_free(&title);
    if (status != STATUS_OK) goto free_name;

    source->one_line = true;
    char *const equals = strchr(name, '=');
    if (equals) {
        *equals = '\0';
        status = assign(tree, name, equals + 1, source, errors);
    } else {
        const struct yaml_mark mark = {source, 1, 1};
        yaml_errors_add(errors, mark, "expects PATH=VALUE, as in --set time.end=3");
    }
free_name:
    free(name);
    return status;
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

void case_merge_complain(const struct case_tree *tree, const char *path, int fish, const char *reason,
                         struct yaml_errors *errors) {
    const struct yaml_mark mark = case_merge_mark(tree, path, fish);
    if (strncmp(path, "fish.", 5) == 0) {
        yaml_errors_add(errors, mark, "fish[%d].%s: %s", fish, path + 5, reason);
    } else {
        yaml_errors_add(errors, mark, "%s: %s", path, reason);
    }
}
