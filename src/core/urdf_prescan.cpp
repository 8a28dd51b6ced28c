#include "core/urdf_prescan.hpp"

#include <algorithm>
#include <stdexcept>

namespace rigid_body_sim {
namespace {

constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxAttributes = 256;
/// The parser's tree takes some 300 bytes a node.
constexpr std::size_t kMaxTags = 1000000;
/// "&#x10FFFF;", the longest reference there is.
constexpr std::size_t kMaxReference = 10;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isHexDigit(char c) { return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
bool startsName(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continuesName(char c) {
  return startsName(c) || isDigit(c) || c == '-' || c == '.' || c == ':';
}

/// Whether `second` may follow `lead`, the first of three or four bytes: no character in more bytes
/// than it needs, no surrogate, none above U+10FFFF (RFC 3629, section 4).
bool isSecondByte(unsigned char lead, unsigned char second) {
  if (lead == 0xE0) return second >= 0xA0;
  if (lead == 0xED) return second < 0xA0;
  if (lead == 0xF0) return second >= 0x90;
  if (lead == 0xF4) return second < 0x90;
  return true;
}

/// Bytes of the UTF-8 character at the head of `text`; 0 if there is none.
std::size_t utf8Length(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return 1;
  const std::size_t length = lead < 0xC2   ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  if (length > 2 && !isSecondByte(lead, static_cast<unsigned char>(text[1]))) return 0;
  return length;
}

/// Whether `name`, the inside of "&name;", is one of XML's own entities or a character reference.
bool isReference(std::string_view name) {
  for (const char* known : {"amp", "lt", "gt", "quot", "apos"})
    if (name == known) return true;
  if (name.size() >= 3 && name.substr(0, 2) == "#x")
    return std::all_of(name.begin() + 2, name.end(), isHexDigit);
  return name.size() >= 2 && name.front() == '#' &&
         std::all_of(name.begin() + 1, name.end(), isDigit);
}

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  std::vector<XmlElement> run() {
    checkCharacters();
    if (isAt("\xEF\xBB\xBF")) at_ += 3;
    for (std::size_t tags = 0; at_ < text_.size();) {
      if (text_[at_] != '<') {
        scanText();
        continue;
      }
      if (++tags > kMaxTags) fail("more than " + std::to_string(kMaxTags) + " tags and comments");
      scanMarkup();
    }
    if (elements_.empty()) fail("no XML element");
    if (!open_.empty()) fail("<" + oneLine(elements_[open_.back().index].name) + "> is not closed");
    return std::move(elements_);
  }

 private:
  struct Open {
    int index;
    int last_child;
  };

  [[noreturn]] void fail(const std::string& why) {
    throw std::invalid_argument(source_ + ": line " + std::to_string(line()) + ": " + why);
  }

  int line() {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_to_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
    counted_to_ = at_;
    return line_;
  }

  bool isAt(std::string_view token) const { return text_.substr(at_, token.size()) == token; }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void checkCharacters() {
    for (at_ = 0; at_ < text_.size();) {
      const char c = text_[at_];
      if (static_cast<unsigned char>(c) < 0x20 && !isBlank(c))
        fail("control character (code " + std::to_string(c) + ") in the text");
      const std::size_t length = utf8Length(text_.substr(at_));
      if (length == 0) fail("text is not UTF-8");
      at_ += length;
    }
    at_ = 0;
  }

  bool skipBlanks() {
    const std::size_t from = at_;
    while (isBlank(next())) ++at_;
    return at_ != from;
  }

  void skipPast(std::string_view token, const char* what) {
    const std::size_t end = text_.find(token, at_);
    if (end == std::string_view::npos) fail(std::string(what) + " is not closed");
    at_ = end + token.size();
  }

  void require(char c, const std::string& where) {
    if (next() != c) fail(std::string("'") + c + "' expected " + where);
    ++at_;
  }

  void checkReferences(std::string_view text) {
    for (std::size_t i = text.find('&'); i != std::string_view::npos; i = text.find('&', i + 1)) {
      const std::size_t end = text.substr(i, kMaxReference).find(';');
      if (end == std::string_view::npos || !isReference(text.substr(i + 1, end - 1)))
        fail("'" + oneLine(text.substr(i, kMaxReference)) +
             "' is not one of XML's own entities; no others are allowed");
    }
  }

  void scanText() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    const std::string_view text = text_.substr(at_, end - at_);
    if (open_.empty() && !std::all_of(text.begin(), text.end(), isBlank)) {
      skipBlanks();
      fail("text outside the root element");
    }
    checkReferences(text);
    at_ = end;
  }

  void scanMarkup() {
    if (isAt("<!--")) {
      at_ += 4;
      skipPast("-->", "comment");
    } else if (isAt("<![CDATA[")) {
      if (open_.empty()) fail("CDATA outside the root element");
      skipPast("]]>", "CDATA");
    } else if (isAt("<!")) {
      fail("DOCTYPE and other declarations are not allowed");
    } else if (isAt("<?")) {
      scanInstruction();
    } else if (isAt("</")) {
      scanEndTag();
    } else {
      scanStartTag();
    }
  }

  std::string_view scanName() {
    if (!startsName(next())) fail("a name of letters, digits and _-.: expected");
    const std::size_t from = at_;
    while (continuesName(next())) ++at_;
    return text_.substr(from, at_ - from);
  }

  XmlAttribute scanAttribute() {
    const std::string_view name = scanName();
    const std::string where = "at attribute '" + oneLine(name) + "'";
    skipBlanks();
    require('=', where);
    skipBlanks();
    const char quote = next();
    if (quote != '"' && quote != '\'') fail("quotes expected " + where);
    const std::size_t from = ++at_;
    skipPast(std::string_view(&quote, 1), "attribute");
    const std::string_view value = text_.substr(from, at_ - 1 - from);
    if (value.find('<') != std::string_view::npos) fail("'<' " + where);
    checkReferences(value);
    return {name, value};
  }

  std::vector<XmlAttribute> scanAttributes() {
    std::vector<XmlAttribute> attributes;
    while (skipBlanks() && startsName(next())) {
      const XmlAttribute added = scanAttribute();
      for (const XmlAttribute& other : attributes)
        if (other.name == added.name)
          fail("attribute '" + oneLine(added.name) + "' is given twice");
      if (attributes.size() == kMaxAttributes)
        fail("more than " + std::to_string(kMaxAttributes) + " attributes");
      attributes.push_back(added);
    }
    return attributes;
  }

  /// The parser ends an instruction at its first '>', and looks for attributes inside values.
  void scanInstruction() {
    at_ += 2;
    scanName();
    for (const XmlAttribute& attribute : scanAttributes())
      if (attribute.value.find_first_of("<>'\"") != std::string_view::npos)
        fail("<, > or a quote inside a processing instruction");
    require('?', "at the end of a processing instruction");
    require('>', "at the end of a processing instruction");
  }

  void scanStartTag() {
    ++at_;
    XmlElement element;
    element.line = line();
    element.name = scanName();
    if (open_.empty() && !elements_.empty()) fail("a second root element");
    if (open_.size() == kMaxDepth)
      fail("elements are nested more than " + std::to_string(kMaxDepth) + " deep");
    element.attributes = scanAttributes();
    const bool is_closed = next() == '/';
    if (is_closed) ++at_;
    require('>', "at the end of <" + oneLine(element.name) + ">");
    const int index = static_cast<int>(elements_.size());
    if (!open_.empty()) {
      Open& parent = open_.back();
      (parent.last_child < 0 ? elements_[parent.index].first_child
                             : elements_[parent.last_child].next_sibling) = index;
      parent.last_child = index;
    }
    elements_.push_back(std::move(element));
    if (!is_closed) open_.push_back({index, -1});
  }

  void scanEndTag() {
    at_ += 2;
    const std::string_view name = scanName();
    if (open_.empty()) fail("</" + oneLine(name) + "> closes nothing");
    const std::string_view opened = elements_[open_.back().index].name;
    if (name != opened) fail("</" + oneLine(name) + "> closes <" + oneLine(opened) + ">");
    skipBlanks();
    require('>', "at the end of </" + oneLine(name) + ">");
    open_.pop_back();
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0;
  std::size_t counted_to_ = 0;
  int line_ = 1;
  std::vector<XmlElement> elements_;
  std::vector<Open> open_;
};

}  // namespace

std::vector<XmlElement> scanXml(std::string_view text, const std::string& source) {
  if (text.empty()) throw std::invalid_argument(source + ": the text is empty");
  if (text.size() > kMaxUrdfBytes)
    throw std::invalid_argument(source + ": the text is over " + std::to_string(kMaxUrdfBytes) +
                                " bytes");
  return Scanner(text, source).run();
}

std::string oneLine(std::string_view text, std::size_t length) {
  const bool is_cut = text.size() > length;
  if (is_cut) {
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    text = text.substr(0, length);
  }
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return is_cut ? line + "..." : line;
}

}  // namespace rigid_body_sim
