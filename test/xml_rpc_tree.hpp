#pragma once

#include <XmlRpcValue.h>

#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {

/// As the parameter server takes it.
inline XmlRpc::XmlRpcValue toXmlRpc(const Value& value) {
  XmlRpc::XmlRpcValue result;
  if (const auto* boolean = std::get_if<bool>(&value.data)) result = *boolean;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data))
    result = static_cast<int>(*integer);
  if (const auto* number = std::get_if<double>(&value.data)) result = *number;
  if (const auto* text = std::get_if<std::string>(&value.data)) result = *text;
  if (const auto* list = std::get_if<Value::List>(&value.data)) {
    result.setSize(static_cast<int>(list->size()));
    for (int i = 0; i < result.size(); ++i) result[i] = toXmlRpc((*list)[i]);
  }
  if (const auto* map = std::get_if<Value::Map>(&value.data))
    for (const auto& [key, item] : *map) result[key] = toXmlRpc(item);
  return result;
}

}  // namespace rigid_body_sim
