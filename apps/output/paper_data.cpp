#include "apps/output/paper_data.hpp"

#include "apps/process/program_files.hpp"

namespace drumlin::apps {

std::filesystem::path paper_data_folder() { return data_folder() / "paper"; }

std::optional<std::filesystem::path> cost_data_folder() {
  const auto data = data_folder_if_any();
  return data && std::filesystem::is_directory(*data / "cost") ? std::optional(*data / "cost") : std::nullopt;
}

}  // namespace drumlin::apps
