// A library for LD_PRELOAD that makes one call of a program to the system fail, so that a test can try each
// in turn.
//
// Environment, read when main() begins; calls before and after main() are neither counted nor touched:
//   FAILING_CALL=KIND       open, write, fsync, rename, close, malloc, or malloc-in-hdf5 (of that library;
//   malloc is of all others)
//   FAILING_FROM=n          the n-th call of that kind fails, counted from 1
//   FAILING_COUNT=m         and the m - 1 after it (1 if absent)
//   FAILING_HDF5=FROM:TO    where the program holds HDF5, as its file counts addresses; a library of its own
//   otherwise
//   FAILING_COUNTS_TO=FILE  receives lines "KIND calls" when main() returns
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

extern "C" {
// The allocation functions of the C library under its own names: looking them up could itself allocate.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

enum class Call : std::size_t { open, write, fsync, rename, close, malloc, malloc_in_hdf5, none };
constexpr std::size_t kinds = static_cast<std::size_t>(Call::none);
constexpr std::array<const char*, kinds> names{"open",  "write",  "fsync",         "rename",
                                               "close", "malloc", "malloc-in-hdf5"};
constexpr std::array<int, kinds> errors{EMFILE, ENOSPC, EIO, EIO, EIO, ENOMEM, ENOMEM};

std::array<std::atomic<long>, kinds> calls;
std::atomic<bool> in_main = false;
Call failing = Call::none;
long first = 0, last = 0;

std::uintptr_t hdf5_begin = 0, hdf5_end = 0;  // its addresses

/// The first entry is the program.
int note_hdf5(dl_phdr_info* library, std::size_t, void*) {
  if (const char* const own = std::getenv("FAILING_HDF5")) {
    char* colon = nullptr;
    hdf5_begin = library->dlpi_addr + std::strtoull(own, &colon, 16);
    hdf5_end = library->dlpi_addr + std::strtoull(colon + 1, nullptr, 16);
    return 1;
  }
  if (std::strstr(library->dlpi_name, "libhdf5") == nullptr ||
      std::strstr(library->dlpi_name, "_hl") != nullptr)
    return 0;
  hdf5_begin = library->dlpi_addr;
  for (int part = 0; part < library->dlpi_phnum; ++part)
    hdf5_end = std::max<std::uintptr_t>(
        hdf5_end, hdf5_begin + library->dlpi_phdr[part].p_vaddr + library->dlpi_phdr[part].p_memsz);
  return 1;
}

/// The kind of an allocation that returns to this address.
Call allocation_of(const void* caller) {
  const auto address = reinterpret_cast<std::uintptr_t>(caller);
  return address >= hdf5_begin && address < hdf5_end ? Call::malloc_in_hdf5 : Call::malloc;
}

/// Counts the call; true, with errno set, if it is one that fails.
bool fails(Call call) {
  if (!in_main) return false;
  const auto kind = static_cast<std::size_t>(call);
  const long number = ++calls[kind];
  if (call != failing || number < first || number > last) return false;
  errno = errors[kind];
  return true;
}

/// The function of that name that the program would have called.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

long number_of(const char* variable, long otherwise) {
  const char* const text = std::getenv(variable);
  return text != nullptr ? std::strtol(text, nullptr, 10) : otherwise;
}

void read_environment() {
  const char* const name = std::getenv("FAILING_CALL");
  for (std::size_t kind = 0; name != nullptr && kind < kinds; ++kind)
    if (std::strcmp(name, names[kind]) == 0) failing = static_cast<Call>(kind);
  first = number_of("FAILING_FROM", std::numeric_limits<long>::max());
  last = first + number_of("FAILING_COUNT", 1) - 1;
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
  ::dl_iterate_phdr(note_hdf5, nullptr);
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

void* malloc(size_t size) noexcept {
  return fails(allocation_of(__builtin_return_address(0))) ? nullptr : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
  return fails(allocation_of(__builtin_return_address(0))) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) noexcept {
  return fails(allocation_of(__builtin_return_address(0))) ? nullptr : __libc_realloc(memory, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return fails(allocation_of(__builtin_return_address(0))) ? nullptr : __libc_memalign(alignment, size);
}
/// The C library allocates here for whom it copies.
char* strdup(const char* text) noexcept {
  const std::size_t size = std::strlen(text) + 1;
  void* const copy = fails(allocation_of(__builtin_return_address(0))) ? nullptr : __libc_malloc(size);
  return copy == nullptr ? nullptr : static_cast<char*>(std::memcpy(copy, text, size));
}
int posix_memalign(void** memory, size_t alignment, size_t size) noexcept {
  if (fails(allocation_of(__builtin_return_address(0)))) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}
