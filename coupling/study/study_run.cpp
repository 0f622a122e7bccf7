#include "coupling/study/study_run.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "coupling/common/errors.hpp"
#include "coupling/statistics/quantiles.hpp"
#include "coupling/statistics/samples.hpp"

namespace drumlin::coupling {
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

namespace {

/// Plain mean of the runs of one speed, and how they lie about it in units of what their intervals say.
struct PlainPool {
  double value = std::numeric_limits<double>::quiet_NaN();
  double ci99 = std::numeric_limits<double>::quiet_NaN();  ///< as told by the runs; NaN where one tells none
  double chi_squared = 0;
  std::size_t runs = 0;
};

PlainPool plain_pool(const std::vector<Scalar>& runs) {
  PlainPool pool;
  double sum = 0, squares = 0;
  for (const Scalar& run : runs) {
    if (!std::isfinite(run.value)) continue;
    ++pool.runs;
    sum += run.value;
    squares += std::pow(run.ci99.value_or(std::numeric_limits<double>::quiet_NaN()), 2);
  }
  if (pool.runs == 0) return pool;
  const auto n = static_cast<double>(pool.runs);
  pool.value = sum / n;
  pool.ci99 = std::sqrt(squares) / n;
  for (const Scalar& run : runs)
    if (std::isfinite(run.value) && run.ci99.value_or(0) > 0)
      pool.chi_squared += std::pow((run.value - pool.value) * statistics::normal_quantile_99 / *run.ci99, 2);
  return pool;
}

}  // namespace

std::vector<Scalar> pooled_speeds(const std::string& name, const std::vector<std::vector<Scalar>>& speeds) {
  std::vector<PlainPool> pools;
  statistics::PooledVariance ratio;
  for (const auto& runs : speeds) {
    pools.push_back(plain_pool(runs));
    if (std::isfinite(pools.back().ci99)) ratio.add(pools.back().chi_squared, pools.back().runs);
  }
  const double widening = statistics::quantile_99_of_told_errors(ratio.value(), ratio.degrees_of_freedom()) /
                          statistics::normal_quantile_99;
  std::vector<Scalar> result;
  for (const PlainPool& pool : pools) {
    result.push_back({name, pool.value, std::nullopt});
    if (std::isfinite(pool.ci99)) result.back().ci99 = pool.ci99 * (pool.runs > 1 ? widening : 1);
  }
  return result;
}

Scalar pooled(const std::string& name, const std::vector<Scalar>& runs) {
  return pooled_speeds(name, {runs}).front();
}

namespace {

/// Names of the scalars of a speed, each once, in the order of its runs.
std::vector<std::string> scalar_names(const std::vector<StudyRun>& runs, const SpeedGroup& group) {
  std::vector<std::string> names;
  for (const std::size_t r : group.runs)
    for (const Scalar& scalar : runs[r].scalars.scalars)
      if (std::find(names.begin(), names.end(), scalar.name) == names.end()) names.push_back(scalar.name);
  return names;
}

std::vector<Scalar> values_of(const std::vector<StudyRun>& runs, const SpeedGroup& group,
                              const std::string& name) {
  std::vector<Scalar> values;
  for (const std::size_t r : group.runs)
    if (const Scalar* found = runs[r].scalars.find(name)) values.push_back(*found);
  return values;
}

void pool_scalars(const std::vector<StudyRun>& runs, std::vector<SpeedGroup>& groups) {
  std::map<std::string, std::vector<Scalar>> pools;  // by name, one entry a speed
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::string& name : scalar_names(runs, groups[g])) {
      auto pool = pools.find(name);
      if (pool == pools.end()) {
        std::vector<std::vector<Scalar>> speeds;
        for (const SpeedGroup& group : groups) speeds.push_back(values_of(runs, group, name));
        pool = pools.emplace(name, pooled_speeds(name, speeds)).first;
      }
      groups[g].scalars.scalars.push_back(pool->second[g]);
    }
}

}  // namespace

bool same_speed(double a, double b) { return std::abs(a - b) <= 0.005 * std::abs(a); }

std::vector<SpeedGroup> speed_groups(const std::vector<StudyRun>& runs) {
  std::vector<SpeedGroup> groups;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double rpm = runs[r].rotation_rpm;
    const auto is_this = [rpm](const SpeedGroup& group) { return same_speed(rpm, group.rotation_rpm); };
    auto group = std::find_if(groups.begin(), groups.end(), is_this);
    if (group == groups.end()) group = groups.insert(groups.end(), SpeedGroup{rpm, {}, {}});
    group->runs.push_back(r);
  }
  std::sort(groups.begin(), groups.end(),
            [](const SpeedGroup& a, const SpeedGroup& b) { return a.rotation_rpm < b.rotation_rpm; });
  pool_scalars(runs, groups);
  return groups;
}

}  // namespace drumlin::coupling
