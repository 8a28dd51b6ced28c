#include "node/dropped_blocks.hpp"

#include <stdexcept>

namespace rigid_body_sim {
namespace {

const Value::Map& mapIn(const Value& value) {
  static const Value::Map kEmpty;
  const auto* map = std::get_if<Value::Map>(&value.data);
  return map ? *map : kEmpty;
}

const Value& entryOf(const Value& value, const std::string& key) {
  static const Value kNothing;
  const Value::Map& map = mapIn(value);
  const auto found = map.find(key);
  return found == map.end() ? kNothing : found->second;
}

/// Of the first block that is not there any more; empty if all are.
std::string pathOfDropped(const Value& file, const Value& given, const std::string& path) {
  for (const auto& [key, value] : mapIn(file)) {
    if (!std::holds_alternative<Value::Map>(value.data)) continue;
    const Value& now = entryOf(given, key);
    const bool means_nothing =
        path.empty() && (key == "effects" || key == "limits" || key == "publish_every");
    if (mapIn(value).empty() && !means_nothing && std::holds_alternative<std::monostate>(now.data))
      return path + key;
    const std::string below = pathOfDropped(value, now, path + key + ".");
    if (!below.empty()) return below;
  }
  return {};
}

}  // namespace

void refuseDroppedBlocks(const Value& file, const Value& given, const std::string& file_name) {
  const std::string path = pathOfDropped(file, given, "");
  if (!path.empty())
    throw std::invalid_argument(path + ": empty in " + file_name +
                                ", and the parameter server drops what is empty; give it one of "
                                "its parameters, or leave it out");
}

}  // namespace rigid_body_sim
