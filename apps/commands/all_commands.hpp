#pragma once
#include <vector>

#include "apps/command_line/command.hpp"

namespace drumlin::apps {

/// The commands of `drumlin`, in the order of its help.
std::vector<Command> all_commands();

}  // namespace drumlin::apps
