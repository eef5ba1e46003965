/* main_steady.c: shoal steady: the steady state of a case. */
#include <stdio.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/main_teller.h"
#include "app/say.h"
#include "base/parallel.h"
#include "result/result_json.h"
#include "result/steady_info.h"
#include "steady/steady.h"

static void tell_progress(const struct steady_progress *now, void *data) {
    struct teller *const teller = data;
    progress_steady(now, &teller->progress);
}

static enum status find_steady_state(const struct case_values *values, const struct request *request,
                                     const char *path) {
    struct teller teller = {0};
    const struct steady_options options = {.path = path,
                                           .from = request->from,
                                           .overwrite = request->force,
                                           .command = request->command_line,
                                           .progress = request->quiet ? NULL : tell_progress,
                                           .warn = main_tell_warning,
                                           .data = &teller,
                                           .stop = main_stop_signal()};
    TRY(parallel_try_threads(values->school.threads));
    parallel_choice_spread(values->school.threads);
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    progress_start(&teller.progress);
    const enum status status = steady_run(values, &options);
    progress_end(&teller.progress);
    TRY(status);
    if (request->json) {
        TRY(netcdf_print(path, result_json_steady, stdout));
    } else if (!request->quiet) {
        struct say_page page;
        say_line(stdout, "%s\n", path);
        TRY(say_begin(&page));
        TRY(say_end(&page, stdout, netcdf_print(path, steady_info, page.stream)));
    }

    return main_refuse_warnings(request, &teller, path);
}

enum status main_steady(const struct request *request) {
    return main_with_case(request, find_steady_state);
}
