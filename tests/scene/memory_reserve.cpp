// The memory that a program sets aside for the moment when there is no more.
#include "apps/process/memory_reserve.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

namespace drumlin::apps {
namespace {

TEST(MemoryReserve, ServesOneFailureAndEndsLongWork) {
  const auto in_a_process_of_its_own = [] {  // the handler belongs to the process
    keep_memory_in_reserve();
    end_if_memory_was_short();
    std::get_new_handler()();  // gives the reserve: the allocation is tried again
    EXPECT_THROW(end_if_memory_was_short(), std::bad_alloc);
    EXPECT_THROW(std::get_new_handler()(), std::bad_alloc);
    std::_Exit(::testing::Test::HasFailure());
  };
  EXPECT_EXIT(in_a_process_of_its_own(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace drumlin::apps
