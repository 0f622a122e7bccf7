#pragma once
// What a sweep of settings says in plain words, as lines that can be pasted into the scene.
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drumlin::apps {

/// For each quantity the cheapest point whose relative error is at most 5, 2 and 1 %, its cost over that of
/// the scene as it is, and what to write into the scene: `lines_of` a point. Then what the scene as it is
/// wastes (a cheaper point is at least as exact in every quantity) or lacks (its error exceeds 5 %). `points`
/// as in cost.json: name, default, cpu_seconds, errors. Empty if no point is the scene as it is.
std::string advice_text(const nlohmann::ordered_json& points, const std::vector<std::string>& quantities,
                        const std::function<std::string(const nlohmann::ordered_json& point)>& lines_of);

}  // namespace drumlin::apps
