#pragma once
// Measured runs and computed flows, read from their folders and checked: all faults of a folder are reported
// at once, before any number of it is used.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin {

/// What `drumlin run` and `drumlin measure` left of particles.
struct MeasuredRun {
  std::string name;  ///< of the folder, also for "." or a path that ends in "/"
  std::filesystem::path folder;
  ProfileSet profiles;
  std::map<double, ProfileSet> slices;  ///< narrow slices by their position x, where they were measured
  ScalarSet scalars;
  Scales scales;
  bool reduced = false;
  std::vector<std::string> unsteady;  ///< reasons, of a run that was accepted all the same; empty: steady
  ResultFolder files = {}, measured_files = {};  ///< RUN and RUN/measured, for what else is read of them
  std::vector<std::string> accepted = {};        ///< edits by hand (accepted_edits)
};

/// What to do with a run that its own measurement does not call steady.
enum class Unsteady { refuse, accept };

/// Throws InputError with every fault (file, key, value, what is allowed): no folder, not measured, files of
/// another version, an unfinished run, one that is not steady, headers without the side "particles" or
/// without the finite numbers that place the frame (theta_deg, rotation, drum_radius, diameter_m, position;
/// in a drum axis_depth and wall_z), headers that disagree with measured.json or with each other in units,
/// frame or speed, layers inside the packing without numbers, "reduced" on one file and not on the other,
/// files that are not as the manifests of RUN and RUN/measured say, a RUN that has changed since it was
/// measured. A folder without run.json (as cut out of a run) is taken for finished, one without log.csv and
/// snapshots needs no manifest.
MeasuredRun read_measured_run(const std::filesystem::path& folder, Unsteady unsteady = Unsteady::refuse);

/// What `drumlin flow` left.
struct FlowRun {
  std::string name;
  std::filesystem::path folder;
  ProfileSet profiles;
  ScalarSet scalars;
  Scales scales;
  bool reduced = false;
  ResultFolder files = {};
  std::vector<std::string> accepted = {};
};

/// Which flows are read. A flow across a gap has no drum, and between plates no slope: its header then says
/// 0.
enum class FlowGeometry { drum, any };

/// As above, of a FLOWRUN: also refused are a flow that was not finished (no flow.json) or misses limits,
/// profiles of another side than "continuum", and unless `any` is asked for a flow that is no drum. A folder
/// without state.h5 (as cut out of a FLOWRUN) needs no manifest.
FlowRun read_flow_run(const std::filesystem::path& folder, FlowGeometry geometry = FlowGeometry::drum);

/// What a flow misses of what its equations ask (key "missed" of its flow.json), a sentence each.
std::vector<std::string> limits_missed_by(const std::filesystem::path& flow_run);

/// The files of a FLOWRUN, to be read by checked_file(). Throws InputError if it is not finished or not as
/// its manifest says.
ResultFolder open_flow_run(const std::filesystem::path& folder);

/// Whether a folder is (or claims to be) a FLOWRUN: it holds flow.json or flow_scene.toml.
bool is_flow_run(const std::filesystem::path& folder);

/// Throws InputError unless the runs are all reduced or all full, and measured in the same units (d, g, rho0
/// to 1e-3). Dimensionless numbers of other grains can be set side by side only by somebody who means to.
void require_same_units(const std::vector<MeasuredRun>& runs);

/// Name of a run's folder, also for "." or a path that ends in "/".
std::string name_of_folder(const std::filesystem::path& folder);

}  // namespace drumlin
