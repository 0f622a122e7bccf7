// The bed of a drum for Python, which fits its laws: what blocks and nodes of a map show, and paths of the
// material with what it carries along them.
#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>

#include "apps/python/arrays-inl.h"
#include "apps/python/bindings.hpp"
#include "coupling/calibration/axis_memory.hpp"
#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/calibration/law_points.hpp"
#include "coupling/core/law/memory_law.hpp"

namespace py = pybind11;

namespace drumlin::python {
namespace {

struct Bed {
  coupling::PathFields fields;
  std::vector<coupling::StressPath> paths;
  std::vector<coupling::LawBlock> blocks;
  double own_weight = 0;  // that of the paths
};

/// One entry for each item: a member or the value of a function.
template <class Items, class Of>
auto over(const Items& items, const Of& of) {
  using Value = std::decay_t<decltype(std::invoke(of, *std::begin(items)))>;
  py::array_t<Value> values(static_cast<py::ssize_t>(std::size(items)));
  Value* to = values.mutable_data();
  for (const auto& item : items) *to++ = std::invoke(of, item);
  return values;
}

std::span<const double> entries(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// `fields`: name to numbers over (z, x); `header`: numbers of the map's by name.
FieldMap map_of(const Numbers& x, const Numbers& z, const std::map<std::string, Numbers>& fields,
                const std::map<std::string, Numbers>& half_widths,
                const std::map<std::string, double>& header) {
  FieldMap map;
  const auto columns = static_cast<std::size_t>(x.size()), rows = static_cast<std::size_t>(z.size());
  map.grid = {x.at(0), z.at(0), x.at(1) - x.at(0), z.at(1) - z.at(0), columns, rows};
  const auto vector = [&](const Numbers& of) {
    if (static_cast<std::size_t>(of.size()) != map.grid.nodes())
      throw py::value_error("not a number per node");
    return std::vector<double>(entries(of).begin(), entries(of).end());
  };
  for (const auto& [name, values] : fields) {
    const auto ci99 = half_widths.find(name);
    map.fields.push_back(
        {name, vector(values), ci99 == half_widths.end() ? std::vector<double>() : vector(ci99->second)});
  }
  for (const HeaderNumber number :
       {&RunHeader::axis_depth, &RunHeader::drum_radius, &RunHeader::rotation, &RunHeader::interval_factor})
    if (const auto found = header.find(key_of(number)); found != header.end())
      map.header.*number = found->second;
  return map;
}

}  // namespace

void add_bed(py::module_& module) {
  using namespace coupling;
  using namespace py::literals;
  py::class_<Bed> bed(module, "Bed");
  refuse_new(bed);
  module.def(
      "bed",
      [](const Numbers& x, const Numbers& z, const std::map<std::string, Numbers>& fields,
         const std::map<std::string, Numbers>& half_widths, const std::map<std::string, double>& header,
         double I_min, double I_max, double own_weight, double smoothing) {
        const FieldMap map = map_of(x, z, fields, half_widths, header);
        Bed made{PathFields(map, {.smoothing = smoothing}),
                 {},
                 law_points(map, {.I_min = I_min, .I_max = I_max, .displacements = true}),
                 own_weight};
        made.paths = stress_paths(made.fields);
        add_own_weight(made.paths, own_weight);
        return made;
      },
      "x"_a, "z"_a, "fields"_a, "half_widths"_a, "header"_a, "I_min"_a = 3e-6, "I_max"_a = 1.0,
      "own_weight"_a = 0.0, "smoothing"_a = 2.0);
  bed.def_property_readonly("share_from_displacements",
                            [](const Bed& of) { return of.fields.share_from_displacements(); });
  bed.def_readonly("own_weight", &Bed::own_weight);
  bed.def_property_readonly("radius", [](const Bed& of) { return of.fields.radius(); });
  bed.def_property_readonly("axis", [](const Bed& of) { return of.fields.axis(); });
  bed.def_property_readonly("blocks", [](const Bed& of) {
    const auto point = [](double FrictionPoint::*member) {
      return [member](const LawBlock& block) { return block.friction.*member; };
    };
    return py::dict("x"_a = over(of.blocks, &LawBlock::x), "I"_a = over(of.blocks, point(&FrictionPoint::I)),
                    "I_error"_a = over(of.blocks, point(&FrictionPoint::I_error)),
                    "mu"_a = over(of.blocks, point(&FrictionPoint::mu)),
                    "amount"_a = over(of.blocks, &LawBlock::stress_ratio),
                    "amount_error"_a = over(of.blocks, &LawBlock::stress_ratio_error),
                    "dilatancy"_a = over(of.blocks, &LawBlock::dilatancy));
  });
  bed.def_property_readonly("paths", [](const Bed& of) {
    return py::dict("angle"_a = over(of.paths, &StressPath::depth_angle),
                    "radius"_a = over(of.paths, &StressPath::radius),
                    "axis"_a = over(of.paths, &StressPath::axis),
                    "ln_I"_a = over(of.paths, &StressPath::ln_I),
                    "spin_share"_a = over(of.paths, &StressPath::spin_share),
                    "stress"_a = over(of.paths, &StressPath::stress), "p"_a = over(of.paths, &StressPath::p));
  });
  // Over (z, x); NaN where a node does not speak.
  bed.def_property_readonly("nodes", [](const Bed& of) {
    const MapGrid& grid = of.fields.grid();
    std::vector<PathPoint> points(grid.nodes());
    for (std::size_t node = 0; node < points.size(); ++node) {
      points[node].p = std::nan("");
      if (of.fields.speaks(node))
        points[node] = of.fields.at(grid.x_of(node % grid.columns), grid.z_of(node / grid.columns));
    }
    std::vector<double> surface(grid.columns);
    for (std::size_t column = 0; column < grid.columns; ++column)
      surface[column] = of.fields.surface(grid.x_of(column));
    const auto plane = [&](auto values) {
      return values.reshape({static_cast<py::ssize_t>(grid.rows), static_cast<py::ssize_t>(grid.columns)});
    };
    return py::dict("p"_a = plane(over(points, &PathPoint::p)),
                    "rate"_a = plane(over(points, &PathPoint::rate)),
                    "stress"_a = plane(over(points, &PathPoint::stress)),
                    "surface"_a = over(surface, [](double z) { return z; }));
  });
  bed.def("axes", [](const Bed& of, double c, double m, double chi, std::optional<double> c_rho, double I_low,
                     double I_high) {
    const AxisMemory law{c, m, chi, c_rho, I_low, I_high};
    return over(of.paths, [&](const StressPath& path) { return carried_axes(path, law); });
  });
  bed.def("lag", [](const Bed& of, double c, double chi, double I_low, double I_high) {
    const AxisMemory law{c, 0, chi, {}, I_low, I_high};
    return over(of.paths, [&](const StressPath& path) { return carried_lag(path, law); });
  });
  bed.def("carried_ln_I", [](const Bed& of, double c, double low, double high) {
    return over(of.paths, [&](const StressPath& path) { return carried_ln_I(path, c, low, high); });
  });
  bed.def("carried_dilatancy", [](const Bed& of, double c) {
    return over(of.paths, [&](const StressPath& path) { return carried_dilatancy(path, c); });
  });

  py::class_<CalibratedLaw> law(module, "FittedLaw");
  refuse_new(law);
  module.def("table_knots", [](const Numbers& I) {
    return table_knots({entries(I).begin(), entries(I).end()});
  });
  module.def(
      "fitted",
      [](const std::vector<FrictionArrays>& runs, const std::string& form, const std::vector<double>& knots,
         int draws, double slope_besides) {
        std::vector<std::vector<FrictionPoint>> points;
        for (const FrictionArrays& run : runs) points.push_back(points_of("fitted", run));
        FrictionForm requested = form_named(form);
        requested.knots = knots;
        requested.slope_besides = slope_besides;
        return calibrated(points, requested, draws);
      },
      "runs"_a, "form"_a, "knots"_a = std::vector<double>(), "draws"_a = 0, "slope_besides"_a = 0.0);
  law.def_property_readonly("coefficients", [](const CalibratedLaw& of) { return of.fit.law; });
  law.def_property_readonly("knots", [](const CalibratedLaw& of) { return of.form.knots; });
  law.def_property_readonly("rms_misfit", [](const CalibratedLaw& of) { return of.fit.rms_misfit; });
  law.def_property_readonly("points", [](const CalibratedLaw& of) { return of.fit.points; });
  law.def_property_readonly("range",
                            [](const CalibratedLaw& of) { return py::make_tuple(of.I_min, of.I_max); });
  law.def_property_readonly("held",
                            [](const CalibratedLaw& of) { return held_intervals(of.form, of.fit.law); });
  law.def_property_readonly("curve", [](const CalibratedLaw& of) {
    const SampledLaw curve = sampled(of);
    return py::dict("I"_a = curve.I, "value"_a = curve.value, "low"_a = curve.low, "high"_a = curve.high);
  });
  law.def("at", [](const CalibratedLaw& of, const Numbers& I) {
    return over(entries(I), [curve = of.curve()](double at) { return curve.at(at).value; });
  });
  module.def("memory_friction",
             [](std::vector<double> knots, std::vector<double> mu, double own_weight, const Numbers& I) {
               const TabulatedLaw table = memory_friction({.mu = {std::move(knots), std::move(mu)},
                                                           .amount = AmountMemory{.own_weight = own_weight}});
               return over(entries(I), [&](double at) { return table.friction(at).mu; });
             });
  module.def("followed_slope", [](double swelling, double c_nu) {
    return followed_slope({.swelling = swelling, .c_nu = c_nu});
  });
  module.def("least_growths", [](const std::vector<double>& knots) {
    const FrictionForm form{.kind = FormKind::table, .knots = knots};
    std::vector<double> least;
    for (std::size_t j = 0; j < knots.size(); ++j) least.push_back(least_coefficient(form, j));
    return least;
  });
}

}  // namespace drumlin::python
