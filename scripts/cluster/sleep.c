// Makes the rows of a study last: loaded before the program (LD_PRELOAD), it sleeps ASDIC_ROW_SECONDS each time a row
// is marked as in hand (study/journal/rows_in_hand.cpp, a line of 64 bytes that begins with m). So one machine can
// stand for many: rows take time and no core. For scripts/cluster/measure.py alone.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

ssize_t pwrite64(int file, const void* text, size_t count, off64_t at) {
  static ssize_t (*real)(int, const void*, size_t, off64_t);
  if (!real) real = (ssize_t (*)(int, const void*, size_t, off64_t))dlsym(RTLD_NEXT, "pwrite64");
  const char* seconds = getenv("ASDIC_ROW_SECONDS");
  if (seconds && count == 64 && *(const char*)text == 'm') {
    const double s = atof(seconds);
    const struct timespec t = {(time_t)s, (long)(1e9 * (s - (double)(time_t)s))};
    nanosleep(&t, NULL);
  }
  return real(file, text, count, at);
}
ssize_t pwrite(int file, const void* text, size_t count, off_t at) { return pwrite64(file, text, count, at); }
