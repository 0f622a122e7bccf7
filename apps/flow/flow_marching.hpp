#pragma once
// Files and messages of a march in time: its start, series.csv, checkpoint.h5.
#include "apps/flow/finished_flow.hpp"
#include "apps/flow/flow_options.hpp"
#include "apps/output/output_folder.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/io/flow_state_file.hpp"
#include "continuum/time_stepping/drum_march.hpp"

namespace drumlin::apps {

/// A march of the scene, and the texts by which its checkpoints know scene and law.
struct FlowMarching {
  continuum::DrumMarch march;
  std::string scene_text, law_text;
  std::string passed_over = {};  ///< why the newest checkpoint was not taken; empty: it was, or there is none
};

/// Begins at the checkpoint of an interrupted march (`resume`), at the flow of another run, or at rest.
/// Throws InputError for a checkpoint of another scene or law, and for a flow that is no drum's.
FlowMarching read_marching(const FlowOptions& options, const FlowRequest& asked);

/// Marches to the end; after every time.every steps the first rank leaves series.csv and checkpoint.h5 in
/// `output`, which is null on the others. Collective. Throws IoError.
continuum::FlowSolution march_scene(const FlowMarching& marching, GrowingOutput* output,
                                    const continuum::FemRuntime& runtime);

}  // namespace drumlin::apps
