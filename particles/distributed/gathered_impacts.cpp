#include "particles/distributed/gathered_impacts.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace drumlin::particles {
namespace {

// How many pairs around what closes, or around bodies that were missing, are sent at once. Passes of a
// flowing drum go on by 2.4 pairs on average, the furthest of a large one by a dozen: one that goes on
// further than was sent costs more than some pairs too many. After that many times all pairs are sent.
constexpr std::array<int, 2> reach{5, 15};

/// Sorts what consists of a few runs in order: the first `sorted` records and what each rank has sent.
template <class Record, class Less>
void merge_runs(std::vector<Record>& records, std::size_t sorted, Less less) {
  for (auto end = records.begin() + static_cast<std::ptrdiff_t>(sorted); end != records.end();) {
    const auto next = std::is_sorted_until(end, records.end(), less);
    std::inplace_merge(records.begin(), end, next, less);
    end = next;
  }
}

StruckRecord record_of(const StruckGrain& grain, const Bodies& bodies) {
  const std::int32_t b = grain.grain;
  return {bodies.id[b], bodies.v_x[b], bodies.v_z[b], bodies.spin.empty() ? 0 : bodies.spin[b], grain.before};
}

}  // namespace

std::vector<StruckRecord> GatheredImpacts::resolve(const RankImpacts& mine) {
  count_ = 0;
  if (ranks_.count() == 1) return resolve_alone(mine);
  const bool close = looked_.any(mine.step, mine.loads, mine.contacts);
  if (!ranks_.any(close)) return {};
  ++counts_.times;
  const std::size_t seen = mine.step.bodies.count();
  seed_.assign(seen, 0), wanted_.assign(seen, 0), sent_.assign(seen, 0);
  pair_sent_.assign(mine.contacts.pairs.size(), 0);
  pairs_.clear(), bodies_.clear();
  const std::size_t identities = ranks_.rank() == 0 ? mine.place_of.size() : 0;
  whole_.assign(identities, 0), place_of_.resize(identities);
  find_neighbours(mine);
  for (const std::int32_t a : looked_.closings()) {
    const Candidate& pair = mine.contacts.pairs[a];
    seed_[pair.i] = 1;
    if (pair.j >= 0) seed_[pair.j] = 1;
  }
  std::vector<StruckRecord> struck;
  for (std::size_t times = 0;; ++times) {
    ++counts_.rounds;
    const bool all = times == reach.size();
    if (all)
      std::fill(wanted_.begin(), wanted_.end(), 1);
    else
      want(mine, ranks_.gather_everywhere<std::int32_t>(around(mine, reach[times])));
    send(mine);
    missing_.clear();
    if (ranks_.rank() == 0) resolve_gathered(mine.step, all, struck);
    ranks_.broadcast(missing_);
    if (missing_.empty()) break;
    if (all) throw std::logic_error("a pair of an impact is on no rank");
    seed_.assign(seen, 0);
    for (const std::int32_t id : missing_)
      if (const std::int32_t b = mine.place_of[id]; b >= 0) seed_[b] = 1;
  }
  ranks_.broadcast(struck);
  std::array<std::int64_t, 1> count{count_};
  ranks_.add(count);  // of the first, who alone knows it
  count_ = static_cast<int>(count[0]);
  return struck;
}

/// On one rank nothing has to be sent.
std::vector<StruckRecord> GatheredImpacts::resolve_alone(const RankImpacts& mine) {
  mine.contacts.strikes.clear();
  impacts_.resolve(mine.step, mine.loads, mine.bodies, mine.contacts);
  count_ = impacts_.count();
  counts_.times += count_ > 0;
  const auto& id = mine.bodies.id;
  for (Strike strike : mine.contacts.strikes) {
    strike.i = static_cast<std::int32_t>(id[strike.i]);
    if (strike.j >= 0) strike.j = static_cast<std::int32_t>(id[strike.j]);
    strikes_.push_back(strike);
  }
  std::vector<StruckRecord> struck;
  for (const StruckGrain& grain : impacts_.struck()) struck.push_back(record_of(grain, mine.bodies));
  return struck;
}

void GatheredImpacts::find_neighbours(const RankImpacts& mine) {
  first_.assign(mine.step.bodies.count() + 1, 0);
  for (const Candidate& pair : mine.candidates)
    if (pair.j >= 0) ++first_[pair.i], ++first_[pair.j];
  std::exclusive_scan(first_.begin(), first_.end(), first_.begin(), 0);
  neighbour_.resize(first_.back());
  // Each body's first place moves on as it fills, to that of the next one.
  for (const Candidate& pair : mine.candidates)
    if (pair.j >= 0) neighbour_[first_[pair.i]++] = pair.j, neighbour_[first_[pair.j]++] = pair.i;
  std::shift_right(first_.begin(), first_.end(), 1);
  first_.front() = 0;
}

std::vector<std::int32_t> GatheredImpacts::around(const RankImpacts& mine, int pairs) {
  ring_.clear();
  for (std::size_t b = 0; b < seed_.size(); ++b)
    if (seed_[b]) ring_.push_back(static_cast<std::int32_t>(b));
  std::vector<std::int32_t> marked;
  const auto& id = mine.step.bodies.id;
  const auto mark = [&](std::int32_t b) {
    if (!wanted_[b]) marked.push_back(static_cast<std::int32_t>(id[b]));
  };
  for (const std::int32_t b : ring_) mark(b);
  std::size_t begin = 0;
  for (int k = 0; k < pairs; ++k) {
    const std::size_t end = ring_.size();
    for (; begin < end; ++begin) {
      const std::int32_t b = ring_[begin];
      for (std::int32_t n = first_[b]; n < first_[b + 1]; ++n)
        if (!std::exchange(seed_[neighbour_[n]], 1)) ring_.push_back(neighbour_[n]), mark(neighbour_[n]);
    }
  }
  return marked;
}

void GatheredImpacts::want(const RankImpacts& mine, std::span<const std::int32_t> identities) {
  for (const std::int32_t id : identities)
    if (const std::int32_t b = mine.place_of[id]; b >= 0) wanted_[b] = 1;
  if (ranks_.rank() == 0)
    for (const std::int32_t id : identities) whole_[id] = 1;
}

void GatheredImpacts::send(const RankImpacts& mine) {
  const Bodies& bodies = mine.step.bodies;
  const auto& id = bodies.id;
  const auto comes_before = [](const BodyRecord& a, const BodyRecord& b) { return a.id < b.id; };
  constexpr char sent_now = 2;
  std::vector<PairRecord> pairs;
  const auto name = [&](std::int32_t b) {
    if (!sent_[b]) sent_[b] = sent_now;
    return static_cast<std::int32_t>(id[b]);
  };
  for (std::size_t a = 0; a < mine.contacts.pairs.size(); ++a) {
    const Candidate& pair = mine.contacts.pairs[a];
    if (pair_sent_[a] || !(wanted_[pair.i] | (pair.j >= 0 ? wanted_[pair.j] : 0))) continue;
    pair_sent_[a] = 1;
    const std::int32_t i = name(pair.i), j = pair.j < 0 ? pair.j : name(pair.j);
    pairs.push_back({i, j, pair.gap, pair.n_x, pair.n_z, pair.wall_v_x, pair.wall_v_z,
                     mine.loads.of(static_cast<std::int32_t>(a))});
  }
  std::vector<BodyRecord> grains;  // by identity, as the rank sees them
  for (std::size_t b = 0; b < sent_.size(); ++b) {
    if (sent_[b] != sent_now) continue;
    sent_[b] = 1;
    grains.push_back({static_cast<std::int32_t>(id[b]), bodies.v_x[b], bodies.v_z[b],
                      bodies.spin.empty() ? 0 : bodies.spin[b], bodies.radius[b], bodies.inverse_mass[b]});
  }
  counts_.pairs += static_cast<std::int64_t>(pairs.size());
  counts_.bytes +=
      static_cast<std::int64_t>(pairs.size() * sizeof(PairRecord) + grains.size() * sizeof(BodyRecord));
  const auto more = ranks_.gather<PairRecord>(pairs);
  const std::size_t held = pairs_.size(), known = bodies_.size();
  pairs_.insert(pairs_.end(), more.begin(), more.end());
  merge_runs(pairs_, held, [](const PairRecord& a, const PairRecord& b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  });
  const auto named = ranks_.gather<BodyRecord>(grains);
  bodies_.insert(bodies_.end(), named.begin(), named.end());
  merge_runs(bodies_, known, comes_before);
}

void GatheredImpacts::resolve_gathered(const StepInput& step, bool all, std::vector<StruckRecord>& struck) {
  // Several ranks may have told of one grain, all the same.
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end(),
                            [](const BodyRecord& a, const BodyRecord& b) { return a.id == b.id; }),
                bodies_.end());
  const std::size_t count = bodies_.size();
  Bodies bodies;
  for (auto* entries : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass})
    entries->resize(count);  // impacts ask for no places
  bodies.id.resize(count), bodies.spin.resize(step.laws.spin ? count : 0);
  std::vector<char> whole(count);
  for (std::size_t b = 0; b < count; ++b) {
    const BodyRecord& body = bodies_[b];
    bodies.v_x[b] = body.v_x, bodies.v_z[b] = body.v_z;
    bodies.radius[b] = body.radius, bodies.inverse_mass[b] = body.inverse_mass;
    if (step.laws.spin) bodies.spin[b] = body.spin;
    bodies.id[b] = body.id;
    whole[b] = static_cast<char>(all || whole_[body.id]);
    place_of_[body.id] = static_cast<std::int32_t>(b);
  }
  StepContacts contacts;
  std::vector<double> load;
  contacts.pairs.reserve(pairs_.size()), load.reserve(pairs_.size());
  for (const PairRecord& pair : pairs_) {
    contacts.pairs.push_back({place_of_[pair.i], pair.j < 0 ? pair.j : place_of_[pair.j], pair.gap, pair.n_x,
                              pair.n_z, pair.wall_v_x, pair.wall_v_z});
    load.push_back(pair.load);
  }
  std::vector<std::int32_t> as_they_stand(pairs_.size());
  std::iota(as_they_stand.begin(), as_they_stand.end(), 0);
  const FreeMotion unused;
  const StepInput known{step.laws, bodies, step.walls, {}, unused, step.time_step};
  if (!impacts_.resolve_part(known, {as_they_stand, load, 1, 1}, whole, bodies, contacts)) {
    for (const std::int32_t b : impacts_.missing()) missing_.push_back(bodies_[b].id);
    return;
  }
  count_ = impacts_.count();
  for (Strike strike : contacts.strikes) {
    strike.i = bodies_[strike.i].id;
    if (strike.j >= 0) strike.j = bodies_[strike.j].id;
    strikes_.push_back(strike);
  }
  for (const StruckGrain& grain : impacts_.struck()) struck.push_back(record_of(grain, bodies));
}

}  // namespace drumlin::particles
