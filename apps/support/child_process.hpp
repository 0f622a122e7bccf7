#pragma once
// Programs that stand beside this one, and what they print.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::apps {

/// The program of this name in the folder of the running executable. Throws IoError if it is missing.
std::filesystem::path program_beside(const std::string& name);

/// Runs it with these words, hands over each line of its standard output as it comes, and returns its exit
/// code (128 + signal as a shell reports it). Throws IoError.
int run_for_lines(const std::filesystem::path& program, const std::vector<std::string>& words,
                  const std::function<void(const std::string&)>& line);

}  // namespace drumlin::apps
