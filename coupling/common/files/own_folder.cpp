#include "coupling/common/files/own_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <set>

#include "coupling/common/errors.hpp"
#include "coupling/common/files/text_file.hpp"

namespace drumlin {

namespace fs = std::filesystem;

struct OwnFolder::Root {
  fs::path path;
  Descriptor folder;
};

namespace {

constexpr int as_folder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

// Those of this process, the inner ones last; snapshots are written by another thread.
std::vector<const OwnFolder::Root*> roots;
std::mutex roots_in_use;

[[noreturn]] void refuse(const fs::path& link) {
  throw InputError(link.string() +
                   ": is a symbolic link, and none is followed below a folder of results; remove it");
}

/// `path` from the root on; nothing where it lies elsewhere.
std::optional<fs::path> below(const fs::path& root, const fs::path& path) {
  const auto [end, rest] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  if (end != root.end()) return std::nullopt;
  fs::path way;
  for (auto part = rest; part != path.end(); ++part) way /= *part;
  return way;
}

Descriptor open_below(const OwnFolder::Root& root, const fs::path& way) {
  if (way.empty()) return Descriptor(::openat(root.folder.number(), ".", as_folder));
  Descriptor at(-1);
  fs::path here = root.path;
  for (const fs::path& part : way) {
    const int above = at.number() < 0 ? root.folder.number() : at.number();
    at = Descriptor(::openat(above, part.empty() ? "." : part.c_str(), as_folder | O_NOFOLLOW));
    if (here /= part; at.number() >= 0) continue;
    const int error = errno;
    if (std::error_code unknown; fs::is_symlink(fs::symlink_status(here, unknown))) refuse(here);
    errno = error;
    break;
  }
  return at;
}

}  // namespace

bool Descriptor::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(number_, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return true;
}

bool Descriptor::close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

OwnFolder::OwnFolder(const fs::path& folder)
    : root_(std::make_unique<Root>(folder.has_filename() ? folder : folder.parent_path(),
                                   open_folder(folder))) {
  if (root_->folder.number() < 0) throw_io_error(folder, "opened");
  const std::lock_guard held(roots_in_use);
  roots.push_back(root_.get());
}

OwnFolder::OwnFolder(OwnFolder&&) noexcept = default;

OwnFolder::~OwnFolder() {
  if (!root_) return;
  const std::lock_guard held(roots_in_use);
  std::erase(roots, root_.get());
}

Descriptor open_folder(const fs::path& folder) {
  const std::lock_guard held(roots_in_use);
  for (const OwnFolder::Root* root : roots)  // the outermost knows most of the way
    if (const auto way = below(root->path, folder)) return open_below(*root, *way);
  return Descriptor(::open(folder.empty() ? "." : folder.c_str(), as_folder));
}

void refuse_links(const fs::path& folder, const std::vector<std::string>& names) {
  std::set<fs::path> ways;
  for (const std::string& name : names)
    for (fs::path way = fs::path(name).parent_path(); !way.empty(); way = way.parent_path())
      if (!ways.insert(way).second) break;
  std::error_code error;
  for (const fs::path& way : ways)
    if (fs::is_symlink(fs::symlink_status(folder / way, error))) refuse(folder / way);
}

void remove_from_folder(const fs::path& path) {
  const Descriptor folder = open_folder(path.parent_path());
  if (folder.number() < 0) return;
  const std::string name = path.filename().string();
  if (::unlinkat(folder.number(), name.c_str(), 0) == 0 || errno == ENOENT) return;
  if (errno != EISDIR || ::unlinkat(folder.number(), name.c_str(), AT_REMOVEDIR) != 0)
    throw_io_error(path, "removed");
}

void move_file(const fs::path& from, const fs::path& to) {
  make_folders(to.parent_path());
  const Descriptor here = open_folder(from.parent_path()), there = open_folder(to.parent_path());
  if (::renameat(here.number(), from.filename().c_str(), there.number(), to.filename().c_str()) != 0)
    throw_io_error(from, "moved");
}

}  // namespace drumlin
