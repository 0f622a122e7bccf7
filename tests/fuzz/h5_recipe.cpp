#include "tests/fuzz/h5_recipe.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"

namespace drumlin::fuzz {
namespace {

/// The numbers of a line; what is none ends them. Whole numbers are cut to their type.
template <class T>
std::vector<T> numbers_in(std::istringstream& line) {
  std::vector<T> values;
  for (std::string word; line >> word;) {
    const auto value = parsed_number<double>(word);
    if (!value) break;
    if constexpr (std::is_integral_v<T>) {
      const double low = static_cast<double>(std::numeric_limits<T>::min());
      values.push_back(*value > low && *value < -low ? static_cast<T>(*value)
                                                     : std::numeric_limits<T>::min());
    } else {
      values.push_back(static_cast<T>(*value));
    }
  }
  return values;
}

template <class T>
void add(H5Writer& out, const std::string& name, std::istringstream& line) {
  const std::vector<T> values = numbers_in<T>(line);
  out.add(name, std::span<const T>(values));
}

std::string with_ends_of_lines(std::string text) {
  for (std::size_t at = 0; (at = text.find("\\n", at)) != std::string::npos; ++at) text.replace(at, 2, "\n");
  return text;
}

void add_described(H5Writer& out, const std::string& text) {
  std::istringstream line(text);
  std::string name, type, rest;
  line >> name >> type;
  if (type == "double") add<double>(out, name, line);
  if (type == "float") add<float>(out, name, line);
  if (type == "int") add<std::int32_t>(out, name, line);
  if (type == "long") add<std::int64_t>(out, name, line);
  if (type == "text" && std::getline(line >> std::ws, rest)) out.add_text(name, with_ends_of_lines(rest));
}

}  // namespace

void write_described(const std::filesystem::path& file, const std::string& text) {
  if (text.starts_with("raw\n")) {
    std::ofstream(file, std::ios::binary) << text.substr(4);
    return;
  }
  H5Writer out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) try {
      add_described(out, line);
    } catch (const IoError&) {  // a name twice, or one that HDF5 does not take
    }
  out.save(file);
}

}  // namespace drumlin::fuzz
