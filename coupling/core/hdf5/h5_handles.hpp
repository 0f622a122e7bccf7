#pragma once
// What the writers and the reader of HDF5 files share: handles, how files are opened, and the checksum at the
// end of a file. Identifiers are HDF5's (hid_t).
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace drumlin {

/// An HDF5 identifier that closes itself.
class H5Id {
 public:
  using Close = int (*)(std::int64_t);
  H5Id(std::int64_t id, Close close) : id_(id), close_(close) {}
  ~H5Id() {
    if (id_ >= 0) close_(id_);
  }
  H5Id(const H5Id&) = delete;
  H5Id& operator=(const H5Id&) = delete;
  std::int64_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Closes it before its time; returns whether HDF5 had nothing to say.
  bool end();

 private:
  std::int64_t id_;
  Close close_;
};

/// Throws IoError, "HDF5 could not `what`", unless `good`.
void check_h5(bool good, const char* what);

/// How a file image is opened: in memory.
std::int64_t h5_access_to_memory();
/// How a file on the disk is opened: nobody else knows its name, so that it needs no lock.
std::int64_t h5_access_to_disk();

/// HDF5 wants a name for an image in memory and looks whether a file of that name exists: this one cannot.
inline constexpr const char* h5_image_name = "/dev/null/image";

/// The end of a file: a word, and the CRC-32 of all that comes before it, low byte first.
inline constexpr std::string_view h5_trailer_word = "DRUMLCRC";
inline constexpr std::size_t h5_trailer_size = h5_trailer_word.size() + 4;
std::string h5_trailer(std::uint32_t checksum);
/// CRC-32 of bytes that follow others whose checksum is `before`.
std::uint32_t h5_checksum(std::span<const char> bytes, std::uint32_t before = 0);

}  // namespace drumlin
