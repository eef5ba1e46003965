/* open_like.h: open and open64 in place of those of the C library: they call open_any of the including file. */
#define OPEN_LIKE(name)                           \
    int name(const char *path, int flags, ...) {  \
        va_list list;                             \
        va_start(list, flags);                    \
        const mode_t mode = va_arg(list, mode_t); \
        va_end(list);                             \
        return open_any(path, flags, mode);       \
    }
OPEN_LIKE(open)
OPEN_LIKE(open64)
