#pragma once
// Memory of the axes of stress: the turn of what the material commits to memory, and the amount of the
// stress.
//
//   s = p mu(I) (n + m A)/rho,  v.grad A + 2 i W A = 2 c |D| (exp(i t chi(I)) n - A),
//   v.grad rho = 2 c_rho |D| (|n + m A| - rho),
//
// with traceless tensors as complex numbers xx + i xz, n = D/|D|, W the spin in the sense of dv_x/dz, and t
// the side to which the material turns (docs/theory/rheology.md). With AmountMemory the target amount is
// mu(I) + psi - lag (axes_lag) + creep, where psi, the dilatancy, follows from what I was:
//
//   v.grad L = 2 c_nu |D| (ln I - L),   v.grad psi = 2 c_psi |D| (swelling c_nu (ln I - L) - psi),
//   creep = slope ln(|D|/(ratio |W|)), at most 0.
#include <complex>

#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin {

/// 2|D|/sqrt(p + own weight) at |D| > 0 and p > 0: the I of everything here.
double inertial_number(const MemoryLaw& law, double rate, double p);

/// chi(I) in rad at I > 0: chi_deg up to I_low, atan(1/c) from I_high on, a cubic in ln I between, without a
/// kink. In steady simple shear A = exp(i t (chi - atan(1/c))) cos(atan(1/c)) n, so that chi = atan(1/c) is
/// mu(I) exactly there.
double memory_turn(const MemoryLaw& law, double I);
/// The same of a law by its numbers, chi in rad.
double memory_turn(double chi, double c, double I_low, double I_high, double ln_I);

/// ln I as the amount remembers it: within the ends of the law's table, beyond which no point was measured.
double remembered_ln_I(const MemoryLaw& law, double I);

/// Rate of change of ln nu per 2|D|, with the sign of div v, of a material whose I is exp(ln_I) now and whose
/// volume fraction is that of the I exp(`carried`): what the dilatancy tends to.
double dilatancy_target(const AmountMemory& law, double ln_I, double carried);

/// t Im(A conj(n)), the lag of the remembered axes, less what steady simple shear has at this I.
double axes_lag(const MemoryLaw& law, double turn, std::complex<double> n, std::complex<double> A, double I);

/// What the past adds to mu, psi - lag (axes_lag), within half of mu. 0 in steady simple shear.
double added_friction(const AmountMemory& law, double mu, double dilatancy, double axes_lag);

/// What creep adds to mu where the material shears at |D| and turns at W, both in the same unit: 0 or less.
double creep_friction(const Creep& creep, double rate, double spin);

/// A slope of what the past adds by ln I, half of what dilatancy could follow at most where I changes over a
/// short way: a solver that takes it into mu(I), and out of what it holds, does not swing.
double followed_slope(const AmountMemory& law);

/// What evaluates mu(I) of the memory. With an own weight it goes on straight in I (da Cruz et al., Phys.
/// Rev. E 72, 021309 (2005), for discs) where the table ends, else straight in ln I.
TabulatedLaw memory_friction(const MemoryLaw& law);

}  // namespace drumlin
