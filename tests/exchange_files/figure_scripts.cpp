#include <gtest/gtest.h>

#include "apps/support/figures.hpp"
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

}  // namespace
}  // namespace drumlin::apps
