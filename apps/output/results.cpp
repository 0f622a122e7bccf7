#include "apps/output/results.hpp"

#include <fmt/format.h>

#include "apps/output/pending_figures.hpp"
#include "apps/process/request_sum.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/result_folder.hpp"

namespace drumlin::apps {

bool is_done_already(const ResultsRequest& request) {
  if (request.existing != ExistingOutput::resume || !is_complete(request.folder / request.finished))
    return false;
  if (!request.computed_from.empty())
    check_source(open_result_folder(request.folder), open_result_folder(request.computed_from),
                 fmt::format("drumlin {} {} --overwrite", request.command, request.computed_from.string()));
  refuse_other(request.folder, request.requested);
  print_out(request.folder.string() + ": done already\n");
  return true;
}

const std::filesystem::path& Results::begin() {
  if (!request_.computed_from.empty()) request_.source = manifest_sum(read_manifest(request_.computed_from));
  flush_out();  // what was said so far, before the long part
  return staged_.emplace(request_).folder();
}

int make_results(const ResultsRequest& request, const std::function<Made(Results&)>& make) {
  if (is_done_already(request)) return static_cast<int>(ExitCode::done);
  Results results(request);
  const Made made = make(results);
  results.publish();
  print_out(made.said);
  throw_if_figures_failed(request.folder / request.finished, made.failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
