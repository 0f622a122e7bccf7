#pragma once
// What the system must give before a program or a library begins, which would crash or give up in words of
// its own without it. Both throw IoError with what there is and what is needed.

namespace drumlin {

/// The stack of a thread, 256 KiB.
void require_stack();
/// So many files open at once.
void require_open_files(int count);

}  // namespace drumlin
