#include "coupling/core/results/layer_ratios.hpp"

#include <utility>

namespace drumlin {
namespace {

struct Ratio {
  const char *name, *above;
  double LayerRatios::*value;
  double power;  ///< of sigma_zz below
};
constexpr Ratio ratios[] = {{"I", "shear_rate", &LayerRatios::I, 0.5},
                            {"mu", "sigma_xz", &LayerRatios::mu, 1},
                            {"k", "sigma_xx", &LayerRatios::k, 1}};

double relative(const ProfileColumn& column, std::size_t layer) {
  return column.ci99[layer] / column.value[layer];
}

}  // namespace

void add_layer_ratios(ProfileSet& set) {
  for (const Ratio& ratio : ratios) {
    const ProfileColumn &above = set.column(ratio.above), &zz = set.column("sigma_zz");
    ProfileColumn column{ratio.name, {}, {}};
    for (std::size_t l = 0; l < set.z.size(); ++l) {
      const LayerStress sigma{set.column("sigma_xx").value[l], zz.value[l], set.column("sigma_xz").value[l]};
      column.value.push_back(layer_ratios(sigma, set.column("shear_rate").value[l]).*ratio.value);
      if (above.ci99.empty() || zz.ci99.empty()) continue;
      column.ci99.push_back(std::abs(column.value.back()) *
                            std::hypot(relative(above, l), ratio.power * relative(zz, l)));
    }
    set.columns.push_back(std::move(column));
  }
}

}  // namespace drumlin
