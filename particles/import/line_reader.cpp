#include "particles/import/line_reader.hpp"

#include "coupling/common/errors.hpp"
#include "coupling/documents/csv.hpp"

namespace drumlin::particles {

LineReader::LineReader(const std::filesystem::path& file) : file_(file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(file.string() + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(file.string() + ": is a folder, not a file");
  stream_.open(file, std::ios::binary);
  if (!stream_) throw IoError(file.string() + ": cannot be read");
}

bool LineReader::next() {
  if (!std::getline(stream_, line_)) {
    if (stream_.bad()) throw IoError(file_.string() + ": cannot be read");
    return false;
  }
  ++number_;
  const std::string_view kept = trimmed(line_);
  if (kept.size() != line_.size()) line_ = std::string(kept);
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
