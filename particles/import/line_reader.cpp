#include "particles/import/line_reader.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"

namespace drumlin::particles {

namespace {

constexpr std::size_t piece = 1 << 16, longest_line = 1 << 20;  // bytes

}  // namespace

LineReader::LineReader(const std::filesystem::path& file)
    : file_(file), input_(file, std::numeric_limits<std::uint64_t>::max()) {
  fill();
  const std::string_view start(buffer_);
  if (start.starts_with("\x1f\x8b") || start.starts_with("\x28\xb5\x2f\xfd"))
    throw InputError(
        {{file_.string(), 0, 0, "", "is compressed (gzip or zstd)", "text: gunzip or unzstd it first"}});
  cut_byte_order_mark(buffer_, file_);
}

/// Reads on behind what is not taken yet; false at the end of the file.
bool LineReader::fill() {
  buffer_.erase(0, taken_);
  taken_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + piece);
  buffer_.resize(kept + input_.read(std::span(buffer_).subspan(kept)));
  return buffer_.size() > kept;
}

bool LineReader::next() {
  std::size_t end = buffer_.find('\n', taken_);
  while (end == std::string::npos) {
    const std::size_t seen = buffer_.size() - taken_;
    if (seen > longest_line) {
      ++number_;
      refuse("", "is longer than 1 MiB", "lines of text");
    }
    if (!fill()) break;
    end = buffer_.find('\n', seen);
  }
  if (end == std::string::npos && taken_ == buffer_.size()) return false;
  unended_ = end == std::string::npos;
  end = std::min(end, buffer_.size());
  ++number_;
  line_ = trimmed(std::string_view(buffer_).substr(taken_, end - taken_));
  taken_ = std::min(end + 1, buffer_.size());
  return true;
}

void LineReader::refuse(const std::string& key, const std::string& what, const std::string& allowed) const {
  throw InputError({{file_.string(), number_, 0, key, what, allowed}});
}

double LineReader::number_from(std::string_view text, const std::string& key) const {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto value = finite_number(digits);
  if (!value) refuse(key, "\"" + std::string(text) + "\" is no number", "a finite number");
  return *value;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t from = line.find_first_not_of(" \t"); from != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(" \t", from);
    words.push_back(line.substr(from, end - from));
    from = line.find_first_not_of(" \t", end);
  }
  return words;
}

}  // namespace drumlin::particles
