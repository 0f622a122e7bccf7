#pragma once
// The law that crosses from the particles to the continuum: friction, k(I), memory, and where they come from.
#include <optional>
#include <string>
#include <vector>

#include "coupling/core/law/friction_law.hpp"

namespace drumlin {

/// k(I) = sigma_xx/sigma_zz as a table, smooth in ln I between its points and constant outside; absent: no k
/// in the law.
struct NormalStressRatio {
  std::vector<double> I;  ///< ascending
  std::vector<double> k;
};

/// Where the material is sheared little while it turns, the amount depends on how little, whatever the speed
/// (docs/theory/dilatancy.md): below a ratio |D|/|W| it falls.
struct Creep {
  double slope = 0;  ///< per ln(|D|/|W|), > 0
  double ratio = 0;  ///< |D|/|W| below which it does, 0 to 1; |D|/|W| is one in simple shear
};

/// What is added to the amount of the stress (docs/theory/dilatancy.md), besides creep by the past of the
/// material: its volume fraction follows that of its I, and it resists more while it swells.
struct AmountMemory {
  double swelling = 0;  ///< beta: by how much ln nu falls per ln I in steady shear, > 0
  double c_nu = 0;      ///< share of nu's way to that value that is made per unit of shear, > 0
  double c_psi = 0;     ///< share of the dilatancy that is felt which is renewed per unit of shear, > 0
  double lag = 0;       ///< by how much the amount falls per lag of the axes, see axes_lag()
  std::optional<Creep> creep = {};  ///< absent: the amount falls with I alone
  /// w in I = 2|D|/sqrt(p + w), rho0 g d, of the amount and the axes: near a free surface grains rearrange by
  /// their own weight, too.
  double own_weight = 0;
};

/// Memory of the axes (coupling/core/law/memory_law.hpp): the material carries the axes of its past strain
/// along, and they share in those of its stress. Its amount follows I, as `mu` here says, and what `amount`
/// adds.
struct MemoryLaw {
  double c = 0;        ///< share of the memory that is renewed per unit of shear, > 0
  double m = 0;        ///< weight of the memory against the strain rate, 0 to 1
  double chi_deg = 0;  ///< by how much new memory is turned against the strain rate below I_low
  double c_rho = 0;    ///< share of the normalisation that is renewed per unit of shear, > 0
  double I_low = 1e-3;
  double I_high = 1e-2;  ///< from here on the turn is atan(1/c): the stress of simple shear lies along D
  FrictionTable mu;      ///< |s|/p, s the deviator of the stress; not tau:D/(2|D|p)
  std::optional<AmountMemory> amount = {};  ///< absent: the amount is that of mu alone
};

/// Where flow stops and over what length it spreads beyond (docs/theory/rheology.md, nonlocal fluidity with a
/// threshold): xi = amplitude d/sqrt|mu - mu_s|.
struct NonlocalLength {
  double amplitude = 0;                                       ///< A
  double mu_s = 0;                                            ///< of the local law for I -> 0
  std::optional<double> amplitude_ci99 = {}, mu_s_ci99 = {};  ///< half widths of 99 % intervals
};

/// A law and the state it was measured in.
struct RheologyFit {
  FrictionLaw mu;
  std::optional<NormalStressRatio> k;
  std::optional<MemoryLaw> memory;         ///< absent: the law has none
  std::optional<NonlocalLength> nonlocal;  ///< absent: the law has none
  double nu = 0;                           ///< volume fraction of the bulk
  std::optional<double> nu_ci99;
  std::optional<double> rms_misfit;    ///< of mu about the fit
  std::vector<FrictionLaw> draws;      ///< laws of the same form that other draws of the points gave
  std::vector<std::string> fitted_on;  ///< runs
  bool reduced = false;                ///< fitted on a reduced (smoke) run
};

}  // namespace drumlin
