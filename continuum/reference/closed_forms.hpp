#pragma once
// Closed-form flows, references for the finite elements: explicit for mu = a + b ln I, for any law by its
// inverse and one integral. None of them depends on k when the pressure that they
// take is sigma_zz, the normal stress across the layers: k then only sets sigma_xx = k(I) sigma_zz.
#include "continuum/rheology/stress_law.hpp"

namespace drumlin::continuum {

/// I at which the law gives this friction, without the floor that keeps its mu positive.
double inertial_number(const LogLaw& law, double mu);

/// I at which a law whose mu follows from I alone gives mu, its floor included; 0 where it needs more than mu
/// to move, infinity where it never gives as much.
double inertial_number(const StressLaw& law, double mu);

/// Bagnold's flow down an incline: layer of height `height` and density nu on a rough bottom at slope theta
/// (rad), free at the top. Speed at the height z above the bottom: 2/3 I0 sqrt(nu cos theta) (H^1.5 - (H -
/// z)^1.5), mu(I0) = tan theta (GDR MiDi, Eur. Phys. J. E 14 (2004), with this law).
double bagnold_speed(const LogLaw& law, double nu, double theta, double height, double z);
double bagnold_speed(const StressLaw& law, double nu, double theta, double height, double z);

/// Plane shear under the pressure P and the shear stress mu P: the rate I sqrt(P), uniform.
double plane_shear_rate(const LogLaw& law, double pressure, double shear_stress);
double plane_shear_rate(const StressLaw& law, double pressure, double shear_stress);

/// Vertical chute between rough walls at |y| = half_width under the pressure P, weight nu along it:
/// u = sqrt(P) (b P/nu) e^(-a/b) (e^(nu W/(b P)) - e^(nu y/(b P))), y >= 0 from the middle.
double vertical_chute_speed(const LogLaw& law, double nu, double pressure, double half_width, double y);
/// For any law: the integral of I(nu y/P) sqrt(P) from y to the wall. A law with a yield
/// friction mu_s has a plug at y < mu_s P/nu.
double vertical_chute_speed(const StressLaw& law, double nu, double pressure, double half_width, double y);

/// Centre of a drum where the layers do not change along x but dk/dx = kappa > 0: at the depth y below the
/// surface d sigma_xx/dx = kappa nu cos(theta) y leaves mu = tan(theta) - kappa y/2. nu and kappa (1/d) are
/// given, theta (rad) is the slope of the surface. kappa = 0 is Bagnold's flow.
struct DrumCentre {
  double nu = 0;
  double kappa = 0;
  double theta = 0;
};
/// Shear rate at the depth y; for the logarithm I0 sqrt(nu cos(theta) y) e^(-y/l), l = 2 b/kappa, I0 = I(tan
/// theta).
double drum_centre_rate(const StressLaw& law, const DrumCentre& centre, double y);
/// Speed over that of the grains at rest below; kappa > 0.
double drum_centre_speed(const StressLaw& law, const DrumCentre& centre, double y);
/// Q = nu times the integral of the speed; for the logarithm nu I0 sqrt(nu cos(theta)) l^2.5 Gamma(5/2).
double drum_centre_flux(const StressLaw& law, const DrumCentre& centre);
double drum_centre_flux(const LogLaw& law, const DrumCentre& centre);
/// Slope (rad) at which the flux is Q.
double drum_centre_slope(const LogLaw& law, double nu, double kappa, double Q);
double drum_centre_slope(const StressLaw& law, double nu, double kappa, double Q);

/// Annular Couette flow under the pressure P without weight: speed at the radius r between an inner wall that
/// carries the friction mu_i and an outer wall at rest,
/// v/r = sqrt(P)/2 e^(-a/b) (Ei(mu_i r_i^2/(b r^2)) - Ei(mu_i r_i^2/(b r_o^2))), since mu = mu_i r_i^2/r^2.
double annular_couette_speed(const LogLaw& law, double pressure, double inner_radius, double outer_radius,
                             double mu_i, double r);

}  // namespace drumlin::continuum
