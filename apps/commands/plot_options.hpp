#pragma once
// The options of `drumlin plot`.
#include "apps/command_line/options.hpp"

namespace drumlin::apps {

struct PlotOptions {
  std::filesystem::path run;
  std::optional<std::filesystem::path> output;
  std::string snapshot = "last";  ///< or its number, from 1
  bool animation = false;
  bool player = false;         ///< a page that plays the run in a browser
  std::vector<double> window;  ///< x0, x1, z0, z1 in d; empty: all grains and what stands beside them
  std::string color;           ///< empty: speed, and spin where there is one
  std::optional<int> every;    ///< snapshots per frame of animation and player; without both, stills of each
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("run", run, "RUN", "Folder of a run, finished or not").required();
    d.add("--snapshot", snapshot, "N", "Which snapshot is drawn: its number, or last");
    d.add("--animation", animation, "Draws the snapshots as an animated GIF as well");
    d.add("--player", player, "Writes player.html as well: one file in which the run plays, in any browser");
    d.add("--window", window, "X0,X1,Z0,Z1",
          "Part of the plane that is shown, in d, in the axes of the scene; absent: all grains");
    d.add("--color", color, "WHAT",
          one_of({"speed", "spin", "size", "material", "pressure", "coordination", "id"}),
          "What the colour of a grain shows; absent: speed, and a second picture of the spin");
    d.add("--every", every, "", at_least(1, 1000000),
          "Every N-th snapshot is a frame of the animation and of the player; without these each of them is "
          "a still of its own");
    d.output(output, "DIR", "Folder for the figures; standard: RUN/plots");
    d.existing(existing);
  }
};

}  // namespace drumlin::apps
