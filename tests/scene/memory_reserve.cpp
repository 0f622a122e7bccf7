// The memory that a program sets aside for the moment when there is no more.
#include "apps/process/memory_reserve.hpp"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "coupling/common/machine/child_process.hpp"

namespace drumlin::apps {
namespace {

TEST(MemoryReserve, ServesOneFailureAndEndsLongWork) {
  const auto end = run_in_copy([] {  // the handler belongs to the process
    keep_memory_in_reserve();
    end_if_memory_was_short();
    const auto expect_end = [](auto work) {
      try {
        work();
      } catch (const std::bad_alloc&) {
        return;
      }
      throw std::runtime_error("no bad_alloc");
    };
    std::get_new_handler()();  // gives the reserve: the allocation is tried again
    expect_end(end_if_memory_was_short);
    expect_end(std::get_new_handler());
  });
  EXPECT_TRUE(end.succeeded());
}

}  // namespace
}  // namespace drumlin::apps
