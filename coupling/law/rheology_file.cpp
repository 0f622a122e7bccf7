#include "coupling/law/rheology_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/common/errors.hpp"
#include "coupling/common/files/text_file.hpp"
#include "coupling/documents/key_table.hpp"
#include "coupling/law/law_draws.hpp"

namespace drumlin {

namespace {

// What a law may hold. Dense flows of any grains have mu of 0.1 to 1 at I of 1e-6 to 1; beyond these ranges
// nothing flows as the equations say, and a solver would end without a reason.
const Allowed friction_range = at_least(1e-3, 10), number_range = at_least(1e-12, 1e3);

}  // namespace

// Found through their arguments, hence not in the unnamed namespace.
template <class Visitor>
void describe(Visitor& v, LogFriction& t) {
  v.value("a", t.a, required("", at_least(-10, 10), "Friction at I = 1."));
  v.value("b", t.b, required("", at_least(-10, 10), "Growth of the friction with ln I, not negative."));
  v.value("covariance", t.covariance, required("", at_least(-100, 100), "var(a), cov(a, b), var(b)."));
  v.value("I_min", t.I_min, required("", number_range, "Smallest inertial number of the fit."));
  v.value("I_max", t.I_max, required("", number_range, "Largest inertial number of the fit."));
}

template <class Visitor>
void describe(Visitor& v, LogLinearFriction& t) {
  v.value("a", t.a, required("", at_least(-10, 10), "Friction at I = 1 without the linear term."));
  v.value("b", t.b, required("", at_least(-10, 10), "Growth of the friction with ln I, not negative."));
  v.value("c", t.c, required("", at_least(-1e3, 1e3), "Growth of the friction with I, not negative."));
  v.value("I_min", t.I_min, required("", number_range, "Smallest inertial number of the fit."));
  v.value("I_max", t.I_max, required("", number_range, "Largest inertial number of the fit."));
}

template <class Visitor>
void describe(Visitor& v, ConstantFriction& t) {
  v.value("mu", t.mu, required("", friction_range, "Friction at every inertial number."));
}

template <class Visitor>
void describe(Visitor& v, JopFriction& t) {
  v.value("mu_s", t.mu_s, required("", friction_range, "Friction for I -> 0."));
  v.value("mu_2", t.mu_2, required("", friction_range, "Friction for I -> infinity, not below mu_s."));
  v.value("I_0", t.I_0, required("", number_range, "Inertial number half way between the two."));
}

template <class Visitor>
void describe(Visitor& v, FrictionTable& t) {
  v.value("I", t.I, required("", number_range, "Inertial numbers, ascending, two at least."));
  v.value("mu", t.mu, required("", friction_range, "Friction there, growing; smooth in ln I between."));
}

namespace {

/// The tables of the file; RheologyFit itself stays free of how it is written.
struct MuTable {
  MeasuredFriction friction;
  std::optional<double> rms_misfit;
};
struct StressRatioTable {
  NormalStressRatio points;
};
struct CreepTable {
  Creep law;
};
struct AmountTable {
  AmountMemory law;
  std::optional<CreepTable> creep;
};
struct MemoryTable {
  MemoryLaw law;
  std::optional<AmountTable> amount;
};
struct NonlocalTable {
  NonlocalLength law;
};
struct PackingTable {
  double nu = 0;
  std::optional<double> nu_ci99;
};
struct BandTable {
  std::vector<double> draws;
};
struct OriginTable {
  std::vector<std::string> runs;
};
struct RheologyFile {
  bool reduced = false;
  MuTable mu;
  std::optional<StressRatioTable> k;
  std::optional<MemoryTable> memory;
  std::optional<NonlocalTable> nonlocal;
  std::optional<BandTable> band;
  PackingTable packing;
  OriginTable fitted_on;
};

template <class Visitor>
void describe(Visitor& v, MuTable& t) {
  v.variant("law", t.friction, "Form of mu(I).",
            alternative<LogFriction>("log", "mu = a + b ln I, natural logarithm."),
            alternative<LogLinearFriction>("log-linear", "mu = a + b ln I + c I."),
            alternative<ConstantFriction>("constant", "The same mu at every I."),
            alternative<JopFriction>("jop", "mu_s + (mu_2 - mu_s)/(I_0/I + 1)."),
            alternative<FrictionTable>("table", "Points, smoothly interpolated."));
  v.value("rms_misfit", t.rms_misfit,
          when_given("", at_least(0, 10), "Root mean square of mu about the fit."));
}

template <class Visitor>
void describe(Visitor& v, StressRatioTable& t) {
  v.value("I", t.points.I, required("", number_range, "Inertial numbers, ascending."));
  v.value("k", t.points.k,
          required("", at_least(0.01, 100),
                   "sigma_xx/sigma_zz there; smooth in ln I between, constant outside."));
}

template <class Visitor>
void describe(Visitor& v, CreepTable& t) {
  v.value("slope", t.law.slope, required("", above(0, 1), "By how much the amount falls per ln(|D|/|W|)."));
  v.value("ratio", t.law.ratio, required("", above(0, 1), "|D|/|W| below which it falls."));
}

template <class Visitor>
void describe(Visitor& v, AmountTable& t) {
  v.value("swelling", t.law.swelling,
          required("", above(0, 1), "By how much ln nu falls per ln I in steady shear."));
  v.value("c_nu", t.law.c_nu,
          required("", above(0, 1e6), "Share of nu's way to that value that is made per unit of shear."));
  v.value("c_psi", t.law.c_psi,
          required("", above(0, 1e6), "Share of the dilatancy felt that is renewed per unit of shear."));
  v.value("lag", t.law.lag,
          required("", at_least(-1, 1), "By how much the amount falls per lag of the remembered axes."));
  v.value("own_weight", t.law.own_weight,
          defaulted("rho0 g d", at_least(0, 100), "w in I = 2|D|/sqrt(p + w), of amount and axes."));
  v.optional_table("creep", t.creep, "What little shear per turn takes off the amount; absent: nothing.");
}

template <class Visitor>
void describe(Visitor& v, MemoryTable& t) {
  v.value("c", t.law.c,
          required("", above(0, 1e6), "Share of the memory that is renewed per unit of shear."));
  v.value("m", t.law.m,
          required("", at_least(0, 1),
                   "Weight of the memory against the strain rate; above 1 a stress could do negative work."));
  v.value(
      "chi_deg", t.law.chi_deg,
      required("deg", at_least(-90, 90),
               "Turn of new memory against the strain rate below I_low, as a phase of xx + i xz: twice the "
               "angle between the axes."));
  v.value("c_rho", t.law.c_rho,
          required("", above(0, 1e6), "Share of the normalisation that is renewed per unit of shear."));
  v.value("I_low", t.law.I_low,
          defaulted("", number_range, "Inertial number up to which the turn is chi_deg."));
  v.value("I_high", t.law.I_high,
          defaulted("", number_range, "Inertial number from which on the turn is atan(1/c)."));
  v.value("I", t.law.mu.I, required("", number_range, "Inertial numbers, ascending, two at least."));
  v.value("mu", t.law.mu.mu,
          required("", friction_range,
                   "Amount of the deviator of the stress over p there, growing; smooth in ln I between."));
  v.optional_table("amount", t.amount,
                   "What is added to the amount: dilatancy, lag, creep; absent: nothing.");
}

template <class Visitor>
void describe(Visitor& v, NonlocalTable& t) {
  v.value("amplitude", t.law.amplitude,
          required("", above(0, 100), "A of the length A d/sqrt|mu - mu_s| over which flow spreads."));
  v.value("mu_s", t.law.mu_s, required("", friction_range, "Friction below which the local law holds."));
  v.value("amplitude_ci99", t.law.amplitude_ci99,
          when_given("", at_least(0, 100), "Half width of its 99 % interval."));
  v.value("mu_s_ci99", t.law.mu_s_ci99, when_given("", at_least(0, 10), "Half width of its 99 % interval."));
}

template <class Visitor>
void describe(Visitor& v, PackingTable& t) {
  v.value("nu", t.nu, required("", at_least(0.01, 1), "Volume fraction of the bulk."));
  v.value("nu_ci99", t.nu_ci99, when_given("", at_least(0, 1), "Half width of its 99 % interval."));
}

template <class Visitor>
void describe(Visitor& v, BandTable& t) {
  v.value("draws", t.draws,
          required("", at_least(-1e3, 1e3),
                   "Laws of other draws of the points, one after the other: a, b; a, b, c; or mu of each I "
                   "of the table."));
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
  v.optional_table("memory", t.memory, "Memory of the axes of stress; absent: the law has none.");
  v.optional_table("nonlocal", t.nonlocal,
                   "NonlocalLength and length of flow that spreads; absent: the law has none.");
  v.optional_table("band", t.band, "What the law owes to the draw of its points; absent: not known.");
  v.table("packing", t.packing, Need::required, "State that the law was measured in.");
  v.table("fitted_on", t.fitted_on, Need::required, "Origin.");
}

bool ascending(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i - 1] < values[i])) return false;
  return true;
}

/// Collects what does not hold between the keys of one file.
class Faults {
 public:
  Faults(const Document& document, std::vector<InputProblem>& problems)
      : document_(document), problems_(problems) {}
  void refuse(const std::string& path, const std::string& what, const std::string& allowed) {
    problems_.push_back(problem_at(document_, path, what, allowed));
  }
  const Document& document() const { return document_; }

 private:
  const Document& document_;
  std::vector<InputProblem>& problems_;
};

// Why such a law is refused: a layer that shears a little faster would resist less, and faster still.
constexpr const char* falling =
    "mu falls with I: faster shear would meet less resistance, so that no flow of this law is stable, and "
    "its "
    "equations are ill-posed";

/// A fitted law must be one where it was fitted. Below I_max it may fall to nothing (kept_positive), as the
/// logarithm does.
template <class Law>
void check_at_largest(const Law& mu, Faults& faults) {
  const double linear = [&] {
    if constexpr (requires { mu.c; }) return mu.c * mu.I_max;
    return 0.0;
  }();
  const double largest = mu.a + mu.b * std::log(mu.I_max) + linear;
  if (!friction_range.holds(largest))
    faults.refuse("mu.a", fmt::format("gives mu = {:.3g} at I_max", largest), "mu of 0.001 to 10 there");
}

void check_together(const LogFriction& mu, Faults& faults) {
  check_at_largest(mu, faults);
  if (mu.b < 0) faults.refuse("mu.b", falling, ">= 0");
  if (!(mu.I_min < mu.I_max)) faults.refuse("mu.I_max", "is not above I_min", "> I_min");
  const auto& [var_a, cov_ab, var_b] = mu.covariance;
  // The tolerance lets a covariance pass whose parts were rounded when it was written by hand.
  if (var_a < 0 || var_b < 0 || cov_ab * cov_ab > var_a * var_b * (1 + 1e-6))
    faults.refuse("mu.covariance", "is no covariance", "var(a) >= 0, var(b) >= 0, cov^2 <= var(a) var(b)");
}

void check_together(const LogLinearFriction& mu, Faults& faults) {
  check_at_largest(mu, faults);
  if (mu.b < 0) faults.refuse("mu.b", falling, ">= 0");
  if (mu.c < 0) faults.refuse("mu.c", falling, ">= 0");
  if (!(mu.I_min < mu.I_max)) faults.refuse("mu.I_max", "is not above I_min", "> I_min");
}

void check_together(const ConstantFriction&, Faults&) {}

void check_together(const JopFriction& mu, Faults& faults) {
  if (mu.mu_2 < mu.mu_s) faults.refuse("mu.mu_2", falling, ">= mu_s");
}

// `table` is where the points stand.
void check_points(const FrictionTable& mu, const std::string& table, Faults& faults) {
  const std::string I_key = table + ".I", mu_key = table + ".mu";
  if (mu.I.size() < 2) faults.refuse(I_key, "has fewer than two entries", "two at least");
  if (mu.I.size() != mu.mu.size()) faults.refuse(mu_key, "has another length than I", "one mu for each I");
  if (!ascending(mu.I)) faults.refuse(I_key, "is not sorted", "ascending");
  for (std::size_t i = 1; i < mu.mu.size(); ++i) {
    const std::string place = "from entry " + std::to_string(i) + " to " + std::to_string(i + 1) + ", ";
    if (mu.mu[i] < mu.mu[i - 1]) return faults.refuse(mu_key, place + falling, "growing");
    if (mu.mu[i] == mu.mu[i - 1])
      return faults.refuse(mu_key, place + "mu does not change: the law would not say how fast its flow is",
                           "growing");
  }
}

void check_together(const FrictionTable& mu, Faults& faults) { check_points(mu, "mu", faults); }

void check_together(const MemoryLaw& memory, Faults& faults) {
  check_points(memory.mu, "memory", faults);
  if (!(memory.I_low < memory.I_high)) faults.refuse("memory.I_high", "is not above I_low", "> I_low");
}

void check_together(const NormalStressRatio& points, Faults& faults) {
  if (points.I.size() != points.k.size())
    return faults.refuse("k.k", "has another length than I", "one k for each I");
  if (!ascending(points.I)) return faults.refuse("k.I", "is not sorted", "ascending");
  // I stands on both sides of I = I_p sqrt((1 + k(I))/2), I_p = 2|D|/sqrt(p). The smooth curve is at most
  // twice as steep as the chord, so that this bound keeps dk/dln I below 2 (1 + k) and leaves one I for each
  // I_p.
  for (std::size_t i = 1; i < points.k.size(); ++i) {
    const double slope = (points.k[i] - points.k[i - 1]) / std::log(points.I[i] / points.I[i - 1]);
    const double bound = 1 + std::min(points.k[i], points.k[i - 1]);
    if (slope >= bound)
      return faults.refuse("k.k",
                           "grows so fast from entry " + std::to_string(i) + " to " + std::to_string(i + 1) +
                               " that one shear rate would have several inertial numbers",
                           "dk/dln I < 1 + k");
  }
}

std::vector<InputProblem> problems_of(const MeasuredFriction& friction, const Document& document) {
  std::vector<InputProblem> problems;
  Faults faults(document, problems);
  std::visit([&](const auto& mu) { check_together(mu, faults); }, friction);
  return problems;
}

void check_band(const RheologyFile& file, Faults& faults) {
  const std::size_t size = draw_size(file.mu.friction), count = file.band->draws.size();
  if (size == 0)
    return faults.refuse("band.draws", "is of a law that is not fitted", "log, log-linear or table");
  if (count == 0 || count % size != 0)
    return faults.refuse("band.draws", "has " + std::to_string(count) + " numbers",
                         "a multiple of " + std::to_string(size) + ", the numbers of one law");
  for (const MeasuredFriction& draw : draws_of(file.mu.friction, file.band->draws))
    if (const auto problems = problems_of(draw, faults.document()); !problems.empty())
      return faults.refuse("band.draws", "holds a law that is none: " + problems.front().what,
                           "laws whose mu grows");
}

/// What holds between keys.
void check_together(const Document& document, const RheologyFile& file, std::vector<InputProblem>& problems) {
  Faults faults(document, problems);
  std::visit([&](const auto& mu) { check_together(mu, faults); }, file.mu.friction);
  if (file.k) check_together(file.k->points, faults);
  if (file.memory) check_together(file.memory->law, faults);
  if (file.band && problems.empty()) check_band(file, faults);
}

RheologyFit fit_of(const Document& document) {
  std::vector<InputProblem> problems;
  const auto content = read_keys<RheologyFile>(document, problems);
  if (problems.empty()) check_together(document, content, problems);
  if (!problems.empty()) throw InputError(problems);
  RheologyFit fit;
  fit.mu = content.mu.friction;
  if (content.k) fit.k = content.k->points;
  if (content.memory) fit.memory = content.memory->law;
  if (content.memory && content.memory->amount) {
    fit.memory->amount = content.memory->amount->law;
    if (const auto& creep = content.memory->amount->creep) fit.memory->amount->creep = creep->law;
  }
  if (content.nonlocal) fit.nonlocal = content.nonlocal->law;
  fit.nu = content.packing.nu;
  fit.nu_ci99 = content.packing.nu_ci99;
  fit.rms_misfit = content.mu.rms_misfit;
  if (content.band) fit.draws = draws_of(fit.mu, content.band->draws);
  fit.fitted_on = content.fitted_on.runs;
  fit.reduced = content.reduced;
  return fit;
}

}  // namespace

bool is_law(const MeasuredFriction& mu) { return problems_of(mu, Document()).empty(); }

RheologyFit read_rheology(const std::filesystem::path& file) { return fit_of(read_toml(file)); }

RheologyFit parse_rheology(const std::string& text, const std::string& name) {
  return fit_of(parse_toml(text, name));
}

std::string rheology_text(const RheologyFit& fit) {
  RheologyFile content;
  content.reduced = fit.reduced;
  content.mu = {fit.mu, fit.rms_misfit};
  if (fit.k) content.k = StressRatioTable{*fit.k};
  if (fit.memory) content.memory = MemoryTable{*fit.memory, {}};
  if (fit.memory && fit.memory->amount) {
    content.memory->amount = AmountTable{*fit.memory->amount, {}};
    if (const auto& creep = fit.memory->amount->creep) content.memory->amount->creep = CreepTable{*creep};
  }
  if (fit.nonlocal) content.nonlocal = NonlocalTable{*fit.nonlocal};
  if (!fit.draws.empty()) content.band.emplace();
  for (const MeasuredFriction& draw : fit.draws)
    for (const double number : draw_of(draw)) content.band->draws.push_back(number);
  content.packing = {fit.nu, fit.nu_ci99};
  content.fitted_on.runs = fit.fitted_on;
  return toml_text(write_keys(content));
}

void write_rheology(const std::filesystem::path& file, const RheologyFit& fit) {
  replace_file(file, rheology_text(fit));
}

}  // namespace drumlin
