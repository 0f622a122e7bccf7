// Fuzz target: the text of a law. One that is accepted has a positive, finite mu(I) that does not fall.
#include <cmath>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "tests/fuzz/one_input.hpp"

using namespace drumlin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refused([&] {
    const RheologyFit fit = parse_rheology(fuzz::text_of(data, size), "rheology.toml");
    const FrictionLaw law = fit.mu;
    for (const double I : {1e-9, 1e-6, 1e-3, 1e-1, 1e1}) {
      const FrictionValue at = friction_at(law, I);
      if (!(at.mu > 0) || !std::isfinite(at.mu) || !(at.slope >= -1e-9 * at.mu)) std::abort();
    }
    (void)rheology_text(fit);
  });
}
