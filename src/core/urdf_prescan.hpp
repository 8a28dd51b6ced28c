#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rigid_body_sim {

constexpr std::size_t kMaxUrdfBytes = 16 * 1024 * 1024;

/// An attribute as it is written: character references are not decoded.
struct XmlAttribute {
  std::string_view name;
  std::string_view value;
};

/// An element of a scanned text; indices are into the vector scanXml returns, -1 is none.
struct XmlElement {
  std::string_view name;
  std::vector<XmlAttribute> attributes;
  int line = 1;
  int first_child = -1;
  int next_sibling = -1;
};

/// The elements of a well-formed XML text, in document order; the views are into `text`.
///
/// Stands before the URDF parser, whose XML reader overflows the stack on deep texts, is quadratic
/// in attributes, and repairs broken texts by guessing. What passes here both read alike: UTF-8
/// without control characters, one root element, every tag closed, no DOCTYPE, no entities but
/// XML's own five, and bounded size, depth, tags and attributes.
/// @throws std::invalid_argument with one line that names source, line and rule.
std::vector<XmlElement> scanXml(std::string_view text, const std::string& source);

/// `text` for a one-line message: control characters become '?', what is over `length` bytes "...".
std::string oneLine(std::string_view text, std::size_t length = 80);

}  // namespace rigid_body_sim
