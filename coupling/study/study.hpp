#pragma once
// Several measured runs together: laws over the speed of rotation, and the paper's table with verdicts.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coupling/study/collapse.hpp"
#include "coupling/study/paper_verdicts.hpp"
#include "coupling/study/speed_laws.hpp"
#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {

/// Whether the numbers of one speed belong together, ours and the paper's.
struct ConsistencyRow {
  double rotation_rpm = 0;
  Scalar Q, H, shear_rate, shear_rate_laboratory, layer_balance, H_over_sqrt_Q;
  double Q_expected = 0;
  // Of the paper, NaN at other speeds than its six. Its shear rate is the stated one at 6 rpm, else that of
  // its own law at its own slope.
  double paper_Q = 0, paper_H = 0, paper_shear_rate = 0, paper_layer_balance = 0, paper_H_over_sqrt_Q = 0;
};

struct Study {
  std::vector<StudyRun> runs;  ///< with the scalars of with_derived
  std::vector<SpeedGroup> speeds;
  std::vector<SpeedLaw> laws;
  std::vector<SpeedTrend> trends;  ///< of every quantity that a speed has
  std::optional<FrictionCollapse> friction;
  std::vector<Collapse> collapses;  ///< of mu, k and nu
  std::vector<ConsistencyRow> consistency;
  std::vector<PaperVerdict> paper;  ///< empty when the drum is not the paper's
  std::vector<std::string> warnings;
};

/// Throws InputError where the runs do not belong together (require_one_study) or the files of the paper
/// (`paper_folder`, data/paper) cannot be read.
Study study_of(std::vector<StudyRun> runs, const std::filesystem::path& paper_folder);

/// What the study holds against an entry of the paper; NaN where it has nothing.
Finding finding_for(const PaperEntry& entry, const Study& study);

}  // namespace drumlin::coupling
