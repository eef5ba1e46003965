/* parallel.c: chunks, and the decision between one thread and all. */
#include "base/parallel.h"

enum { CHUNK = 16 };

int parallel_n_chunks(int n) {
    return (n + CHUNK - 1) / CHUNK;
}

struct range parallel_chunk(int i, int n) {
    const int first = i * CHUNK, rest = n - first;
    return (struct range){first, rest < CHUNK ? rest : CHUNK};
}

int parallel_threads(int threads, int n, double work, double min_work) {
    return n > 1 && work >= min_work ? threads : 1;
}
