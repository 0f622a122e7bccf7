#include "particles/distributed/gathered_impacts.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace drumlin::particles {
namespace {

// How far around the discs that close, or that were missing, pairs are sent at once, in d. Passes of a
// flowing drum go on by 2.4 pairs on average, the furthest of a large one by a dozen: one that goes on
// further than was sent costs more than some pairs too many. After that many times all pairs are sent.
constexpr std::array<double, 2> reach{4, 15};

/// Sorts what consists of a few runs in order: the first `sorted` records and what each rank has sent.
template <class Record, class Less>
void merge_runs(std::vector<Record>& records, std::size_t sorted, Less less) {
  for (auto end = records.begin() + static_cast<std::ptrdiff_t>(sorted); end != records.end();) {
    const auto next = std::is_sorted_until(end, records.end(), less);
    std::inplace_merge(records.begin(), end, next, less);
    end = next;
  }
}

StruckRecord record_of(const StruckGrain& grain, const Bodies& bodies, std::span<const PathShift> shift) {
  const std::int32_t b = grain.grain;
  return {bodies.id[b], bodies.v_x[b], bodies.v_z[b], bodies.spin.empty() ? 0 : bodies.spin[b],
          grain.before, shift[b]};
}

}  // namespace

std::vector<Strike> GatheredImpacts::strikes() const {
  auto records = ranks_.gather<StrikeRecord>(strikes_);
  std::stable_sort(records.begin(), records.end(),
                   [](const StrikeRecord& a, const StrikeRecord& b) { return a.call < b.call; });
  std::vector<Strike> strikes;
  for (const StrikeRecord& record : records) strikes.push_back(record.strike);
  return strikes;
}

bool GatheredImpacts::choose_resolver(const RankImpacts& mine) {
  std::vector<std::int64_t> closings(ranks_.count(), 0);
  if (looked_.any({mine.step, mine.contacts.pairs, mine.loads, {}}))
    closings[ranks_.rank()] = static_cast<std::int64_t>(looked_.closings().size());
  ranks_.add(closings);
  const auto most = std::max_element(closings.begin(), closings.end());
  resolver_ = static_cast<int>(most - closings.begin());
  return *most > 0;
}

std::vector<StruckRecord> GatheredImpacts::resolve(const RankImpacts& mine) {
  count_ = unresolved_ = 0;
  ++calls_;
  if (ranks_.count() == 1) return resolve_alone(mine);
  if (!choose_resolver(mine)) return {};
  ++counts_.times;
  const std::size_t seen = mine.step.bodies.count();
  wanted_.assign(seen, 0), sent_.assign(seen, 0);
  pair_sent_.assign(mine.contacts.pairs.size(), 0);
  pairs_.clear(), bodies_.clear();
  if (resolves()) place_of_.resize(mine.place_of.size());
  near_.clear(mine.all, mine.step.bodies);
  seeds_.clear();
  for (const std::int32_t a : looked_.closings()) {
    const Candidate& pair = mine.contacts.pairs[a];
    seeds_.push_back(pair.i);
    if (pair.j >= 0) seeds_.push_back(pair.j);
  }
  std::sort(seeds_.begin(), seeds_.end());
  seeds_.erase(std::unique(seeds_.begin(), seeds_.end()), seeds_.end());
  std::vector<StruckRecord> struck;
  for (std::size_t times = 0;; ++times) {
    ++counts_.rounds;
    const bool all = times == reach.size();
    if (all)
      std::fill(wanted_.begin(), wanted_.end(), 1);
    else
      want_around(mine.step.bodies, reach[times]);
    send(mine);
    missing_.clear();
    if (resolves()) resolve_gathered(mine.step, struck);
    ranks_.broadcast(missing_, resolver_);
    if (missing_.empty()) break;
    if (all) throw std::logic_error("a pair of an impact is on no rank");
    seeds_.clear();
    for (const std::int32_t id : missing_)
      if (const std::int32_t b = mine.place_of[id]; b >= 0) seeds_.push_back(b);
  }
  ranks_.broadcast(struck, resolver_);
  std::array<std::int64_t, 2> counts{count_, unresolved_};
  ranks_.add(counts);  // of the one that alone knows them
  count_ = static_cast<int>(counts[0]), unresolved_ = static_cast<int>(counts[1]);
  return struck;
}

/// On one rank nothing has to be sent.
std::vector<StruckRecord> GatheredImpacts::resolve_alone(const RankImpacts& mine) {
  mine.contacts.strikes.clear();
  impacts_.resolve({mine.step, mine.contacts.pairs, mine.loads, {}},
                   {mine.bodies, mine.shift, mine.contacts});
  count_ = impacts_.count(), unresolved_ = impacts_.unresolved();
  counts_.times += count_ > 0;
  const auto& id = mine.bodies.id;
  for (Strike strike : mine.contacts.strikes) {
    strike.i = static_cast<std::int32_t>(id[strike.i]);
    if (strike.j >= 0) strike.j = static_cast<std::int32_t>(id[strike.j]);
    strikes_.push_back({calls_, strike});
  }
  std::vector<StruckRecord> struck;
  for (const StruckGrain& grain : impacts_.struck())
    struck.push_back(record_of(grain, mine.bodies, mine.shift));
  return struck;
}

void GatheredImpacts::want_around(const Bodies& seen, double reach) {
  std::vector<Surroundings> places;
  for (const std::int32_t b : seeds_) places.push_back({{seen.x[b], seen.z[b]}, seen.radius[b] + reach});
  near_.mark(ranks_.gather_everywhere<Surroundings>(places));
  for (std::size_t b = 0; b < wanted_.size(); ++b)
    wanted_[b] = static_cast<char>(near_.marked({seen.x[b], seen.z[b]}));
}

void GatheredImpacts::list_wanted(const RankImpacts& mine) {
  const Bodies& bodies = mine.step.bodies;
  const auto& id = bodies.id;
  enum : char { no, as_part, as_whole, now };
  const auto name = [&](std::int32_t b) {
    if (sent_[b] == no || (sent_[b] == as_part && wanted_[b])) sent_[b] = now;
    return static_cast<std::int32_t>(id[b]);
  };
  listed_pairs_.clear();
  for (std::size_t a = 0; a < mine.contacts.pairs.size(); ++a) {
    const Candidate& pair = mine.contacts.pairs[a];
    if (!(wanted_[pair.i] | (pair.j >= 0 ? wanted_[pair.j] : 0))) continue;
    const std::int32_t i = name(pair.i), j = pair.j < 0 ? pair.j : name(pair.j);
    if (std::exchange(pair_sent_[a], 1)) continue;
    listed_pairs_.push_back({i, j, pair.gap, pair.n_x, pair.n_z, pair.wall_v_x, pair.wall_v_z,
                             mine.loads.of(static_cast<std::int32_t>(a))});
  }
  listed_bodies_.clear();
  for (std::size_t b = 0; b < sent_.size(); ++b) {
    if (sent_[b] != now) continue;
    sent_[b] = wanted_[b] ? as_whole : as_part;
    BodyRecord body;
    body.id = static_cast<std::int32_t>(id[b]), body.whole = wanted_[b];
    body.x = bodies.x[b], body.z = bodies.z[b], body.v_x = bodies.v_x[b], body.v_z = bodies.v_z[b];
    if (!mine.shift.empty()) body.shift = mine.shift[b];
    if (!bodies.spin.empty()) body.spin = bodies.spin[b];
    body.radius = bodies.radius[b], body.inverse_mass = bodies.inverse_mass[b];
    listed_bodies_.push_back(body);
  }
}

void GatheredImpacts::send(const RankImpacts& mine) {
  list_wanted(mine);
  const std::size_t held = pairs_.size(), known = bodies_.size();
  // What the resolving rank has itself it does not send.
  const auto take = [](auto& all, auto& listed) {
    if (all.empty()) return all.swap(listed);
    all.insert(all.end(), listed.begin(), listed.end());
    listed.clear();
  };
  if (resolves()) take(pairs_, listed_pairs_), take(bodies_, listed_bodies_);
  counts_.pairs += static_cast<std::int64_t>(listed_pairs_.size());
  counts_.bytes += static_cast<std::int64_t>(listed_pairs_.size() * sizeof(PairRecord) +
                                             listed_bodies_.size() * sizeof(BodyRecord));
  const auto more = ranks_.gather<PairRecord>(listed_pairs_, resolver_);
  pairs_.insert(pairs_.end(), more.begin(), more.end());
  merge_runs(pairs_, held, [](const PairRecord& a, const PairRecord& b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  });
  const auto named = ranks_.gather<BodyRecord>(listed_bodies_, resolver_);
  bodies_.insert(bodies_.end(), named.begin(), named.end());
  merge_runs(bodies_, known, [](const BodyRecord& a, const BodyRecord& b) { return a.id < b.id; });
}

void GatheredImpacts::resolve_gathered(const StepInput& step, std::vector<StruckRecord>& struck) {
  // Several ranks may have told of one grain, all the same, or first that a part of its pairs is sent.
  std::size_t count = 0;
  for (const BodyRecord& body : bodies_)
    if (count > 0 && bodies_[count - 1].id == body.id)
      bodies_[count - 1].whole |= body.whole;
    else
      bodies_[count++] = body;
  bodies_.resize(count);
  Bodies bodies;
  for (auto* entries : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass})
    entries->resize(count);
  FreeMotion free;
  free.shift.resize(count);
  bodies.id.resize(count), bodies.spin.resize(step.laws.spin ? count : 0);
  std::vector<char> whole(count);
  for (std::size_t b = 0; b < count; ++b) {
    const BodyRecord& body = bodies_[b];
    bodies.x[b] = body.x, bodies.z[b] = body.z, free.shift[b] = body.shift;
    bodies.v_x[b] = body.v_x, bodies.v_z[b] = body.v_z;
    bodies.radius[b] = body.radius, bodies.inverse_mass[b] = body.inverse_mass;
    if (step.laws.spin) bodies.spin[b] = body.spin;
    bodies.id[b] = body.id;
    whole[b] = static_cast<char>(body.whole);
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
  const StepInput known{step.laws, bodies, step.walls, {}, free, step.time_step};
  const RememberedLoads loads(as_they_stand, load, 1, 1);
  if (!impacts_.resolve_part({known, contacts.pairs, loads, {}}, whole, {bodies, free.shift, contacts})) {
    for (const std::int32_t b : impacts_.missing()) missing_.push_back(bodies_[b].id);
    return;
  }
  count_ = impacts_.count(), unresolved_ = impacts_.unresolved();
  for (Strike strike : contacts.strikes) {
    strike.i = bodies_[strike.i].id;
    if (strike.j >= 0) strike.j = bodies_[strike.j].id;
    strikes_.push_back({calls_, strike});
  }
  for (const StruckGrain& grain : impacts_.struck()) struck.push_back(record_of(grain, bodies, free.shift));
}

}  // namespace drumlin::particles
