#pragma once
// Memory of the axes of stress: the turn of what the material commits to memory, and the amount of the
// stress.
//
//   s = p mu(I) (n + m A)/rho,  v.grad A + 2 i W A = 2 c |D| (exp(i t chi(I)) n - A),
//   v.grad rho = 2 c_rho |D| (|n + m A| - rho),
//
// with traceless tensors as complex numbers xx + i xz, n = D/|D|, W the spin in the sense of dv_x/dz, and t
// the side to which the material turns (docs/theory/rheology.md).
#include "coupling/law/friction_law.hpp"

namespace drumlin {

/// chi(I) in rad at I > 0: chi_deg up to I_low, atan(1/c) from I_high on, a cubic in ln I between, without a
/// kink. In steady simple shear A = exp(i t (chi - atan(1/c))) cos(atan(1/c)) n, so that chi = atan(1/c) is
/// mu(I) exactly there.
double memory_turn(const MemoryLaw& law, double I);
/// The same of a law by its numbers, chi in rad.
double memory_turn(double chi, double c, double I_low, double I_high, double ln_I);

/// What evaluates mu(I) of the memory.
TabulatedLaw memory_friction(const MemoryLaw& law);

}  // namespace drumlin
