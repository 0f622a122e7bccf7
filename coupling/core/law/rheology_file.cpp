#include "coupling/core/law/rheology_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/key_table.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin {

// Found through their arguments, hence not in the unnamed namespace.
template <class Visitor>
void describe(Visitor& v, NormalStressRatio& t) {
  v.value("I", t.I, required("", number_range(), "Inertial numbers, ascending."));
  v.value("k", t.k,
          required("", at_least(0.01, 100),
                   "sigma_xx/sigma_zz there; smooth in ln I between, constant outside."));
}

template <class Visitor>
void describe(Visitor& v, Creep& t) {
  v.value("slope", t.slope, required("", above(0, 1), "By how much the amount falls per ln(|D|/|W|)."));
  v.value("ratio", t.ratio, required("", above(0, 1), "|D|/|W| below which it falls."));
}

template <class Visitor>
void describe(Visitor& v, AmountMemory& t) {
  v.value("swelling", t.swelling,
          required("", above(0, 1), "By how much ln nu falls per ln I in steady shear."));
  v.value("c_nu", t.c_nu,
          required("", above(0, 1e6), "Share of nu's way to that value that is made per unit of shear."));
  v.value("c_psi", t.c_psi,
          required("", above(0, 1e6), "Share of the dilatancy felt that is renewed per unit of shear."));
  v.value("lag", t.lag,
          required("", at_least(-1, 1), "By how much the amount falls per lag of the remembered axes."));
  v.value("own_weight", t.own_weight,
          defaulted("rho0 g d", at_least(0, 100), "w in I = 2|D|/sqrt(p + w), of amount and axes."));
  v.optional_table("creep", t.creep, "What little shear per turn takes off the amount; absent: nothing.");
}

template <class Visitor>
void describe(Visitor& v, MemoryLaw& t) {
  v.value("c", t.c, required("", above(0, 1e6), "Share of the memory that is renewed per unit of shear."));
  v.value("m", t.m,
          required("", at_least(0, 1),
                   "Weight of the memory against the strain rate; above 1 a stress could do negative work."));
  v.value(
      "chi_deg", t.chi_deg,
      required("deg", at_least(-90, 90),
               "Turn of new memory against the strain rate below I_low, as a phase of xx + i xz: twice the "
               "angle between the axes."));
  v.value("c_rho", t.c_rho,
          required("", above(0, 1e6), "Share of the normalisation that is renewed per unit of shear."));
  v.value("I_low", t.I_low,
          defaulted("", number_range(), "Inertial number up to which the turn is chi_deg."));
  v.value("I_high", t.I_high,
          defaulted("", number_range(), "Inertial number from which on the turn is atan(1/c)."));
  v.value("I", t.mu.I, required("", number_range(), "Inertial numbers, ascending, two at least."));
  v.value("mu", t.mu.mu,
          required("", friction_range(),
                   "Amount of the deviator of the stress over p there, growing; smooth in ln I between."));
  v.optional_table("amount", t.amount,
                   "What is added to the amount: dilatancy, lag, creep; absent: nothing.");
}

template <class Visitor>
void describe(Visitor& v, NonlocalLength& t) {
  v.value("amplitude", t.amplitude,
          required("", above(0, 100), "A of the length A d/sqrt|mu - mu_s| over which flow spreads."));
  v.value("mu_s", t.mu_s, required("", friction_range(), "Friction below which the local law holds."));
  v.value("amplitude_ci99", t.amplitude_ci99,
          when_given("", at_least(0, 100), "Half width of its 99 % interval."));
  v.value("mu_s_ci99", t.mu_s_ci99, when_given("", at_least(0, 10), "Half width of its 99 % interval."));
}

namespace {

/// The tables of the file that gather what RheologyFit holds itself.
struct MuTable {
  FrictionLaw friction;
  std::optional<double> rms_misfit;
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
  std::optional<NormalStressRatio> k;
  std::optional<MemoryLaw> memory;
  std::optional<NonlocalLength> nonlocal;
  std::optional<BandTable> band;
  PackingTable packing;
  OriginTable fitted_on;
};

template <class Visitor, class... Laws>
void describe_form(Visitor& v, std::variant<Laws...>& law) {
  v.variant("law", law, "Form of mu(I).", alternative<Laws>(Laws::name, Laws::sentence)...);
}

template <class Visitor>
void describe(Visitor& v, MuTable& t) {
  describe_form(v, t.friction);
  v.value("rms_misfit", t.rms_misfit,
          when_given("", at_least(0, 10), "Root mean square of mu about the fit."));
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
                   "Amplitude and length of flow that spreads; absent: the law has none.");
  v.optional_table("band", t.band, "What the law owes to the draw of its points; absent: not known.");
  v.table("packing", t.packing, Need::required, "State that the law was measured in.");
  v.table("fitted_on", t.fitted_on, Need::required, "Origin.");
}

/// Collects what does not hold between the keys of one file.
class Faults {
 public:
  Faults(const Document& document, std::vector<InputProblem>& problems)
      : document_(document), problems_(problems) {}
  void refuse(const std::string& path, const std::string& what, const std::string& allowed) {
    problems_.push_back(problem_at(document_, path, what, allowed));
  }
  void refuse(const std::string& table, const std::vector<FormFault>& faults) {
    for (const FormFault& fault : faults) refuse(table + "." + fault.key, fault.what, fault.allowed);
  }

 private:
  const Document& document_;
  std::vector<InputProblem>& problems_;
};

void check_together(const MemoryLaw& memory, Faults& faults) {
  faults.refuse("memory", faults_of(memory.mu));
  if (!(memory.I_low < memory.I_high)) faults.refuse("memory.I_high", "is not above I_low", "> I_low");
}

void check_together(const NormalStressRatio& points, Faults& faults) {
  if (points.I.size() != points.k.size())
    return faults.refuse("k.k", "has another length than I", "one k for each I");
  if (std::adjacent_find(points.I.begin(), points.I.end(), std::greater_equal<>()) != points.I.end())
    return faults.refuse("k.I", "is not sorted", "ascending");
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

std::vector<FrictionLaw> draws_of(const FrictionLaw& law, const std::vector<double>& numbers) {
  std::vector<FrictionLaw> draws;
  const std::size_t size = coefficients_of(law).size();
  for (std::size_t first = 0; first < numbers.size(); first += size)
    draws.push_back(with_coefficients(law, std::span(numbers).subspan(first, size)));
  return draws;
}

void check_band(const RheologyFile& file, Faults& faults) {
  const std::size_t size = coefficients_of(file.mu.friction).size(), count = file.band->draws.size();
  if (size == 0)
    return faults.refuse("band.draws", "is of a law that is not fitted",
                         fmt::format("{}", fmt::join(fitted_names(), ", ")));
  if (count == 0 || count % size != 0)
    return faults.refuse("band.draws", "has " + std::to_string(count) + " numbers",
                         "a multiple of " + std::to_string(size) + ", the numbers of one law");
  for (const FrictionLaw& draw : draws_of(file.mu.friction, file.band->draws))
    if (const auto found = faults_of(draw); !found.empty())
      return faults.refuse("band.draws", "holds a law that is none: " + found.front().what,
                           "laws whose mu grows");
}

/// What holds between keys.
void check_together(const Document& document, const RheologyFile& file, std::vector<InputProblem>& problems) {
  Faults faults(document, problems);
  faults.refuse("mu", faults_of(file.mu.friction));
  if (!is_of_inertial_number(file.mu.friction))
    for (const auto& [table, given] : {std::pair{"k", file.k.has_value()},
                                       {"memory", file.memory.has_value()},
                                       {"nonlocal", file.nonlocal.has_value()}})
      if (given)
        faults.refuse(table,
                      "does not go with " + described(file.mu.friction) + ", which depends on p besides I",
                      "absent, or another mu.law");
  if (file.k) check_together(*file.k, faults);
  if (file.memory) check_together(*file.memory, faults);
  if (file.band && problems.empty()) check_band(file, faults);
}

RheologyFit fit_of(const Document& document) {
  std::vector<InputProblem> problems;
  const auto content = read_keys<RheologyFile>(document, problems);
  if (problems.empty()) check_together(document, content, problems);
  if (!problems.empty()) throw InputError(problems);
  RheologyFit fit;
  fit.mu = content.mu.friction;
  fit.k = content.k;
  fit.memory = content.memory;
  fit.nonlocal = content.nonlocal;
  fit.nu = content.packing.nu;
  fit.nu_ci99 = content.packing.nu_ci99;
  fit.rms_misfit = content.mu.rms_misfit;
  if (content.band) fit.draws = draws_of(fit.mu, content.band->draws);
  fit.fitted_on = content.fitted_on.runs;
  fit.reduced = content.reduced;
  return fit;
}

}  // namespace

RheologyFit read_rheology(const std::filesystem::path& file) { return fit_of(read_toml(file)); }

RheologyFit parse_rheology(const std::string& text, const std::string& name) {
  return fit_of(parse_toml(text, name));
}

std::string rheology_text(const RheologyFit& fit) {
  RheologyFile content{fit.reduced, {fit.mu, fit.rms_misfit}, fit.k,          fit.memory, fit.nonlocal,
                       {},          {fit.nu, fit.nu_ci99},    {fit.fitted_on}};
  if (!fit.draws.empty()) content.band.emplace();
  for (const FrictionLaw& draw : fit.draws)
    for (const double number : coefficients_of(draw)) content.band->draws.push_back(number);
  return toml_text(write_keys(content));
}

void write_rheology(const std::filesystem::path& file, const RheologyFit& fit) {
  replace_file(file, rheology_text(fit));
}

}  // namespace drumlin
