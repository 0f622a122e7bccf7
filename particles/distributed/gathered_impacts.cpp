#include "particles/distributed/gathered_impacts.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace drumlin::particles {

std::vector<StruckRecord> GatheredImpacts::resolve(const StepInput& step, const RememberedLoads& loads,
                                                   const StepContacts& contacts,
                                                   std::span<const RankGrain> own) {
  count_ = 0;
  if (!ranks_.any(looked_.any(step, loads, contacts))) return {};
  const auto& id = step.bodies.id;
  std::vector<PairRecord> mine;
  for (std::size_t a = 0; a < contacts.pairs.size(); ++a) {
    const Candidate& pair = contacts.pairs[a];
    mine.push_back({id[pair.i], pair.j < 0 ? pair.j : id[pair.j], pair.gap, pair.n_x, pair.n_z, pair.wall_v_x,
                    pair.wall_v_z, loads.of(static_cast<std::int32_t>(a))});
  }
  pairs_ = ranks_.gather<PairRecord>(mine);
  const auto grains = ranks_.gather<RankGrain>(own);
  std::vector<StruckRecord> struck;
  if (ranks_.rank() == 0) struck = resolve_for_all(step, grains);
  ranks_.broadcast(struck);
  std::vector<std::int64_t> count{count_};
  ranks_.add(count);  // of the first, who alone knows it
  count_ = static_cast<int>(count[0]);
  return struck;
}

std::vector<StruckRecord> GatheredImpacts::resolve_for_all(const StepInput& step,
                                                           std::span<const RankGrain> grains) {
  // Those of each rank come in the order of (i, j): runs that are merged.
  const auto before = [](const PairRecord& a, const PairRecord& b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  };
  for (auto sorted = std::is_sorted_until(pairs_.begin(), pairs_.end(), before); sorted != pairs_.end();) {
    const auto run = std::is_sorted_until(sorted, pairs_.end(), before);
    std::inplace_merge(pairs_.begin(), sorted, run, before);
    sorted = run;
  }
  Bodies bodies;
  for (auto* values : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass})
    values->resize(grains.size());
  if (step.laws.spin) bodies.spin.resize(grains.size());
  for (const RankGrain& grain : grains) {
    const auto b = static_cast<std::size_t>(grain.id);
    bodies.x[b] = grain.x, bodies.z[b] = grain.z, bodies.v_x[b] = grain.v_x, bodies.v_z[b] = grain.v_z;
    bodies.radius[b] = grain.radius, bodies.inverse_mass[b] = grain.inverse_mass;
    if (step.laws.spin) bodies.spin[b] = grain.spin;
  }
  StepContacts contacts;
  std::vector<double> load;
  for (const PairRecord& pair : pairs_) {
    contacts.pairs.push_back({static_cast<std::int32_t>(pair.i), static_cast<std::int32_t>(pair.j), pair.gap,
                              pair.n_x, pair.n_z, pair.wall_v_x, pair.wall_v_z});
    load.push_back(pair.load);
  }
  std::vector<std::int32_t> place(pairs_.size());
  std::iota(place.begin(), place.end(), 0);
  const FreeMotion unused;
  const StepInput all{step.laws, bodies, step.walls, {}, unused, step.time_step};
  impacts_.resolve(all, {place, load, 1, 1}, bodies, contacts);
  count_ = impacts_.count();
  strikes_.insert(strikes_.end(), contacts.strikes.begin(), contacts.strikes.end());
  std::vector<StruckRecord> struck;
  for (const StruckGrain& grain : impacts_.struck()) {
    const std::int32_t b = grain.grain;
    struck.push_back({b, bodies.v_x[b], bodies.v_z[b], step.laws.spin ? bodies.spin[b] : 0});
  }
  return struck;
}

}  // namespace drumlin::particles
