#pragma once
// Continuum flows of the paper's drum made from known laws, to go with drum_runs.hpp.
#include "coupling/study/speed_comparison.hpp"
#include "tests/study/drum_runs.hpp"

namespace drumlin::testing {

/// The flow that shows exactly what drum_run(rpm, laws) shows, without intervals, counted from a surface that
/// lies `lower` d nearer to the drum's axis.
inline coupling::StudyFlow flow_run(double rpm, const DrumLaws& laws = {}, double lower = 0) {
  const coupling::StudyRun run = drum_run(rpm, laws);
  coupling::StudyFlow flow;
  flow.name = "flow-" + std::to_string(std::lround(rpm));
  flow.rotation_rpm = rpm;
  flow.side.profiles = run.profiles;
  for (double& z : flow.side.profiles.z) z -= lower;
  flow.side.profiles.header.axis_depth = 4 - lower;
  flow.side.profiles.header.side = RunSide::continuum;
  for (ProfileColumn& column : flow.side.profiles.columns) column.ci99.clear();
  // The rest is read off its profile, which ends in a tail: the line through it reaches 3 d below H.
  for (const char* name : {"theta_deg", "Q"})
    flow.side.scalars.scalars.push_back({name, run.scalars.value(name), std::nullopt});
  flow.cpu_seconds = 5;
  flow.start = "cold";
  flow.identity = {{"law", "mu = 0.35 + 0.013 ln I"}, {"effects", "nothing"}};
  flow.fitted_on = {std::to_string(6.0)};
  return flow;
}

}  // namespace drumlin::testing
