#include "apps/output/pending_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/output/figures.hpp"
#include "apps/output/output_folder.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

fs::path note_in(const fs::path& folder) { return folder / "figures.pending"; }

void attempt(const fs::path& folder, const FigureScript& figure, std::vector<std::string>& failures) {
  try {
    draw_figures(figure.script, figure.arguments);
  } catch (const IoError& error) {
    failures.emplace_back(error.what());
    replace_file(note_in(folder), fmt::format("{}\n", fmt::join(failures, "\n")));
  }
}

}  // namespace

void note_pending_figures(const fs::path& folder) {
  replace_file(note_in(folder),
               "The results are complete or nearly so; their figures are still to be drawn.\n");
}

bool is_complete(const fs::path& finished) {
  return !fs::exists(note_in(finished.parent_path())) &&
         holds_results(finished.parent_path(), finished.filename());
}

std::vector<std::string> draw_pending_figures(const fs::path& folder,
                                              const std::vector<FigureScript>& figures,
                                              const std::optional<ResultPage>& page) {
  std::vector<std::string> failures;
  for (const FigureScript& figure : figures) attempt(folder, figure, failures);
  if (page) {
    FigureScript writer{"../pages/write_page.py",
                        {page->name + ".html", page->content.string(), folder.string()}};
    if (!failures.empty()) writer.arguments.push_back(note_in(folder).string());
    attempt(folder, writer, failures);
  }
  if (failures.empty()) fs::remove(note_in(folder));
  return failures;
}

void throw_if_figures_failed(const fs::path& finished, const std::vector<std::string>& failures) {
  if (failures.empty()) return;
  throw IoError(
      fmt::format("{}\n{} is complete; figures are missing", fmt::join(failures, "\n"), finished.string()));
}

}  // namespace drumlin::apps
