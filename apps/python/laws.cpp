// Laws for Python: files evaluated over arrays, and calibration from arrays.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>

#include "apps/python/arrays-inl.h"
#include "apps/python/bindings.hpp"
#include "apps/python/others_run.hpp"
#include "coupling/calibration/calibration.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/law_curve.hpp"
#include "coupling/core/law/rheology_file.hpp"

namespace py = pybind11;

namespace drumlin::python {
namespace {

/// The entries of a function over an array, in its shape.
template <class Function>
py::array_t<double> over(const Numbers& I, const Function& value) {
  py::array_t<double> result(std::vector<py::ssize_t>(I.shape(), I.shape() + I.ndim()));
  for (py::ssize_t k = 0; k < I.size(); ++k) {
    if (!(I.data()[k] > 0)) throw InputError("an inertial number is not above 0");
    result.mutable_data()[k] = value(I.data()[k]);
  }
  return result;
}

constexpr int most_draws = 10000;  // as `drumlin calibrate` takes them

coupling::Calibration calibrated(const std::vector<FrictionArrays>& arrays,
                                 const std::vector<std::string>& names, double nu, const std::string& form,
                                 int draws, const py::object& drawn) {
  if (!(nu > 0 && nu < 1)) throw InputError("nu: the volume fraction of the bulk (allowed: between 0 and 1)");
  if (draws < 20 || draws > most_draws)
    throw InputError(fmt::format("draws: {} (allowed: 20 to {})", draws, most_draws));
  std::vector<coupling::RunEvidence> runs;
  for (std::size_t k = 0; k < arrays.size(); ++k)
    runs.push_back(
        {.name = names.at(k), .nu = {"nu_bulk", nu, {}}, .layers = points_of(names.at(k), arrays[k])});
  if (runs.empty()) throw InputError("no points");
  coupling::CalibrationOptions options{.source = coupling::EvidenceSource::profiles, .draws = draws};
  if (in_main_thread())
    options.before_each_draw = [&drawn] {  // Ctrl-C is seen here
      const py::gil_scoped_acquire lock;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!drawn.is_none()) drawn();
    };
  if (form != "auto") options.form = form;
  const OthersRun others_run;
  coupling::Calibration found = coupling::calibration_of(std::move(runs), {}, options);
  found.options.before_each_draw = {};
  return found;
}

py::tuple band_of(const coupling::Calibration& calibration, const Numbers& I, double share) {
  if (!(share > 0 && share < 1)) throw InputError("share: of the draws (allowed: between 0 and 1)");
  const auto band = calibration.law().band();
  return py::make_tuple(over(I, [&](double i) { return band.at(i, share).low; }),
                        over(I, [&](double i) { return band.at(i, share).high; }));
}

}  // namespace

void add_laws(py::module_& module) {
  py::class_<RheologyFit> law(module, "Law");
  refuse_new(law);
  module.def("law", &parse_rheology);
  law.def("mu", [](const RheologyFit& of, const Numbers& I) {
    return over(I, [&](double i) { return friction_at(of.mu, i).mu; });
  });
  law.def("slope", [](const RheologyFit& of, const Numbers& I) {
    return over(I, [&](double i) { return friction_at(of.mu, i).slope; });
  });
  law.def_property_readonly("nu", [](const RheologyFit& of) { return of.nu; });
  law.def_property_readonly("words", [](const RheologyFit& of) { return described(of.mu); });

  // a, b, half widths of their intervals, rms of mu, Birge ratio, number and range of the points.
  module.def("fit_log_friction", [](const FrictionArrays& arrays) {
    const coupling::FrictionFit fit = coupling::fit_log_friction(points_of("fit_log_friction", arrays));
    const auto& [var_a, covariance, var_b] = fit.law.covariance;
    return py::make_tuple(fit.law.a, fit.law.b, half_width_99(fit, var_a), half_width_99(fit, var_b),
                          fit.rms_misfit, fit.birge_ratio, fit.points, fit.law.I_min, fit.law.I_max);
  });
  module.def("log_curve", [](double a, double b, double I_min, double I_max) {
    const LawCurve curve = law_curve(LogLaw{.a = a, .b = b}, I_min, I_max);
    return py::dict(py::arg("I") = curve.I, py::arg("mu") = curve.mu);
  });

  using coupling::Calibration;
  py::class_<Calibration> calibration(module, "Calibration");
  refuse_new(calibration);
  module.def("calibrate", &calibrated);
  calibration.def_property_readonly("text", [](const Calibration& c) { return rheology_text(c.rheology); });
  calibration.def_property_readonly("form", [](const Calibration& c) { return name_of(c.law().form); });
  calibration.def_property_readonly("coefficients", [](const Calibration& c) { return c.law().fit.law; });
  calibration.def_property_readonly("rms_misfit",
                                    [](const Calibration& c) { return c.law().fit.rms_misfit; });
  calibration.def_property_readonly("scatter",
                                    [](const Calibration& c) { return c.law().fit.intrinsic_scatter; });
  calibration.def_property_readonly("points", [](const Calibration& c) { return c.law().fit.points; });
  calibration.def_property_readonly(
      "range", [](const Calibration& c) { return py::make_tuple(c.law().I_min, c.law().I_max); });
  calibration.def_property_readonly("ill_posed", [](const Calibration& c) {
    py::list ranges;
    for (const InertialRange& range : c.ill_posed) ranges.append(py::make_tuple(range.from, range.to));
    return ranges;
  });
  calibration.def("band", &band_of, py::arg("I"), py::arg("share") = 0.99);
}

}  // namespace drumlin::python
