#include <gtest/gtest.h>

#include "apps/output/figures.hpp"
#include "apps/output/paper_data.hpp"
#include "apps/output/pending_figures.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/signed_folder.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;

TEST(FigureScript, ThatFailsIsAnErrorWithItsMessage) {
  const TemporaryFolder folder;
  const auto script = folder.with("bad.py", "import sys\nsys.exit('no layers in ' + sys.argv[1])\n");
  const auto message = message_of<IoError>([&] { draw_figures(script, {"profiles.csv"}); });
  expect_has(message, "no layers in profiles.csv");
}

TEST(FigureScript, ThatIsKilledIsAnError) {
  const TemporaryFolder folder;
  const auto script = folder.with("killed.py", "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n");
  EXPECT_THROW(draw_figures(script, {}), IoError);
}

TEST(FigureScript, ThatDoesNotExistIsAnError) { EXPECT_THROW(draw_figures("none.py", {}), IoError); }

TEST(FigureScript, GetsItsArgumentsAndABackendWithoutDisplay) {
  const TemporaryFolder folder;
  const auto script = folder.with(
      "good.py", "import os, sys\nopen(sys.argv[1], 'w').write(os.environ['MPLBACKEND'] + sys.argv[2])\n");
  draw_figures(script, {(folder / "out").string(), " a b"});
  std::string text;
  std::getline(std::ifstream(folder / "out"), text);
  EXPECT_EQ(text, "Agg a b");
}

TEST(FigureScript, ImportsFromItsOwnFolderAndNeitherTheCurrentOneNorPythonpath) {
  const TemporaryFolder own, strange;
  const fs::path executed = strange / "executed", before = fs::current_path();
  for (const char* module : {"json.py", "sitecustomize.py"})
    strange.with(module, "open('" + executed.string() + "', 'w').close()\n");
  own.with("neighbour.py", "ink = 'blue'\n");
  const auto script = own.with(
      "draw.py", "import json, sys\nimport neighbour\nopen(sys.argv[1], 'w').write(neighbour.ink)\n");
  ::setenv("PYTHONPATH", strange.path().c_str(), 1);
  ::setenv("PYTHONHOME", strange.path().c_str(), 1);
  fs::current_path(strange.path());
  EXPECT_NO_THROW(draw_figures(script, {(own / "drawn").string()}));
  fs::current_path(before);
  ::unsetenv("PYTHONPATH");
  ::unsetenv("PYTHONHOME");
  EXPECT_EQ(file_text(own / "drawn"), "blue");
  EXPECT_FALSE(fs::exists(executed));
}

/// Four contacts in a row, of which one has changed its state.
void write_contacts(const fs::path& problem, const fs::path& solution, bool changes) {
  const std::vector<double> x{1, 2, 3, 4}, none(4, 0.0), one(4, 1.0), r{1, 0, 2, 0.8, 0, 0, 1, 0.1};
  const std::vector<std::int32_t> state{1, 2, 0, 1}, changed{0, 5, 0, 0};
  {
    H5Writer out;
    out.add("drumlin/contacts/x", std::span(x)), out.add("drumlin/contacts/z", std::span(none));
    out.add("drumlin/contacts/normal_x", std::span(one)),
        out.add("drumlin/contacts/normal_z", std::span(none));
    out.save(problem);
  }
  H5Writer out;
  out.add("solution/r", std::span(r)), out.add("solution/error", std::span(one));
  out.add("solution/state", std::span(state));
  if (changes) out.add("solution/changes", std::span(changed));
  out.save(solution);
}

TEST(FigureScript, DrawsTheContactsThatFoldWhereTheirChangesAreKnown) {
  const TemporaryFolder folder;
  const auto problem = folder.path() / "p.h5", solution = folder.path() / "s.h5",
             drawn = folder.path() / "f.png";
  const std::vector<std::string> words{problem.string(), solution.string(), drawn.string()};
  const std::string script = drumlin::test::docs_folder() / "figures/folding_contacts.py";
  write_contacts(problem, solution, true);
  draw_figures(script, words);
  EXPECT_EQ(file_text(drawn).substr(1, 3), "PNG");
  write_contacts(problem, solution, false);
  const auto message = message_of<IoError>([&] { draw_figures(script, words); });
  expect_has(message, "s.h5: holds no changes of states");
}

TEST(PendingFigures, AreAllDrawnButThoseThatFailAndTheseAreNamed) {
  const TemporaryFolder folder;
  const fs::path results = folder / "results", finished = results / "measured.json";
  fs::create_directories(results);
  const std::string bad = folder.with("bad.py", "import sys\nsys.exit('no ink')\n");
  const std::string good = folder.with("good.py", "import sys\nopen(sys.argv[1], 'w').close()\n");
  EXPECT_FALSE(is_complete(finished));
  note_pending_figures(results);
  replace_file(finished, "{}");
  EXPECT_FALSE(is_complete(finished));

  const auto failures =
      draw_pending_figures(results, {{bad, {}}, {good, {(results / "drawn.png").string()}}});
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_TRUE(fs::exists(results / "drawn.png"));
  EXPECT_FALSE(is_complete(finished));
  const auto message = message_of<IoError>([&] { throw_if_figures_failed(finished, failures); });
  for (const char* part : {"bad.py", "no ink", "measured.json is complete"}) expect_has(message, part);

  EXPECT_TRUE(draw_pending_figures(results, {{good, {(results / "drawn.png").string()}}}).empty());
  drumlin::testing::sign(results, "measure");
  EXPECT_TRUE(is_complete(finished));
  EXPECT_NO_THROW(throw_if_figures_failed(finished, {}));
}

// Two $ would begin mathematics, and 20,000 letters a picture that no one draws.
TEST(FigureScript, DrawsTextsOfTheUserAsTheyStand) {
  const TemporaryFolder folder;
  const auto script = folder.with("titles.py", R"(import sys
sys.path.insert(0, sys.argv[1])
import style
assert style.plain("a $x_1$ b") == r"a \$x_1\$ b"
assert style.plain("one\ntwo\x00\x1b") == "one\N{REPLACEMENT CHARACTER}two" + 2 * "\N{REPLACEMENT CHARACTER}"
assert max(map(len, style.plain("w" * 20000).splitlines())) <= 80 and len(style.plain("w" * 20000).splitlines()) == 3
style.use_style()
for number, text in enumerate(["$", "$x_", "$\\frac{1}{$", "\\", "a_b^{c", "$" * 200, "\\$" * 30, "%&#~{}", "_" * 20000, "\u202e x", ""]):
    figure, axes = style.plt.subplots()
    figure.suptitle(style.title_of(style.plain(text) + "\nbeside $x_1$", True))
    axes.plot([0, 1], label=style.plain(text))
    axes.legend()
    style.save(figure, f"{sys.argv[2]}/{number}.png", True)
    assert figure._suptitle.get_text().endswith("- reduced")
)");
  draw_figures(script, {(drumlin::test::docs_folder().parent_path() / "apps/figures").string(),
                        folder.path().string()});
  EXPECT_TRUE(fs::exists(folder / "10.png"));
}

TEST(FigureScript, ReplacesPlantedLinksAndFollowsNone) {
  const TemporaryFolder folder;
  const auto theirs = folder.with("theirs", "keep");
  fs::create_directory(folder / "drawn");
  const auto script = folder.with("links.py", R"(import os, pathlib, sys
sys.path.insert(1, sys.argv[1])
import style, whole_file
folder = pathlib.Path(sys.argv[2])
for name in ("figure.png", "table.md", f".drumlin-{os.getpid()}.part"):
    (folder / name).symlink_to(folder.parent / "theirs")
style.save(style.plt.figure(), folder / "figure.png", False)
whole_file.write_text(folder / "table.md", "text")
assert sorted(path.name for path in folder.iterdir() if not path.is_symlink()) == ["figure.png", "table.md"]
umask = os.umask(0)
os.umask(umask)
assert (folder / "table.md").stat().st_mode & 0o777 == 0o666 & ~umask
)");
  draw_figures(script, {(drumlin::test::docs_folder().parent_path() / "apps/figures").string(),
                        (folder / "drawn").string()});
  EXPECT_EQ(file_text(theirs), "keep");
}

TEST(ReportCosts, DrawsWhatTheRepositoryRecorded) {
  const TemporaryFolder folder;
  draw_figures("report_costs.py", {cost_data_folder().value().string(), folder.path().string()});
  int accuracy = 0, effects = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    accuracy += name.starts_with("cost_accuracy_");
    effects += name.starts_with("cost_effects_");
  }
  EXPECT_GE(accuracy, 1);
  EXPECT_GE(effects, 1);
}

}  // namespace
}  // namespace drumlin::apps
