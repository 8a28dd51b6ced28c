// Guards the borders that the compiler does not: on Debian the ROS headers lie in /usr/include, so
// that a stray include compiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "effects/registry.hpp"
#include "rigid_body_sim/integrator.hpp"

namespace rigid_body_sim {
namespace {

namespace fs = std::filesystem;

struct Source {
  std::string path;  ///< from the package's folder
  std::string text;
  std::vector<std::string> includes;  ///< what stands between the quotes or brackets
};

std::string textOf(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Every C++ source below a folder of the package; absent folders hold none.
std::vector<Source> sourcesBelow(const std::string& folder) {
  static const std::regex kInclude("^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]+)[>\"]");
  std::vector<Source> sources;
  const fs::path package(PACKAGE_DIR);
  if (!fs::exists(package / folder)) return sources;
  for (const auto& entry : fs::recursive_directory_iterator(package / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
    Source source = {fs::relative(entry.path(), package).string(), textOf(entry.path()), {}};
    std::istringstream lines(source.text);
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      if (std::regex_search(line, match, kInclude)) source.includes.push_back(match[1]);
    }
    sources.push_back(source);
  }
  return sources;
}

std::vector<Source> sourcesIn(const std::vector<std::string>& folders) {
  std::vector<Source> all;
  for (const std::string& folder : folders)
    for (Source& source : sourcesBelow(folder)) all.push_back(std::move(source));
  return all;
}

bool startsWith(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

/// Fails for every include of `sources` that matches `forbidden`, but in files that `excused`
/// takes.
void expectNoInclude(
    const std::vector<Source>& sources, const std::string& forbidden,
    const std::function<bool(const std::string&)>& excused = [](const auto&) { return false; }) {
  ASSERT_FALSE(sources.empty());
  const std::regex pattern(forbidden);
  for (const Source& source : sources) {
    if (excused(source.path)) continue;
    for (const std::string& include : source.includes)
      EXPECT_FALSE(std::regex_search(include, pattern)) << source.path << " includes " << include;
  }
}

const std::vector<std::string> kCore = {"include",         "src/core",      "src/effects",
                                        "src/integrators", "src/reference", "src/tools"};

TEST(House, CoreIncludesNothingOfRos) {
  expectNoInclude(sourcesIn(kCore),
                  "^(ros|tf2[^/]*|[^/]*_msgs|[^/]*_srvs|message_[^/]*|std_srvs|diagnostic_updater|"
                  "xmlrpcpp|node)/|^XmlRpc|^rigid_body_sim/[A-Z]");
}

TEST(House, UrdfHeadersAreInTheUrdfSourcesOnly) {
  expectNoInclude(
      sourcesIn({"include", "src"}), "^(urdf[^/]*|urdf_parser|urdf_model|console_bridge)/|^tinyxml",
      [](const std::string& path) {
        return startsWith(path, "src/core/urdf") && fs::path(path).extension() == ".cpp";
      });
}

TEST(House, YamlHeadersAreInTheYamlSourceOnly) {
  expectNoInclude(sourcesIn({"include", "src"}), "^yaml-cpp/",
                  [](const std::string& path) { return path == "src/core/yaml.cpp"; });
}

TEST(House, EffectsAndIntegratorsDoNotKnowOfEachOther) {
  expectNoInclude(sourcesIn({"src/effects"}), "integrator(s/|\\.hpp)");
  expectNoInclude(sourcesIn({"src/integrators"}), "^effects/");
}

TEST(House, PublicHeadersIncludePublicHeadersOnly) {
  for (const Source& source : sourcesIn({"include"}))
    for (const std::string& include : source.includes)
      EXPECT_TRUE(startsWith(include, "rigid_body_sim/") || startsWith(include, "Eigen/") ||
                  include.find('/') == std::string::npos)
          << source.path << " includes " << include;
}

TEST(House, NodeHasNoIntegrationOfItsOwn) {
  expectNoInclude(sourcesIn({"src/node"}), "^(integrators|effects|core|reference)/");
}

TEST(House, LibraryDoesNotKnowOfReferencesAndTests) {
  expectNoInclude(sourcesIn({"include", "src/core", "src/effects", "src/integrators"}),
                  "^(reference|tools|node|example)/|gtest|generic\\.hpp");
}

TEST(House, EveryHeaderIsIncludedOnce) {
  for (const Source& source : sourcesIn({"include", "src", "test", "bench"})) {
    if (fs::path(source.path).extension() == ".cpp") continue;
    EXPECT_TRUE(startsWith(source.text, "#pragma once\n")) << source.path;
  }
}

TEST(House, FilesAreUnderFourHundredLines) {
  for (const Source& source : sourcesIn({"include", "src", "test", "bench"}))
    EXPECT_LT(std::count(source.text.begin(), source.text.end(), '\n'), 400) << source.path;
}

TEST(House, NothingIsLeftForLater) {
  const std::regex later(std::string("TO") + "DO|FIX" + "ME");  // not to find itself
  for (const Source& source : sourcesIn({"include", "src", "test", "bench"}))
    EXPECT_FALSE(std::regex_search(source.text, later)) << source.path;
}

TEST(House, NoFolderIsCalledRos) {
  for (const auto& entry : fs::directory_iterator(fs::path(PACKAGE_DIR) / "src"))
    EXPECT_NE(entry.path().filename(), "ros") << "on the include path it would hide <ros/...>";
}

TEST(House, EveryRegistryNameIsInTheReadmeAndInTheDefaults) {
  std::vector<std::string> names;
  for (const IntegratorRow& row : integrators()) names.push_back(row.name);
  for (const EffectRow& row : effectRegistry()) names.push_back(row.name);
  ASSERT_GE(names.size(), 4u);
  for (const char* file : {"README.md", "config/default.yaml"}) {
    const std::string text = textOf(fs::path(PACKAGE_DIR) / file);
    EXPECT_FALSE(text.empty()) << file;
    for (const std::string& name : names)
      EXPECT_TRUE(std::regex_search(text, std::regex("\\b" + name + "\\b")))
          << name << " is not in " << file;
  }
}

}  // namespace
}  // namespace rigid_body_sim
