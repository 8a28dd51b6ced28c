#pragma once

#include <string>
#include <utility>
#include <vector>

/// URDFs that must be refused, and what the refusal must say.

namespace rigid_body_sim {

struct BadUrdf {
  std::string name;
  std::string text;
  std::vector<std::string> told;  ///< what the message must say: who, and which rule
};

const std::string kInertia = "<inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/>";
const std::string kInertial = "<inertial><mass value='1'/>" + kInertia + "</inertial>";

inline std::string robot(const std::string& inside) {
  return "<robot name='r'>" + inside + "</robot>";
}

inline std::string link(const std::string& name, const std::string& inside = kInertial) {
  return "<link name='" + name + "'>" + inside + "</link>";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>";
}

inline std::string mass(const std::string& value) {
  return robot(link("base", "<inertial><mass value='" + value + "'/>" + kInertia + "</inertial>"));
}

inline std::string inertia(const std::string& attributes) {
  return robot(link("base", "<inertial><mass value='1'/><inertia " + attributes + "/></inertial>"));
}

inline std::string inertialOrigin(const std::string& attributes) {
  return robot(link("base", "<inertial><origin " + attributes + "/><mass value='1'/>" + kInertia +
                                "</inertial>"));
}

inline std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

inline std::string attributes(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += " a" + std::to_string(i) + "='0'";
  return all;
}

inline std::string links(int count) {
  std::string all = link("l0");
  for (int i = 1; i < count; ++i) {
    const std::string name = "l" + std::to_string(i);
    all += link(name, "") + joint("j" + std::to_string(i), "fixed", "l0", name);
  }
  return all;
}

inline std::vector<BadUrdf> badNumbers() {
  const std::string decimal = "is not a plain decimal number";
  std::vector<BadUrdf> cases;
  for (const char* value :
       {"0,5", "0.5 ", " 0.5", "${m}", "nan", "-nan",  "inf", "0x10",  "1kg", "",
        "1e",  "1e+",  ".",    "+",    "--1", "1.2.3", "1\n", "&#49;", "1d0", "1_000"})
    cases.push_back(
        {std::string("mass ") + value, mass(value), {"link 'base'", "mass '", decimal}});
  for (const char* value : {"1e400", "-1e400"})
    cases.push_back({std::string("mass ") + value, mass(value), {"link 'base'", value, "range"}});
  for (const char* value : {"1e-400", "1e-310"})
    cases.push_back({std::string("mass ") + value, mass(value), {"link 'base'", value, "small"}});
  cases.push_back({"mass negative", mass("-1"), {"link 'base'", "mass '-1'", "negative"}});
  cases.push_back({"mass zero", mass("0"), {"link 'base'", "mass is 0", "positive"}});
  const std::string rest = " ixy='0' ixz='0' iyy='1' iyz='0' izz='1'";
  for (const char* value : {"nan", "inf", "1,0", "1 ", "", "0x1p3"})
    cases.push_back({std::string("ixx ") + value,
                     inertia("ixx='" + std::string(value) + "'" + rest),
                     {"link 'base'", "ixx '", decimal}});
  cases.push_back({"ixx over", inertia("ixx='1e999'" + rest), {"link 'base'", "ixx", "range"}});
  for (const char* value : {"1 2", "1 2 3 4", "", " "})
    cases.push_back({std::string("origin ") + value,
                     inertialOrigin("xyz='" + std::string(value) + "'"),
                     {"link 'base'", "origin xyz", "is not three numbers"}});
  for (const char* value : {"1 2 nan", "1, 2, 3", "1\t2\t3", "0 0 3m", "1 2 1e"})
    cases.push_back({std::string("origin ") + value,
                     inertialOrigin("rpy='" + std::string(value) + "'"),
                     {"link 'base'", "origin rpy", decimal}});
  return cases;
}

const std::string kNoIxy = "ixx='1' ixz='0' iyy='1' iyz='0' izz='1'";
const std::string kMass = "<mass value='1'/>";
const std::vector<BadUrdf> kImpossibleInertials = {
    {"missing ixy", inertia(kNoIxy), {"link 'base'", "no attribute 'ixy'"}},
    {"misspelt ixy", inertia(kNoIxy + " iyx='0'"), {"link 'base'", "unknown attribute 'iyx'"}},
    {"repeated ixx", inertia(kNoIxy + " ixx='0'"), {"attribute 'ixx' is given twice"}},
    {"no mass",
     robot(link("base", "<inertial>" + kInertia + "</inertial>")),
     {"link 'base'", "<inertial> has no <mass>"}},
    {"no mass value",
     robot(link("base", "<inertial><mass/>" + kInertia + "</inertial>")),
     {"link 'base'", "<mass> has no attribute 'value'"}},
    {"mass as text",
     robot(link("base", "<inertial><mass>1</mass>" + kInertia + "</inertial>")),
     {"link 'base'", "<mass> has no attribute 'value'"}},
    {"no inertia",
     robot(link("base", "<inertial>" + kMass + "</inertial>")),
     {"link 'base'", "<inertial> has no <inertia>"}},
    {"two inertials",
     robot(link("base", kInertial + kInertial)),
     {"link 'base'", "more than one <inertial>"}},
    {"two masses",
     robot(link("base", "<inertial>" + kMass + kMass + kInertia + "</inertial>")),
     {"link 'base'", "more than one <mass>"}},
    {"quaternion origin",
     inertialOrigin("quat_xyzw='0 0 0 1'"),
     {"link 'base'", "unknown attribute 'quat_xyzw'"}},
    {"triangle",
     inertia("ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'"),
     {"link 'base'", "triangle inequality: 1 + 1 < 3", "nearest valid tensor", "ixx=1.5", "iyy=1.5",
      "izz=3"}},
    {"negative moment",
     inertia("ixx='-1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'"),
     {"link 'base'", "principal moments (-1, 1, 1)", "positive"}},
    {"zero tensor",
     inertia("ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'"),
     {"link 'base'", "principal moments (0, 0, 0)", "positive"}},
    {"product of inertia too large",
     inertia("ixx='1' ixy='1.5' ixz='0' iyy='1' iyz='0' izz='1'"),
     {"link 'base'", "principal moments (-0.5, 1, 2.5)"}},
    {"lump breaks the triangle",
     robot(link("base",
                "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
                "iyz='0' izz='9'/></inertial>") +
           link("tip") + joint("j", "fixed", "base", "tip")),
     {"link 'base'", "1 lumped", "triangle inequality", "nearest valid tensor"}},
    {"far apart",
     robot(link("base") + link("tip") +
           joint("j", "fixed", "base", "tip", "<origin xyz='1e308 0 0'/>")),
     {"link 'base'", "not finite"}},
    {"no inertial at all", robot(link("base", "")), {"link 'base'", "mass is 0"}},
    {"massless free child",
     robot(link("base") + link("free", "") + joint("j", "floating", "base", "free")),
     {"link 'free'", "mass is 0"}},
    {"masses add up to infinity",
     robot(link("base", "<inertial><mass value='1e308'/>" + kInertia + "</inertial>") +
           link("tip", "<inertial><mass value='1e308'/>" + kInertia + "</inertial>") +
           joint("j", "fixed", "base", "tip")),
     {"link 'base'", "mass is inf"}},
};

const std::string kTwoLinks = link("base") + link("tip");
const std::string kLimit = "<limit lower='0' upper='1' effort='1' velocity='1'/>";
const std::vector<BadUrdf> kBrokenTrees = {
    {"no name", robot("<link>" + kInertial + "</link>"), {"<link>", "no attribute 'name'"}},
    {"empty name", robot(link("")), {"link ''", "a name must"}},
    {"dots", robot(link("a..b")), {"link 'a..b'", "a name must"}},
    {"path", robot(link("../etc")), {"link '../etc'", "a name must"}},
    {"blank", robot(link("a b")), {"link 'a b'", "a name must"}},
    {"newline", robot(link("a\nb")), {"link 'a?b'", "a name must"}},
    {"entity in a name", robot(link("a&amp;b")), {"link 'a&amp;b'", "a name must"}},
    {"digit first", robot(link("1a")), {"link '1a'", "a name must"}},
    {"long name", robot(link(std::string(256, 'n'))), {"link 'nnn", "255"}},
    {"duplicate link",
     robot(link("base") + link("base")),
     {"link 'base'", "defined more than once"}},
    {"two roots", robot(kTwoLinks), {"'base'", "'tip'", "both roots"}},
    {"no link", robot(""), {"no <link>"}},
    {"loop",
     robot(link("base") + link("a") + link("b") + joint("j", "fixed", "a", "b") +
           joint("k", "fixed", "b", "a")),
     {"link 'a'", "loop"}},
    {"loop of all",
     robot(kTwoLinks + joint("j", "fixed", "base", "tip") + joint("k", "fixed", "tip", "base")),
     {"link 'base'", "loop"}},
    {"own parent",
     robot(link("base") + joint("j", "fixed", "base", "base")),
     {"link 'base'", "loop"}},
    {"two parents",
     robot(kTwoLinks + link("b") + joint("j", "fixed", "base", "tip") +
           joint("m", "fixed", "base", "b") + joint("k", "fixed", "b", "tip")),
     {"link 'tip'", "more than one joint", "'k'"}},
    {"duplicate joint",
     robot(kTwoLinks + link("b") + joint("j", "fixed", "base", "tip") +
           joint("j", "fixed", "base", "b")),
     {"joint 'j'", "defined more than once"}},
    {"unknown parent",
     robot(kTwoLinks + joint("j", "fixed", "bass", "tip")),
     {"joint 'j'", "parent link 'bass'", "does not exist"}},
    {"unknown child",
     robot(kTwoLinks + joint("j", "fixed", "base", "top")),
     {"joint 'j'", "child link 'top'", "does not exist"}},
    {"no parent",
     robot(kTwoLinks + "<joint name='j' type='fixed'><child link='tip'/></joint>"),
     {"joint 'j'", "no <parent>"}},
    {"parent without link",
     robot(kTwoLinks + "<joint name='j' type='fixed'><parent/><child link='tip'/></joint>"),
     {"joint 'j'", "<parent> has no attribute 'link'"}},
    {"joint without type",
     robot(kTwoLinks + "<joint name='j'><parent link='base'/><child link='tip'/></joint>"),
     {"joint 'j'", "no attribute 'type'"}},
    {"unknown type",
     robot(kTwoLinks + joint("j", "Fixed", "base", "tip")),
     {"joint 'j'", "unknown type 'Fixed'"}},
    {"joint without name",
     robot(kTwoLinks + "<joint type='fixed'><parent link='base'/><child link='tip'/></joint>"),
     {"<joint>", "no attribute 'name'"}},
    {"empty joint name",
     robot(kTwoLinks + joint("", "fixed", "base", "tip")),
     {"joint's name is empty"}},
    {"revolute",
     robot(kTwoLinks + joint("hinge", "revolute", "base", "tip", kLimit)),
     {"joint 'hinge'", "revolute"}},
    {"planar",
     robot(kTwoLinks + joint("table", "planar", "base", "tip")),
     {"joint 'table'", "planar"}},
    {"revolute from world",
     robot(link("world", "") + link("base") + joint("hinge", "revolute", "world", "base", kLimit)),
     {"joint 'hinge'", "is revolute", "only fixed and floating"}},
    {"revolute without limit",
     robot(kTwoLinks + joint("hinge", "revolute", "base", "tip")),
     {"hinge", "refused by the URDF parser"}},
    {"malformed joint origin",
     robot(kTwoLinks + joint("j", "fixed", "base", "tip", "<origin xyz='0 0 0,5'/>")),
     {"joint 'j'", "origin xyz", "plain decimal"}},
    {"misspelt joint origin",
     robot(kTwoLinks + joint("j", "fixed", "base", "tip", "<origin xzy='0 0 1'/>")),
     {"joint 'j'", "unknown attribute 'xzy'"}},
    {"two joint origins",
     robot(kTwoLinks + joint("j", "fixed", "base", "tip", "<origin/><origin/>")),
     {"joint 'j'", "more than one <origin>"}},
    {"endless origins",
     robot(kTwoLinks + link("b") +
           joint("j", "floating", "base", "tip", "<origin xyz='1.7e308 0 0'/>") +
           joint("k", "floating", "tip", "b", "<origin xyz='1.7e308 0 0'/>")),
     {"joint 'k'", "add up"}},
    {"bare world", robot(link("world", "")), {"link 'world'", "no body"}},
    {"10001 links", robot(links(10001)), {"more than 10000 links"}},
};

/// Bytes that are no UTF-8 by RFC 3629 though each has the right high bits: at both ends of every
/// range that it forbids.
inline std::vector<BadUrdf> badUtf8() {
  const std::vector<std::pair<std::string, std::vector<std::string>>> kinds = {
      {"stray continuation", {"\x80", "\xBF"}},
      {"overlong",
       {"\xC0\x80", "\xC1\xBF", "\xE0\x80\x80", "\xE0\x9F\xBF", "\xF0\x80\x80\x80",
        "\xF0\x8F\xBF\xBF"}},
      {"surrogate", {"\xED\xA0\x80", "\xED\xBF\xBF"}},
      {"above U+10FFFF",
       {"\xF4\x90\x80\x80", "\xF4\xBF\xBF\xBF", "\xF5\x80\x80\x80", "\xF7\xBF\xBF\xBF"}},
      {"five and six bytes", {"\xF8\x88\x80\x80\x80", "\xFC\x84\x80\x80\x80\x80", "\xFE", "\xFF"}},
      {"no continuation", {"\xC3(", "\xE2\x82(", "\xE2(\x82", "\xF0\x9F\x98("}}};
  std::vector<BadUrdf> cases;
  for (const auto& [kind, texts] : kinds)
    for (std::size_t i = 0; i < texts.size(); ++i)
      cases.push_back({kind + " " + std::to_string(i),
                       robot("<!-- " + texts[i] + " -->" + link("base")),
                       {"line 1", "not UTF-8"}});
  return cases;
}

const std::string kGood = robot(link("base"));
const std::string kLaughs =
    "<!DOCTYPE robot [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;'>]>";
const std::vector<BadUrdf> kHostileTexts = {
    {"empty", "", {"empty"}},
    {"blank", " \n\t ", {"no XML element"}},
    {"binary",
     std::string("\x7F"
                 "ELF\x02\x01\x01\x00\x00",
                 9),
     {"control character"}},
    {"random words", "not a urdf", {"line 1", "outside the root element"}},
    {"NUL", robot(link(std::string("b\0se", 4))), {"control character (code 0)"}},
    {"trailing NUL", kGood + '\0', {"control character (code 0)"}},
    {"Latin-1", robot("<!-- \xE9 -->" + link("base")), {"not UTF-8"}},
    {"hidden quote",
     robot("<gazebo a='\xE2'/>" + link("base") + "<gazebo b='\x80\x80'/>"),
     {"not UTF-8"}},
    {"UTF-16", std::string("\xFF\xFE<\0r\0", 6), {"not UTF-8"}},
    {"truncated", kGood.substr(0, kGood.size() - 8), {"<robot> is not closed"}},
    {"truncated tag", kGood.substr(0, kGood.size() - 1), {"'>' expected"}},
    {"truncated attribute", "<robot name='r", {"attribute is not closed"}},
    {"truncated comment", robot("<!-- " + link("base")), {"comment is not closed"}},
    {"crossed tags",
     robot("<link name='base'>" + kInertial) + "</link>",
     {"</robot> closes <link>"}},
    {"stray end tag", kGood + "</robot>", {"</robot> closes nothing"}},
    {"trailing garbage", kGood + "<robot name='s'/>", {"second root element"}},
    {"trailing text", kGood + "garbage", {"outside the root element"}},
    {"other root", "<sdf name='r'>" + link("base") + "</sdf>", {"<sdf>", "must be <robot>"}},
    {"robot without name", "<robot>" + link("base") + "</robot>", {"no attribute 'name'"}},
    {"unknown version",
     "<robot name='r' version='9.9'>" + link("base") + "</robot>",
     {"refused by the URDF parser"}},
    {"unquoted attribute", robot("<link name=base/>"), {"quotes expected"}},
    {"attribute without value", robot("<link name/>"), {"'=' expected"}},
    {"bracket in an attribute", robot("<link name='<'/>"), {"'<' at attribute 'name'"}},
    {"attributes without blank", robot("<link name='a'b=''/>"), {"'>' expected"}},
    {"nameless tag", robot("< link/>"), {"a name of letters"}},
    {"unclosed CDATA", robot(link("base") + "<![CDATA[ ]] >"), {"CDATA is not closed"}},
    {"CDATA outside", kGood + "<![CDATA[x]]>", {"CDATA outside the root"}},
    {"link in CDATA", robot("<![CDATA[" + link("base") + "]]>"), {"no <link>"}},
    {"CDATA that closes early",
     robot("<![CDATA[ <a> ]]> ]]></a>" + link("base")),
     {"</a> closes <robot>"}},
    {"conditional section", robot("<![INCLUDE[" + link("base") + "]]>"), {"not allowed"}},
    {"instruction that hides",
     robot("<?x version=\"?>" + link("base") + "<?x \"?>"),
     {"'<' at attribute 'version'"}},
    {"instruction with a quote", "<?xml a='version=\"1'?>" + kGood, {"processing instruction"}},
    {"instruction with a bracket", "<?xml a='>'?>" + kGood, {"processing instruction"}},
    {"truncated UTF-8", kGood + "\xE2\x80", {"not UTF-8"}},
    {"instruction without end", robot("<?x y>" + link("base")), {"'=' expected"}},
    {"billion laughs", kLaughs + robot(link("base") + "&b;"), {"DOCTYPE"}},
    {"external entity",
     "<!DOCTYPE r [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>" + robot(link("&x;")),
     {"DOCTYPE"}},
    {"unknown entity", robot(link("base") + "&b;"), {"'&b;", "XML's own entities"}},
    {"bare ampersand", robot(link("base") + "<gazebo a='b & c'/>"), {"XML's own entities"}},
    {"100,000 levels",
     robot(link("base") + repeated(100000, "<a>") + repeated(100000, "</a>")),
     {"64 deep"}},
    {"65 levels", robot(repeated(64, "<a>") + repeated(64, "</a>")), {"64 deep"}},
    {"200,000 attributes", robot("<link" + attributes(200000) + "/>"), {"256 attributes"}},
    {"257 attributes", robot("<link" + attributes(257) + "/>"), {"256 attributes"}},
    {"a million tags", robot(link("base") + repeated(1000001, "<a/>")), {"1000000 tags"}},
    {"100 MB comment",
     robot("<!--" + std::string(100000000, '-') + "-->" + link("base")),
     {"over 16777216 bytes"}},
};

}  // namespace rigid_body_sim
