#pragma once
// The options of `drumlin flow` and of drumlin-flow, which it starts.
#include "apps/command_line/command.hpp"

namespace drumlin::apps {

struct FlowOptions {
  std::filesystem::path scene;
  std::filesystem::path rheology;
  std::filesystem::path output;
  std::optional<std::filesystem::path> from;  ///< FLOWRUN to start from; absent: cold
  std::vector<std::string> overrides;
  int law_draws = 0;  ///< laws of other draws that are solved as well, for the band of the law
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.scene(scene, "Flow scene", shipped_flow_scene);
    d.law("--rheology", rheology, "Law").required();
    d.output(output, "FLOWRUN", "Folder for the results");
    d.add("--from", from, "FLOWRUN",
          "Finished flow to start from: same geometry and mesh, other speed or law");
    d.add("--law-draws", law_draws, "", at_least(0, 16),
          "Solves again with so many of the laws that other draws of the law's points gave: the part of the "
          "result that the law leaves open; 3 at least for a band, 0: none");
    d.changes(overrides);
    d.existing(existing);
  }
};

/// As a command that `function` does.
inline Command flow_command(int (*function)(const FlowOptions&)) {
  return command("flow", "Solves the continuum flow with a law (starts drumlin-flow)", function);
}

}  // namespace drumlin::apps
