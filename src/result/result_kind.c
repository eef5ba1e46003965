/* result_kind.c: the part of the summary that all files of shoal share. */
#include "result/result_kind.h"

#include <string.h>
#include <sys/stat.h>

#include "base/text.h"
#include "result/netcdf.h"
#include "result/result_info.h"

// ---- the summary

enum status result_kind_info(struct arena *arena, int n_kinds, const struct result_kind *kinds, const char *path,
                             enum result_info_form form, FILE *stream) {
    static const char *const lines[][2] = {
        {"  case        %s\n", "title"}, {"  program     %s\n", "source"}, {"  history     %s\n", "history"}};
    struct arena *const scratch = arena_create(arena, path);
    struct netcdf_reader *reader;
    const struct result_kind *kind = kinds;
    char *text;
    NEW(scratch, reader, 1);
    TRY(netcdf_open(scratch, reader, path));

    // the kind, by the attribute with the schema
    const int none = -1;
    int schema = none;
    for (; kind < kinds + n_kinds; kind++) {
        TRY(netcdf_read_integer(reader, kind->schema_name, none, &schema));
        if (schema != none) break;
    }
    if (schema == none) {
        return status_fail(STATUS_FILE, "%s: a NetCDF file, but not of shoal (attribute %s is missing)", path,
                           kinds[0].schema_name);
    }
    if (schema != kind->schema) {
        return status_fail(
            STATUS_FILE,
            "%s: written in schema %d, but this program reads schema %d: use the program that wrote the file", path,
            schema, kind->schema);
    }

    if (form == RESULT_INFO_JSON) {
        TRY(result_json_summary(reader, kind->name, stream));
    } else if (form == RESULT_INFO_CASE) {
        TRY(netcdf_attribute(reader, kind->case_name, &text));
        fputs(text, stream);
    } else {
        fprintf(stream, "%s\n", path);
        for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
            TRY(netcdf_attribute(reader, lines[i][1], &text));
            fprintf(stream, lines[i][0], text);
        }
        struct stat facts;
        const double bytes = stat(path, &facts) == 0 ? (double)facts.st_size : 0;
        fprintf(stream, "  size        %.1f %s\n", bytes < 1e6 ? bytes / 1e3 : bytes / 1e6, bytes < 1e6 ? "kB" : "MB");
        TRY(kind->info(reader, stream));
    }

    arena_free(scratch);
    return STATUS_OK;
}

// ---- the list of variables

int result_kind_variables(int n_kinds, const struct result_kind *kinds, int as_json, const char *word, FILE *stream) {
    struct result_listed listed;
    int n = 0;
    for (int k = 0; k < n_kinds; k++) {
        const bool is_file = kinds[k].schema_name != NULL;
        int n_of_kind = 0;
        for (int i = 0; kinds[k].listed(i, &listed); i++) {
            // append the words of the values
            char meaning[320];
            size_t length = (size_t)snprintf(meaning, sizeof meaning, "%s", listed.meaning);
            const char *flag = listed.flags ? listed.flags : "";
            for (int value = 0; *flag && length < sizeof meaning; value++) {
                const int n_letters = (int)strcspn(flag, " ");
                length += (size_t)snprintf(meaning + length, sizeof meaning - length, "%s%d %.*s",
                                           value == 0 ? ": " : ", ", value, n_letters, flag);
                flag += n_letters + (flag[n_letters] == ' ');
            }
            listed.meaning = meaning;

            if (word && !text_contains(listed.name, word) && !text_contains(listed.meaning, word)) continue;
            if (k > 0 && n_of_kind == 0 && !as_json)
                fprintf(stream, is_file ? "\nIn the file of a %s:\n\n" : "\nThe %ss about a result:\n\n",
                        kinds[k].name);
            n_of_kind++;
            if (as_json) {
                fputs(n == 0 ? "[" : ",", stream);
                fprintf(stream, "\n  {\"file\": \"%s\", \"name\": \"%s\", \"dimensions\": [", kinds[k].name,
                        listed.name);
                for (const char *name = listed.dimensions; *name; name += strspn(name, ", ")) {
                    const int length_of_name = (int)strcspn(name, ",");
                    fprintf(stream, "%s\"%.*s\"", name == listed.dimensions ? "" : ", ", length_of_name, name);
                    name += length_of_name;
                }
                fprintf(stream, "], \"type\": \"%s\", \"unit\": \"%s\", \"meaning\": \"%s\"}", listed.type, listed.unit,
                        listed.meaning);
            } else if (is_file) {
                fprintf(stream, "%-20s  (%s)%*s  %-6s  %s\n", listed.name, listed.dimensions,
                        22 - (int)strlen(listed.dimensions), "", listed.unit, listed.meaning);
            } else {
                fprintf(stream, "%s: %s\n", listed.name, listed.meaning);
            }
            n++;
        }
    }

    if (as_json) fprintf(stream, n > 0 ? "\n]\n" : "[]\n");
    return n;
}
