#include <gtest/gtest.h>

#include "apps/support/figures.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/report_page.hpp"
#include "coupling/exchange/errors.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin::apps {
namespace {

using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;

TEST(FigureScript, ThatFailsIsAnErrorWithItsMessage) {
  const TemporaryFolder folder;
  const auto script = folder.with("bad.py", "import sys\nsys.exit('no layers in ' + sys.argv[1])\n");
  const auto message = message_of<IoError>([&] { draw_figures(script, {"profiles.csv"}); });
  EXPECT_NE(message.find("no layers in profiles.csv"), std::string::npos) << message;
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

TEST(ReportCosts, DrawsWhatTheRepositoryRecordedAndThePageFindsIt) {
  const TemporaryFolder folder;
  draw_figures("report_costs.py", {cost_data_folder().string(), folder.path().string()});
  int accuracy = 0, effects = 0;
  for (const ReportFigure& figure : figures_in(folder.path())) {
    EXPECT_EQ(figure.section, ReportSection::costs);
    EXPECT_NE(figure.caption.find("data/cost/"), std::string::npos);
    const std::string name = figure.png.filename().string();
    accuracy += name.starts_with("cost_accuracy_");
    effects += name.starts_with("cost_effects_");
  }
  EXPECT_GE(accuracy, 1);
  EXPECT_GE(effects, 1);
}

}  // namespace
}  // namespace drumlin::apps
