#pragma once
// What HDF5 is asked about a dataset before anything of it is read: whether its data stand in the file
// itself, and whether the file holds as much as the dataset says. Identifiers are HDF5's (hid_t).
#include <cstdint>

namespace drumlin {

/// Whether the name of an existing link leads elsewhere than to data of its own.
bool is_soft_or_external_link(std::int64_t file, const char* name);

/// Why the `count` numbers of a dataset are not read; nullptr: nothing speaks against it. Refused are more
/// than 2^28 numbers, data in other files, filters that HDF5 would load as programs, and sizes that the
/// stored bytes cannot give (deflate packs at most 1032 bytes into one), so that nothing is allocated for
/// what is not there.
const char* storage_fault(std::int64_t set, std::int64_t type, std::int64_t count);

}  // namespace drumlin
