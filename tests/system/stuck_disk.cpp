// Simulates a disk that does not respond. The library is preloaded into the program (LD_PRELOAD):
//
//   STUCK_FOLDER=/tmp/runs STUCK_WHILE=/tmp/stuck LD_PRELOAD=.../libstuck_disk.so softgrip-web ...
//
// While the file STUCK_WHILE exists, a call that reads or writes a folder or a regular file below
// STUCK_FOLDER waits. The first call that waits creates the file STUCK_WHILE.waits. A test then knows that
// the program waits for the disk.

#undef _FORTIFY_SOURCE  // its wrapper would define read() a second time

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

template <class Function>
Function real(const char* name) noexcept {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_of_the_disk(int descriptor) {
  const char* const folder = std::getenv("STUCK_FOLDER");
  std::array<char, 4096> target{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = ::readlink(link.c_str(), target.data(), target.size());
  return folder != nullptr && size > 0 &&
         std::string_view(target.data(), static_cast<std::size_t>(size)).starts_with(folder);
}

void wait_for_the_disk(int descriptor) {
  const char* const while_there = std::getenv("STUCK_WHILE");
  if (while_there == nullptr || ::access(while_there, F_OK) != 0 || !is_of_the_disk(descriptor)) return;
  const std::string waits = std::string(while_there) + ".waits";
  const int told = ::open(waits.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (told >= 0) ::close(told);
  constexpr useconds_t pause_us = 5000;
  while (::access(while_there, F_OK) == 0) ::usleep(pause_us);
}

}  // namespace

extern "C" {

dirent* readdir(DIR* folder) {
  static const auto call = real<dirent* (*)(DIR*)>("readdir");
  wait_for_the_disk(::dirfd(folder));
  return call(folder);
}

ssize_t read(int descriptor, void* bytes, size_t size) {
  static const auto call = real<ssize_t (*)(int, void*, size_t)>("read");
  wait_for_the_disk(descriptor);
  return call(descriptor, bytes, size);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t)>("write");
  wait_for_the_disk(descriptor);
  return call(descriptor, bytes, size);
}

ssize_t pread(int descriptor, void* bytes, size_t size, off_t offset) {
  static const auto call = real<ssize_t (*)(int, void*, size_t, off_t)>("pread");
  wait_for_the_disk(descriptor);
  return call(descriptor, bytes, size, offset);
}
}
