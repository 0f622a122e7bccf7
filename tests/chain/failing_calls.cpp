// A library for LD_PRELOAD that makes one call of a program to the system fail, so that a test can try each
// in turn.
//
// Environment, read when main() begins; calls before and after main() are neither counted nor touched:
//   FAILING_CALL=KIND       open, write, fsync, rename or close
//   FAILING_NUMBER=n        the n-th call of that kind fails, counted from 1
//   FAILING_COUNTS_TO=FILE  receives lines "KIND calls" when main() returns
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Call : std::size_t { open, write, fsync, rename, close, none };
constexpr std::size_t kinds = static_cast<std::size_t>(Call::none);
constexpr std::array<const char*, kinds> names{"open", "write", "fsync", "rename", "close"};
constexpr std::array<int, kinds> errors{EMFILE, ENOSPC, EIO, EIO, EIO};

std::array<std::atomic<long>, kinds> calls;
std::atomic<bool> in_main = false;
Call failing = Call::none;
long failing_number = 0;

/// Counts the call; true, with errno set, if it is one that fails.
bool fails(Call call) {
  if (!in_main) return false;
  const auto kind = static_cast<std::size_t>(call);
  const long number = ++calls[kind];
  if (call != failing || number != failing_number) return false;
  errno = errors[kind];
  return true;
}

/// The function of that name that the program would have called.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void read_environment() {
  const char* const name = std::getenv("FAILING_CALL");
  for (std::size_t kind = 0; name != nullptr && kind < kinds; ++kind)
    if (std::strcmp(name, names[kind]) == 0) failing = static_cast<Call>(kind);
  if (const char* const number = std::getenv("FAILING_NUMBER"))
    failing_number = std::strtol(number, nullptr, 10);
}

void write_counts() {
  const char* const file = std::getenv("FAILING_COUNTS_TO");
  std::FILE* const out = file != nullptr ? std::fopen(file, "w") : nullptr;
  if (out == nullptr) return;
  for (std::size_t kind = 0; kind < kinds; ++kind)
    std::fprintf(out, "%s %ld\n", names[kind], calls[kind].load());
  std::fclose(out);
}

using Main = int(int, char**, char**);
Main* main_of_program = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  read_environment();
  in_main = true;
  const int code = main_of_program(argc, argv, environment);
  in_main = false;
  write_counts();
  return code;
}

}  // namespace

extern "C" {

int __libc_start_main(Main* program, int argc, char** argv, Main* init, void (*fini)(), void (*end)(),
                      void* stack) {
  main_of_program = program;
  using Start = int(Main*, int, char**, Main*, void (*)(), void (*)(), void*);
  return real<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, end, stack);
}

// The mode that a call without it does not hand over is not looked at. Names with 64 are the same calls.
int open_here(const char* path, int flags, mode_t mode) asm("open");
int open_here(const char* path, int flags, mode_t mode) {
  return fails(Call::open) ? -1 : real<int(const char*, int, ...)>("open")(path, flags, mode);
}
int open64_here(const char* path, int flags, mode_t mode) asm("open64") __attribute__((alias("open")));
int open_at(int folder, const char* path, int flags, mode_t mode) asm("openat");
int open_at(int folder, const char* path, int flags, mode_t mode) {
  return fails(Call::open) ? -1 : real<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
}
int open64_at(int folder, const char* path, int flags, mode_t mode) asm("openat64")
    __attribute__((alias("openat")));

ssize_t write(int file, const void* bytes, size_t count) {
  return fails(Call::write) ? -1 : real<ssize_t(int, const void*, size_t)>("write")(file, bytes, count);
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  return fails(Call::write)
             ? -1
             : real<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes, count, offset);
}
ssize_t pwrite64(int, const void*, size_t, off64_t) __attribute__((alias("pwrite")));

int fsync(int file) { return fails(Call::fsync) ? -1 : real<int(int)>("fsync")(file); }
int fdatasync(int) __attribute__((alias("fsync")));

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  using Rename = int(int, const char*, int, const char*, unsigned);
  return fails(Call::rename) ? -1 : real<Rename>("renameat2")(from_folder, from, to_folder, to, flags);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  return renameat2(from_folder, from, to_folder, to, 0);
}
int rename(const char* from, const char* to) noexcept { return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0); }

/// A close that fails has closed all the same, as on Linux.
int close(int file) {
  const bool is_failing = fails(Call::close);
  const int error = errno;
  const int result = real<int(int)>("close")(file);
  if (!is_failing) return result;
  errno = error;
  return -1;
}
}
