#pragma once
// Small HDF5 files that survive: built in memory or aside, closed by a checksum, synced and renamed.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_words.hpp"

namespace drumlin {

/// What an HDF5 file in the making takes. Names are paths like "contacts/normal"; groups are made as needed.
class H5Content {
 public:
  H5Content(const H5Content&) = delete;
  H5Content& operator=(const H5Content&) = delete;

  /// T: double, float, std::int32_t or std::int64_t.
  template <class T>
  void add(const std::string& name, std::span<const T> values, H5Words words = {});
  template <class T>
  void add(const std::string& name, const std::vector<T>& values, H5Words words = {}) {
    add(name, std::span<const T>(values), words);
  }
  /// Of any number of lengths, the slowest index first; their product is that of `values`. `piece`: lengths
  /// of what is packed at once, every bit kept; empty: nothing is.
  void add_array(const std::string& name, std::span<const double> values,
                 const std::vector<std::size_t>& lengths, H5Words words = {},
                 const std::vector<std::size_t>& piece = {});
  /// Row after row; `values` holds a whole number of rows.
  void add_table(const std::string& name, std::span<const double> values, std::size_t columns,
                 H5Words words = {});
  /// The same in single precision, packed (shuffled and deflated) after rounding to `bits` binary digits, 1
  /// to 23, of which the first one is not counted: a relative error of 2^-(bits + 1).
  void add_packed_table(const std::string& name, std::span<const double> values, std::size_t columns,
                        int bits, H5Words words = {});
  void add_number(const std::string& name, double value, H5Words words = {});
  void add_number(const std::string& name, std::int64_t value, H5Words words = {});
  void add_scales(const Scales& scales);
  /// A string of UTF-8 as long as it is.
  void add_text(const std::string& name, const std::string& text);

 protected:
  struct Handles;
  explicit H5Content(std::unique_ptr<Handles> handles);
  ~H5Content();
  std::unique_ptr<Handles> handles_;
};

/// An HDF5 file that is made in memory.
class H5Writer : public H5Content {
 public:
  H5Writer();
  /// The bytes of the whole file, with its checksum.
  std::string image() const;
  /// Writes them as replace_file().
  void save(const std::filesystem::path& file, const std::filesystem::path& previous = {}) const;
};

/// The same file, byte for byte, made on the disk: for tables that are never in memory as a whole.
class H5FileWriter : public H5Content {
 public:
  /// Throws IoError; so do all members. The older file of that name is untouched until save().
  explicit H5FileWriter(const std::filesystem::path& file);
  ~H5FileWriter();
  /// A table of `rows` rows whose first ones are `values`, a whole number of rows; the others follow by
  /// add_rows().
  void begin_table(const std::string& name, std::span<const double> values, std::size_t rows,
                   std::size_t columns, H5Words words = {});
  void add_rows(const std::string& name, std::size_t first_row, std::span<const double> values);
  /// Closes it by its checksum and puts it in its place. Nothing is added after it.
  void save();

 private:
  AtomicFile aside_;
};

}  // namespace drumlin
