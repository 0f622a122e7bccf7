#pragma once
// Folders that this process writes into: below them it opens, makes, moves and removes nothing through a
// symbolic link, whoever has made them (docs/robustness.md).
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drumlin {

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { (void)close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    other.number_ = std::exchange(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  /// Writes all of it; false where the system does not take it (errno).
  bool write(std::string_view bytes) const;
  /// Whether the system had nothing to say of what was written.
  bool close();

 private:
  int number_;
};

/// As long as it lives, open_folder() follows no link below this folder, which stays the one that it was.
class OwnFolder {
 public:
  /// Throws IoError if it cannot be opened.
  explicit OwnFolder(const std::filesystem::path& folder);
  ~OwnFolder();
  OwnFolder(OwnFolder&&) noexcept;
  OwnFolder& operator=(OwnFolder&&) = delete;

  struct Root;

 private:
  std::unique_ptr<Root> root_;
};

/// Opens a folder to work in it; empty: the current one. number() < 0 where it is none (errno). Throws
/// InputError where the way to it, below a folder of our own, leads over a link.
Descriptor open_folder(const std::filesystem::path& folder);

/// Throws InputError where the way from `folder` to one of these names in it leads over a link.
void refuse_links(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Removes a file or an empty folder, if it is there; of a link the link. Throws IoError.
void remove_from_folder(const std::filesystem::path& path);
/// Moves a file, into a folder that is made if it is missing. Throws IoError.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace drumlin
