/* main_signals.c: a signal only stores its number; the integration asks for it and stops with a checkpoint. */
#include "app/main_signals.h"

#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>
#include <unistd.h>

#include "app/main_commands.h"
#include "result/durable.h"

static volatile sig_atomic_t stop_signal;
static bool is_catching; /* the command catches signals */

static void on_signal(int number) {
    stop_signal = number;
}

/* Signals that request a stop. */
static const struct {
    int number, flags;
} asking[] = {
    {.number = SIGINT, .flags = (int)SA_RESETHAND},
    // a batch queue can send these repeatedly while the checkpoint is written
    {.number = SIGTERM},
    {.number = SIGHUP},
    {.number = SIGUSR1},
    // soft limit on CPU time; the hard limit kills
    {.number = SIGXCPU},
};

/* End a command that does not catch signals, and leave no part of a file. */
static void on_end(int number) {
    durable_remove_parts();
    signal(number, SIG_DFL);
    raise(number);
}

/* Handle the signals, but none that the parent process ignores (nohup). */
static void handle_signals(void (*handler)(int), bool once) {
    for (size_t i = 0; i < sizeof asking / sizeof *asking; i++) {
        struct sigaction before, action = {.sa_handler = handler, .sa_flags = once ? asking[i].flags : 0};
        sigemptyset(&action.sa_mask);
        sigaction(asking[i].number, NULL, &before);
        if (before.sa_handler != SIG_IGN) sigaction(asking[i].number, &action, NULL);
    }
}

void main_end_by_pipe(void) {
    struct pollfd output = {.fd = STDOUT_FILENO};
    if (is_catching || poll(&output, 1, 0) != 1 || !(output.revents & POLLERR)) return;
    signal(SIGPIPE, SIG_DFL);
    raise(SIGPIPE);
}

void main_catch_signals(void) {
    handle_signals(on_signal, true);
    is_catching = true;
}

void main_leave_no_part(void) {
    handle_signals(on_end, false);
}

enum status main_limit_wall_time(const char *text) {
    int hours, minutes, seconds, length = 0;
    const int n = sscanf(text, "%5d:%2d:%2d%n", &hours, &minutes, &seconds, &length);
    const bool is_time =
        n == 3 && text[length] == '\0' && hours >= 0 && minutes >= 0 && seconds >= 0 && minutes < 60 && seconds < 60;
    const int total = is_time ? (hours * 60 + minutes) * 60 + seconds : 0;
    if (total == 0) return status_fail(STATUS_CASE, "--max-wall %s: expects HH:MM:SS, such as 23:50:00", text);
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGALRM, &action, NULL);
    alarm((unsigned)total);
    return STATUS_OK;
}

void main_limit_processor_time(double seconds) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGPROF, &action, NULL);
    const double whole = floor(seconds);
    const struct itimerval once = {.it_value = {(time_t)whole, (suseconds_t)(1e6 * (seconds - whole))}};
    setitimer(ITIMER_PROF, &once, NULL);
}

// ---- exits of libraries

static volatile sig_atomic_t is_guarded;

static void on_exit_of_a_library(void) {
    if (!is_guarded) return;
    durable_remove_parts();
    fputs("shoal: error: a library ended the program: out of memory or too many threads\n", stderr);
    _exit(status_exit_code(STATUS_MEMORY));
}

void main_prepare(void) {
    // open standard output for reading, so that writing still fails
    for (int file = 0; file <= STDERR_FILENO; file++) {
        if (fcntl(file, F_GETFD) < 0) open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    }

    // waiting for child processes fails if the parent process ignores the signal
    signal(SIGCHLD, SIG_DFL);

    // report a file size limit as an error of the write; the default action kills
    signal(SIGXFSZ, SIG_IGN);

    // a closed pipe for messages ends no command
    signal(SIGPIPE, SIG_IGN);
    is_guarded = atexit(on_exit_of_a_library) == 0;
}

int main_exit(int code) {
    is_guarded = 0;
    return code;
}

const volatile sig_atomic_t *main_stop_signal(void) {
    return &stop_signal;
}
