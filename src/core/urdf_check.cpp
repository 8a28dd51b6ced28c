#include "core/urdf_check.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "rigid_body_sim/urdf.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::size_t kMaxLinks = 10000;
constexpr std::initializer_list<const char*> kJointTypes = {"fixed",      "floating",  "revolute",
                                                            "continuous", "prismatic", "planar"};
constexpr std::initializer_list<const char*> kTensorElements = {"ixx", "ixy", "ixz",
                                                                "iyy", "iyz", "izz"};

using Xml = std::vector<XmlElement>;

[[noreturn]] void fail(const std::string& where, const std::string& why) {
  throw std::invalid_argument(where + ": " + why);
}

std::string quoted(std::string_view text) { return "'" + oneLine(text) + "'"; }

bool isOneOf(std::string_view word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// A decimal number and nothing else: no blanks, hexadecimals, nan or inf.
bool isDecimal(std::string_view text) {
  std::size_t i = 0;
  const auto skipSign = [&] { i += i < text.size() && (text[i] == '+' || text[i] == '-'); };
  const auto skipDigits = [&] {
    const std::size_t from = i;
    while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
    return i - from;
  };
  skipSign();
  std::size_t digits = skipDigits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    digits += skipDigits();
  }
  if (digits == 0) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    skipSign();
    if (skipDigits() == 0) return false;
  }
  return i == text.size();
}

/// @param where begins the message, `what` is the number's name in it
double requireNumber(std::string_view text, const std::string& where, const std::string& what) {
  if (!isDecimal(text)) fail(where, what + " " + quoted(text) + " is not a plain decimal number");
  // Neither strtod (follows the locale) nor std::from_chars (not for doubles in gcc 9).
  std::istringstream stream{std::string(text)};
  stream.imbue(std::locale::classic());
  double value = 0;
  stream >> value;
  if (stream.fail() || !std::isfinite(value))
    fail(where, what + " " + quoted(text) + " is out of the range of a double");
  return value;
}

const std::string_view* findAttribute(const XmlElement& element, std::string_view name) {
  for (const XmlAttribute& attribute : element.attributes)
    if (attribute.name == name) return &attribute.value;
  return nullptr;
}

std::string_view requireAttribute(const XmlElement& element, std::string_view name,
                                  const std::string& where) {
  const std::string_view* value = findAttribute(element, name);
  if (value == nullptr)
    fail(where, "<" + oneLine(element.name) + "> has no attribute '" + std::string(name) + "'");
  return *value;
}

void requireKnownAttributes(const XmlElement& element, std::initializer_list<const char*> known,
                            const std::string& where) {
  for (const XmlAttribute& attribute : element.attributes)
    if (!isOneOf(attribute.name, known))
      fail(where,
           "<" + oneLine(element.name) + "> has an unknown attribute " + quoted(attribute.name));
}

/// The child called `name`, null if there is none.
const XmlElement* onlyChild(const Xml& xml, const XmlElement& parent, std::string_view name,
                            const std::string& where) {
  const XmlElement* found = nullptr;
  for (int i = parent.first_child; i >= 0; i = xml[i].next_sibling) {
    if (xml[i].name != name) continue;
    if (found != nullptr) fail(where, "more than one <" + std::string(name) + ">");
    found = &xml[i];
  }
  return found;
}

const XmlElement& requireChild(const Xml& xml, const XmlElement& parent, std::string_view name,
                               const std::string& where) {
  const XmlElement* child = onlyChild(xml, parent, name, where);
  if (child == nullptr)
    fail(where, "<" + oneLine(parent.name) + "> has no <" + std::string(name) + ">");
  return *child;
}

/// Three numbers between blanks; only ' ' separates for the URDF parser.
void checkTriple(std::string_view text, const std::string& where, const std::string& what) {
  int count = 0;
  for (std::size_t i = text.find_first_not_of(' '); i < text.size();
       i = text.find_first_not_of(' ', i)) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    requireNumber(text.substr(i, end - i), where, what);
    ++count;
    i = end;
  }
  if (count != 3) fail(where, what + " " + quoted(text) + " is not three numbers");
}

void checkOrigin(const Xml& xml, const XmlElement& parent, const std::string& where) {
  const XmlElement* origin = onlyChild(xml, parent, "origin", where);
  if (origin == nullptr) return;
  requireKnownAttributes(*origin, {"xyz", "rpy"}, where);
  for (const XmlAttribute& attribute : origin->attributes)
    checkTriple(attribute.value, where, "origin " + std::string(attribute.name));
}

void checkMass(const XmlElement& mass, const std::string& where) {
  requireKnownAttributes(mass, {"value"}, where);
  const std::string_view text = requireAttribute(mass, "value", where);
  const double value = requireNumber(text, where, "mass");
  if (value < 0) fail(where, "mass " + quoted(text) + " is negative");
  const std::string_view digits = text.substr(0, text.find_first_of("eE"));
  const bool is_zero = digits.find_first_of("123456789") == std::string_view::npos;
  if (!is_zero && value < std::numeric_limits<double>::min())
    fail(where, "mass " + quoted(text) + " is too small for a double");
}

void checkInertial(const Xml& xml, const XmlElement& link, const std::string& where) {
  const XmlElement* inertial = onlyChild(xml, link, "inertial", where);
  if (inertial == nullptr) return;
  checkOrigin(xml, *inertial, where);
  checkMass(requireChild(xml, *inertial, "mass", where), where);
  const XmlElement& inertia = requireChild(xml, *inertial, "inertia", where);
  requireKnownAttributes(inertia, kTensorElements, where);
  for (const char* element : kTensorElements)
    requireNumber(requireAttribute(inertia, element, where), where, element);
}

/// The links and joints met so far; views are into the text.
class TreeCheck {
 public:
  TreeCheck(const Xml& xml, const std::string& source) : xml_(xml), source_(source) {}

  void addLink(const XmlElement& link) {
    const std::string name(requireAttribute(link, "name", lineOf(link)));
    requireName(name, source_ + ": link");
    const std::string where = source_ + ": link " + quoted(name);
    if (!links_.insert(name).second) fail(where, "defined more than once");
    if (links_.size() > kMaxLinks)
      fail(source_, "more than " + std::to_string(kMaxLinks) + " links");
    checkInertial(xml_, link, where);
  }

  void addJoint(const XmlElement& joint) {
    const std::string_view name = requireAttribute(joint, "name", lineOf(joint));
    if (name.empty()) fail(lineOf(joint), "a joint's name is empty");
    const std::string where = source_ + ": joint " + quoted(name);
    if (!joints_.insert(name).second) fail(where, "defined more than once");
    const std::string_view type = requireAttribute(joint, "type", where);
    if (!isOneOf(type, kJointTypes)) fail(where, "unknown type " + quoted(type));
    checkOrigin(xml_, joint, where);
    const std::string_view parent = endOf(joint, "parent", where);
    const std::string_view child = endOf(joint, "child", where);
    if (!parents_.emplace(child, parent).second)
      fail(source_ + ": link " + quoted(child),
           "child of more than one joint, " + quoted(name) + " is one of them");
    children_[parent].push_back(child);
  }

  /// One root, and every link hangs on it: each has at most one parent, so the rest are in loops.
  void finish() const {
    if (links_.empty()) fail(source_, "no <link>");
    std::vector<std::string_view> reached;
    for (const std::string& link : links_) {
      if (parents_.count(link) != 0) continue;
      if (!reached.empty())
        fail(source_, "links " + quoted(reached.front()) + " and " + quoted(link) +
                          " are both roots, must be one");
      reached.push_back(link);
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const auto children = children_.find(reached[i]);
      if (children == children_.end()) continue;
      reached.insert(reached.end(), children->second.begin(), children->second.end());
    }
    if (reached.size() == links_.size()) return;
    const std::set<std::string_view> on_tree(reached.begin(), reached.end());
    for (const std::string& link : links_)
      if (on_tree.count(link) == 0)
        fail(source_ + ": link " + quoted(link), "hangs in a loop of joints, not on a root link");
  }

  /// The link a joint's <parent> or <child> names; links are all known by now.
  std::string_view endOf(const XmlElement& joint, const char* end, const std::string& where) const {
    const std::string_view link =
        requireAttribute(requireChild(xml_, joint, end, where), "link", where);
    if (links_.count(std::string(link)) == 0)
      fail(where, std::string(end) + " link " + quoted(link) + " does not exist");
    return link;
  }

  std::string lineOf(const XmlElement& element) const {
    return source_ + ": line " + std::to_string(element.line);
  }

 private:
  const Xml& xml_;
  const std::string& source_;
  std::set<std::string> links_;
  std::set<std::string_view> joints_;
  std::map<std::string_view, std::string_view> parents_;
  std::map<std::string_view, std::vector<std::string_view>> children_;
};

}  // namespace

void checkUrdf(const std::vector<XmlElement>& xml, const std::string& source) {
  const XmlElement& robot = xml.front();
  if (robot.name != "robot")
    fail(source, "the root element is <" + oneLine(robot.name) + ">, must be <robot>");
  requireAttribute(robot, "name", source);
  TreeCheck tree(xml, source);
  for (int i = robot.first_child; i >= 0; i = xml[i].next_sibling)
    if (xml[i].name == "link") tree.addLink(xml[i]);
  for (int i = robot.first_child; i >= 0; i = xml[i].next_sibling)
    if (xml[i].name == "joint") tree.addJoint(xml[i]);
  tree.finish();
}

}  // namespace rigid_body_sim
