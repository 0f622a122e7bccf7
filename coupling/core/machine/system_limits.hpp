#pragma once
// What the system must give before a program or a library begins, which would crash, hang or give up in words
// of its own without it. All throw IoError with what there is and what is needed.

namespace drumlin {

/// The stack of a thread, 256 KiB.
void require_stack();
/// So many files open at once.
void require_open_files(int count);
/// So much memory more, in MiB; it is asked for and given back.
void require_memory(int mebibytes);
/// What BLAS works in, 128 MiB, and so much memory more. OpenBLAS takes it with its first product and, where
/// it gets none, asks for ever: it has it when this returns.
void start_blas(int mebibytes_more);

}  // namespace drumlin
