#pragma once
// Particles and continuum over the speed of rotation: a law calibrated at one speed and asked for the others.
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/paper_table.hpp"
#include "coupling/study/speed_laws.hpp"
#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {

/// What `drumlin flow` left of one speed.
struct StudyFlow {
  std::string name;
  double rotation_rpm = 0;
  ComparedSide side;
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();
  std::string start;  ///< "cold", or what it started from
  /// What must be the same in all flows of a study, as text: the law, the effects, the drum.
  std::map<std::string, std::string> identity;
  /// What may differ, but is worth a word: mesh, regularisation.
  std::map<std::string, std::string> numerics;
  std::vector<std::string> fitted_on;      ///< runs that the law was calibrated on
  std::vector<std::string> accepted = {};  ///< edits by hand (accepted_edits of coupling/common)
};

/// What a speed can say of the law. `unknown`: the law was fitted on none of the runs of this study.
enum class SpeedRole { calibrated, predicted, unknown, particles_only, continuum_only };

/// A result at one speed on all three sides; NaN where a side does not have it.
struct SpeedScalar {
  Scalar paper;
  Scalar particles;      ///< pooled over the runs of the speed
  double continuum = 0;  ///< mean of what it shows at the places of each run
  /// What the law's calibration leaves open in it (99 %), the same for all runs; NaN where the flow does not
  /// say.
  double continuum_ci99 = std::numeric_limits<double>::quiet_NaN();
};

struct ComparedSpeed {
  double rotation_rpm = 0;
  SpeedRole role = SpeedRole::unknown;
  std::vector<std::string> particles;  ///< runs
  std::string continuum;               ///< empty where there is none
  std::vector<SpeedScalar> scalars;
  /// Fields: means over the runs of the errors; scalars: against the pooled ones. Empty where a side is
  /// missing.
  std::vector<Target> targets;
  double particle_seconds = 0;   ///< processor time of one run, mean of the runs; NaN where unknown
  double continuum_seconds = 0;  ///< processor time
  std::string start;             ///< of the continuum
};

struct SpeedComparison {
  std::vector<ComparedSpeed> speeds;  ///< ascending
  std::vector<SpeedLaw>
      particles_laws;  ///< speed_laws of the pooled particles, without those of the centre of mass
  std::vector<SpeedLaw> continuum_laws;  ///< of the continuum; no intervals
  std::vector<SpeedLaw> paper_laws;      ///< of the same names; empty for another drum than the paper's
  std::vector<std::string> fitted_on;    ///< runs of the law
  std::vector<std::string> warnings;
};

/// Each continuum flow against every particle run of its speed (to 0.5 %), each registered by the drum's
/// axis. Throws InputError, every reason at once, where the runs do not belong together: require_one_study on
/// the particles, two flows at one speed, other laws or effects, another drum, one side empty. A speed that
/// one side lacks is kept and warned of. `paper_folder` is data/paper.
SpeedComparison compared_speeds(const std::vector<StudyRun>& particles, const std::vector<StudyFlow>& flows,
                                const std::filesystem::path& paper_folder);

/// The scalars that stand in ComparedSpeed::scalars, in this order.
const std::vector<std::string>& compared_speed_scalars();

}  // namespace drumlin::coupling
