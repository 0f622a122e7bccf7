#pragma once
// Measured runs of the paper's drum made from known laws.
#include <cmath>
#include <random>

#include "coupling/study/study_run.hpp"
#include "tests/support/headers.hpp"

namespace drumlin::testing {

/// The laws that the runs are made from.
struct DrumLaws {
  double depth = 3.0, c0 = 0.31, c1 = 1.9e-3, lambda = 3, I_th = 0.018;
  double mu_a = 0.35, mu_b = 0.013;
  double mu_per_rpm = 0;  ///< moves mu(I) with the speed: no collapse
};

/// One run at a speed, every scalar with an interval of 3 % and moved by `noise` times its standard error.
inline coupling::StudyRun drum_run(double rpm, const DrumLaws& laws = {}, std::mt19937_64* noise = nullptr) {
  const double Q = 3.65 * rpm, theta = std::atan(laws.c0 + laws.c1 * Q) * 180 / 3.14159265358979;
  const double H = laws.depth * std::sqrt(Q), rate = 0.15;
  coupling::StudyRun run;
  run.name = std::to_string(rpm);
  run.rotation_rpm = rpm;
  std::normal_distribution<double> normal(0, 1);
  const auto add = [&](const std::string& name, double value) {
    const double ci99 = 0.03 * std::abs(value);
    run.scalars.scalars.push_back({name, value + (noise ? ci99 / 2.576 * normal(*noise) : 0), ci99});
  };
  add("Q", Q);
  add("theta_deg", theta);
  add("theta_com_deg", theta);
  add("H", H);
  add("shear_rate", rate);
  add("lambda", laws.lambda);
  add("I_th", laws.I_th);
  add("mu_a", laws.mu_a);
  add("mu_b", laws.mu_b);
  add("nu_bulk", 0.82);
  run.profiles.header = header_from({{"reduced", "false"},
                                     {"theta_deg", std::to_string(theta)},
                                     {"axis_depth", "4"},
                                     {"slice_width", "20"},
                                     {"rotation", std::to_string(rpm * 0.0019206626)},
                                     {"drum_radius", "68.1818"},
                                     {"diameter_m", "0.0033"},
                                     {"wall_z", "-64"},
                                     {"position", "0"},
                                     {"side", "particles"}});
  const char* names[] = {"v_x", "v_z", "shear_rate", "nu",       "sigma_zz", "sigma_zz_kinetic",
                         "I",   "mu",  "k",          "sigma_xx", "sigma_xz", "dv"};
  for (const char* name : names) run.profiles.columns.push_back({name, {}, {}});
  for (double z = -63.5; z < 0; z += 1) {
    const double local = z > -H ? rate : rate * std::exp((z + H) / laws.lambda);
    const double v_x = z > -H ? rate * (z + H + laws.lambda) : local * laws.lambda;
    const double sigma = -0.77 * z, I = local / std::sqrt(sigma);
    const double mu = laws.mu_a + laws.mu_b * std::log(I) + laws.mu_per_rpm * rpm;
    const double values[] = {v_x, 0.0, local, z > -H ? 0.80 : 0.82, sigma,       0.001 * sigma, I,
                             mu,  1.0, sigma, mu * sigma,           2.65 * local};
    run.profiles.z.push_back(z);
    for (std::size_t i = 0; i < run.profiles.columns.size(); ++i) {
      run.profiles.columns[i].value.push_back(values[i]);
      run.profiles.columns[i].ci99.push_back(0.03 * std::abs(values[i]));
    }
  }
  run.identity = {{"reduced", "false"}, {"drum_radius", "68.1818"}, {"grains", "7183 discs"}};
  return run;
}

inline std::vector<coupling::StudyRun> six_speeds(const DrumLaws& laws = {},
                                                  std::mt19937_64* noise = nullptr) {
  std::vector<coupling::StudyRun> runs;
  for (const double rpm : {2.0, 4.0, 5.0, 6.0, 10.0, 15.0}) runs.push_back(drum_run(rpm, laws, noise));
  return runs;
}

}  // namespace drumlin::testing
