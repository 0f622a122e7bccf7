#pragma once
// Anisotropy of contacts and of their forces: Rothenburg & Bathurst, Geotechnique 39 (1989) 601.
#include <array>
#include <complex>
#include <cstddef>

#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/forces/contact_forces.hpp"

namespace drumlin::particles {

/// Sums over contacts between grains, whole and by direction of the normal: bin b holds the directions from
/// b to b + 1 times pi/bins.
struct DirectionSums {
  static constexpr std::size_t bins = 18;
  std::array<double, bins> count{}, normal{}, tangential{};
  double contacts = 0, normal_sum = 0, tangential_size = 0;  ///< number, sums of f_n and |f_t|
  std::array<std::complex<double>, 3> turned{};  ///< sums of exp(2 i phi), exp(4 i phi), exp(6 i phi)
  double pressure = 0;                           ///< sum of f_n l / 2, l the branch: p times the area
  std::complex<double> shear{};                  ///< sum of (f_x n_x - f_z n_z + i (f_x n_z + f_z n_x)) l / 2

  /// Counts a contact with its forces multiplied by `weight`.
  void add(const ContactForce& contact, double weight);
  DirectionSums& operator+=(const DirectionSums& other);
  DirectionSums& operator-=(const DirectionSums& other);
};

/// Harmonics as complex numbers a exp(2 i phi_0), which stands for a cos 2(phi - phi_0):
/// E(phi) = (1 + a_c cos 2(phi - phi_c))/(2 pi), <f_n>(phi) = f_0 (1 + a_n cos 2(phi - phi_n)),
/// <f_t>(phi) = f_0 a_t sin 2(phi - phi_t), f_t along the normal turned clockwise: the force leans towards
/// phi_t. NaN where a direction holds no contact.
struct ForceAnisotropy {
  std::complex<double> contacts, normal, tangential;
  std::complex<double> contacts_fourth, contacts_sixth;  ///< a exp(4 i phi_0), a exp(6 i phi_0)
  std::complex<double>
      stress;              ///< |tau|/p of the contacts' own stress, phi_0 = direction of greatest pressure
  double mean_normal = 0;  ///< f_0: mean over directions, not over contacts
};
ForceAnisotropy force_anisotropy(const DirectionSums& sums);

/// |tau|/p that the harmonics carry: the mean of E f over all directions. With C, N, T for the second ones
/// and F for the fourth one of E: |C + N + T + F (N* - T*)/2| / (2 + Re(C N*)). The source stops at (a_c +
/// a_n + a_t)/2; among discs of almost one size F is as large as C. Left out: higher harmonics of the forces,
/// and a correlation of force and branch length.
double stress_ratio_of(const ForceAnisotropy& anisotropy);

/// Under the names of docs/formats/measured.md: contacts, f_n, f_t, fabric_xx, fabric_zz, fabric_xz, a_c,
/// a_n, a_t, a_c4, a_c6, phi_c_deg, phi_n_deg, phi_t_deg, phi_stress_deg, stress_ratio, half_sum,
/// stress_ratio_harmonics.
ScalarSet direction_scalars(const DirectionSums& sums);

}  // namespace drumlin::particles
