#pragma once
// How a command leaves its results in a folder, once and for all commands: refused where it exists, done
// already where it was finished for the same request, else all of the new results or none.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/command_line/options.hpp"
#include "apps/output/output_folder.hpp"

namespace drumlin::apps {

/// What is said of results that were written, and the figures that could not be drawn (pending_figures.hpp).
struct Made {
  std::string said;
  std::vector<std::string> failures = {};
};
struct ResultsRequest : OutputRequest {
  std::string finished;                      ///< the file whose presence says that all is there
  std::filesystem::path computed_from = {};  ///< a result folder to whose present state the results belong
};
/// The folder of a command with its options: what they read, and the sum of what they request, after `first`.
template <class Options>
ResultsRequest results_of(const Options& options, std::string command, std::filesystem::path folder,
                          std::string finished,
                          nlohmann::ordered_json first = nlohmann::ordered_json::array()) {
  const Description description = described(options);
  return {{std::move(folder),
           options.existing,
           std::move(command),
           inputs_of(description),
           {},
           requested_sum(description, std::move(first))},
          std::move(finished)};
}

/// Whether --resume was given and an earlier call has finished what is requested, which is said. Throws
/// InputError where it has finished something else, or of another state of what the results belong to.
bool is_done_already(const ResultsRequest& request);

/// The folder that a command makes its results in.
class Results {
 public:
  explicit Results(ResultsRequest request) : request_(std::move(request)) {}
  /// Claims the folder, once everything that can be refused was read; where the results are to be written.
  const std::filesystem::path& begin();
  /// Puts them in their place.
  void publish() { staged_->publish(); }

 private:
  ResultsRequest request_;
  std::optional<StagedOutput> staged_;
};

/// Makes the results of a command in its folder, and says so; returns the exit code.
int make_results(const ResultsRequest& request, const std::function<Made(Results&)>& make);

}  // namespace drumlin::apps
