#pragma once
// Memory set aside for the moment when there is no more.
namespace drumlin::apps {

/// From now on the first allocation with new that fails gets the reserve, a megabyte, and is tried again:
/// small ones succeed, so that what a program does until it can end in good order has the memory it needs.
/// Libraries do not always stand a failure in the middle of their work (nlohmann's JSON 3.11.2 ends a process
/// that cannot turn a null into an object). Once it is gone allocations fail as ever.
void keep_memory_in_reserve();

/// Throws std::bad_alloc if the reserve was needed: called between the steps of long work.
void end_if_memory_was_short();

}  // namespace drumlin::apps
