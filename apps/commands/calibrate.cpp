// drumlin calibrate: one friction law from the profiles of one or more runs.
#include <fmt/format.h>

#include <cmath>

#include "apps/commands.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/calibration/log_friction.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/rheology_fit.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

/// Layers of all runs and the volume fraction of their bulks.
struct Pool {
  std::vector<FrictionPoint> points;
  double nu = 0;
  double nu_ci99 = 0;
  bool reduced = false;
  std::vector<std::string> runs;
};

/// Name of a run's folder, also for "." or a path that ends in "/".
std::string name_of_run(const fs::path& run) {
  const fs::path whole = fs::weakly_canonical(run);
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

Pool pool_of(const CalibrateOptions& options, const LayerSelection& selection) {
  Pool pool;
  for (const fs::path& run : options.runs) {
    const fs::path measured = run / "measured";
    if (!fs::exists(measured / "measured.json"))
      throw InputError(run.string() + ": has not been measured; run drumlin measure first");
    const ProfileSet profiles = read_profiles(measured / "profiles.csv");
    const auto points = friction_points(profiles, selection);
    pool.points.insert(pool.points.end(), points.begin(), points.end());

    const ScalarSet scalars = read_scalars(measured / "measured.json", "drumlin-measured-1");
    const Scalar* nu = scalars.find("nu_bulk");
    if (nu == nullptr || !std::isfinite(nu->value))
      throw InputError((measured / "measured.json").string() +
                       ": nu_bulk: was not measured, and the law needs the volume fraction of the bulk");
    const auto runs = static_cast<double>(options.runs.size());
    pool.nu += nu->value / runs;
    pool.nu_ci99 = std::hypot(pool.nu_ci99, nu->ci99.value_or(std::nan("")) / runs);
    const auto reduced = profiles.header.find("reduced");
    pool.reduced = pool.reduced || (reduced != profiles.header.end() && reduced->second == "true");
    pool.runs.push_back(name_of_run(run));
  }
  return pool;
}

void check_growth(const LogFriction& law) {
  const double error = std::sqrt(law.covariance[2]);
  if (law.b > 0) return;
  throw InputError(
      fmt::format("mu(I) = {:.4f} + ({:.5f} +- {:.5f}) ln I does not grow with I between {:.2g} and {:.2g}: "
                  "such a law has no "
                  "steady flow; calibrate on longer or more accurate runs, or on another range of I",
                  law.a, law.b, error, law.I_min, law.I_max));
}

std::vector<std::string> figure_arguments(const CalibrateOptions& options, const Pool& pool,
                                          const FrictionFit& fit, const LayerSelection& selection) {
  fs::path figure = options.output;
  std::vector<std::string> arguments{"--output", figure.replace_extension(".png").string()};
  const auto add = [&](const std::string& name, double value) {
    arguments.push_back(fmt::format("--{}={}", name, value));
  };
  add("a", fit.law.a);
  add("b", fit.law.b);
  add("var-a", fit.law.covariance[0]);
  add("cov-ab", fit.law.covariance[1]);
  add("var-b", fit.law.covariance[2]);
  add("I-min", fit.law.I_min);
  add("I-max", fit.law.I_max);
  add("rms", fit.rms_misfit);
  add("surface-margin", selection.surface_margin);
  add("wall-margin", selection.wall_margin);
  if (pool.reduced) arguments.push_back("--reduced");
  for (const fs::path& run : options.runs) arguments.push_back((run / "measured" / "profiles.csv").string());
  return arguments;
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  if (options.existing == ExistingOutput::resume && fs::is_regular_file(options.output)) {
    fmt::print("{}: done already\n", options.output.string());
    return static_cast<int>(ExitCode::done);
  }
  if (options.runs.empty()) throw InputError("calibrate needs at least one measured run");
  if (!(options.I_min > 0 && options.I_min < options.I_max))
    throw InputError(
        fmt::format("the range of I is {} to {} (allowed: 0 < I_min < I_max)", options.I_min, options.I_max));
  LayerSelection selection;
  selection.I_min = options.I_min;
  selection.I_max = options.I_max;
  const Pool pool = pool_of(options, selection);
  const FrictionFit fit = fit_log_friction(pool.points);
  check_growth(fit.law);

  RheologyFit rheology;
  rheology.mu = fit.law;
  rheology.nu = pool.nu;
  if (std::isfinite(pool.nu_ci99)) rheology.nu_ci99 = pool.nu_ci99;
  rheology.rms_misfit = fit.rms_misfit;
  rheology.fitted_on = pool.runs;
  rheology.reduced = pool.reduced;
  prepare_output_file(options.output, options.existing);
  draw_figures("calibrate_figures.py", figure_arguments(options, pool, fit, selection));
  write_rheology(options.output, rheology);
  fmt::print(
      "{}{}\n  mu(I) = {:.4f} + {:.5f} ln I, standard errors {:.4f} and {:.5f}, {} layers with I from {:.2g} "
      "to {:.2g}\n"
      "  rms misfit {:.4f}, scatter beyond the errors of the layers {:.4f}, nu {:.4f}\n",
      options.output.string(), pool.reduced ? " (reduced)" : "", fit.law.a, fit.law.b,
      std::sqrt(fit.law.covariance[0]), std::sqrt(fit.law.covariance[2]), fit.points, fit.law.I_min,
      fit.law.I_max, fit.rms_misfit, fit.intrinsic_scatter, pool.nu);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
