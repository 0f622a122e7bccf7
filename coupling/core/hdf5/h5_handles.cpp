#include "coupling/core/hdf5/h5_handles.hpp"

#include <hdf5.h>
#include <zlib.h>

#include <utility>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

/// Begins to use HDF5, which crashes if it is used after it could not start. It prints nothing, for we report
/// its failures ourselves, and tidies nothing up when the program ends: after a failure that crashes too.
void start_library() {
  static const bool started = [] {
    (void)H5dont_atexit();  // refused where another part of the program has started it
    check_h5(H5open() >= 0, "start");
    return H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  }();
  (void)started;
}

}  // namespace

bool H5Id::end() { return close_(std::exchange(id_, -1)) >= 0; }

void check_h5(bool good, const char* what) {
  if (!good) throw IoError(std::string("HDF5 could not ") + what);
}

std::int64_t h5_access_to_memory() {
  start_library();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  check_h5(access >= 0 && H5Pset_fapl_core(access, 1 << 20, false) >= 0, "prepare a file image");
  return access;
}

std::int64_t h5_access_to_disk() {
  start_library();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  check_h5(access >= 0 && H5Pset_fapl_sec2(access) >= 0 && H5Pset_file_locking(access, false, true) >= 0,
           "prepare a file");
  return access;
}

std::string h5_trailer(std::uint32_t checksum) {
  std::string bytes(h5_trailer_word);
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(checksum >> (8 * byte));
  return bytes;
}

std::uint32_t h5_checksum(std::span<const char> bytes, std::uint32_t before) {
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(before, first, bytes.size()));
}

}  // namespace drumlin
