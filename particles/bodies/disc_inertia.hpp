#pragma once
// The inertia of a disc that turns: J = m r^2 / 2. All that a body's shape does to the mechanics of contacts.

namespace drumlin::particles {

inline constexpr double disc_inertia = 0.5;  ///< J / (m r^2)
/// What a tangential impulse changes of the rim's velocity, over what it changes of the centre's: m r^2 / J.
inline constexpr double surface_gain = 1 / disc_inertia;
/// W_tt / W_nn of a contact of discs, with spin and without.
template <bool spin>
inline constexpr double tangential_gain = spin ? 1 + surface_gain : 1;

}  // namespace drumlin::particles
