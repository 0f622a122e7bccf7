#include "apps/support/paper_data.hpp"

namespace drumlin::apps {

std::filesystem::path paper_data_folder() { return DRUMLIN_PAPER_DATA; }

std::filesystem::path cost_data_folder() { return paper_data_folder().parent_path() / "cost"; }

}  // namespace drumlin::apps
