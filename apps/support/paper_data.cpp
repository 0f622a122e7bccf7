#include "apps/support/paper_data.hpp"

namespace drumlin::apps {

std::filesystem::path paper_data_folder() { return DRUMLIN_PAPER_DATA; }

}  // namespace drumlin::apps
