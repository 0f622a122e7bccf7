#include "apps/process/standard_streams.hpp"

#include <fcntl.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {
namespace {
int lost = 0;  // errno of the first write that failed; like the stream it belongs to the process

int error_number() { return errno != 0 ? errno : EIO; }
}  // namespace

void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free descriptor is this one. Standard output is opened for reading: writing to it fails.
    const int mode = descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", mode) != descriptor) ::_exit(static_cast<int>(ExitCode::input_output));
  }
}

void print_out(std::string_view text) {
  if (lost != 0) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) lost = error_number();
}

void flush_out() {
  if (lost != 0) return;
  errno = 0;
  if (std::fflush(stdout) == 0) return;
  lost = error_number();
  ::__fpurge(stdout);  // else whoever flushes next fails again
}

int lost_output() {
  flush_out();
  return lost;
}

void print_error(std::string_view text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

void print_over_line(std::string_view text) noexcept {
  (void)std::fputc('\r', stderr);
  print_error(text);
}

}  // namespace drumlin::apps
