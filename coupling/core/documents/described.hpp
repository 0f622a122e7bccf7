#pragma once
// Results in JSON, each struct described once by the list of its members, which stand under their own names.
// From that comes what writes it, and what reads it and reports every value of another type:
//
//     struct Piece { double length_m; std::optional<bool> reduced; };
//     DRUMLIN_DESCRIBED(Piece, length_m, reduced)
//     write_json(file, piece);
//     const auto piece = read_record<Piece>(file);
#include <concepts>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_document.hpp"

#define DRUMLIN_MEMBER(member) visit(#member, it.member);
/// In the namespace of `Type`: makes it a table of these members, in this order. Its constant `format`, where
/// it has one, is that of its files.
#define DRUMLIN_DESCRIBED(Type, ...)                                       \
  template <class T, class V>                                              \
  requires std::same_as<std::remove_const_t<T>, Type>                      \
  void each_member(T& it, const V& visit) {                                \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(DRUMLIN_MEMBER, __VA_ARGS__)) \
  }

namespace drumlin {

template <class T>
concept Described = requires(T& it) {
  each_member(it, [](const char*, const auto&) {});
};

/// A value that stands in no table, or is null, where it was not computed.
template <class T>
struct OrNull {
  std::optional<T> value;
};
/// What stands in a table, of the shape of a T; null: nothing does.
template <class T>
struct OfShape {
  nlohmann::ordered_json json;
};
using Anything = OfShape<nlohmann::ordered_json>;
using JsonTable = std::map<std::string, nlohmann::ordered_json>;
using Numbers = std::map<std::string, OrNull<double>>;
/// A text of one line.
struct Line {};

/// Fills described structs from JSON.
struct JsonReader {
  using Json = nlohmann::ordered_json;

  std::string file;  ///< as the problems name it
  std::vector<InputProblem> problems = {};

  /// `key`: of the value, each step after a dot. What a table lacks is discarded JSON.
  template <Described T>
  void read(const Json& json, const std::string& key, T& target) {
    static const Json missing = Json::value_t::discarded;
    if (expect(json.is_object(), json, key, "a table"))
      each_member(target, [&](const char* name, auto& member) {
        const auto found = json.find(name);
        read(found == json.end() ? missing : *found, key + "." + name, member);
      });
  }
  template <class T>
  void read(const Json& json, const std::string& key, std::vector<T>& target) {
    if (expect(json.is_array(), json, key, "an array"))
      for (const auto& [index, entry] : json.items()) read(entry, key + "." + index, target.emplace_back());
  }
  template <class T>
  void read(const Json& json, const std::string& key, std::map<std::string, T>& target) {
    if (expect(json.is_object(), json, key, "a table"))
      for (const auto& [name, entry] : json.items()) read(entry, key + "." + name, target[name]);
  }
  template <class T>
  void read(const Json& json, const std::string& key, std::optional<T>& target) {
    if (!json.is_discarded()) read(json, key, target.emplace());
  }
  template <class T>
  void read(const Json& json, const std::string& key, OrNull<T>& target) {
    const std::size_t before = problems.size();
    if (!json.is_null()) read(json, key, target.value);
    if (problems.size() > before && "." + problems[before].key == key) problems[before].allowed += " or null";
  }
  template <class T>
  void read(const Json& json, const std::string& key, OfShape<T>& target) {
    if (json.is_discarded()) return;
    T shape;
    read(target.json = json, key, shape);
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void read(const Json& json, const std::string& key, T& target) {
    if constexpr (std::same_as<T, bool>)
      expect(json.is_boolean(), json, key, "true or false");
    else
      expect(std::integral<T> ? json.is_number_integer() : json.is_number(), json, key, "a number");
    if (problems.empty()) target = json.get<T>();
  }
  void read(const Json& json, const std::string& key, std::string& target);
  void read(const Json& json, const std::string& key, Line&);
  static void read(const Json& json, const std::string&, Json& target) { target = json; }

 private:
  bool expect(bool holds, const Json& json, const std::string& key, const char* allowed);
};

/// The content of a file that holds a T, which is read, too. Throws InputError as read_json does, and where
/// values are of other types than T says, each with its key ("settings.scales.length_m", entries of lists by
/// index).
template <Described T>
nlohmann::ordered_json read_json(const std::filesystem::path& file, T& record) {
  auto content = read_json(file, T::format);
  JsonReader reader{file.string()};
  reader.read(content, "", record);
  return accepted(std::move(content), reader.problems);
}
template <class T>
nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  T record;
  return read_json(file, record);
}
template <class T>
T read_record(const std::filesystem::path& file) {
  T record;
  (void)read_json(file, record);
  return record;
}

}  // namespace drumlin

template <drumlin::Described T>
struct nlohmann::adl_serializer<T> {
  static void to_json(ordered_json& json, const T& record) {
    json = ordered_json::object();
    if constexpr (requires { T::format; }) json["format"] = T::format;
    each_member(record, [&](const char* name, const auto& member) {
      if constexpr (requires { member.json; }) {
        if (!member.json.is_null()) json[name] = member.json;
      } else if constexpr (requires { *member; }) {
        if (member) json[name] = *member;
      } else {
        json[name] = member;
      }
    });
  }
};
