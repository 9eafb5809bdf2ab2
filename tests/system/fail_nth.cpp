// Makes the Nth call of one function fail. The library is preloaded into the program (LD_PRELOAD):
//
//   FAIL_CALL=open FAIL_NTH=3 FAIL_TOLD=/tmp/failed LD_PRELOAD=.../libfail_nth.so softgripd ...
//
// FAIL_CALL is a name in the table of functions in this file. Calls of functions with the same purpose, such
// as open, openat and fopen, are counted together. With FAIL_FROM=1 every call from the Nth on fails, as on a
// full disk. When a call fails, the file FAIL_TOLD is created. A test increments N until this file is no
// longer created, as the tests of SQLite do.
//
// With FAIL_CREATED=FILE the path of every file that a call may create is appended to FILE, one path per
// line.
//
// With FAIL_HANG=NAME a call that opens a file whose path ends in NAME never returns, as on a mount without
// its server. FAIL_TOLD is created in this case, too.

#undef _FORTIFY_SOURCE  // its wrappers would define functions such as recv() a second time

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>

namespace {

/// The settings, which are read once from the environment.
struct Order {
  const char* call = std::getenv("FAIL_CALL");
  const char* told = std::getenv("FAIL_TOLD");
  long nth = std::getenv("FAIL_NTH") != nullptr ? std::atol(std::getenv("FAIL_NTH")) : 0;
  bool from = std::getenv("FAIL_FROM") != nullptr;
  const char* hang = std::getenv("FAIL_HANG");
  const char* created = std::getenv("FAIL_CREATED");
};

const Order& order() noexcept {
  static const Order asked;
  return asked;
}

std::atomic<long> calls{0};
std::atomic<bool> in_main{false};

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

int noted_main(int count, char** arguments, char** environment) {
  in_main = true;
  const int code = program_main(count, arguments, environment);
  in_main = false;
  return code;
}

template <class Function>
Function real(const char* name) noexcept {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Creates the file FAIL_TOLD. Calls that this function itself makes are not counted.
void tell() noexcept {
  if (order().told == nullptr) return;
  using Open = int (*)(const char*, int, ...);
  static const auto open_file = real<Open>("open");
  const int descriptor = open_file(order().told, O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor >= 0) ::close(descriptor);
}

/// Counts a call of a function of the group `call`. If this call must fail, sets errno to `error` and returns
/// true.
bool fails(const char* call, int error) noexcept {
  if (order().call == nullptr || std::strcmp(order().call, call) != 0) return false;
  const long number = ++calls;
  if (number != order().nth && !(order().from && number > order().nth)) return false;
  tell();
  errno = error;
  return true;
}

/// If this call may create a file, appends the path of the file to the file FAIL_CREATED. Calls that this
/// function itself makes are not counted.
void note_created(const char* path, bool creates) noexcept {
  if (!creates || order().created == nullptr) return;
  using Open = int (*)(const char*, int, ...);
  static const auto open_file = real<Open>("open");
  using Write = ssize_t (*)(int, const void*, size_t);
  static const auto write_file = real<Write>("write");
  const int list = open_file(order().created, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (list < 0) return;
  const ssize_t noted = write_file(list, path, std::strlen(path)) + write_file(list, "\n", 1);
  ::close(list);
  if (noted <= 0) std::abort();
}

/// Never returns if the path ends in the name that FAIL_HANG specifies.
void hang_at(const char* path) noexcept {
  if (order().hang == nullptr) return;
  const std::size_t end = std::strlen(order().hang);
  const std::size_t size = std::strlen(path);
  if (size < end || std::strcmp(path + size - end, order().hang) != 0) return;
  tell();
  while (true) ::pause();
}

}  // namespace

// Counts the allocations of C++ code in all threads from main() on. Before main(), a program cannot report an
// error and has commanded no output, so these allocations are not counted. Allocations with a special
// alignment are not counted either.
void* operator new(std::size_t size) {
  void* const memory = in_main && fails("allocation", ENOMEM) ? nullptr : std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

extern "C" {

// NOLINTBEGIN(readability-identifier-naming,bugprone-reserved-identifier): these names are given by the C
// library
int __libc_start_main(Main program, int count, char** arguments, void (*begin)(), void (*end)(),
                      void (*unload)(), void* stack) {
  program_main = program;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  return real<Start>("__libc_start_main")(noted_main, count, arguments, begin, end, unload, stack);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  hang_at(path);
  note_created(path, (flags & O_CREAT) != 0);
  if (fails("open", EMFILE)) return -1;
  static const auto next = real<int (*)(const char*, int, ...)>("open");
  return next(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  hang_at(path);
  note_created(path, (flags & O_CREAT) != 0);
  if (fails("open", EMFILE)) return -1;
  static const auto next = real<int (*)(const char*, int, ...)>("open64");
  return next(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  hang_at(path);
  note_created(path, (flags & O_CREAT) != 0);
  if (fails("open", EMFILE)) return -1;
  static const auto next = real<int (*)(int, const char*, int, ...)>("openat");
  return next(folder, path, flags, mode);
}

// If the flags are not constant, a program with hardening options calls these functions instead of open() and
// openat().
int __open_2(const char* path, int flags) {
  hang_at(path);
  if (fails("open", EMFILE)) return -1;
  static const auto next = real<int (*)(const char*, int)>("__open_2");
  return next(path, flags);
}

int __openat_2(int folder, const char* path, int flags) {
  hang_at(path);
  if (fails("open", EMFILE)) return -1;
  static const auto next = real<int (*)(int, const char*, int)>("__openat_2");
  return next(folder, path, flags);
}

FILE* fopen(const char* path, const char* mode) {
  hang_at(path);
  note_created(path, std::strpbrk(mode, "wa") != nullptr);
  if (fails("open", EMFILE)) return nullptr;
  static const auto next = real<FILE* (*)(const char*, const char*)>("fopen");
  return next(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  hang_at(path);
  note_created(path, std::strpbrk(mode, "wa") != nullptr);
  if (fails("open", EMFILE)) return nullptr;
  static const auto next = real<FILE* (*)(const char*, const char*)>("fopen64");
  return next(path, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  if (fails("write", ENOSPC)) return -1;
  static const auto next = real<ssize_t (*)(int, const void*, size_t)>("write");
  // When a disk becomes full, one call writes a part of the data and the next call fails. This call therefore
  // writes one half of the data.
  if (size > 1 && fails("short_write", ENOSPC)) return next(descriptor, data, size / 2);
  return next(descriptor, data, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  if (fails("write", ENOSPC)) return -1;
  static const auto next = real<ssize_t (*)(int, const iovec*, int)>("writev");
  // Makes a short write: writes half of the first part that is not empty, and nothing else.
  int first = 0;
  while (first < count && parts[first].iov_len == 0) ++first;
  if (first < count && parts[first].iov_len > 1 && fails("short_write", ENOSPC)) {
    const iovec half{parts[first].iov_base, parts[first].iov_len / 2};
    return next(descriptor, &half, 1);
  }
  return next(descriptor, parts, count);
}

size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  if (fails("write", ENOSPC)) return 0;
  static const auto next = real<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite");
  return next(data, size, count, file);
}

int fsync(int descriptor) {
  if (fails("fsync", EIO)) return -1;
  static const auto next = real<int (*)(int)>("fsync");
  return next(descriptor);
}

int fdatasync(int descriptor) {
  if (fails("fsync", EIO)) return -1;
  static const auto next = real<int (*)(int)>("fdatasync");
  return next(descriptor);
}

int rename(const char* from, const char* to) {
  if (fails("rename", EACCES)) return -1;
  static const auto next = real<int (*)(const char*, const char*)>("rename");
  return next(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  if (fails("rename", EACCES)) return -1;
  static const auto next = real<int (*)(int, const char*, int, const char*)>("renameat");
  return next(from_folder, from, to_folder, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (fails("rename", EACCES)) return -1;
  using Rename = int (*)(int, const char*, int, const char*, unsigned);
  static const auto next = real<Rename>("renameat2");
  return next(from_folder, from, to_folder, to, flags);
}

int mkdir(const char* path, mode_t mode) {
  if (fails("mkdir", EROFS)) return -1;
  static const auto next = real<int (*)(const char*, mode_t)>("mkdir");
  return next(path, mode);
}

int socket(int domain, int type, int protocol) noexcept {
  if (fails("socket", EMFILE)) return -1;
  static const auto next = real<int (*)(int, int, int)>("socket");
  return next(domain, type, protocol);
}

int connect(int descriptor, const sockaddr* address, socklen_t size) {
  if (fails("connect", ECONNREFUSED)) return -1;
  static const auto next = real<int (*)(int, const sockaddr*, socklen_t)>("connect");
  return next(descriptor, address, size);
}

int bind(int descriptor, const sockaddr* address, socklen_t size) noexcept {
  if (fails("bind", EADDRINUSE)) return -1;
  static const auto next = real<int (*)(int, const sockaddr*, socklen_t)>("bind");
  return next(descriptor, address, size);
}

int listen(int descriptor, int backlog) noexcept {
  if (fails("listen", EADDRINUSE)) return -1;
  static const auto next = real<int (*)(int, int)>("listen");
  return next(descriptor, backlog);
}

ssize_t send(int descriptor, const void* data, size_t size, int flags) {
  if (fails("send", EPIPE)) return -1;
  static const auto next = real<ssize_t (*)(int, const void*, size_t, int)>("send");
  return next(descriptor, data, size, flags);
}

ssize_t recv(int descriptor, void* data, size_t size, int flags) {
  if (fails("recv", ECONNRESET)) return -1;
  static const auto next = real<ssize_t (*)(int, void*, size_t, int)>("recv");
  return next(descriptor, data, size, flags);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) noexcept {
  if (fails("thread", EAGAIN)) return EAGAIN;
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto next = real<Create>("pthread_create");
  return next(thread, attributes, body, argument);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (fails("clock", EINVAL)) return -1;
  static const auto next = real<int (*)(clockid_t, timespec*)>("clock_gettime");
  return next(clock, time);
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left) {
  if (fails("sleep", EINTR)) return EINTR;
  static const auto next = real<int (*)(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  return next(clock, flags, until, left);
}

void* mmap(void* address, size_t size, int protection, int flags, int descriptor, off_t offset) noexcept {
  if (fails("mmap", ENOMEM)) return MAP_FAILED;
  static const auto next = real<void* (*)(void*, size_t, int, int, int, off_t)>("mmap");
  return next(address, size, protection, flags, descriptor, offset);
}

int mlockall(int flags) noexcept {
  if (fails("mlockall", ENOMEM)) return -1;
  static const auto next = real<int (*)(int)>("mlockall");
  return next(flags);
}

int sched_setscheduler(pid_t process, int policy, const sched_param* parameters) noexcept {
  if (fails("scheduler", EPERM)) return -1;
  static const auto next = real<int (*)(pid_t, int, const sched_param*)>("sched_setscheduler");
  return next(process, policy, parameters);
}

int pthread_setschedparam(pthread_t thread, int policy, const sched_param* parameters) noexcept {
  if (fails("scheduler", EPERM)) return EPERM;
  static const auto next = real<int (*)(pthread_t, int, const sched_param*)>("pthread_setschedparam");
  return next(thread, policy, parameters);
}
// NOLINTEND(readability-identifier-naming,bugprone-reserved-identifier)

}  // extern "C"
