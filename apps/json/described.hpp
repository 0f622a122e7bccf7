#pragma once
// Results as JSON from a list of their members, each under its own name.
#include <nlohmann/json.hpp>
#include <optional>

/// In the namespace of `Type`: makes it a table of these members, in this order. NaN is written as null.
#define DRUMLIN_DESCRIBED(Type, ...)                                                          \
  inline void to_json(nlohmann::ordered_json& nlohmann_json_j, const Type& nlohmann_json_t) { \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))                  \
  }

/// What is not there is null.
template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(ordered_json& json, const std::optional<T>& value) {
    if (value)
      json = *value;
    else
      json = nullptr;
  }
};
