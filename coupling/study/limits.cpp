#include "coupling/study/limits.hpp"

#include "coupling/common/errors.hpp"
#include "coupling/documents/document.hpp"
#include "coupling/documents/key_table.hpp"

namespace drumlin::coupling {

// Found through their arguments, hence not in the unnamed namespace.
template <class Visitor>
void describe(Visitor& v, Limit& t) {
  v.value("quantity", t.quantity, required("", not_empty(), "What is judged."));
  v.value("where", t.where,
          required("", one_of({"centre", "map", "wall", "scalar", "cost"}), "Where it is read."));
  v.value("zone", t.zone,
          defaulted("", one_of({"", "flowing", "static", "all"}), "Zone of a field; a scalar has none."));
  v.value("measure", t.measure,
          required("", one_of({"relative", "rms", "difference", "inside_interval", "value"}),
                   "How the difference is taken."));
  v.value("must", t.must, required("", above(0), "What has to be kept."));
  v.value("aim", t.aim, required("", above(0), "Where to go."));
  v.value("must_worst", t.must_worst,
          when_given("", above(0), "What one speed has to keep; must and aim are then of the mean."));
}

template <class Visitor>
void describe(Visitor& v, Limits& t) {
  v.format("drumlin-limits-1");
  v.value("floor_factor", t.floor_factor,
          defaulted("", at_least(0, 100), "A limit below so many noise floors is judged against that."));
  v.tables("limits", t.limits, 1, "One number that is judged at every speed.");
}

namespace {

/// Fields are read in a zone and compared by their errors; other things have neither.
bool fits(const Limit& limit) {
  const bool field = limit.where == "centre" || limit.where == "map";
  if (field != !limit.zone.empty()) return false;
  if (field) return limit.measure == "relative" || limit.measure == "rms";
  if (limit.where == "wall") return limit.quantity == "traction_ratio" && limit.measure == "rms";
  if (limit.where == "cost") return limit.measure == "value";
  return limit.measure == "difference" || limit.measure == "relative" || limit.measure == "inside_interval";
}

}  // namespace

Limits read_limits(const std::filesystem::path& file) {
  const Document document = read_toml(file);
  std::vector<InputProblem> problems;
  Limits limits = read_keys<Limits>(document, problems);
  if (problems.empty())
    for (std::size_t i = 0; i < limits.limits.size(); ++i)
      if (!fits(limits.limits[i]))
        problems.push_back(problem_at(
            document, "limits." + std::to_string(i), "place, zone and measure do not belong together",
            "centre and map: a zone, relative or rms; wall: traction_ratio, rms; scalar: "
            "difference, relative or inside_interval; cost: value"));
  if (!problems.empty()) throw InputError(problems);
  return limits;
}

}  // namespace drumlin::coupling
