#pragma once
// Every number and statement of the paper (data/paper) against what the study found.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::coupling {

/// What the paper says of one quantity.
struct PaperEntry {
  enum class Expects { value, zero, not_zero, positive, collapse, no_collapse };
  std::string quantity;
  std::optional<double> rotation_rpm;  ///< absent: holds for every speed
  Expects expects = Expects::value;
  double value = 0;  ///< x downslope, whatever the paper's axis
  std::optional<double> half_width;
  std::string source;
  std::string remark;
};

/// Table I (18 entries), the observables that no law repeats, the coefficients of the laws as
/// LAW.COEFFICIENT, the claims. `folder` is data/paper; throws InputError on its files.
std::vector<PaperEntry> paper_entries_of(const std::filesystem::path& folder);

/// What stands against an entry.
struct Finding {
  Scalar ours;       ///< NaN where it was not measured
  double scale = 1;  ///< what "zero" is small against
  double limit = 1;  ///< of the ratio, for a collapse
};

/// open: an interval so wide that what lies within it says little. imposed: the fill and the speed give the
/// number, whatever the grains do.
enum class Verdict { agrees, open, near, differs, imposed, not_measured };

/// Why a verdict is what it is.
enum class Reason {
  inside_interval,
  inside_wide_interval,
  within_ten_percent,
  outside,
  unresolved,
  given_by_the_scene,
  absent
};

struct PaperVerdict {
  PaperEntry entry;
  Finding finding;
  Verdict verdict = Verdict::not_measured;
  Reason reason = Reason::absent;
};

/// A value agrees when it lies within our interval plus the paper's stated half width, is near within 10 % of
/// it, else differs. Zero agrees when our interval holds it, is near when we stay below 10 % of the scale.
/// Not zero and positive agree when our interval excludes the opposite and differ when it shows the opposite;
/// an interval that leaves both open is called near, reason unresolved. A collapse agrees up to its limit, is
/// near up to twice it; a missing collapse agrees above the limit and differs below. An interval above 25 %
/// of the paper's value (of the scale) that holds it leaves the verdict open. Q is imposed: a drum that is
/// filled so far and turns so fast has no other.
PaperVerdict verdict_on(const PaperEntry& entry, const Finding& finding);

}  // namespace drumlin::coupling
