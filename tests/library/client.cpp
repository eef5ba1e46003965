// client.cpp: a C++ program that uses the installed library: a run that closes itself, errors as exceptions, and two
// runs in two threads that give the bits of the same runs one after the other. Built and run by test_library.sh.
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "shoal.h"

static void ok(int status) {
    if (status < 0) throw std::runtime_error(shoal_message());
}

// all positions of a run with this assignment, event after event; the run writes a result file too
static void swim(const char *path, const char *assignment, const std::string &file, std::vector<double> &track) {
    shoal *opened;
    ok(shoal_open(&opened, path, 1, &assignment));
    const std::unique_ptr<shoal, void (*)(shoal *)> run(opened, shoal_close);
    ok(shoal_write(run.get(), file.c_str(), 1));
    for (int step = 0; step < 5; step++) {
        shoal_array x;
        ok(shoal_step(run.get()));
        ok(shoal_read(run.get(), "x", &x));
        const double *const values = static_cast<const double *>(x.values);
        track.insert(track.end(), values, values + x.shape[0] * x.shape[1] * x.shape[2]);
    }
    ok(shoal_write_end(run.get()));
}

// the same bits; an unused slot is NaN and equals itself then
static bool same(const std::vector<double> &a, const std::vector<double> &b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

int main(int argc, char **argv) try {
    if (argc != 2) return 2;
    const char *const gait[] = {"fish[0].wave.frequency=1.1", "fish[0].wave.frequency=0.9"};
    std::vector<double> alone[2], together[2];
    for (int i = 0; i < 2; i++) swim(argv[1], gait[i], "alone" + std::to_string(i) + ".nc", alone[i]);
    std::thread other(swim, argv[1], gait[1], "together1.nc", std::ref(together[1]));
    swim(argv[1], gait[0], "together0.nc", together[0]);
    other.join();
    if (same(alone[0], alone[1]) || !same(alone[0], together[0]) || !same(alone[1], together[1])) return 1;
    std::printf("%zu numbers\n", alone[0].size());
    return 0;
} catch (const std::exception &error) {
    std::puts(error.what());
    return 1;
}
