#pragma once
// Rate at which the material renews the turn of its stress: an estimate for effects.fabric.relaxation.
#include <vector>

#include "coupling/calibration/friction_form.hpp"
#include "coupling/calibration/law_points.hpp"
#include "coupling/exchange/field_map.hpp"

namespace drumlin::coupling {

/// u.grad N = c 2|D| (N_ss(I) - N), N the turn of the stress, u the velocity in the laboratory: least squares
/// of the left side on what c multiplies, over the blocks of a map that have neighbours on all sides.
struct FabricRelaxation {
  double c = 0;
  double ci99 = 0;       ///< half width, by leaving out one column of blocks at a time
  double explained = 0;  ///< share of the squares of the left side that c explains; may be negative
  std::size_t points = 0;
};

/// Noise of N is in both sides with opposite signs, and makes c too large where it rules; noise of N_ss - N
/// makes it too small. Only blocks with I above `I_min`, where the turn stands clear of its error. NaN with
/// fewer than 10 blocks. `turn` is N_ss over 2|D|/sqrt(p), `map` as in law_points(), with v_x, v_z and the
/// header's rotation.
FabricRelaxation fabric_relaxation(const FieldMap& map, const FormCurve& turn,
                                   const BlockSelection& selection = {}, double I_min = 1e-3);

}  // namespace drumlin::coupling
