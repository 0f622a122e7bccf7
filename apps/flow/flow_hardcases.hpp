#pragma once
#include <string>
#include <vector>

namespace drumlin::apps {

/// What `drumlin hardcases` asks of drumlin-flow: one line of JSON per case on standard output. With "--list"
/// as the first word {"name", "fast"} of every case, else the rows of the cases named, in their order.
/// FemRuntime has to live. Throws InputError for a name that it does not know.
int flow_hardcases(const std::vector<std::string>& words);

}  // namespace drumlin::apps
