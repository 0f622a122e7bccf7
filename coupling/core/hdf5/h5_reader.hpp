#pragma once
// HDF5 files that are read: their checksum is checked before HDF5 sees a byte (random bit flips otherwise
// crash or hang it, or pass unnoticed).
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/hdf5/h5_words.hpp"

namespace drumlin {

/// An HDF5 file opened for reading. Every member throws InputError naming the file when something is missing
/// or has another type or size.
class H5Reader {
 public:
  /// `checked`: the file must end in the checksum that H5Writer leaves; otherwise any HDF5 file is taken.
  explicit H5Reader(const std::filesystem::path& file, bool checked = true);
  ~H5Reader();
  H5Reader(const H5Reader&) = delete;
  H5Reader& operator=(const H5Reader&) = delete;

  bool ends_in_checksum() const;
  bool has(const std::string& name) const;
  /// Lengths of a dataset, slowest index first.
  std::vector<std::size_t> shape(const std::string& name) const;
  std::vector<double> doubles(const std::string& name) const;
  std::vector<float> floats(const std::string& name) const;
  std::vector<std::int32_t> ints(const std::string& name) const;
  std::vector<std::int64_t> longs(const std::string& name) const;
  double number(const std::string& name) const;
  /// Refuses numbers out of the range.
  std::vector<double> doubles(const std::string& name, H5Range range) const;
  double number(const std::string& name, H5Range range) const;
  std::int64_t integer(const std::string& name) const;
  /// Whole numbers within bounds, both included; refuses any other, before it is cut to another type.
  std::int64_t integer(const std::string& name, std::int64_t low,
                       std::int64_t high = std::numeric_limits<std::int64_t>::max()) const;
  std::vector<std::int32_t> ints(const std::string& name, std::int32_t low, std::int32_t high) const;
  Scales scales() const;
  std::string text(const std::string& name) const;
  /// Throws unless the text "format" is this one; `otherwise`: what to do then.
  void require_format(const std::string& format, const std::string& otherwise = "") const;
  /// Throws where a link leads elsewhere, or a dataset cannot be read: for all of the file.
  void require_readable() const;
  [[noreturn]] void refuse(const std::string& name, const std::string& what,
                           const std::string& allowed = "") const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  std::filesystem::path file_;
};

/// For readers that are not ours (h5py): throws as the members above where a file is not whole, leads
/// elsewhere or says more than it holds. A file with a format of ours must end in the checksum.
void require_readable(const std::filesystem::path& file);

}  // namespace drumlin
