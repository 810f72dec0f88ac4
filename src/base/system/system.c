/* What the program asks of the system: paths, files, locks, signals, processes, memory (POSIX; Linux where it says so).
 *
 * The numbers and structures of the system stand in its headers, and here alone the compiler sees them. atrito_system.f90 has
 * the Fortran interfaces. Texts come as C strings. */
#define _GNU_SOURCE
#include <ctype.h>
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <fenv.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <stdio_ext.h>
#include <sys/prctl.h>
#include <sys/vfs.h>
#else
#define __fpurge fpurge
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

/* ---- paths ---- */

int atrito_is_folder(const char *path) {
   struct stat is;
   return stat(path, &is) == 0 && S_ISDIR(is.st_mode);
}

int atrito_may_write(const char *path) { return access(path, W_OK) == 0; }

/* What keeps a run from writing into a folder: 0 nothing, 1 it is not there, 2 something above it is no folder, 3 it cannot be
 * read, 4 it cannot be written into. One question to the system decides: between two, another run may make the folder or remove
 * it. */
int atrito_judge_folder(const char *path) {
   if (access(path, R_OK | W_OK | X_OK) == 0)
      return 0;
   if (errno == ENOENT)
      return 1;
   if (errno == ENOTDIR)
      return 2;
   return access(path, W_OK | X_OK) == 0 ? 3 : 4;
}

void atrito_remove_file(const char *path) { unlink(path); }

void atrito_remove_folder(const char *path) { rmdir(path); }

/* What has a name, links not followed: 0 nothing, 1 a plain file, 2 a folder, 3 a link, 4 something else. */
int atrito_kind_of(const char *path) {
   struct stat is;
   if (lstat(path, &is) != 0)
      return 0;
   return S_ISREG(is.st_mode) ? 1 : S_ISDIR(is.st_mode) ? 2 : S_ISLNK(is.st_mode) ? 3 : 4;
}

/* The same of a name in a folder. */
int atrito_kind_in(const char *folder, const char *name) {
   size_t n = strlen(folder), m = strlen(name);
   char path[4096];
   if (n + m + 2 > sizeof path)
      return 0;
   memcpy(path, folder, n);
   path[n] = '/';
   memcpy(path + n + 1, name, m + 1);
   return atrito_kind_of(path);
}

/* Whether a text has nothing but printable characters of ASCII, eight of them at a time. */
int atrito_is_plain(const char *text, size_t length) {
   const uint64_t ones = 0x0101010101010101u;
   uint64_t found = 0, some;
   size_t i = 0;

   for (; i + sizeof some <= length; i += sizeof some) {
      memcpy(&some, text + i, sizeof some);
      found |= some | (some - 32 * ones) | (some + ones); /* 128 and more, less than 32, 127: the uppermost bit */
   }
   for (; i < length; i++)
      if (text[i] < 32 || text[i] > 126)
         return 0;
   return (found & (128 * ones)) == 0;
}

int atrito_exists(const char *path) { return access(path, F_OK) == 0; }

/* What was written into a file is on the disk, not in the memory of the system, which a loss of power takes. 1: done. */
int atrito_settle_file(const char *path) {
   int file = open(path, O_RDONLY);
   if (file < 0)
      return 0;
   int is_done = fsync(file) == 0 || errno == EINVAL || errno == EROFS; /* some file systems know of no such thing */
   return close(file) == 0 && is_done;
}

/* 1: done. */
int atrito_rename(const char *from, const char *to) { return rename(from, to) == 0; }

/* The path without links, `.` and `..`: its length, 0 where there is no such file or no room for its path. */
int atrito_true_path(const char *path, char *out, int room) {
   char *resolved = realpath(path, NULL);
   size_t n = resolved ? strlen(resolved) : 0;

   if (n > (size_t)room)
      n = 0;
   if (n > 0)
      memcpy(out, resolved, n);
   free(resolved);
   return (int)n;
}

/* ---- files that are read ----
 *
 * What is judged is the file that was opened, not its name, which may be a link or may be changed meanwhile. */

enum { NOT_THERE = -1, NOT_ALLOWED = -2, IS_FOLDER = -3, IS_PIPE = -4, IS_DEVICE = -5, OF_SYSTEM = -6, OUTSIDE = -7, NOT_OPENED = -8 };
enum { LONGEST_PATH = 4096, MOST_LINKS = 40 };

static struct { dev_t device; ino_t number; } *inputs;      /* files of the user that this run has read */
static int n_inputs;
static char *roots[2];                              /* --confine: folders, true paths, outside of which nothing is read */

/* The second folder is that of the output. */
void atrito_confine(const char *input, const char *output) {
   roots[0] = strdup(input);
   roots[1] = strdup(output);
   if (!roots[0] || !roots[1])
      abort();                                      /* better than to read without bounds */
}

static int is_below(const char *path, const char *folder) {
   size_t n = strlen(folder);
   while (n > 1 && folder[n - 1] == '/')
      n--;
   return n == 1 || (strncmp(path, folder, n) == 0 && (path[n] == '/' || path[n] == '\0'));
}

static int is_within_roots(const char *true_path) {
   return !roots[0] || is_below(true_path, roots[0]) || is_below(true_path, roots[1]);
}

/* A folder, by its true path, in which may be written. */
int atrito_may_hold(const char *folder) { return !roots[1] || is_below(folder, roots[1]); }

/* A name in /proc or /dev, also behind links: what is there is no file of a user. /dev/shm holds plain ones. */
static int names_system(const char *path) {
   char name[LONGEST_PATH], target[LONGEST_PATH], folder[LONGEST_PATH];

   if (strlen(path) >= sizeof name)
      return 0;
   strcpy(name, path);
   for (int i = 0; i < MOST_LINKS; i++) {
      char *slash = strrchr(name, '/');
      snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - name) + 1 : 1, slash ? name : ".");
      char *resolved = realpath(folder, NULL);
      if (!resolved)
         return 0;
      int is_so = (is_below(resolved, "/proc") || is_below(resolved, "/dev") || is_below(resolved, "/sys")) &&
                  !is_below(resolved, "/dev/shm");
      free(resolved);
      if (is_so)
         return 1;
      ssize_t n = readlink(name, target, sizeof target - 1);
      if (n < 0)
         return 0;
      target[n] = '\0';
      if (target[0] == '/' || !slash)
         strcpy(name, target);
      else if ((size_t)(slash - name) + 1 + (size_t)n < sizeof name)
         strcpy(slash + 1, target);
      else
         return 0;
   }
   return 0;
}

/* Of a name that cannot be opened: whether it leads out of the roots. It must not be told then whether there is such a file. */
static int leads_outside(const char *path) {
   char name[LONGEST_PATH];
   struct stat is;

   if (!roots[0])
      return 0;
   if (strlen(path) >= sizeof name)
      return 1;
   strcpy(name, path);
   for (;;) {
      char *resolved = realpath(name, NULL);
      if (resolved) {
         int is_out = !is_within_roots(resolved);
         free(resolved);
         return is_out;
      }
      if (lstat(name, &is) == 0)
         return 1;                                  /* a link to nothing, or to what may not be seen */
      char *slash = strrchr(name, '/');
      if (!slash)
         strcpy(name, strcmp(name, ".") == 0 ? "/" : ".");
      else
         slash[slash == name ? 1 : 0] = '\0';
   }
}

/* The path of an opened file, without links; 0: the system does not tell. */
static int path_of_opened(int file, const char *path, char *out, size_t room) {
#ifdef __linux__
   char name[64];
   snprintf(name, sizeof name, "/proc/self/fd/%d", file);
   ssize_t n = readlink(name, out, room - 1);
   (void)path;
   if (n <= 0)
      return 0;
   out[n] = '\0';
   return 1;
#else
   struct stat opened, is;
   char *resolved = realpath(path, NULL);
   int is_it = resolved && strlen(resolved) < room && fstat(file, &opened) == 0 && stat(resolved, &is) == 0 &&
               opened.st_ino == is.st_ino && opened.st_dev == is.st_dev;
   if (is_it)
      strcpy(out, resolved);
   free(resolved);
   return is_it;
#endif
}

/* What keeps an opened file from being read, a negative number; 0: nothing. */
static int judge_opened(int file, const char *path, const struct stat *is) {
   char opened[LONGEST_PATH];

   if (roots[0] && (!path_of_opened(file, path, opened, sizeof opened) || !is_within_roots(opened)))
      return OUTSIDE;
   if (S_ISDIR(is->st_mode))
      return IS_FOLDER;
   if (S_ISCHR(is->st_mode) && isatty(file))
      return IS_PIPE;
   if (S_ISCHR(is->st_mode) || S_ISBLK(is->st_mode))
      return IS_DEVICE;
   if (!S_ISREG(is->st_mode))
      return IS_PIPE;
   if (names_system(path))
      return OF_SYSTEM;
#ifdef __linux__
   struct statfs system;
   if (fstatfs(file, &system) == 0 && (system.f_type == 0x9fa0 || system.f_type == 0x62656572)) /* proc, sysfs: bound elsewhere */
      return OF_SYSTEM;
#endif
   return 0;
}

/* Opens a file to be read: its descriptor and its length [bytes], or why it is not, a negative number. First without reading: to
 * open a device may do something, and to open a pipe may wait. */
int atrito_open_input(const char *path, int64_t *length) {
   struct stat seen, is;
   int file;
#ifdef O_PATH
   file = open(path, O_PATH | O_CLOEXEC);
   if (file >= 0) {
      int code = fstat(file, &seen) == 0 ? judge_opened(file, path, &seen) : NOT_OPENED;
      close(file);
      if (code < 0)
         return code;
   }
#endif
   file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
   if (file < 0) {
      int code = errno == ENOENT || errno == ENOTDIR ? NOT_THERE : errno == EACCES || errno == EPERM ? NOT_ALLOWED : NOT_OPENED;
      return leads_outside(path) ? OUTSIDE : code;
   }
   int code = fstat(file, &is) == 0 ? judge_opened(file, path, &is) : NOT_OPENED;
   if (code < 0) {
      close(file);
      return code;
   }
   *length = is.st_size;
   return file;
}

/* What a file is, whatever its name: its device and its number there. */
void atrito_identify(int file, int64_t *identity) {
   struct stat is;
   int is_known = fstat(file, &is) == 0;
   identity[0] = is_known ? (int64_t)is.st_dev : -1;
   identity[1] = is_known ? (int64_t)is.st_ino : -1;
}

/* The file is one of the user's: it will not be replaced or removed until atrito_forget_inputs. 1: noted. */
int atrito_note_input(const int64_t *identity) {
   void *longer = realloc(inputs, sizeof *inputs * (size_t)(n_inputs + 1));

   if (!longer)
      return 0;
   inputs = longer;
   inputs[n_inputs].device = (dev_t)identity[0];
   inputs[n_inputs++].number = (ino_t)identity[1];
   return 1;
}

void atrito_forget_inputs(void) { n_inputs = 0; }

/* Whether a file, or what a link leads to, is one of those. */
int atrito_is_input(const char *path) {
   struct stat is;

   if (stat(path, &is) != 0)
      return 0;
   for (int i = 0; i < n_inputs; i++)
      if (inputs[i].device == is.st_dev && inputs[i].number == is.st_ino)
         return 1;
   return 0;
}

/* So many bytes at a place. 1: all of them were read. */
int atrito_read_input(int file, char *text, size_t length, int64_t place) {
   while (length > 0) {
      ssize_t n = pread(file, text, length, (off_t)place);
      if (n < 0 && errno == EINTR)
         continue;
      if (n <= 0)
         return 0;
      text += n;
      length -= (size_t)n;
      place += n;
   }
   return 1;
}

void atrito_close_input(int file) { close(file); }

/* The first or the last bytes of a plain file that is no link: how many there are; -1: it is none. */
int atrito_peek(const char *path, char *text, int room, int from_end) {
   struct stat is;
   int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
   int n = -1;

   if (file < 0)
      return -1;
   if (fstat(file, &is) == 0 && S_ISREG(is.st_mode))
      n = (int)pread(file, text, (size_t)room, from_end && is.st_size > room ? is.st_size - room : 0);
   close(file);
   return n;
}

/* The first bytes of a file that the system makes when it is read (/proc, /sys; such a file has no length): how many there are;
 * -1: it cannot be read. */
int atrito_read_system(const char *path, char *text, int room) {
   int file = open(path, O_RDONLY | O_CLOEXEC);
   int n = 0;

   if (file < 0)
      return -1;
   while (n < room) {
      ssize_t more = read(file, text + n, (size_t)(room - n));
      if (more < 0 && errno == EINTR)
         continue;
      if (more <= 0)
         break;
      n += (int)more;
   }
   close(file);
   return n;
}

/* The n-th name in a folder that ends so, from 1 on: its length; 0: there is none. */
int atrito_find_name(const char *folder, const char *ending, int n, char *name, int room) {
   DIR *list = opendir(folder);
   int length = 0;

   for (struct dirent *entry; list && n > 0 && (entry = readdir(list));) {
      size_t all = strlen(entry->d_name), end = strlen(ending);
      if (all <= end || all > (size_t)room || strcmp(entry->d_name + all - end, ending) != 0 || --n > 0)
         continue;
      memcpy(name, entry->d_name, all);
      length = (int)all;
   }
   if (list)
      closedir(list);
   return length;
}

/* ---- files that are written ---- */

int atrito_is_terminal(int file) { return isatty(file); }

/* Columns of a terminal; 0 where it does not say. */
int atrito_terminal_width(int file) {
   struct winsize size;
   return ioctl(file, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

/* A file that is not there yet: neither one that somebody has put there meanwhile nor what a link leads to is written into. */
void *atrito_create_file(const char *path) {
   int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
   FILE *stream = file < 0 ? NULL : fdopen(file, "wb");

   if (file >= 0 && !stream)
      close(file);
   return stream;
}

/* 1: all of it is written, as far as is known by now. */
int atrito_write_text(void *file, const char *text, size_t length) { return fwrite(text, 1, length, file) == length; }

int atrito_write_line(void *file, const char *text, size_t length) {
   return fwrite(text, 1, length, file) == length && putc('\n', file) != EOF;
}

/* A file without a name, on the disk of a folder, to be written and read: it is gone with the process, however that ends. NULL:
 * there is none. Programs that this one starts do not inherit it. */
void *atrito_open_nameless(const char *folder) {
   char path[4096];
   int file = -1;

#ifdef O_TMPFILE
   file = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
#endif
   if (file < 0 && snprintf(path, sizeof path, "%s/.atrito-XXXXXX", folder) < (int)sizeof path) {
      file = mkostemp(path, O_CLOEXEC);             /* network disks know no files without names */
      if (file >= 0)
         unlink(path);
   }
   if (file < 0)
      return NULL;
   FILE *stream = fdopen(file, "w+b");
   if (!stream)
      close(file);
   return stream;
}

/* The place in the file that is read or written next; -1: it is not known. */
int64_t atrito_place_in_file(void *file) { return ftello(file); }

/* Goes to a place. What was written is handed to the system. 1: done; else what could not be written is given up. */
int atrito_go_to_place(void *file, int64_t place) {
   if (fflush(file) == 0)
      return fseeko(file, place, SEEK_SET) == 0;
   __fpurge(file);
   clearerr(file);
   return 0;
}

int atrito_write_bytes(void *file, const void *bytes, size_t length) { return fwrite(bytes, 1, length, file) == length; }

int atrito_read_bytes(void *file, void *bytes, size_t length) { return fread(bytes, 1, length, file) == length; }

int atrito_close_file(void *file) { return fclose(file) == 0; }

/* Adds a line at the end of a plain file, which is made where it is missing; not of what a link leads to. The system takes it as one piece: what several processes
 * add does not mix. 1: done. */
int atrito_append_line(const char *path, const char *line) {
   size_t length = strlen(line);
   char *text = malloc(length + 1);
   int file = text ? open(path, O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666) : -1;
   int is_done = 0;
   struct stat is;

   if (file >= 0 && (fstat(file, &is) != 0 || !S_ISREG(is.st_mode))) {
      close(file);
      file = -1;
   }
   if (file >= 0) {
      memcpy(text, line, length);
      text[length] = '\n';
      is_done = write(file, text, length + 1) == (ssize_t)(length + 1);
      is_done = close(file) == 0 && is_done;
   }
   free(text);
   return is_done;
}

/* ---- locks on folders ---- */

/* The lock is one on a file that nobody may read: who may look into the folder, but not write into it, cannot hold it. Those who
 * wait have opened the same file; when it is removed they look for the next one. */
static int lock_path(const char *folder, char *path, size_t room) {
   return (size_t)snprintf(path, room, "%s/.atrito.lock", folder) < room;
}

/* A descriptor, for atrito_lock_folder; -1: no lock can be made. Programs that this one starts do not inherit it. */
int atrito_open_lock(const char *folder) {
   char path[LONGEST_PATH];
   struct stat is;
   int file = -1;

   if (lock_path(folder, path, sizeof path))
      file = open(path, O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, S_IWUSR | S_IWGRP | S_IWOTH);
   /* a file with something in it is somebody's, and is not to be removed */
   if (file >= 0 && (fstat(file, &is) != 0 || !S_ISREG(is.st_mode) || is.st_size > 0)) {
      close(file);
      file = -1;
   }
   return file;
}

void atrito_close_lock(int file) { close(file); }

/* Whether the file that was opened is the one that others find: the run that had it may have removed it. */
int atrito_is_lock_of(int file, const char *folder) {
   char path[LONGEST_PATH];
   struct stat opened, is;

   return lock_path(folder, path, sizeof path) && fstat(file, &opened) == 0 && lstat(path, &is) == 0 &&
          opened.st_ino == is.st_ino && opened.st_dev == is.st_dev;
}

/* Locks a folder, waiting for others no longer than so many seconds. 0: they have it still; 1: it is locked, or cannot be
 * because the file system has no locks. */
int atrito_lock_folder(int file, double seconds) {
   enum { TICK = 20 };                              /* ms */

   for (double waited = 0; flock(file, LOCK_EX | LOCK_NB) != 0; waited += TICK / 1000.0) {
      if (errno != EWOULDBLOCK)
         return 1;
      if (waited >= seconds)
         return 0;
      poll(NULL, 0, TICK);
   }
   return 1;
}

/* ---- what happens when the program is ended ----
 *
 * From outside (by any signal that ends a program and can be caught) or by a fault of its own (SIGSEGV and the like): files that
 * are not complete are removed, and folders that were made for them and are empty, and workers end first.
 *
 * A factorisation may take minutes, so a handler does all this at once rather than set a flag for the next phase. It calls
 * nothing but what POSIX calls async-signal-safe; what is to be removed stands ready. atrito_hold_interrupts puts off the end
 * where half of the work would be worse than all or none of it. */

static const int endings[] = {SIGHUP, SIGINT, SIGTERM, SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF,
#ifdef SIGPWR
                              SIGPWR,
#endif
#ifdef SIGSTKFLT
                              SIGSTKFLT,
#endif
#ifdef SIGPOLL
                              SIGPOLL,
#endif
};
/* The program's own, or sent from outside, which is another ending. */
static const int faults[] = {SIGILL, SIGBUS, SIGFPE, SIGSEGV, SIGABRT, SIGTRAP, SIGSYS};
enum { ENDINGS = sizeof endings / sizeof *endings, FAULTS = sizeof faults / sizeof *faults };

static char **paths;                                /* to be removed; folders stand before what is in them */
static pid_t *children;                             /* processes, and groups of processes as negative numbers */
static int n_paths, n_children;
static volatile sig_atomic_t held;                  /* depth of atrito_hold_interrupts */
static volatile sig_atomic_t waiting;               /* a signal that came meanwhile */
static pthread_t main_thread;
static int is_silent;                               /* a worker leaves the word to the process that made it */
static int is_rank;                                 /* of several */
static int is_follower;                             /* a rank other than the first, which leaves it the word */
static void (*former_handler[FAULTS])(int);
static int fault_code;                              /* exit code of a fault */
static int on_guard;                                /* between atrito_guard_exit and atrito_release_exit */
/* The stack on which a handler runs when that of the main thread has overflown. */
static _Alignas(16) char spare_stack[262144];

/* ---- the line of progress ----
 *
 * A thread writes it to standard error, twice a second, so that it goes on while nothing is said; a run that is over before the first
 * time has none. What it says is in memory that workers share: theirs is the same line. It takes the place of itself, and gives way
 * to messages until there is something new. */

static struct line {
   atomic_flag is_taken;
   int is_shown, is_away;
   char place[256], detail[256];                    /* 'step 2 of 3, 45 %'; 'outer 4  ... residual 1e-3' */
   struct timespec begin;
} *line;
static const char clear_line[] = "\r\033[K";
enum { LINE_TICK = 500 /* ms */, LINE_TRIES = 10000 };

/* Who had it may have been ended: nobody waits for ever. */
static void take_line(void) {
   for (int i = 0; atomic_flag_test_and_set(&line->is_taken) && i < LINE_TRIES; i++)
      sched_yield();
}

static void leave_line(void) { atomic_flag_clear(&line->is_taken); }

static void write_line_of_progress(void) {
   char text[sizeof line->place + sizeof line->detail + 64];
   struct timespec now;
   int width = atrito_terminal_width(STDERR_FILENO), n;

   clock_gettime(CLOCK_MONOTONIC, &now);
   long seconds = (long)(now.tv_sec - line->begin.tv_sec) - (now.tv_nsec < line->begin.tv_nsec);
   if (seconds < 60)
      n = snprintf(text, sizeof text, "%s[%2ld s] %s", clear_line, seconds, line->place);
   else
      n = snprintf(text, sizeof text, "%s[%ld:%02ld min] %s", clear_line, seconds / 60, seconds % 60, line->place);
   n += snprintf(text + n, sizeof text - (size_t)n, "%s%s", line->detail[0] ? "  " : "", line->detail);
   int room = (width > 0 ? width : 80) - 1 + (int)sizeof clear_line - 1;
   if (n > room)
      for (n = room; n > 0 && (text[n] & 0xC0) == 0x80; n--) /* no half of a letter */
         ;
   ssize_t ignored = write(STDERR_FILENO, text, (size_t)n);
   (void)ignored;
   line->is_shown = 1;
}

static void *keep_line(void *unused) {
   for (;;) {
      poll(NULL, 0, LINE_TICK);
      take_line();
      if (!line->is_away)
         write_line_of_progress();
      leave_line();
   }
   return unused;
}

/* Something else is going to be written. */
void atrito_hide_line(void) {
   if (!line)
      return;
   take_line();
   if (line->is_shown) {
      ssize_t ignored = write(STDERR_FILENO, clear_line, sizeof clear_line - 1);
      (void)ignored;
   }
   line->is_shown = 0;
   line->is_away = 1;
   leave_line();
}

/* What is done: a new place, of which nothing more is known, or a detail of it. */
void atrito_set_line(int is_place, const char *text) {
   if (!line)
      return;
   take_line();
   if (is_place)
      line->detail[0] = 0;
   snprintf(is_place ? line->place : line->detail, sizeof line->place, "%s", text);
   line->is_away = 0;
   leave_line();
}

void *atrito_share_memory(size_t bytes);

/* 1: from now on there is such a line; 0: the system has no thread for it. The thread leaves all signals to the others. */
int atrito_begin_line(void) {
   sigset_t all, before;
   pthread_t thread;
   pthread_attr_t attributes;
   int is_made = 0;

   if (line)
      return 1;
   line = atrito_share_memory(sizeof *line);
   if (!line)
      return 0;
   line->is_away = 1;
   clock_gettime(CLOCK_MONOTONIC, &line->begin);
   sigfillset(&all);
   pthread_sigmask(SIG_SETMASK, &all, &before);
   if (pthread_attr_init(&attributes) == 0) {
      pthread_attr_setstacksize(&attributes, 1 << 20); /* with room for what libraries keep for each thread */
      pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
      is_made = pthread_create(&thread, &attributes, keep_line, NULL) == 0;
      pthread_attr_destroy(&attributes);
   }
   pthread_sigmask(SIG_SETMASK, &before, NULL);
   if (!is_made)
      line = NULL;
   else
      atexit(atrito_hide_line);
   return is_made;
}

static void say(const char *text) {
   if (line && line->is_shown && !is_silent) {
      line->is_shown = 0;
      line->is_away = 1;
      say(clear_line);
   }
   ssize_t ignored = is_silent ? 0 : write(STDERR_FILENO, text, strlen(text));
   (void)ignored;
}

static void remove_unfinished(void) {
   for (int i = n_paths - 1; i >= 0; i--)
      if (unlink(paths[i]) != 0)
         rmdir(paths[i]);
}

static void await_worker(pid_t process) {
   for (int i = 0; i < 500; i++) {
      if (waitpid(process, NULL, WNOHANG) != 0)
         return;
      poll(NULL, 0, 10);
   }
   kill(process, SIGKILL);
   waitpid(process, NULL, 0);
}

/* Waits for the first process of a group, then until the others are gone, too. */
static void await_group(pid_t process) {
   waitpid(process, NULL, 0);
   for (int i = 0; i < 200 && kill(-process, 0) == 0; i++)
      poll(NULL, 0, 10);
}

/* Workers are asked to end and clean up themselves; groups, which are programs that draw, just end. */
static void end_children(void) {
   for (int i = 0; i < n_children; i++) {
      kill(children[i], children[i] < 0 ? SIGKILL : SIGTERM);
      if (children[i] > 0)
         kill(children[i], SIGCONT);
   }
   for (int i = 0; i < n_children; i++) {
      if (children[i] > 0)
         await_worker(children[i]);
      else
         await_group(-children[i]);
   }
}

/* mpirun ends all ranks by SIGTERM when one of them fails or it is told to end itself, and kills those that are left, still
 * cleaning up or not, as soon as it sees the first of them gone (Open MPI 4.1). So each waits a moment for the others [ms]. */
enum { LINGER = 500 };

static void end_by(int number) {
   held++;                                          /* a second signal changes nothing */
   end_children();
   remove_unfinished();
   if (!is_follower) {
      say("atrito: error [E-INTERRUPTED] ");
      say(number == SIGINT ? "interrupted" : number == SIGTERM ? "terminated" : number == SIGHUP ? "the terminal hung up"
          : number == SIGXCPU ? "the limit of processor time is reached" : "ended by a signal");
      say(is_rank ? ", all ranks; files that were not complete are removed\n" : "; files that were not complete are removed\n");
   }
   if (is_rank)
      poll(NULL, 0, LINGER);
   _exit(128 + number);
}

/* Threads of the parallel regions may be given the signal; `held` speaks for the main thread alone. */
static void obey(int number) {
   if (!pthread_equal(pthread_self(), main_thread))
      pthread_kill(main_thread, number);
   else if (held > 0)
      waiting = number;
   else
      end_by(number);
}

static void fail(int number, siginfo_t *info, void *context) {
   (void)context;
   if (info->si_code <= 0 && info->si_pid != getpid()) { /* kill: nothing is wrong with the program */
      obey(number);
      return;
   }
   end_children();
   remove_unfinished();
   for (int i = 0; i < FAULTS; i++) {
      void (*former)(int) = former_handler[i];
      if (faults[i] != number || !former)
         continue;
      former_handler[i] = NULL;                     /* once, should it fail itself */
      former(number);
   }
   say("atrito: error [E-INTERNAL] a fault of the program ended it; files that were not complete are removed\n");
   _exit(fault_code);
}

/* The handler of the run-time library, which tells where the fault was, is called too. One of another kind, which a sanitizer
 * sets, is left alone. */
static void guard_fault(int i) {
   struct sigaction action = {.sa_sigaction = fail, .sa_flags = SA_ONSTACK | SA_SIGINFO}, former;

   sigaction(faults[i], NULL, &former);
   if (former.sa_flags & SA_SIGINFO)
      return;
   if (former.sa_handler != SIG_DFL && former.sa_handler != SIG_IGN)
      former_handler[i] = former.sa_handler;
   sigaction(faults[i], &action, NULL);
}

/* From now on this holds. Called once, by the main thread. A signal that is ignored already (nohup, a job in the background of a
 * script) stays so. A reader of the output that goes away (`| head -1`) and a limit on the size of files (`ulimit -f`) come back
 * from writing, as a full disk does. */
void atrito_guard_interrupts(int code) {
   struct sigaction action = {.sa_handler = obey, .sa_flags = SA_RESTART}, present;
   stack_t stack = {.ss_sp = spare_stack, .ss_size = sizeof spare_stack};

   main_thread = pthread_self();
   fault_code = code;
   signal(SIGPIPE, SIG_IGN);
   signal(SIGXFSZ, SIG_IGN);
   for (int i = 0; i < ENDINGS; i++)
      if (sigaction(endings[i], NULL, &present) == 0 && present.sa_handler != SIG_IGN)
         sigaction(endings[i], &action, NULL);
#ifdef SIGRTMIN
   for (int i = SIGRTMIN; i <= SIGRTMAX; i++)
      if (sigaction(i, NULL, &present) == 0 && present.sa_handler == SIG_DFL)
         sigaction(i, &action, NULL);
#endif
   sigaltstack(&stack, NULL);                       /* of this thread alone: where another one's stack overflows, the system ends the
                                                       program (139), and what is unfinished stays, as docs/user/running.md says */
   for (int i = 0; i < FAULTS; i++)
      guard_fault(i);
   atexit(remove_unfinished);
}

/* This process is one of several ranks. When all are ended the first says so. */
void atrito_be_rank(int rank) {
   is_rank = 1;
   is_follower = rank > 0;
}

/* Puts off the end by a signal until atrito_release_interrupts. Calls may be nested. */
void atrito_hold_interrupts(void) {
   held++;
   atomic_signal_fence(memory_order_seq_cst);
}

void atrito_release_interrupts(void) {
   atomic_signal_fence(memory_order_seq_cst);
   if (--held == 0 && waiting)
      end_by(waiting);
}

/* A file, or a folder that is empty by then, that is to be removed when the program ends before atrito_forget_path. */
void atrito_note_path(const char *path) {
   atrito_hold_interrupts();
   char *copy = strdup(path);
   char **longer = realloc(paths, sizeof *paths * (size_t)(n_paths + 1));
   if (longer)
      paths = longer;
   if (longer && copy)
      paths[n_paths++] = copy;
   atrito_release_interrupts();
}

/* 1: the folder is new. is_noted: it is noted then. */
int atrito_make_folder(const char *path, int is_noted) {
   atrito_hold_interrupts();
   int is_new = mkdir(path, S_IRWXU | S_IRWXG | S_IRWXO) == 0;
   if (is_new && is_noted)
      atrito_note_path(path);
   atrito_release_interrupts();
   return is_new;
}

void atrito_forget_path(const char *path) {
   int i = n_paths - 1;

   atrito_hold_interrupts();
   while (i >= 0 && strcmp(paths[i], path) != 0)
      i--;
   if (i >= 0) {
      free(paths[i]);
      n_paths--;
      memmove(paths + i, paths + i + 1, sizeof *paths * (size_t)(n_paths - i));
   }
   atrito_release_interrupts();
}

/* A child that ends with this process; a group of processes as the negative number of its first one. Called while interrupts are
 * held. */
static void note_child(pid_t child) {
   pid_t *longer = realloc(children, sizeof *children * (size_t)(n_children + 1));
   if (!longer)
      return;
   children = longer;
   children[n_children++] = child;
}

static void forget_child(pid_t child) {
   atrito_hold_interrupts();
   for (int i = 0; i < n_children; i++)
      if (children[i] == child)
         children[i--] = children[--n_children];
   atrito_release_interrupts();
}

/* The run-time library ends the program (an array that cannot be allocated, an index out of its range) with exit codes that mean
 * something else here: 2 is an error in the deck. Until atrito_release_exit such an end has this code. */
static void change_code(void) {
   if (on_guard)
      _exit(fault_code);
}

void atrito_guard_exit(int code) {
   fault_code = code;
   on_guard = 1;
   atexit(change_code);
}

void atrito_release_exit(void) { on_guard = 0; }

static int final_code;

static void leave(int number) {
   (void)number;
   _exit(final_code);
}

/* The program is over but for the end of a library: a fault there ends it as if it had gone well. Open MPI 4.1 unloads parts of
 * itself in MPI_Finalize in which a thread of its own may still be, once in some thousand runs on a busy machine. */
void atrito_forgive_faults(int code) {
   struct sigaction action = {.sa_handler = leave, .sa_flags = SA_ONSTACK};

   final_code = code;
   for (int i = 0; i < FAULTS; i++)
      sigaction(faults[i], &action, NULL);
}

/* SIGTERM to this process, for a library that took it for something of its own. */
void atrito_terminate(void) { raise(SIGTERM); }

/* ---- processes ---- */

/* This process gets a signal when the one that made it is gone, however it went, where the system knows of such a thing. */
static void end_with(int number, pid_t maker) {
#ifdef __linux__
   prctl(PR_SET_PDEATHSIG, number);
#endif
   if (getppid() != maker)
      _exit(128 + number);
}

/* A copy of this process, which ends with it: 0 in the copy; its number, or -1 where none can be made, in this one. Files and children are those of
 * the process that made it. */
int atrito_begin_worker(void) {
   atrito_hold_interrupts();
   pid_t maker = getpid(), id = fork();
   if (id == 0) {
      end_with(SIGTERM, maker);
      n_paths = n_children = 0;
      waiting = 0;
      is_silent = 1;
      is_rank = 0;
   } else if (id > 0) {
      note_child(id);
   }
   atrito_release_interrupts();
   return id;
}

/* At once, without the end of the run-time library. */
void atrito_end_worker(void) { _exit(0); }

void atrito_await_workers(void) {
   pid_t id;
   while ((id = wait(NULL)) > 0)
      forget_child(id);
}

/* Whether a worker has ended: -1 while it runs; else its exit code, or 128 and the number of the signal that ended it. */
int atrito_worker_end(int id) {
   int state;
   pid_t ended = waitpid(id, &state, WNOHANG);

   if (ended == 0)
      return -1;
   forget_child(id);
   if (ended != id)
      return fault_code;                            /* nobody knows what became of it */
   return WIFSIGNALED(state) ? 128 + WTERMSIG(state) : WEXITSTATUS(state);
}

int atrito_process_number(void) { return getpid(); }

int atrito_maker_number(void) { return getppid(); }

void atrito_pause(double seconds) {
   struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
   nanosleep(&time, NULL);
}

/* An integer that workers share: what was written before it is seen by whoever has read it. */
int atrito_get_shared(const int *number) { return atomic_load_explicit((const _Atomic int *)number, memory_order_acquire); }

/* Sets it and says what it was: of two that take it at once one alone gets it. */
int atrito_swap_shared(int *number, int value) { return atomic_exchange((_Atomic int *)number, value); }

void atrito_set_shared(int *number, int value) { atomic_store_explicit((_Atomic int *)number, value, memory_order_release); }

/* Ends a whole group of processes, this one, its first, among them. */
static void end_group(int number) {
   (void)number;
   kill(0, SIGKILL);
}

/* The first process of a group of its own: a signal from the terminal comes to the maker alone, which ends the group; and when the
 * maker is gone, this one ends it, whatever the programs in it have started. */
static void guard_command(const char *command, pid_t maker) {
   enum { NO_PROGRAM = 127 };                       /* the shell's code for a program that is not there */
   struct sigaction ends = {.sa_handler = end_group}, plain = {.sa_handler = SIG_DFL};
   int state;

   setpgid(0, 0);
   for (int i = 0; i < ENDINGS; i++)
      sigaction(endings[i], &ends, NULL);
   for (int i = 0; i < FAULTS; i++)
      sigaction(faults[i], &plain, NULL);
   end_with(SIGTERM, maker);
   pid_t id = fork();
   if (id == 0) {
      execl("/bin/sh", "sh", "-c", command, (char *)NULL);
      _exit(NO_PROGRAM);
   }
   if (id < 0 || waitpid(id, &state, 0) != id)
      _exit(NO_PROGRAM);
   _exit(WIFSIGNALED(state) ? 128 + WTERMSIG(state) : WEXITSTATUS(state));
}

/* Has the shell run a command and waits for its end: the exit code, 128 and the number of the signal that ended it, 127 where
 * there is no shell, or 124 where it has not ended after so many seconds and was ended. */
int atrito_run_command(const char *command, double seconds) {
   enum { NO_PROGRAM = 127, TOO_LATE = 124, TICK = 10 /* ms */ };
   int state, code = NO_PROGRAM;
   pid_t ended;

   atrito_hold_interrupts();
   pid_t maker = getpid(), id = fork();
   if (id == 0)
      guard_command(command, maker);
   if (id > 0) {
      setpgid(id, id);                              /* here, too: nobody knows who comes first */
      note_child(-id);
   }
   atrito_release_interrupts();
   if (id < 0)
      return code;
   for (double waited = 0; (ended = waitpid(id, &state, WNOHANG)) == 0 && waited < seconds; waited += TICK / 1000.0)
      poll(NULL, 0, TICK);
   if (ended == id)
      code = WIFSIGNALED(state) ? 128 + WTERMSIG(state) : WEXITSTATUS(state);
   if (ended == 0) {
      code = TOO_LATE;
      kill(-id, SIGKILL);
      await_group(id);
   }
   forget_child(-id);
   return code;
}

/* Memory of zeros that all workers to come see and change; NULL: the system has none. */
void *atrito_share_memory(size_t bytes) {
   void *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
   return memory == MAP_FAILED ? NULL : memory;
}

/* ---- libraries ---- */

/* A routine by its symbol; NULL where the library cannot be loaded or has none of that name. The library stays loaded. If it brings a
 * BLAS of its own (CMake's ATRITO_OWN_BLAS), that starts no threads. */
void *atrito_find_routine(const char *file, const char *symbol) {
   void *library;

   setenv("OPENBLAS_NUM_THREADS", "1", 0);
   library = dlopen(file, RTLD_LAZY);
   return library ? dlsym(library, symbol) : NULL;
}

/* ---- time and memory ---- */

/* Processor time of this process and of its children that have ended [s]. */
double atrito_processor_seconds(void) {
   static const int whose[] = {RUSAGE_CHILDREN, RUSAGE_SELF};
   double seconds = 0;
   struct rusage use;

   for (int i = 0; i < 2; i++)
      if (getrusage(whose[i], &use) == 0)
         seconds += (double)(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
                    1e-6 * (double)(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
   return seconds;
}

/* Largest resident memory of the process so far [bytes]; 0 where the system does not tell. Linux counts KiB. */
int64_t atrito_peak_memory(void) {
   struct rusage use;
   return getrusage(RUSAGE_SELF, &use) == 0 ? (int64_t)use.ru_maxrss * 1024 : 0;
}

/* Whether so many bytes of address space can be had now, in one piece. */
int atrito_has_address_space(int64_t bytes) {
   void *space = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
   if (space == MAP_FAILED)
      return 0;
   munmap(space, bytes);
   return 1;
}

/* The stack of a thread that OMP_STACKSIZE asks for, '64M' (KiB without a unit); 0: it asks for none. */
static int64_t stack_asked_for(void) {
   static const char units[] = "BKMG";
   const char *text = getenv("OMP_STACKSIZE");
   char *rest;

   if (!text)
      return 0;
   errno = 0;
   long long size = strtoll(text, &rest, 10);
   while (*rest == ' ')
      rest++;
   const char *unit = *rest ? strchr(units, toupper((unsigned char)*rest)) : units + 1;
   if (errno || size <= 0 || !unit)
      return 0;
   for (; unit > units; unit--)
      size = size > INT64_MAX / 1024 ? INT64_MAX : size * 1024;
   return size;
}

/* What a thread takes of the address space for its stack. */
int64_t atrito_stack_of_thread(void) {
   pthread_attr_t attributes;
   size_t size = 0;
   int64_t asked = stack_asked_for();
   if (asked > 0)
      return asked;
   if (pthread_attr_init(&attributes) != 0)
      return 0;
   pthread_attr_getstacksize(&attributes, &size);
   pthread_attr_destroy(&attributes);
   return (int64_t)size;
}

static void *wait_for_all(void *gate) {
   pthread_mutex_lock(gate);
   pthread_mutex_unlock(gate);
   return NULL;
}

/* How many threads there can be at a time beside this one, up to so many: they are made, and end at once. */
int atrito_count_threads(int most) {
   pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
   pthread_t *threads = calloc(most, sizeof *threads);
   pthread_attr_t attributes;
   int n = 0;

   if (pthread_attr_init(&attributes) != 0)
      return 0;
   pthread_attr_setstacksize(&attributes, (size_t)atrito_stack_of_thread());
   pthread_mutex_lock(&gate);
   while (threads && n < most && pthread_create(&threads[n], &attributes, wait_for_all, &gate) == 0)
      n++;
   pthread_mutex_unlock(&gate);
   for (int i = 0; i < n; i++)
      pthread_join(threads[i], NULL);
   pthread_attr_destroy(&attributes);
   free(threads);
   return n;
}

/* The stack that the program may have, in bytes; -1: there is no limit. */
int64_t atrito_stack_limit(void) {
   struct rlimit limit;
   return getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? (int64_t)limit.rlim_cur : -1;
}

/* What `ulimit -v` allows [bytes]; -1: no limit. */
int64_t atrito_address_space_limit(void) {
   struct rlimit limit;
   return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? (int64_t)limit.rlim_cur : -1;
}

/* Keeps the memory that the program gives back to the C library for what it asks for next.
 *
 * Left to itself the GNU library takes every large array from the system and gives it back there: the system clears each page
 * anew when it is touched, which took a fifth of the processor time of a large run. In one growing heap a page is cleared once:
 * the page faults of a run are its peak memory, and that is no larger (docs/developer/multifrontal.md). To be called before the first
 * large array is allocated. */
enum { HEAP_GROWS_BY = 1048576 };

void atrito_keep_freed_memory(void) {
#ifdef __GLIBC__
   mallopt(M_MMAP_MAX, 0);
   mallopt(M_TRIM_THRESHOLD, -1);
   mallopt(M_TOP_PAD, HEAP_GROWS_BY);
#endif
}

/* Memory that the process holds and that will serve again [bytes], without what may not have been touched yet; 0 where the
 * library does not tell. */
int64_t atrito_reusable_memory(void) {
   int64_t bytes = 0;
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
   bytes = (int64_t)mallinfo2().fordblks - HEAP_GROWS_BY;
#endif
#endif
   return bytes > 0 ? bytes : 0;
}

/* ---- floating-point exceptions ---- */

/* Saves the environment (in 256 bytes), clears the exception flags and stops the halting on any exception. */
void atrito_suspend_halting(void *environment) {
   _Static_assert(sizeof(fenv_t) <= 256, "halting_t of atrito_halting.f90 is too small");
   feholdexcept(environment);
}

void atrito_restore_halting(const void *environment) { fesetenv(environment); }
