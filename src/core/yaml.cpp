#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstdlib>
#include <regex>
#include <stdexcept>

#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {
namespace {

/// The types that PyYAML, and so rosparam, gives to plain scalars (YAML 1.1): a float needs a dot,
/// a digit before it if it has a sign, and a sign in its exponent. Octal, hexadecimal, base-60 and
/// underscored integers stay strings, so that no number means what it does not look like.
Value scalar(const YAML::Node& node) {
  static const std::regex kInteger("[-+]?(0|[1-9][0-9]*)");
  static const std::regex kFloat("([-+]?[0-9]+\\.[0-9]*|\\.[0-9]+)([eE][-+][0-9]+)?");
  static const std::regex kSpecial("([-+]?\\.(inf|Inf|INF))|\\.(nan|NaN|NAN)");
  static const std::regex kTrue("yes|Yes|YES|true|True|TRUE|on|On|ON");
  static const std::regex kFalse("no|No|NO|false|False|FALSE|off|Off|OFF");
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return {text};  // quoted
  if (std::regex_match(text, kTrue)) return {true};
  if (std::regex_match(text, kFalse)) return {false};
  if (std::regex_match(text, kInteger)) {
    errno = 0;
    const std::int64_t integer = std::strtoll(text.c_str(), nullptr, 10);
    return errno == 0 ? Value{integer} : Value{text};
  }
  if (std::regex_match(text, kFloat) || std::regex_match(text, kSpecial))
    return {node.as<double>()};
  return {text};
}

Value fromNode(const YAML::Node& node, int depth) {
  if (depth > 32) throw std::invalid_argument("nested more than 32 levels deep");
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return scalar(node);
    case YAML::NodeType::Sequence: {
      Value::List list;
      for (const YAML::Node& item : node) list.push_back(fromNode(item, depth + 1));
      return {list};
    }
    case YAML::NodeType::Map: {
      Value::Map map;
      for (const auto& entry : node) {
        const std::string key = entry.first.as<std::string>();
        if (!map.emplace(key, fromNode(entry.second, depth + 1)).second)
          throw std::invalid_argument("key '" + key + "' stands twice in one map");
      }
      return {map};
    }
    default:
      return {};
  }
}

}  // namespace

Value readYaml(const std::string& text, const std::string& source) {
  try {
    return fromNode(YAML::Load(text), 0);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(source + ":" + std::to_string(error.mark.line + 1) + ": " +
                                error.msg);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(source + ": " + error.what());
  }
}

}  // namespace rigid_body_sim
