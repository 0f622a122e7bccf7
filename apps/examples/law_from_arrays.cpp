// A law from arrays: friction that was measured somewhere, its errors, a fit with its band, and the file that
// `drumlin flow` reads.
#include <cmath>
#include <cstdio>
#include <utility>

#include "coupling/calibration/calibration.hpp"
#include "coupling/core/law/rheology_file.hpp"

using namespace drumlin;

int main(int argc, char** argv) {
  // Forty points of mu = 0.35 + 0.02 ln I with errors of 0.003, as an experiment might give them.
  coupling::RunEvidence measured{.name = "shear cell", .nu = {"nu_bulk", 0.81, 0.002}};
  for (int i = 0; i < 40; ++i) {
    const double I = std::pow(10, -3 + 0.05 * i), noise = 0.003 * std::sin(37.0 * i);
    measured.layers.push_back(
        {.I = I, .mu = 0.35 + 0.02 * std::log(I) + noise, .I_error = 0.01 * I, .mu_error = 0.003});
  }
  const coupling::Calibration calibration =
      coupling::calibration_of({measured}, {}, {.source = coupling::EvidenceSource::profiles, .form = "log"});
  const coupling::CalibratedLaw& law = calibration.law();
  std::printf("%s, rms misfit %.4f\n", described(calibration.rheology.mu).c_str(), law.fit.rms_misfit);
  for (const double I : {1e-3, 1e-2, 1e-1}) {
    const auto band = law.band().at(I);
    std::printf("mu(%.0e) = %.4f, between %.4f and %.4f with 99 %%\n", I, law.curve().at(I).value, band.low,
                band.high);
  }
  std::printf("%s\n", calibration.ill_posed.empty() ? "well-posed" : "ill-posed somewhere");
  write_rheology(argc > 1 ? argv[1] : "rheology.toml", calibration.rheology);
}
