// Fuzz target: the text of a law. One that is accepted has a positive, finite mu(I) that does not fall.
#include <cmath>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "tests/fuzz/one_input.hpp"

using namespace drumlin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refused([&] {
    const RheologyFit fit = parse_rheology(fuzz::text_of(data, size), "rheology.toml");
    for (const double I : {1e-9, 1e-6, 1e-3, 1e-1, 1e1}) {
      const Strength at = std::visit([I](const auto& law) { return strength(law, 0.5 * I, 1); }, fit.mu);
      if (!(at.value > 0) || !std::isfinite(at.value) || !(I * at.d_rate >= -2e-9 * at.value)) std::abort();
    }
    (void)rheology_text(fit);
  });
}
