/* What has to be so before the libraries of the program begin: they do when it is loaded, before its first statement.
 *
 * OpenBLAS starts a thread a processor then, each of which asks for 128 MiB: where `ulimit -v` does not leave them they ask again and
 * again for ever, and where `ulimit -u` leaves no threads the library ends the program. The program needs none of them (its own
 * threads call BLAS), so under such a limit it is begun anew with OPENBLAS_NUM_THREADS=1. A small stack (`ulimit -s`) is made as
 * large as may be: that, too, counts from the beginning alone. */
#define _GNU_SOURCE
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef __ELF__
#define NAME "OPENBLAS_NUM_THREADS="

enum { LEAST_STACK = 1 << 20, FEW_PROCESSES = 1024 };

static char alone[] = NAME "1";

/* Whether the threads that libraries start may be too many. */
static int is_limited(void) {
   struct rlimit space, processes;
   return (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) ||
          (getrlimit(RLIMIT_NPROC, &processes) == 0 && processes.rlim_cur < FEW_PROCESSES);
}

/* 1: the stack was too small and is larger from the next beginning on. */
static int has_raised_stack(void) {
   struct rlimit stack;
   if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= LEAST_STACK || stack.rlim_max <= stack.rlim_cur)
      return 0;
   stack.rlim_cur = stack.rlim_max < 8 * LEAST_STACK ? stack.rlim_max : 8 * LEAST_STACK;
   return setrlimit(RLIMIT_STACK, &stack) == 0;
}

/* Where the program cannot be begun anew it goes on as it is. */
static void begin_anew(char **arguments, char **environment) {
   char path[4096];
   ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);

   if (length > 0) {
      path[length] = 0;
      execve(path, arguments, environment);
   }
   execve("/proc/self/exe", arguments, environment);
}

static void prepare(int n_arguments, char **arguments, char **environment) {
   int is_raised = has_raised_stack(), n = 0, k = -1;

   (void)n_arguments;
   while (environment[n]) {
      if (strncmp(environment[n], NAME, strlen(NAME)) == 0)
         k = n;
      n++;
   }
   if (is_limited() && k >= 0)
      environment[k] = alone;                       /* libraries read it from here */
   if (is_limited() && k < 0) {
      char *more[n + 2];
      memcpy(more, environment, n * sizeof *more);
      more[n] = alone;
      more[n + 1] = NULL;
      begin_anew(arguments, more);
   } else if (is_raised) {
      begin_anew(arguments, environment);
   }
}

/* The linker's list of what is called before anything of a library; of a program alone, and where the C library knows it. */
__attribute__((section(".preinit_array"), used)) static void (*const before_libraries)(int, char **, char **) = prepare;
#endif
