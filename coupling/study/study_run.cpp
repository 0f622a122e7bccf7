#include "coupling/study/study_run.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/student.hpp"

namespace drumlin {
namespace {

std::string text_of(const std::map<std::string, std::string>& texts, const std::string& key) {
  const auto found = texts.find(key);
  return found == texts.end() ? std::string("nothing") : found->second;
}

/// The same number in other words, or the same words.
bool same(const std::string& a, const std::string& b) {
  if (a == b) return true;
  double x = 0, y = 0;
  const auto read_a = std::from_chars(a.data(), a.data() + a.size(), x);
  const auto read_b = std::from_chars(b.data(), b.data() + b.size(), y);
  const bool numbers = read_a.ec == std::errc() && read_b.ec == std::errc() &&
                       read_a.ptr == a.data() + a.size() && read_b.ptr == b.data() + b.size();
  // The mean diameter in one file is that of the scene, in another that of the discs drawn.
  return numbers && std::abs(x - y) <= 1e-3 * std::abs(x);
}

}  // namespace

void require_one_study(const std::vector<StudyRun>& runs) {
  if (runs.empty()) throw InputError("a study needs at least one run");
  std::vector<InputProblem> problems;
  std::set<std::string> names, keys;
  for (const StudyRun& run : runs) {
    if (!names.insert(run.name).second)
      problems.push_back({run.name, 0, 0, "", "stands twice in this study", "each run once"});
    if (!(run.rotation_rpm > 0))
      problems.push_back({run.name, 0, 0, "rotation", "the drum stands still", "a drum that turns"});
    for (const auto& [key, value] : run.identity) keys.insert(key);
  }
  const StudyRun& first = runs.front();
  for (const StudyRun& run : runs)
    for (const std::string& key : keys) {
      const std::string ours = text_of(run.identity, key), theirs = text_of(first.identity, key);
      if (!same(ours, theirs))
        problems.push_back({run.name, 0, 0, key, ours + ", but " + theirs + " in " + first.name,
                            "the same in all runs of a study"});
    }
  if (!problems.empty()) throw InputError(problems);
}

Scalar pooled(const std::string& name, const std::vector<Scalar>& runs) {
  double sum = 0, squares = 0, n = 0;
  bool all_known = true;
  for (const Scalar& run : runs) {
    if (!std::isfinite(run.value)) continue;
    n += 1;
    sum += run.value;
    squares += std::pow(run.ci99.value_or(0), 2);
    all_known = all_known && run.ci99 && std::isfinite(*run.ci99);
  }
  Scalar result{name, n > 0 ? sum / n : std::numeric_limits<double>::quiet_NaN(), std::nullopt};
  if (n == 0 || !all_known) return result;
  double chi2 = 0;
  for (const Scalar& run : runs)
    if (std::isfinite(run.value) && *run.ci99 > 0)
      chi2 += std::pow((run.value - result.value) * normal_quantile_99 / *run.ci99, 2);
  const double birge = n > 1 ? std::sqrt(chi2 / (n - 1)) : 0;
  result.ci99 = std::sqrt(squares) / n * std::max(1.0, birge);
  return result;
}

std::vector<SpeedGroup> speed_groups(const std::vector<StudyRun>& runs) {
  std::vector<SpeedGroup> groups;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double rpm = runs[r].rotation_rpm;
    const auto same_speed = [rpm](const SpeedGroup& group) {
      return std::abs(group.rotation_rpm - rpm) <= 0.005 * rpm;
    };
    auto group = std::find_if(groups.begin(), groups.end(), same_speed);
    if (group == groups.end()) group = groups.insert(groups.end(), SpeedGroup{rpm, {}, {}});
    group->runs.push_back(r);
  }
  std::sort(groups.begin(), groups.end(),
            [](const SpeedGroup& a, const SpeedGroup& b) { return a.rotation_rpm < b.rotation_rpm; });
  for (SpeedGroup& group : groups) {
    std::vector<std::string> names;
    for (const std::size_t r : group.runs)
      for (const Scalar& scalar : runs[r].scalars.scalars)
        if (std::find(names.begin(), names.end(), scalar.name) == names.end()) names.push_back(scalar.name);
    for (const std::string& name : names) {
      std::vector<Scalar> values;
      for (const std::size_t r : group.runs)
        if (const Scalar* found = runs[r].scalars.find(name)) values.push_back(*found);
      group.scalars.scalars.push_back(pooled(name, values));
    }
  }
  return groups;
}

}  // namespace drumlin
