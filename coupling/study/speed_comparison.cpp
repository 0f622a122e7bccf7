#include "coupling/study/speed_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "coupling/common/errors.hpp"
#include "coupling/comparison/targets.hpp"
#include "coupling/study/paper_verdicts.hpp"
#include "coupling/study/run_scalars.hpp"

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string text_of(const std::map<std::string, std::string>& texts, const std::string& key) {
  const auto found = texts.find(key);
  return found == texts.end() ? std::string("nothing") : found->second;
}

void require_one_law(const std::vector<StudyFlow>& flows, std::vector<InputProblem>& problems) {
  const StudyFlow& first = flows.front();
  std::set<std::string> keys;
  for (const StudyFlow& flow : flows)
    for (const auto& [key, value] : flow.identity) keys.insert(key);
  for (std::size_t i = 0; i < flows.size(); ++i) {
    for (const std::string& key : keys) {
      const std::string ours = text_of(flows[i].identity, key), theirs = text_of(first.identity, key);
      if (ours == theirs) continue;
      constexpr std::size_t readable = 80;  // characters; the points of a table are more
      const bool is_short = ours.size() <= readable && theirs.size() <= readable;
      problems.push_back(
          {flows[i].name, 0, 0, key,
           is_short ? ours + ", but " + theirs + " in " + first.name : "another than in " + first.name,
           "one law and the same effects in all flows of a study"});
    }
    for (std::size_t j = 0; j < i; ++j)
      if (same_speed(flows[i].rotation_rpm, flows[j].rotation_rpm))
        problems.push_back({flows[i].name, 0, 0, "rotation", "is the speed of " + flows[j].name + ", too",
                            "one flow per speed"});
  }
}

/// Another drum or other units, named run by run.
void require_one_drum(const std::vector<StudyRun>& particles, const std::vector<StudyFlow>& flows,
                      std::vector<InputProblem>& problems) {
  const StudyRun& run = particles.front();
  constexpr double tolerance = 1e-3;  // as in require_same_drum: the discs drawn against their mean
  for (const StudyFlow& flow : flows) {
    const RunHeader &first = run.profiles.header, &second = flow.side.profiles.header;
    const auto both = [&](const std::string& key) {
      return header_text(second, key).value_or("nothing") + ", but " +
             header_text(first, key).value_or("nothing") + " in " + run.name;
    };
    for (const HeaderNumber number : {&RunHeader::drum_radius, &RunHeader::diameter_m}) {
      const double ours = number_or_nan(first, number), theirs = number_or_nan(second, number);
      if (!(std::abs(ours - theirs) <= tolerance * std::abs(ours)))
        problems.push_back(
            {flow.name, 0, 0, key_of(number), both(key_of(number)), "the same drum on both sides"});
    }
    if (first.reduced != second.reduced || !first.reduced)
      problems.push_back({flow.name, 0, 0, "reduced", both("reduced"), "both reduced or both full"});
  }
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? nan : sum / static_cast<double>(values.size());
}

/// Zone by zone the mean of the errors of several comparisons; layers and gaps are summed.
std::vector<FieldComparison> mean_errors(const std::vector<Comparison>& comparisons) {
  std::vector<FieldComparison> mean;
  for (const FieldComparison& field : comparisons.front().fields) {
    FieldOverlay named;
    named.field = field.overlay.field;
    named.present = field.overlay.present;
    mean.push_back({std::move(named), field.zones});
    for (std::size_t z = 0; z < field.zones.size(); ++z) {
      FieldErrors& errors = mean.back().zones[z].errors;
      for (double FieldErrors::*measure :
           {&FieldErrors::rel_l2, &FieldErrors::rms, &FieldErrors::max, &FieldErrors::inside_band,
            &FieldErrors::interval_rms, &FieldErrors::particles_rms}) {
        std::vector<double> values;
        for (const Comparison& one : comparisons)
          values.push_back(one.fields[mean.size() - 1].zones[z].errors.*measure);
        errors.*measure = mean_of(values);
      }
      for (std::size_t i = 1; i < comparisons.size(); ++i) {
        errors.layers += comparisons[i].fields[mean.size() - 1].zones[z].errors.layers;
        errors.undefined += comparisons[i].fields[mean.size() - 1].zones[z].errors.undefined;
      }
    }
  }
  return mean;
}

/// Value and half width (NaN where there is none).
std::pair<double, double> continuum_value(const std::vector<Comparison>& comparisons,
                                          const std::string& name) {
  std::vector<double> values, intervals;
  for (const Comparison& comparison : comparisons)
    for (const ScalarPair& pair : comparison.scalars)
      if (pair.name == name) {
        values.push_back(pair.continuum);
        intervals.push_back(pair.continuum_ci99.value_or(nan));
      }
  return {mean_of(values), mean_of(intervals)};
}

/// What the paper says of a quantity at a speed; NaN where it says nothing.
Scalar said_by_paper(const std::vector<PaperNumber>& numbers, const std::string& name) {
  for (const PaperNumber& number : numbers)
    if (number.name == name) return {name, number.value, number.half_width};
  return {name, nan, std::nullopt};
}

/// A speed with both sides compared; `flow` may be absent, and so may the runs.
ComparedSpeed compared_at(double rotation_rpm, const std::vector<StudyRun>& particles,
                          const SpeedGroup* group, const StudyFlow* flow,
                          const std::vector<PaperNumber>& paper) {
  ComparedSpeed speed;
  speed.rotation_rpm = rotation_rpm;
  std::vector<double> seconds;
  std::vector<Comparison> comparisons;
  for (const std::size_t r : group == nullptr ? std::vector<std::size_t>() : group->runs) {
    speed.particles.push_back(particles[r].name);
    seconds.push_back(particles[r].cpu_seconds);
    if (flow != nullptr)
      comparisons.push_back(compare({particles[r].profiles, particles[r].scalars}, flow->side));
  }
  speed.particle_seconds = mean_of(seconds);
  speed.continuum_seconds = flow == nullptr ? nan : flow->cpu_seconds;
  if (flow != nullptr) {
    speed.continuum = flow->name;
    speed.start = flow->start;
  }
  std::vector<ScalarPair> pairs;
  for (const std::string& name : compared_speed_scalars()) {
    const Scalar* found = group == nullptr ? nullptr : group->scalars.find(name);
    const Scalar ours = found == nullptr ? Scalar{name, nan, std::nullopt} : *found;
    auto [theirs, open] = continuum_value(comparisons, name);
    if (group == nullptr &&
        flow != nullptr)  // counted from its own surface: there is no other to register by
      if (const Scalar* own = flow->side.scalars.find(name)) theirs = own->value;
    speed.scalars.push_back({said_by_paper(paper, name), ours, theirs, open});
    pairs.push_back({name, ours.value, ours.ci99, theirs});
  }
  if (!comparisons.empty()) speed.targets = judged_targets(mean_errors(comparisons), pairs);
  return speed;
}

SpeedRole role_of(const ComparedSpeed& speed, const std::set<std::string>& fitted_on, bool is_known) {
  if (speed.continuum.empty()) return SpeedRole::particles_only;
  if (speed.particles.empty()) return SpeedRole::continuum_only;
  for (const std::string& run : speed.particles)
    if (fitted_on.contains(run)) return SpeedRole::calibrated;
  return is_known ? SpeedRole::predicted : SpeedRole::unknown;
}

/// Laws over the speed of what the continuum shows.
std::vector<SpeedLaw> laws_of_continuum(const std::vector<ComparedSpeed>& speeds) {
  std::vector<SpeedGroup> groups;
  for (const ComparedSpeed& speed : speeds) {
    if (speed.continuum.empty()) continue;
    groups.push_back({speed.rotation_rpm, {}, {}});
    for (const SpeedScalar& scalar : speed.scalars)
      groups.back().scalars.scalars.push_back({scalar.particles.name, scalar.continuum, std::nullopt});
    const double theta_deg = groups.back().scalars.value("theta_deg");
    groups.back().scalars.scalars.push_back(
        {"mu_eff", std::tan(theta_deg * std::numbers::pi / 180), std::nullopt});
  }
  return speed_laws(groups);
}

/// The continuum's slope is that of its surface alone.
std::vector<SpeedLaw> without_centre_of_mass(std::vector<SpeedLaw> laws) {
  std::erase_if(laws, [](const SpeedLaw& law) { return law.name.ends_with("_com"); });
  return laws;
}

/// The paper's coefficients of the laws that we fit, too.
std::vector<SpeedLaw> laws_of_paper(const std::vector<SpeedLaw>& ours, const std::filesystem::path& folder) {
  std::vector<SpeedLaw> laws;
  const std::vector<PaperEntry> entries = paper_entries_of(folder);
  for (const SpeedLaw& law : ours) {
    SpeedLaw paper{law.name, law.formula, {}, nan, nan, 0};
    for (const PaperEntry& entry : entries)
      if (entry.quantity.starts_with(law.name + "."))
        paper.coefficients.push_back(
            {entry.quantity.substr(law.name.size() + 1), entry.value, entry.half_width.value_or(nan)});
    if (!paper.coefficients.empty()) laws.push_back(paper);
  }
  return laws;
}

void warn_of(SpeedComparison& result, const std::vector<StudyRun>& particles,
             const std::vector<StudyFlow>& flows) {
  for (const StudyRun& run : particles)
    for (const std::string& warning : run.warnings) result.warnings.push_back(run.name + ": " + warning);
  for (const StudyFlow& flow : flows)
    for (const auto& [key, value] : flow.numerics)
      if (text_of(flows.front().numerics, key) != value)
        result.warnings.push_back(flow.name + ": " + key + " = " + value + ", other than in " +
                                  flows.front().name);
  bool is_known = false;
  for (const ComparedSpeed& speed : result.speeds) {
    is_known = is_known || speed.role == SpeedRole::calibrated;
    std::string rpm = std::to_string(speed.rotation_rpm);
    rpm.resize(rpm.find('.') + 2);
    if (speed.role == SpeedRole::particles_only)
      result.warnings.push_back("no flow at " + rpm + " rpm, the speed of " + speed.particles.front());
    if (speed.role == SpeedRole::continuum_only)
      result.warnings.push_back("no particle run at " + rpm + " rpm, the speed of " + speed.continuum);
  }
  if (!is_known)
    result.warnings.push_back(
        "the law was fitted on none of these runs: which speed is calibrated and which predicted is not "
        "known");
}

}  // namespace

const std::vector<std::string>& compared_speed_scalars() {
  static const std::vector<std::string> names{"theta_deg", "Q", "H", "lambda", "shear_rate", "I_th"};
  return names;
}

SpeedComparison compared_speeds(const std::vector<StudyRun>& particles, const std::vector<StudyFlow>& flows,
                                const std::filesystem::path& paper_folder) {
  if (particles.empty())
    throw InputError("a study of both sides needs a measured particle run; there is none");
  if (flows.empty()) throw InputError("a study of both sides needs a continuum flow; there is none");
  require_one_study(particles);
  std::vector<InputProblem> problems;
  require_one_law(flows, problems);
  require_one_drum(particles, flows, problems);
  if (!problems.empty()) throw InputError(problems);

  std::vector<StudyRun> runs = particles;
  for (StudyRun& run : runs) run.scalars = with_derived(run.scalars, run.profiles);
  const std::vector<SpeedGroup> groups = speed_groups(runs);
  std::vector<double> rotations;
  for (const SpeedGroup& group : groups) rotations.push_back(group.rotation_rpm);
  for (const StudyFlow& flow : flows)
    if (std::none_of(groups.begin(), groups.end(), [&](const SpeedGroup& group) {
          return same_speed(group.rotation_rpm, flow.rotation_rpm);
        }))
      rotations.push_back(flow.rotation_rpm);
  std::sort(rotations.begin(), rotations.end());

  SpeedComparison result;
  result.fitted_on = flows.front().fitted_on;
  bool is_papers = true;
  for (const double rotation : rotations) {
    const auto is_here = [&](const auto& one) { return same_speed(rotation, one.rotation_rpm); };
    const auto group = std::find_if(groups.begin(), groups.end(), is_here);
    const auto flow = std::find_if(flows.begin(), flows.end(), is_here);
    const ProfileSet& profiles =
        group == groups.end() ? flow->side.profiles : particles[group->runs.front()].profiles;
    const auto papers = paper_speed_rpm(profiles, paper_folder);
    is_papers = is_papers && papers.has_value();
    result.speeds.push_back(
        compared_at(rotation, particles, group == groups.end() ? nullptr : &*group,
                    flow == flows.end() ? nullptr : &*flow,
                    papers ? paper_numbers(paper_folder, *papers) : std::vector<PaperNumber>()));
  }
  const std::set<std::string> fitted_on(result.fitted_on.begin(), result.fitted_on.end());
  const bool is_known = std::any_of(particles.begin(), particles.end(),
                                    [&](const StudyRun& run) { return fitted_on.contains(run.name); });
  for (ComparedSpeed& speed : result.speeds) speed.role = role_of(speed, fitted_on, is_known);
  result.particles_laws = without_centre_of_mass(speed_laws(groups));
  result.continuum_laws = without_centre_of_mass(laws_of_continuum(result.speeds));
  if (is_papers) result.paper_laws = laws_of_paper(result.particles_laws, paper_folder);
  warn_of(result, particles, flows);
  return result;
}

}  // namespace drumlin::coupling
