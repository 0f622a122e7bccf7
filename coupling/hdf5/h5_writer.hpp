#pragma once
// Small HDF5 files that survive: built in memory or aside, closed by a checksum, synced and renamed.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "coupling/common/files/text_file.hpp"

namespace drumlin {

/// What an HDF5 file in the making takes. Names are paths like "contacts/normal"; groups are made as needed.
class H5Content {
 public:
  H5Content(const H5Content&) = delete;
  H5Content& operator=(const H5Content&) = delete;

  void add(const std::string& name, std::span<const double> values);
  void add(const std::string& name, std::span<const float> values);
  void add(const std::string& name, std::span<const std::int32_t> values);
  void add(const std::string& name, std::span<const std::int64_t> values);
  /// Row after row; `values` holds a whole number of rows.
  void add_table(const std::string& name, std::span<const double> values, std::size_t columns);
  /// The same in single precision, packed (shuffled and deflated) after rounding to `bits` binary digits, 1
  /// to 23, of which the first one is not counted: a relative error of 2^-(bits + 1).
  void add_packed_table(const std::string& name, std::span<const double> values, std::size_t columns,
                        int bits);
  void add_number(const std::string& name, double value);
  void add_number(const std::string& name, std::int64_t value);
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

/// The same file, byte for byte, made on the disk: for tables that are never in memory as a whole, and arrays
/// that others write.
class H5FileWriter : public H5Content {
 public:
  /// Throws IoError; so do all members. The older file of that name is untouched until save().
  explicit H5FileWriter(const std::filesystem::path& file);
  ~H5FileWriter();
  /// A table of `rows` rows whose first ones are `values`, a whole number of rows; the others follow by
  /// add_rows().
  void begin_table(const std::string& name, std::span<const double> values, std::size_t rows,
                   std::size_t columns);
  void add_rows(const std::string& name, std::size_t first_row, std::span<const double> values);
  /// An array of `count` numbers that others write into the file once end_content() has told them where. T:
  /// double, float, std::int32_t or std::int64_t, low bytes first.
  template <class T>
  void begin_array(const std::string& name, std::size_t count);
  /// Ends what HDF5 has to do. Returns where the arrays stand that were begun, in bytes from the beginning of
  /// the file, in their order; 0 of an empty one.
  std::vector<std::uint64_t> end_content();
  /// The file as long as it is in the making.
  const std::filesystem::path& aside() const { return aside_.path(); }
  /// Closes it by its checksum and puts it in its place, as FileInTheMaking does. Nothing is added after it.
  void save(const std::filesystem::path& previous = {});

 private:
  FileInTheMaking aside_;
  std::vector<std::uint64_t> places_;  // of the arrays begun
  bool ended_ = false;                 // end_content()
};

}  // namespace drumlin
