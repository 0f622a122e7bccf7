#include "apps/support/interruption.hpp"

#include <csignal>

namespace drumlin::apps {
namespace {
volatile std::sig_atomic_t caught = 0;
extern "C" void catch_signal(int signal) { caught = signal; }
}  // namespace

void catch_interruptions() {
  std::signal(SIGINT, catch_signal);
  std::signal(SIGTERM, catch_signal);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its write, with its name
}

int interruption() { return caught; }

}  // namespace drumlin::apps
