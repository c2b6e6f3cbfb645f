// Preloaded, it makes a file system of every one that refuses locks, as some over a network do: flock() and the locks of
// fcntl() fail with the error number NO_LOCKS. For tests/app/validation/without_locks.py.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>

static int refuse(void) {
  errno = atoi(getenv("NO_LOCKS"));
  return -1;
}

static int is_lock(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_GETLK || command == F_OFD_SETLK ||
         command == F_OFD_SETLKW || command == F_OFD_GETLK;
}

static int real(const char* name, int file, int command, void* value) {
  return ((int (*)(int, int, ...))dlsym(RTLD_NEXT, name))(file, command, value);
}

int flock(int file, int operation) {
  (void)file, (void)operation;
  return refuse();
}

int fcntl(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void* const value = va_arg(values, void*);
  va_end(values);
  return is_lock(command) ? refuse() : real("fcntl", file, command, value);
}

int fcntl64(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void* const value = va_arg(values, void*);
  va_end(values);
  return is_lock(command) ? refuse() : real("fcntl64", file, command, value);
}
