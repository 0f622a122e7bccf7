#pragma once
// Numbers that wait on the disk, in a file without a name, until they are needed again: what does not fit
// into memory.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupling/core/files/descriptor.hpp"

namespace drumlin {

/// Bytes that grow at their end and are read anywhere, in a file of `folder` that no folder lists: it
/// vanishes with this object, however the process ends.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path folder = std::filesystem::temp_directory_path())
      : folder_(std::move(folder)) {}

  /// Returns the place of the first byte. Throws IoError when the folder takes no file, or the disk no more.
  std::uint64_t append(std::span<const std::byte> bytes);
  /// Fills `bytes` from `place` on, all of which must have been appended. Throws IoError.
  void read(std::uint64_t place, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  Descriptor file_{-1};
  std::uint64_t size_ = 0;
};

/// A list in a scratch file, which it may share with others: grows at its end, is read in order. Holds one
/// block in memory.
template <class Item>
class ScratchList {
  static_assert(std::is_trivially_copyable_v<Item>);

 public:
  static constexpr std::size_t block = 1024;  ///< items

  ScratchList() : ScratchList(std::make_shared<ScratchFile>()) {}
  explicit ScratchList(std::shared_ptr<ScratchFile> file) : file_(std::move(file)) {}

  void push_back(const Item& item) {
    newest_.push_back(item);
    if (newest_.size() < block) return;
    places_.push_back(file_->append(std::as_bytes(std::span(newest_))));
    newest_.clear();
  }
  std::size_t size() const { return places_.size() * block + newest_.size(); }

  /// Calls action(item) for all of them, in their order.
  template <class Action>
  void each(Action action) const {
    std::vector<Item> items(places_.empty() ? 0 : block);
    for (const std::uint64_t place : places_) {
      file_->read(place, std::as_writable_bytes(std::span(items)));
      for (const Item& item : items) action(item);
    }
    for (const Item& item : newest_) action(item);
  }

 private:
  std::shared_ptr<ScratchFile> file_;
  std::vector<std::uint64_t> places_;  // of the blocks in the file
  std::vector<Item> newest_;
};

}  // namespace drumlin
