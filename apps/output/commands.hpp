#pragma once
// The commands of `drumlin`: what the command line fills in and the function that does it. Each throws the
// errors of coupling/core/basics/errors.hpp; drumlin.cpp turns them into exit codes.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/output/existing_output.hpp"
#include "apps/output/plot_options.hpp"

namespace drumlin::particles {
class World;
}

namespace drumlin::apps {

/// Of --threads: more than any machine that this program was made for, and few enough that all can be
/// started.
inline constexpr int most_threads = 256;
/// Processors that this process may use, most_threads at most.
int processors_at_hand();

struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path output;
  std::vector<std::string> overrides;  ///< "key=value"
  int threads = processors_at_hand();
  std::optional<std::filesystem::path>
      accuracy;  ///< COST of the scene; absent: a shipped record, if there is one
  ExistingOutput existing = ExistingOutput::refuse;
  double accuracy_seconds = 0;  ///< simulated, of the stretches that tell errors at the end; 0: none
  double extend_seconds = 0;    ///< simulated, by which the finished run in `output` goes on; 0: none
  std::optional<int> ranks;     ///< MPI ranks that take the steps; absent: this process alone
};
/// `world`: ranks that follow this one; none: this process alone.
int run(const RunOptions&, particles::World* world = nullptr);
/// Starts `drumlin-run`, which stands beside the running executable, by mpirun with the same words; returns
/// the exit code of the job.
int run_by_mpirun(const RunOptions&);

struct MeasureOptions {
  std::filesystem::path run;
  double slice_width = 20;            ///< d
  double layer_thickness = 1;         ///< d
  double position = 0;                ///< x of the slice, d
  std::vector<std::string> parts;     ///< beside the profiles; empty: all, "none": none (measure/part.hpp)
  double gradient_step = 5;           ///< d
  std::vector<double> slices;         ///< positions of the narrow slices, d; empty: spread over the surface
  double map_spacing = 1;             ///< d, of the nodes of the maps
  double map_width = 1;               ///< d, of their kernel
  std::vector<std::string> radial;    ///< centre of rings: "axis", or x and z in d; empty: none
  std::vector<double> height, width;  ///< x0, x1 of a profile over the height; z0, z1 of one over the width
  std::string grains;  ///< snapshots whose grains get their fields written, a list as in export; empty: none
  std::optional<std::filesystem::path>
      accuracy;          ///< COST of the scene; absent: a shipped record, if there is one
  bool verbose = false;  ///< prints every number
  ExistingOutput existing = ExistingOutput::refuse;
};
int measure(const MeasureOptions&);

struct StudyOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path output;
  ExistingOutput existing = ExistingOutput::refuse;
};
/// `drumlin measure --study`: several measured runs together.
int study(const StudyOptions&);

struct ImportOptions {
  std::optional<std::filesystem::path> description;
  std::optional<std::filesystem::path> output;
  std::vector<std::string> overrides;
  bool keys = false;      ///< lists the keys of a description; nothing else
  bool markdown = false;  ///< keys as a Markdown table
  ExistingOutput existing = ExistingOutput::refuse;
};
/// Makes a run folder of the snapshots of another program.
int import_foreign(const ImportOptions&);

int plot(const PlotOptions&);

struct ReportOptions {
  std::filesystem::path run;
  std::optional<std::filesystem::path> output;  ///< standard: RUN/report
  std::optional<std::filesystem::path> bundle;  ///< in place of a page: what a report of a fault needs
  ExistingOutput existing = ExistingOutput::refuse;
};
/// One page of a run: what was simulated, how exactly, what was measured, pictures, a player, costs.
int report(const ReportOptions&);

struct ExportOptions {
  std::filesystem::path run;
  std::optional<std::filesystem::path> output;  ///< standard: RUN/vtu
  bool vtu = false;
  std::string snapshots = "all";  ///< "all", "last", or "1,5,10-20"
  ExistingOutput existing = ExistingOutput::refuse;
  bool measurements = false;  ///< what was measured, small, in place of VTK files; `output` has to be given
};
int export_run(const ExportOptions&);
/// A measured run without snapshots and figures, its maps packed: what readers of measurements take in the
/// place of the run.
int export_measurements(const ExportOptions&);

struct HistoryOptions {
  std::filesystem::path run;
  std::optional<std::filesystem::path> output;  ///< standard: RUN/history
  std::vector<double> box;  ///< x_min, x_max, z_min, z_max in d, laboratory axes; empty: walls alone
  int sectors = 36;         ///< of a circular container
  ExistingOutput existing = ExistingOutput::refuse;
};
/// Stress, fabric and strain of a region, forces on walls and angle of the surface, snapshot by snapshot.
int history(const HistoryOptions&);

struct CalibrateOptions {
  std::vector<std::filesystem::path> runs;
  std::vector<std::filesystem::path> validate;  ///< runs that the law is not fitted on but has to predict
  std::filesystem::path output;
  std::string from = "auto";  ///< maps, profiles; auto: maps where all runs are drums and have them
  std::string law = "auto";   ///< log, log-linear, table; auto: table where there are points enough, else log
  std::optional<double> I_min;  ///< absent: 1e-4 of profiles, 3e-5 of maps
  std::optional<double> I_max;  ///< absent: 1e-1 of a drum's profiles, 1 of maps and of layers
  int draws = 200;
  bool k = false;
  bool misalignment = false;
  bool memory = false;
  bool accept_unsteady = false;
  ExistingOutput existing = ExistingOutput::refuse;
  bool nonlocal = false;
  bool amount = false;
  double own_weight = 0;  ///< rho0 g d
};
int calibrate(const CalibrateOptions&);

struct FlowOptions {
  std::filesystem::path scene;
  std::filesystem::path rheology;
  std::filesystem::path output;
  std::optional<std::filesystem::path> from;  ///< FLOWRUN to start from; absent: cold
  std::vector<std::string> overrides;
  int law_draws = 0;  ///< laws of other draws that are solved as well, for the band of the law
  ExistingOutput existing = ExistingOutput::refuse;
};
/// Starts `drumlin-flow`, which stands beside the running executable, with the same words; returns its exit
/// code.
int flow(const FlowOptions&);

struct CompareOptions {
  std::filesystem::path run;       ///< RUN or FLOWRUN
  std::filesystem::path flow_run;  ///< FLOWRUN or RUN
  std::filesystem::path output;
  std::optional<std::filesystem::path> floor;   ///< another RUN of the first one's drum: the noise floor
  std::optional<std::filesystem::path> beside;  ///< another FLOWRUN of the drum, judged beside the second
  std::string registration = "axis";            ///< or "surface"
  bool accept_unsteady = false;
  ExistingOutput existing = ExistingOutput::refuse;
};
int compare(const CompareOptions&);

struct CompareStudyOptions {
  std::vector<std::filesystem::path> folders;   ///< measured runs and continuum flows, in any order
  std::optional<std::filesystem::path> limits;  ///< limits by which each flow is judged beside; absent: none
  std::filesystem::path output;
  ExistingOutput existing = ExistingOutput::refuse;
};
/// `drumlin compare --study`: both sides over the speed of rotation.
int compare_study(const CompareStudyOptions&);

struct ScoreOptions {
  std::filesystem::path fields;                ///< FLOWRUN, or a file of profiles, maps or fields
  std::filesystem::path limits;                ///< by which they are judged
  std::vector<std::filesystem::path> against;  ///< measured runs; empty: those of data/bed at that speed
  std::filesystem::path output;
  ExistingOutput existing = ExistingOutput::refuse;
};
/// Errors of one continuum against runs, each beside its limit and noise floor.
int score(const ScoreOptions&);

enum class SceneAction { check, show, keys, list };
struct SceneOptions {
  SceneAction action = SceneAction::check;
  std::filesystem::path scene;  ///< unused for keys and list
  bool markdown = false;        ///< keys as a Markdown table
  std::vector<std::string> overrides;
};
int scene(const SceneOptions&);

/// Kinds of scenes to start from, data/templates.
constexpr std::array<const char*, 4> scene_kinds{"drum", "shear", "chute", "silo"};
struct NewSceneOptions {
  std::string kind;
  std::filesystem::path output;
  ExistingOutput existing = ExistingOutput::refuse;
};
/// Writes a commented scene to start from.
int new_scene(const NewSceneOptions&);

struct SolveContactsOptions {
  std::filesystem::path problem;
  std::string solver = "accelerated";
  double tolerance = 1e-4;
  double max_seconds = 60;
  int threads = 1;
  bool backward_error = false;  ///< which problem the solution solves exactly
  std::optional<int> watch;     ///< further plain sweeps in which changes of state are counted
  std::optional<std::filesystem::path> output;
  ExistingOutput existing = ExistingOutput::refuse;
  bool json = false;
};
int solve_contacts(const SolveContactsOptions&);

struct CostOptions {
  std::filesystem::path scene;  ///< of particles or of a flow
  bool effects = false;         ///< the price list of the scene's effects, in place of a sweep
  std::optional<std::filesystem::path> output;  ///< a sweep needs it
  std::vector<std::string> overrides;
  double seconds = 1;               ///< of --effects, simulated, from the start of the scene
  std::vector<std::string> sweep;   ///< "tolerance" or "tolerance=1e-2:1e-3"; empty: all that the scene has
  std::optional<double> horizon_s;  ///< over which velocities are compared; absent: 16 steps of the scene
  std::optional<double> statistics_s;             ///< length of a run whose measured numbers are compared
  std::optional<std::filesystem::path> from;      ///< RUN to start from, of the same scene
  std::optional<std::filesystem::path> rheology;  ///< of a flow scene, which needs one
  std::vector<int> ranks = {1};                   ///< flows: numbers of MPI processes on which each is solved
  std::vector<std::string> neighbour;  ///< flows: changes that make the neighbour to start from; empty: none
  int repeats = 1;                     ///< flows: solves of each, of which least and median time are kept
  std::optional<double> time_limit_s;  ///< flows: after which one is given up
  std::vector<std::string> variants;   ///< of --effects, flows: "inertia+k"; empty: each effect alone
  std::vector<std::filesystem::path> against;  ///< of --effects, flows: measured runs to be compared with
  int threads = 1;
  ExistingOutput existing = ExistingOutput::refuse;
};
int cost(const CostOptions&);

}  // namespace drumlin::apps
