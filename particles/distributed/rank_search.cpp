#include "particles/distributed/rank_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "particles/stepping/set_free_motion.hpp"

namespace drumlin::particles {
namespace {

// Rounds of impacts within a step, which may throw grains into pairs that no search has found.
constexpr int most_searches = 5;

}  // namespace

RankSearch::RankSearch(const StepLaws& laws, const Ranks& ranks, std::int64_t grains_of_all, int unknowns,
                       RankGrains& grains, ThreadTeam* team, WorkMemory* memory)
    : laws_(laws),
      ranks_(ranks),
      grains_of_all_(grains_of_all),
      unknowns_(unknowns),
      grains_(grains),
      impacts_(ranks),
      loops_(team) {
  const auto share = [&](auto&... users) { (users.use(team), ...), (users.use(memory), ...); };
  share(detection_, recollection_);
}

ImpactCounts RankSearch::find(RankState& state, const WallStep& walls, double time_step, Point gain) {
  const Step step{walls, time_step};
  impacts_.clear();
  free_.shift.clear(), shifted_.clear();
  move_freely(step);
  search(step);
  ImpactCounts count;
  if (!laws_.restitution) return count;
  std::vector<StruckRecord> struck;
  for (int searches = 1;; ++searches) {
    if (searches > 1 && !ranks_.any(strikes_again(struck, step))) return count;
    struck = strike(step);
    count.met += impacts_.count(), count.unresolved += impacts_.unresolved();
    if (impacts_.count() == 0) return count;
    set_velocities(struck);
    shifted_.insert(shifted_.end(), struck.begin(), struck.end());
    set_shifts();
    take_over(struck, state);
    move_freely(step);
    if (searches == most_searches) return count;
    auto thrown = ranks_.gather_everywhere<ThrownRecord>(thrown_of(struck, step));
    if (thrown.empty()) return count;
    rounds_.push_back({struck, std::move(thrown)});
    const bool sorted = grains_.settle_again(state, walls, time_step, gain);
    if (sorted) set_shifts(), move_freely(step);
    if (!is_local(rounds_.back().thrown))
      search(step);
    else if (sorted)
      search_as_before(step);
    else
      search_around(rounds_.back(), step);
  }
}

DetectionInput RankSearch::input(const Step& step) const {
  return {step.walls.before, step.walls.displacement, step.time_step, laws_.detection_margin, {}};
}

void RankSearch::move_freely(const Step& step) {
  set_free_motion(grains_.seen().bodies, laws_, step.time_step, loops_, free_);
}

void RankSearch::search(const Step& step) {
  rounds_.clear();
  if (laws_.restitution) searched_.x = free_.x, searched_.z = free_.z;
  detection_.find(grains_.seen().bodies, free_.x, free_.z, input(step));
  find_homes(grains_.seen(), detection_.candidates(), grains_.tiles(), ranks_.rank(), homed_);
  take_mine();
  recollection_.find(grains_.memory(), mine_.pairs);
  mine_is_fresh_ = true;
}

void RankSearch::search_around(const Round& round, const Step& step) {
  thrown_.clear();
  for (const ThrownRecord& grain : round.thrown) {
    const std::int32_t b = grains_.place_of(grain.id);
    if (b < 0) continue;
    thrown_.push_back({b, grain.push});
    searched_.x[b] = free_.x[b], searched_.z[b] = free_.z[b];
  }
  const SeenGrains& seen = grains_.seen();
  std::vector<std::int32_t> added;
  if (detection_.add_around(thrown_, seen.bodies, free_.x, free_.z, input(step)))
    added = find_homes_of_added(seen, detection_.candidates(), detection_.added(), grains_.tiles(),
                                ranks_.rank(), homed_);
  mine_is_fresh_ = false;
  std::vector<Candidate> pairs_added;
  for (const std::int32_t m : added) pairs_added.push_back(detection_.candidates()[homed_.mine[m]]);
  recollection_.find_added(grains_.memory(), added, pairs_added);
}

void RankSearch::search_as_before(const Step& step) {
  std::vector<Round> rounds = std::exchange(rounds_, {});
  Bodies& bodies = grains_.seen().bodies;
  for (auto round = rounds.rbegin(); round != rounds.rend(); ++round)
    for (const StruckRecord& grain : round->struck)
      if (const std::int32_t b = grains_.place_of(grain.id); b >= 0)
        bodies.v_x[b] = grain.before.x, bodies.v_z[b] = grain.before.z;
  move_freely(step);
  search(step);
  for (const Round& round : rounds) {
    set_velocities(round.struck);
    move_freely(step);
    search_around(round, step);
  }
  rounds_ = std::move(rounds);
}

bool RankSearch::is_local(std::span<const ThrownRecord> thrown) const {
  const Reach& reach = grains_.reach();
  double push = reach.approach;
  for (const ThrownRecord& grain : thrown) push = std::max(push, grain.push);
  const double range = 2 * reach.margin + reach.approach + 1.5 * push;
  const double cells = 2 * (range + reach.largest) / reach.largest + 2;  // along x and z
  return static_cast<double>(thrown.size()) * cells * cells < static_cast<double>(grains_of_all_);
}

void RankSearch::take_mine() {
  resize_closely(mine_.pairs, homed_.mine.size());
  const auto found = detection_.candidates();
  for (std::size_t m = 0; m < homed_.mine.size(); ++m) mine_.pairs[m] = found[homed_.mine[m]];
}

std::vector<StruckRecord> RankSearch::strike(const Step& step) {
  Bodies& seen = grains_.seen().bodies;
  const StepInput all{laws_, seen, step.walls, {}, free_, step.time_step};
  if (!std::exchange(mine_is_fresh_, false)) take_mine();
  const auto loads = recollection_.loads(grains_.memory(), unknowns_, step.time_step);
  const TileGrid& grid = grains_.tiles().grid;
  const GrainSquare square{grid.origin, grid.edge(), grains_.places().size()};
  return impacts_.resolve({all, loads, seen, free_.shift, mine_, grains_.places(), square});
}

bool RankSearch::strikes_again(std::span<const StruckRecord> struck, const Step& step) {
  const Bodies& seen = grains_.seen().bodies;
  const auto found = detection_.candidates();
  struck_pairs_.select(
      seen.count(), struck, [&](const StruckRecord& grain) { return grains_.place_of(grain.id); },
      homed_.mine.size(), [&](std::size_t m) -> const Candidate& { return found[homed_.mine[m]]; },
      pairs_of_struck_);
  const StepInput all{laws_, seen, step.walls, {}, free_, step.time_step};
  const auto loads = recollection_.loads_of(pairs_of_struck_, grains_.memory(), unknowns_, step.time_step);
  return looking_.any({all, pairs_of_struck_, loads, {}});
}

void RankSearch::set_velocities(std::span<const StruckRecord> struck) {
  Bodies& bodies = grains_.seen().bodies;
  for (const StruckRecord& grain : struck)
    if (const std::int32_t b = grains_.place_of(grain.id); b >= 0) {
      bodies.v_x[b] = grain.v_x, bodies.v_z[b] = grain.v_z;
      if (!bodies.spin.empty()) bodies.spin[b] = grain.spin;
    }
}

void RankSearch::set_shifts() {
  free_.shift.assign(grains_.seen().bodies.count(), {});
  for (const StruckRecord& grain : shifted_)
    if (const std::int32_t b = grains_.place_of(grain.id); b >= 0) free_.shift[b] = grain.shift;
}

void RankSearch::take_over(std::span<const StruckRecord> struck, RankState& state) const {
  const SeenGrains& seen = grains_.seen();
  for (const StruckRecord& record : struck) {
    const std::int32_t b = grains_.place_of(record.id);
    if (b < 0 || seen.place[b] < 0) continue;
    RankGrain& grain = state.grains[seen.place[b]];
    grain.v_x = record.v_x, grain.v_z = record.v_z, grain.spin = record.spin;
  }
}

std::vector<RankSearch::ThrownRecord> RankSearch::thrown_of(std::span<const StruckRecord> struck,
                                                            const Step& step) const {
  const SeenGrains& seen = grains_.seen();
  std::vector<ThrownRecord> thrown;
  for (const StruckRecord& record : struck) {
    const std::int32_t b = grains_.place_of(record.id);
    if (b < 0 || seen.place[b] < 0) continue;
    const double push =
        2 * step.time_step * std::hypot(free_.x[b] - searched_.x[b], free_.z[b] - searched_.z[b]);
    if (push > detection_.jolt(b) + laws_.detection_margin) thrown.push_back({record.id, push});
  }
  return thrown;
}

}  // namespace drumlin::particles
