#include "apps/run/files_in_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/common/errors.hpp"
#include "coupling/common/last_whole.hpp"
#include "coupling/files/h5_writer.hpp"
#include "particles/io/checkpoint_contents.hpp"
#include "particles/io/snapshot_contents.hpp"

namespace drumlin::apps {
using namespace particles;
namespace {

/// What takes the content of a file on each rank: the first one makes the file, all keep their parts of the
/// arrays until these have places in it.
class FileInParts {
 public:
  /// Arrays whose names begin with one of `spread` are cut into parts.
  FileInParts(const Ranks& ranks, const std::filesystem::path& file, std::vector<std::string> spread)
      : ranks_(ranks), name_(file), spread_(std::move(spread)) {
    make([&] { file_.emplace(file); });
  }

  void add_text(const std::string& name, const std::string& text) {
    make([&] { file_->add_text(name, text); });
  }
  template <class Number>
  void add_number(const std::string& name, Number number) {
    make([&] { file_->add_number(name, number); });
  }
  template <class T>
  void add(const std::string& name, std::span<const T> part) {
    const auto is_spread = [&](const std::string& beginning) { return name.starts_with(beginning); };
    if (std::none_of(spread_.begin(), spread_.end(), is_spread)) return make([&] { file_->add(name, part); });
    const std::vector<std::int64_t> own{static_cast<std::int64_t>(part.size())};
    const auto counts = ranks_.gather_everywhere<std::int64_t>(own);
    std::int64_t before = 0, all = 0;
    for (std::size_t r = 0; r < counts.size(); ++r) {
      if (r == static_cast<std::size_t>(ranks_.rank())) before = all;
      all += counts[r];
    }
    make([&] { file_->begin_array<T>(name, static_cast<std::size_t>(all)); });
    const auto bytes = std::as_bytes(part);
    arrays_.push_back({static_cast<std::uint64_t>(before) * sizeof(T), {bytes.begin(), bytes.end()}});
  }
  /// What only the first rank has to add.
  void add_by_first(const std::function<void(H5Content&)>& action) {
    make([&] { action(*file_); });
  }

  /// Writes it, and puts it in its place with `settle`.
  void write(const std::function<void(H5FileWriter&)>& settle) {
    std::vector<std::uint64_t> places;
    std::string aside;
    ranks_.on_first([&] {
      if (failed_) std::rethrow_exception(failed_);
      places = file_->end_content(), aside = file_->aside().string();
    });
    ranks_.broadcast(places);
    std::vector<char> name(aside.begin(), aside.end());
    ranks_.broadcast(name);
    aside.assign(name.begin(), name.end());
    std::vector<Ranks::FilePiece> pieces;
    for (std::size_t k = 0; k < arrays_.size(); ++k)
      pieces.push_back({places[k] + arrays_[k].before, arrays_[k].bytes});
    const std::string wrong = ranks_.write_pieces(aside, pieces);
    ranks_.on_first([&] {
      if (!wrong.empty()) throw IoError(name_.string() + ": " + wrong + " (all ranks must see its folder)");
      settle(*file_);
    });
  }

 private:
  /// On the first rank alone, without a word to the others: write() tells them of a failure.
  void make(const std::function<void()>& action) {
    if (ranks_.rank() != 0 || failed_) return;
    try {
      action();
    } catch (const IoError& error) {
      failed_ = std::make_exception_ptr(IoError(name_.string() + ": " + error.what()));
    } catch (...) {
      failed_ = std::current_exception();
    }
  }

  struct Array {
    std::uint64_t before = 0;  // bytes of the ranks before this one
    std::vector<std::byte> bytes;
  };

  const Ranks& ranks_;
  std::filesystem::path name_;
  std::vector<std::string> spread_;
  std::optional<H5FileWriter> file_;  // of the first rank alone, as the next one
  std::exception_ptr failed_;
  std::vector<Array> arrays_;
};

}  // namespace

void write_snapshot_in_parts(const Ranks& ranks, const std::filesystem::path& file, const Snapshot& part) {
  FileInParts parts(ranks, file, {"grains/", "contacts/"});
  add_snapshot(part, parts);
  parts.write([](H5FileWriter& whole) { whole.save(); });
}

void keep_checkpoint_in_parts(const Ranks& ranks, const std::filesystem::path& run, const Checkpoint& part) {
  FileInParts parts(ranks, run / checkpoint_name, {"bodies/", "memory/"});
  add_checkpoint(part, parts);
  parts.write([&](H5FileWriter& whole) { whole.save_keeping(run / previous_checkpoint_name); });
}

}  // namespace drumlin::apps
