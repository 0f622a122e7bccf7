#pragma once
// What past strain adds to the amount of the stress, fitted along the paths of the material: its dilatancy,
// and the lag of its axes (docs/theory/dilatancy.md).
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/calibration/memory_fit.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::coupling {

enum : std::size_t { amount_swelling, amount_lag, amount_creep };  ///< places of the coefficients in arrays

/// A pair of rates at which volume fraction and dilatancy follow, a ratio below which creep counts, and what
/// the fit leaves of |s|/p.
struct AmountTrial {
  double c_nu = 0, c_psi = 0, creep_ratio = 0, rms = 0;
};

/// What is left of |s|/p of a run: root mean squares over its paths, by mu(I) alone and with its memory.
struct AmountScore {
  std::string run;
  double bed = 0, flow = 0, bed_alone = 0, flow_alone = 0;  ///< .._alone: mu(I) of the law without memory
};

/// The same with the dilatancy that the particles show in place of the law's: |s|/p = mu(I) + coefficient Q -
/// lag axes_lag + creep, v.grad Q = 2 c_psi |D| (div v/(2|D|) - Q), at the ratio of creep that fits the law
/// best. Taylor's coefficient is one.
struct StressDilatancy {
  double c_psi = 0, coefficient = 0, coefficient_ci99 = 0, lag = 0, rms = 0;
};

struct AmountFit {
  AmountMemory law;
  CalibratedLaw table;                 ///< |s|/p over I less what the past adds: mu(I) of steady simple shear
  std::array<double, 3> ci99_sectors;  ///< of swelling, lag and creep, over the sectors of the drum
  std::vector<AmountTrial> trials;
  std::optional<StressDilatancy> measured;  ///< no part of the law, its check; none where nothing dilates
  std::vector<AmountScore> scores, predictions;  ///< per run of the fit, per run held out
};

/// psi - lag axes_lag + creep at the end of a path, what is added to mu(I) there; `law`: with an amount. t
/// = 1.
double added_amount(const StressPath& path, const MemoryLaw& law);

/// Least squares of |s|/p over all paths: the knots of a table of mu(I) that grows, swelling, lag and the
/// slope of creep, for each c_nu = 2, 3, 4, 6, 8, c_psi = 8, 12, 16, 24, 32 above it and ratio of creep =
/// 0.02, 0.035, 0.05, 0.07, 0.1, of which the best are taken; then the table once more, robustly, over what
/// is left. `axes`: the law of the axes, `alone`: its mu(I) without memory, whose knots are kept but for
/// those inside where creep counts (one speed cannot tell I from |D|/|W|) and those in the flow, which are
/// octaves down from the largest I. `own_weight`: that of the paths' I. Nothing of `held_out` enters but the
/// predictions. Throws InputError where the paths do not determine it.
AmountFit fit_amount(std::span<const PathsOfRun> runs, std::span<const PathsOfRun> held_out, MemoryLaw axes,
                     const CalibratedLaw& alone, double own_weight = 0);

}  // namespace drumlin::coupling
