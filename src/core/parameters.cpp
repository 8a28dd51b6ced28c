#include "rigid_body_sim/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace rigid_body_sim {
namespace {

std::string numberText(double number) {
  std::ostringstream text;
  text << std::setprecision(12) << number;
  return text.str();
}

std::string rangeText(const Allowed& allowed) {
  std::ostringstream text;
  const bool lower = std::isfinite(allowed.min);
  const bool upper = std::isfinite(allowed.max);
  if (lower && upper)
    text << "a number from " << numberText(allowed.min) << " to " << numberText(allowed.max);
  else if (lower)
    text << "a finite number " << (allowed.above_min ? "> " : ">= ") << numberText(allowed.min);
  else if (upper)
    text << "a finite number <= " << numberText(allowed.max);
  else
    text << "a finite number";
  if (!allowed.unit.empty()) text << " [" << allowed.unit << "]";
  return text.str();
}

/// Control characters, which would end a message or its line, as \x0a.
std::string printable(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const int code = static_cast<unsigned char>(c);
    constexpr const char* kDigits = "0123456789abcdef";
    if (code < 0x20 || code == 0x7f)
      shown += {'\\', 'x', kDigits[code / 16], kDigits[code % 16]};
    else
      shown += c;
  }
  return shown;
}

/// YAML 1.1, which ROS uses, takes 1e-6, 1.0e6 and -.5 for strings: it wants a dot with a digit
/// before it, and the exponent's sign.
std::string hintForNumber(const Value& value) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (!text || text->find_first_not_of("+-.0123456789eE") != std::string::npos) return {};
  char* end = nullptr;
  std::strtod(text->c_str(), &end);
  if (end == text->c_str() || *end != '\0') return {};
  const auto e = text->find_first_of("eE");
  std::string wanted = text->substr(0, e);
  const std::size_t first = wanted.find_first_not_of("+-");
  if (wanted[first] == '.') wanted.insert(first, "0");
  if (e != std::string::npos) {
    const std::string exponent = text->substr(e + 1);
    if (wanted.find('.') == std::string::npos) wanted += ".0";
    wanted += (exponent.find_first_of("+-") == std::string::npos ? "e+" : "e") + exponent;
  }
  if (wanted == *text) return "; it is a string: leave the quotes out";
  return "; to YAML this is a string: write " + wanted;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string fullText(const Value& value) {
  std::string text;
  if (std::holds_alternative<std::monostate>(value.data)) return "nothing";
  if (const auto* boolean = std::get_if<bool>(&value.data)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value.data)) return numberText(*number);
  if (const auto* string = std::get_if<std::string>(&value.data)) return "'" + *string + "'";
  if (const auto* list = std::get_if<Value::List>(&value.data)) {
    for (const Value& item : *list) text += (text.empty() ? "" : ", ") + fullText(item);
    return "[" + text + "]";
  }
  for (const auto& [key, item] : std::get<Value::Map>(value.data))
    text += (text.empty() ? "" : ", ") + key + ": " + fullText(item);
  return "{" + text + "}";
}

}  // namespace

std::string toText(const Value& value) {
  std::string text = fullText(value);
  // One line of bounded length, whatever a user wrote.
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string nearestWord(const std::string& word, const std::set<std::string>& known) {
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance >= best) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string readTextFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw std::invalid_argument(path + ": cannot be read");
  return text.str();
}

Parameters::Parameters(const Value& value, std::string path) : path_(std::move(path)) {
  if (const auto* map = std::get_if<Value::Map>(&value.data))
    map_ = *map;
  else if (!std::holds_alternative<std::monostate>(value.data))
    throw std::invalid_argument((path_.empty() ? "parameters" : path_) + ": " + toText(value) +
                                " is not a map of keys");
}

std::string Parameters::pathOf(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void Parameters::refuse(const std::string& key, const std::string& what) const {
  throw std::invalid_argument(printable(pathOf(key)) + ": " + what);
}

void Parameters::refuseMissing(const std::string& key, const std::string& what) const {
  std::set<std::string> others;
  for (const auto& entry : map_)
    if (asked_.count(entry.first) == 0) others.insert(entry.first);
  const std::string nearest = nearestWord(key, others);
  if (!nearest.empty()) others = {nearest};
  std::string instead;
  constexpr std::size_t kMostNamed = 5;
  for (const std::string& other : others)
    if (others.size() <= kMostNamed) instead += (instead.empty() ? "" : ", ") + ("'" + other + "'");
  if (!instead.empty())
    instead = (others.size() == 1 ? "; there is " : "; there are ") + instead + " instead";
  refuse(key, "is missing; " + what + printable(instead));
}

const Value* Parameters::find(const std::string& key) const {
  asked_.insert(key);
  const auto found = map_.find(key);
  return found == map_.end() ? nullptr : &found->second;
}

bool Parameters::has(const std::string& key) const { return find(key) != nullptr; }

bool Parameters::isMap(const std::string& key) const {
  const Value* value = find(key);
  return value && std::holds_alternative<Value::Map>(value->data);
}

bool Parameters::isBoolean(const std::string& key) const {
  const Value* value = find(key);
  return value && std::holds_alternative<bool>(value->data);
}

double Parameters::toNumber(const Value& value, const std::string& key,
                            const Allowed& allowed) const {
  double number = std::nan("");
  if (const auto* integer = std::get_if<std::int64_t>(&value.data))
    number = static_cast<double>(*integer);
  else if (const auto* floating = std::get_if<double>(&value.data))
    number = *floating;
  const bool in_range = std::isfinite(number) && number <= allowed.max &&
                        (allowed.above_min ? number > allowed.min : number >= allowed.min);
  if (!in_range)
    refuse(key, toText(value) + " is not " + rangeText(allowed) + hintForNumber(value));
  return number;
}

double Parameters::number(const std::string& key, const Allowed& allowed,
                          std::optional<double> fallback) const {
  if (const Value* value = find(key)) return toNumber(*value, key, allowed);
  if (!fallback) refuseMissing(key, "it must be " + rangeText(allowed));
  return *fallback;
}

int Parameters::integer(const std::string& key, int min, int max, std::optional<int> fallback,
                        const std::string& unit) const {
  const Value* value = find(key);
  const std::string expected = "a whole number from " + std::to_string(min) + " to " +
                               std::to_string(max) + (unit.empty() ? "" : " [" + unit + "]");
  if (!value) {
    if (!fallback) refuseMissing(key, "it must be " + expected);
    return *fallback;
  }
  const auto* integer = std::get_if<std::int64_t>(&value->data);
  if (!integer || *integer < min || *integer > max)
    refuse(key, toText(*value) + " is not " + expected);
  return static_cast<int>(*integer);
}

bool Parameters::boolean(const std::string& key, std::optional<bool> fallback) const {
  const Value* value = find(key);
  if (!value) {
    if (!fallback) refuseMissing(key, "it must be true or false");
    return *fallback;
  }
  const auto* boolean = std::get_if<bool>(&value->data);
  if (!boolean) refuse(key, toText(*value) + " is not true or false");
  return *boolean;
}

std::string Parameters::text(const std::string& key, std::optional<std::string> fallback) const {
  const Value* value = find(key);
  if (!value) {
    if (!fallback) refuseMissing(key, "it must be a string");
    return *fallback;
  }
  const auto* text = std::get_if<std::string>(&value->data);
  if (!text || text->empty()) refuse(key, toText(*value) + " is not a (non-empty) string");
  return *text;
}

std::vector<std::string> Parameters::texts(const std::string& key) const {
  const Value* value = find(key);
  if (!value) return {};
  const auto* list = std::get_if<Value::List>(&value->data);
  if (!list) refuse(key, toText(*value) + " is not a list of strings");
  std::vector<std::string> texts;
  for (const Value& item : *list) {
    const auto* text = std::get_if<std::string>(&item.data);
    if (!text || text->empty()) refuse(key, toText(item) + " in the list is not a string");
    texts.push_back(*text);
  }
  return texts;
}

std::vector<double> Parameters::numbers(const std::string& key,
                                        const std::vector<std::size_t>& counts,
                                        const Allowed& allowed) const {
  std::string expected;
  for (const std::size_t count : counts)
    expected += (expected.empty() ? "" : " or ") + std::to_string(count);
  expected = "a list of " + expected + " numbers" +
             (allowed.unit.empty() ? "" : " [" + allowed.unit + "]");
  const Value* value = find(key);
  if (!value) refuseMissing(key, "it must be " + expected);
  const auto* list = std::get_if<Value::List>(&value->data);
  if (!list || std::find(counts.begin(), counts.end(), list->size()) == counts.end())
    refuse(key, toText(*value) + " is not " + expected);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < list->size(); ++i)
    numbers.push_back(toNumber((*list)[i], key + "[" + std::to_string(i) + "]", allowed));
  return numbers;
}

Vector3d Parameters::vector3(const std::string& key, const Allowed& allowed,
                             std::optional<Vector3d> fallback) const {
  if (!has(key) && fallback) return *fallback;
  return Vector3d(numbers(key, {3}, allowed).data());
}

Parameters Parameters::child(const std::string& key) const {
  const Value* value = find(key);
  if (!value) return {Value(), pathOf(key)};
  return {*value, pathOf(key)};
}

std::vector<Parameters> Parameters::children(const std::string& key) const {
  const Value* value = find(key);
  const auto* list = value ? std::get_if<Value::List>(&value->data) : nullptr;
  if (!list) refuse(key, (value ? toText(*value) : "nothing") + " is not a list of maps");
  std::vector<Parameters> children;
  for (std::size_t i = 0; i < list->size(); ++i)
    children.emplace_back((*list)[i], pathOf(key) + "[" + std::to_string(i) + "]");
  return children;
}

std::vector<std::string> Parameters::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : map_) keys.push_back(entry.first);
  return keys;
}

void Parameters::refuseUnknown() const {
  for (const auto& entry : map_) {
    if (asked_.count(entry.first)) continue;
    const std::string nearest = nearestWord(entry.first, asked_);
    std::string known;
    for (const std::string& key : asked_) known += (known.empty() ? "" : ", ") + key;
    if (!nearest.empty()) refuse(entry.first, "unknown key; did you mean '" + nearest + "'?");
    refuse(entry.first, "unknown key; there are " + (known.empty() ? "none here" : known));
  }
}

}  // namespace rigid_body_sim
