#pragma once
// From the maps of runs to the law of memory: the amount of the stress over I, the coefficients of its axes,
// and what the runs cannot tell of them.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/calibration/amount_memory.hpp"
#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/calibration/memory_fit.hpp"
#include "coupling/calibration/run_evidence.hpp"

namespace drumlin::coupling {

/// A range of I over which chi falls from its value in the bed to atan(1/c), and the least cost with it.
struct LeadTrial {
  double I_low = 0, I_high = 0, cost = 0;
};

/// A rate at which rho is carried, the fit with it, and whether the runs tell it from rho at once: its cost
/// lies further off than its 99 % interval by leaving out sectors.
struct CarriedRhoTrial {
  MemoryFit fit;  ///< fit.law.c_rho absent: at once
  bool told_apart = false;
};

/// mu along the strain rate and div v/(2|D|), upstream (x < 0) and downstream, over a range of I; means over
/// the blocks of all runs, NaN without any.
struct DilationShare {
  struct Half {
    std::size_t points = 0;
    double mu = 0, dilatancy = 0;
  };
  double I_from = 0, I_to = 0;
  Half upstream, downstream;
  /// Difference of mu over difference of dilatancy; 1 would be Taylor's stress-dilatancy.
  double slope() const;
};

struct MemoryCalibration {
  CalibratedLaw amount;                    ///< |s|/p over I, a table
  std::optional<RobustFriction> bed_line;  ///< a + b ln I through the amounts below bed_I; absent: too few
  std::vector<LeadTrial> leads;
  MemoryFit free;       ///< c, m, chi; rho at once
  MemoryFit bed_alone;  ///< the same over paths that end in the bed alone, with chi at every I
  MemoryFit bounded;    ///< the same with m at most 1
  std::vector<CarriedRhoTrial> carried;          ///< the first: at once
  AxisMemory law;                                ///< what a flow can solve: m at most 1, rho carried
  std::vector<MemoryScore> scores, predictions;  ///< per run of the fit, per run held out
  std::vector<AxesOnArc> arcs;                   ///< of the runs of the fit
  std::vector<DilationShare> dilation;
  std::vector<double>
      from_displacements;               ///< share of each run's nodes whose motion is that of displacements
  std::vector<std::string> untold;      ///< what the runs cannot tell, as sentences
  std::optional<AmountFit> remembered;  ///< where the amount remembers too: in place of `amount`
};

/// The amount |s|/p over I, a table, of the blocks for it. Throws InputError with fewer than 24 of them.
CalibratedLaw amount_law(std::span<const RunEvidence> runs, int draws);

/// `runs`, `held_out`: with their maps; `amount`: of `runs`. Nothing of what is held out enters but
/// `predictions`. Throws InputError where a map lacks a field, has no drum, or where the runs have too little
/// bed: fewer than 100 paths that end in it, or in fewer than five sectors of 15 deg. `own_weight`: what
/// is added to the amount is fitted as well, after the axes, all with this AmountMemory::own_weight.
MemoryCalibration memory_calibration(std::span<const RunEvidence> runs, std::span<const RunEvidence> held_out,
                                     const CalibratedLaw& amount, std::optional<double> own_weight = {});

/// The law as it crosses to the continuum: the amount as its table.
MemoryLaw measured_memory(const MemoryCalibration& found);

}  // namespace drumlin::coupling
