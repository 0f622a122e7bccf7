#include "coupling/exchange/rheology_fit.hpp"

#include <cmath>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/key_table.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin {
namespace {

/// The tables of the file; RheologyFit itself stays free of how it is written.
struct FrictionTable {
  std::string law = "log";
  LogFriction friction;
  std::optional<double> rms_misfit;
};
struct StressRatioTable {
  NormalStressRatio points;
};
struct PackingTable {
  double nu = 0;
  std::optional<double> nu_ci99;
};
struct OriginTable {
  std::vector<std::string> runs;
};
struct RheologyFile {
  bool reduced = false;
  FrictionTable mu;
  std::optional<StressRatioTable> k;
  PackingTable packing;
  OriginTable fitted_on;
};

template <class Visitor>
void describe(Visitor& v, FrictionTable& t) {
  v.value("law", t.law, required("", one_of({"log"}), "mu = a + b ln I, natural logarithm."));
  v.value("a", t.friction.a, required("", anything(), "Friction at I = 1."));
  v.value("b", t.friction.b, required("", at_least(0), "Growth of the friction with ln I."));
  v.value("covariance", t.friction.covariance, required("", anything(), "var(a), cov(a, b), var(b)."));
  v.value("I_min", t.friction.I_min, required("", above(0), "Smallest inertial number of the fit."));
  v.value("I_max", t.friction.I_max, required("", above(0), "Largest inertial number of the fit."));
  v.value("rms_misfit", t.rms_misfit, when_given("", at_least(0), "Root mean square of mu about the fit."));
}

template <class Visitor>
void describe(Visitor& v, StressRatioTable& t) {
  v.value("I", t.points.I, required("", above(0), "Inertial numbers, ascending."));
  v.value("k", t.points.k,
          required("", above(0), "sigma_xx/sigma_zz there; linear in ln I between, constant outside."));
}

template <class Visitor>
void describe(Visitor& v, PackingTable& t) {
  v.value("nu", t.nu, required("", above(0, 1), "Volume fraction of the bulk."));
  v.value("nu_ci99", t.nu_ci99, when_given("", at_least(0), "Half width of its 99 % interval."));
}

template <class Visitor>
void describe(Visitor& v, OriginTable& t) {
  v.value("runs", t.runs, required("", anything(), "Runs or publications that the law was fitted on."));
}

template <class Visitor>
void describe(Visitor& v, RheologyFile& t) {
  v.format("drumlin-rheology-1");
  v.value("reduced", t.reduced, defaulted("", anything(), "Fitted on a reduced run."));
  v.table("mu", t.mu, Need::required, "Effective friction.");
  v.optional_table("k", t.k, "Ratio of the normal stresses; absent: no such ratio in the law.");
  v.table("packing", t.packing, Need::required, "State that the law was measured in.");
  v.table("fitted_on", t.fitted_on, Need::required, "Origin.");
}

bool ascending(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i - 1] < values[i])) return false;
  return true;
}

/// What holds between keys.
void check_together(const Document& document, const RheologyFile& file, std::vector<InputProblem>& problems) {
  const LogFriction& mu = file.mu.friction;
  const auto refuse = [&](const std::string& path, const std::string& what, const std::string& allowed) {
    problems.push_back(problem_at(document, path, what, allowed));
  };
  if (!(mu.I_min < mu.I_max)) refuse("mu.I_max", "is not above I_min", "> I_min");
  const auto& [var_a, cov_ab, var_b] = mu.covariance;
  // The tolerance lets a covariance pass whose parts were rounded when it was written by hand.
  if (var_a < 0 || var_b < 0 || cov_ab * cov_ab > var_a * var_b * (1 + 1e-6))
    refuse("mu.covariance", "is no covariance", "var(a) >= 0, var(b) >= 0, cov^2 <= var(a) var(b)");
  if (!file.k) return;
  const NormalStressRatio& points = file.k->points;
  if (points.I.size() != points.k.size()) refuse("k.k", "has another length than I", "one k for each I");
  if (!ascending(points.I)) refuse("k.I", "is not sorted", "ascending");
}

}  // namespace

RheologyFit read_rheology(const std::filesystem::path& file) {
  const Document document = read_toml(file);
  std::vector<InputProblem> problems;
  const auto content = read_keys<RheologyFile>(document, problems);
  if (problems.empty()) check_together(document, content, problems);
  if (!problems.empty()) throw InputError(problems);
  RheologyFit fit;
  fit.mu = content.mu.friction;
  if (content.k) fit.k = content.k->points;
  fit.nu = content.packing.nu;
  fit.nu_ci99 = content.packing.nu_ci99;
  fit.rms_misfit = content.mu.rms_misfit;
  fit.fitted_on = content.fitted_on.runs;
  fit.reduced = content.reduced;
  return fit;
}

void write_rheology(const std::filesystem::path& file, const RheologyFit& fit) {
  RheologyFile content;
  content.reduced = fit.reduced;
  content.mu = {"log", fit.mu, fit.rms_misfit};
  if (fit.k) content.k = StressRatioTable{*fit.k};
  content.packing = {fit.nu, fit.nu_ci99};
  content.fitted_on.runs = fit.fitted_on;
  replace_file(file, toml_text(write_keys(content)));
}

}  // namespace drumlin
