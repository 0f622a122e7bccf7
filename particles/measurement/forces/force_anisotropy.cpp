#include "particles/measurement/forces/force_anisotropy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace drumlin::particles {
namespace {

using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Applies an action to each pair of sums, so that none is forgotten.
template <class Action>
void for_each_sum(DirectionSums& a, const DirectionSums& b, Action action) {
  for (std::size_t k = 0; k < DirectionSums::bins; ++k) {
    action(a.count[k], b.count[k]);
    action(a.normal[k], b.normal[k]);
    action(a.tangential[k], b.tangential[k]);
  }
  for (std::size_t k = 0; k < a.turned.size(); ++k) action(a.turned[k], b.turned[k]);
  for (auto member : {&DirectionSums::contacts, &DirectionSums::normal_sum, &DirectionSums::tangential_size,
                      &DirectionSums::pressure})
    action(a.*member, b.*member);
  action(a.shear, b.shear);
}

/// Second harmonic of a mean over the contacts of each bin; a bin's width damps it by sin(w)/w.
Complex second_harmonic(const std::array<double, DirectionSums::bins>& mean) {
  constexpr double width = pi / DirectionSums::bins;
  Complex found = 0;
  for (std::size_t k = 0; k < mean.size(); ++k)
    found += std::polar(1.0, (2 * static_cast<double>(k) + 1) * width) * mean[k];
  const double damping = std::sin(width) / width;
  return found * (2 / (static_cast<double>(mean.size()) * damping));
}

/// phi_0 of a exp(2 i phi_0) in [0, 180).
double direction_deg(Complex harmonic) {
  const double angle = std::arg(harmonic) * 90 / pi;
  return angle < 0 ? angle + 180 : angle;
}

}  // namespace

void DirectionSums::add(const ContactForce& contact, double weight) {
  const double direction = contact.direction;
  const double f_n = contact.normal * weight, f_t = contact.tangential * weight;
  const auto bin = std::min(bins - 1, static_cast<std::size_t>(direction / pi * bins));
  count[bin] += 1;
  normal[bin] += f_n;
  tangential[bin] += f_t;
  contacts += 1;
  normal_sum += f_n;
  tangential_size += std::abs(f_t);
  const Complex normal_direction(std::cos(direction), std::sin(direction));
  const Complex twice = normal_direction * normal_direction, four_times = twice * twice;
  turned[0] += twice;
  turned[1] += four_times;
  turned[2] += twice * four_times;
  pressure += f_n * contact.branch / 2;
  shear += Complex(f_n, -f_t) * twice * (contact.branch / 2.0);  // the tangent is the normal times -i
}

DirectionSums& DirectionSums::operator+=(const DirectionSums& other) {
  for_each_sum(*this, other, [](auto& a, const auto& b) { a += b; });
  return *this;
}

DirectionSums& DirectionSums::operator-=(const DirectionSums& other) {
  for_each_sum(*this, other, [](auto& a, const auto& b) { a -= b; });
  return *this;
}

ForceAnisotropy force_anisotropy(const DirectionSums& sums) {
  std::array<double, DirectionSums::bins> normal{}, tangential{};
  double mean_normal = 0;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const bool filled = sums.count[k] > 0;
    normal[k] = filled ? sums.normal[k] / sums.count[k] : none;
    tangential[k] = filled ? sums.tangential[k] / sums.count[k] : none;
    mean_normal += normal[k] / static_cast<double>(normal.size());
  }
  ForceAnisotropy found;
  found.mean_normal = mean_normal;
  // The mean of exp(2 i phi) over contacts is half the harmonic of E.
  found.contacts = 2.0 * sums.turned[0] / sums.contacts;
  found.contacts_fourth = 2.0 * sums.turned[1] / sums.contacts;
  found.contacts_sixth = 2.0 * sums.turned[2] / sums.contacts;
  found.normal = second_harmonic(normal) / mean_normal;
  found.tangential =
      Complex(0, -1) * second_harmonic(tangential) / mean_normal;  // sin 2phi = cos(2phi - pi/2)
  found.stress = sums.shear / sums.pressure;
  return found;
}

double stress_ratio_of(const ForceAnisotropy& a) {
  const Complex shear =
      a.contacts + a.normal + a.tangential + a.contacts_fourth * std::conj(a.normal - a.tangential) / 2.0;
  return std::abs(shear) / (2 + (a.contacts * std::conj(a.normal)).real());
}

ScalarSet direction_scalars(const DirectionSums& sums) {
  const ForceAnisotropy a = force_anisotropy(sums);
  const Complex fabric = sums.turned[0] / sums.contacts;
  ScalarSet set;
  const auto add = [&](const char* name, double value) {
    set.scalars.push_back({name, value, std::nullopt});
  };
  add("contacts", sums.contacts);
  add("f_n", sums.normal_sum / sums.contacts);
  add("f_t", sums.tangential_size / sums.contacts);
  add("fabric_xx", (1 + fabric.real()) / 2);
  add("fabric_zz", (1 - fabric.real()) / 2);
  add("fabric_xz", fabric.imag() / 2);
  add("a_c", std::abs(a.contacts));
  add("a_n", std::abs(a.normal));
  add("a_t", std::abs(a.tangential));
  add("a_c4", std::abs(a.contacts_fourth));
  add("a_c6", std::abs(a.contacts_sixth));
  add("phi_c_deg", direction_deg(a.contacts));
  add("phi_n_deg", direction_deg(a.normal));
  add("phi_t_deg", direction_deg(a.tangential));
  add("phi_stress_deg", direction_deg(a.stress));
  add("stress_ratio", std::abs(a.stress));
  add("half_sum", (std::abs(a.contacts) + std::abs(a.normal) + std::abs(a.tangential)) / 2);
  add("stress_ratio_harmonics", stress_ratio_of(a));
  return set;
}

}  // namespace drumlin::particles
