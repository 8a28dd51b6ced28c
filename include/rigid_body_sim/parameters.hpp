#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// A tree of typed values, as YAML files and the ROS parameter server hold them.
struct Value {
  using List = std::vector<Value>;
  using Map = std::map<std::string, Value>;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, List, Map> data;
};

/// What a number may be.
struct Allowed {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string unit;
  bool above_min = false;  ///< min itself is not allowed
};

inline Allowed positive(const std::string& unit) {
  return {0, std::numeric_limits<double>::infinity(), unit, true};
}
inline Allowed notNegative(const std::string& unit) {
  return {0, std::numeric_limits<double>::infinity(), unit, false};
}
inline Allowed finite(const std::string& unit) {
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), unit,
          false};
}

/// Strict reader of a map of values. It remembers which keys were asked for: one that nobody asked
/// for is an error. A getter without default requires the key. All errors are std::invalid_argument
/// with one line: path of the key, its value, what is allowed, unit.
class Parameters {
 public:
  /// @param path names the map in messages; empty for the top level.
  /// @throws std::invalid_argument if `value` is not a map.
  Parameters(const Value& value, std::string path);

  bool has(const std::string& key) const;
  bool isMap(const std::string& key) const;
  bool isBoolean(const std::string& key) const;

  double number(const std::string& key, const Allowed& allowed,
                std::optional<double> fallback = std::nullopt) const;
  /// A whole number from `min` to `max`.
  int integer(const std::string& key, int min, int max, std::optional<int> fallback = std::nullopt,
              const std::string& unit = "") const;
  bool boolean(const std::string& key, std::optional<bool> fallback = std::nullopt) const;
  std::string text(const std::string& key,
                   std::optional<std::string> fallback = std::nullopt) const;
  std::vector<std::string> texts(const std::string& key) const;
  /// As many numbers as one of `counts`.
  std::vector<double> numbers(const std::string& key, const std::vector<std::size_t>& counts,
                              const Allowed& allowed) const;
  Vector3d vector3(const std::string& key, const Allowed& allowed,
                   std::optional<Vector3d> fallback = std::nullopt) const;

  /// The map below `key`; an absent key gives an empty map.
  Parameters child(const std::string& key) const;
  /// The maps in the list below `key`.
  std::vector<Parameters> children(const std::string& key) const;

  /// The keys that are there, sorted.
  std::vector<std::string> keys() const;

  /// Marks a key as asked for whatever it holds.
  void ignore(const std::string& key) const { asked_.insert(key); }

  /// @throws std::invalid_argument naming a key that nobody asked for, and the nearest that was.
  void refuseUnknown() const;

  /// @throws std::invalid_argument "<path of key>: <what>"
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

  /// @throws std::invalid_argument "<path of key>: is missing; <what>", and which key is there that
  /// nobody has asked for yet: the key may be misspelt.
  [[noreturn]] void refuseMissing(const std::string& key, const std::string& what) const;

 private:
  const Value* find(const std::string& key) const;
  std::string pathOf(const std::string& key) const;
  double toNumber(const Value& value, const std::string& key, const Allowed& allowed) const;

  Value::Map map_;
  std::string path_;
  mutable std::set<std::string> asked_;
};

/// The value as one line of YAML, shortened to some 60 characters.
std::string toText(const Value& value);

/// Of `known`, the word with the smallest edit distance to `word`; empty if none is near.
std::string nearestWord(const std::string& word, const std::set<std::string>& known);

/// Reads YAML text; scalars get the types that rosparam gives them.
/// @throws std::invalid_argument naming source and line.
Value readYaml(const std::string& text, const std::string& source);

/// The text of a file. @throws std::invalid_argument if it cannot be read.
std::string readTextFile(const std::string& path);

}  // namespace rigid_body_sim
