#pragma once
// Headers made from texts, as a file would hold them.
#include <map>
#include <string>
#include <vector>

#include "coupling/core/results/run_header.hpp"

namespace drumlin::testing {

inline RunHeader header_from(const std::map<std::string, std::string>& texts) {
  std::vector<std::string> entries;
  for (const auto& [key, text] : texts) entries.push_back(key + " = " + text);
  std::vector<HeaderLine> lines;
  for (const std::string& entry : entries) lines.push_back({static_cast<int>(lines.size()) + 1, entry});
  return read_header(lines, "header");
}

/// Another text for one key.
inline void set_entry(RunHeader& header, const std::string& key, const std::string& text) {
  auto texts = header_texts(header);
  texts[key] = text;
  header = header_from(texts);
}

inline void erase_entry(RunHeader& header, const std::string& key) {
  auto texts = header_texts(header);
  texts.erase(key);
  header = header_from(texts);
}

}  // namespace drumlin::testing
