#include "coupling/law/law_draws.hpp"

#include <utility>

namespace drumlin {
namespace {

MeasuredFriction with_draw(MeasuredFriction mu, std::vector<double> draw) {
  if (auto* log = std::get_if<LogFriction>(&mu)) {
    log->a = draw[0];
    log->b = draw[1];
  } else if (auto* both = std::get_if<LogLinearFriction>(&mu)) {
    both->a = draw[0];
    both->b = draw[1];
    both->c = draw[2];
  } else if (auto* table = std::get_if<FrictionTable>(&mu)) {
    table->mu = std::move(draw);
  }
  return mu;
}

}  // namespace

std::size_t draw_size(const MeasuredFriction& mu) {
  if (std::holds_alternative<LogFriction>(mu)) return 2;
  if (std::holds_alternative<LogLinearFriction>(mu)) return 3;
  const auto* table = std::get_if<FrictionTable>(&mu);
  return table == nullptr ? 0 : table->mu.size();
}

std::vector<double> draw_of(const MeasuredFriction& mu) {
  if (const auto* log = std::get_if<LogFriction>(&mu)) return {log->a, log->b};
  if (const auto* both = std::get_if<LogLinearFriction>(&mu)) return {both->a, both->b, both->c};
  const auto* table = std::get_if<FrictionTable>(&mu);
  return table == nullptr ? std::vector<double>() : table->mu;
}

std::vector<MeasuredFriction> draws_of(const MeasuredFriction& mu, const std::vector<double>& numbers) {
  std::vector<MeasuredFriction> laws;
  const std::size_t size = draw_size(mu);
  for (std::size_t first = 0; first + size <= numbers.size(); first += size)
    laws.push_back(with_draw(mu, {numbers.begin() + static_cast<std::ptrdiff_t>(first),
                                  numbers.begin() + static_cast<std::ptrdiff_t>(first + size)}));
  return laws;
}

}  // namespace drumlin
