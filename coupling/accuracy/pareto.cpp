#include "coupling/accuracy/pareto.hpp"

#include <cmath>

namespace drumlin::coupling {

std::vector<bool> pareto_front(std::span<const double> cost, std::span<const double> error) {
  const auto known = [&](std::size_t i) { return std::isfinite(cost[i]) && std::isfinite(error[i]); };
  const auto beats = [&](std::size_t a, std::size_t b) {
    return known(a) && cost[a] <= cost[b] && error[a] <= error[b] &&
           (cost[a] < cost[b] || error[a] < error[b]);
  };
  std::vector<bool> front(cost.size(), false);
  for (std::size_t i = 0; i < cost.size(); ++i) {
    front[i] = known(i);
    for (std::size_t j = 0; j < cost.size() && front[i]; ++j) front[i] = !beats(j, i);
  }
  return front;
}

}  // namespace drumlin::coupling
