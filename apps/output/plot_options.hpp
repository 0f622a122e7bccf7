#pragma once
// The options of `drumlin plot`.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/output/existing_output.hpp"

namespace drumlin::apps {

struct PlotOptions {
  std::filesystem::path run;
  std::optional<std::filesystem::path> output;  ///< standard: RUN/plots
  std::string snapshot = "last";                ///< or its number, from 1
  bool animation = false;
  bool player = false;  ///< a page that plays the run in a browser
  ExistingOutput existing = ExistingOutput::refuse;
  std::vector<double> window = {};  ///< x0, x1, z0, z1 in d; empty: all grains and what stands beside them
  std::string color = {};           ///< one of plot_colors; empty: speed, and spin where there is one
  int every = 0;  ///< snapshots per frame of animation and player; without both, stills of each such snapshot
};
/// What the colour of a grain may show.
constexpr std::array<const char*, 7> plot_colors{"speed",    "spin",         "size", "material",
                                                 "pressure", "coordination", "id"};

}  // namespace drumlin::apps
