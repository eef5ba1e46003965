/* main_signals.c: a handler stores the number of the signal, and the work looks at it. */
#include "app/main_signals.h"

#include <fcntl.h>
#include <stddef.h>
#include <unistd.h>

static volatile sig_atomic_t stop_signal;

static void on_signal(int number) {
    stop_signal = number;
}

void main_open_standard(void) {
    // standard output must fail as it would have: nothing can be written to what is open for reading
    for (int file = 0; file <= STDERR_FILENO; file++) {
        if (fcntl(file, F_GETFD) < 0) open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    }
}

void main_reset_signals(void) {
    signal(SIGCHLD, SIG_DFL);
}

void main_catch_signals(void) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    action.sa_flags = (int)SA_RESETHAND;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    // a full disk or a file limit is an error to report, not a death
    signal(SIGXFSZ, SIG_IGN);
    // so is a closed pipe; of progress, it is not even that
    signal(SIGPIPE, SIG_IGN);
}

const volatile sig_atomic_t *main_stop_signal(void) {
    return &stop_signal;
}
