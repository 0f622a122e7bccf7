#include "particles/import/line_reader.hpp"

#include <charconv>
#include <cmath>

#include "coupling/exchange/errors.hpp"

namespace drumlin {

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
  double value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || fault != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse(key, "\"" + std::string(text) + "\" is no number", "a finite number");
  return value;
}

std::string_view trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
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

void split_at_commas(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace drumlin
