#include "apps/output/paper_data.hpp"

#include "apps/process/program_files.hpp"

namespace drumlin::apps {

std::filesystem::path paper_data_folder() { return data_folder() / "paper"; }

std::filesystem::path cost_data_folder() { return data_folder() / "cost"; }

}  // namespace drumlin::apps
