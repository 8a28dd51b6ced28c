#include "core/effect_plugin.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <stdexcept>

#include "rigid_body_sim/effect_plugin.hpp"

namespace rigid_body_sim {
namespace {

constexpr const char* kSymbol = "rigidBodySimEffect";

/// A name that cannot lead anywhere: no slash, no dot.
bool isPlainName(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_plain);
}

/// Whether the linker found no such library, rather than one that it could not load.
bool isMissing(const std::string& error, const std::string& library) {
  return error.rfind(library + ": cannot open shared object file: No such file", 0) == 0;
}

}  // namespace

const EffectRow* effectPlugin(const std::string& name) {
  if (!isPlainName(name)) return nullptr;
  const std::string library = "librigid_body_sim_effect_" + name + ".so";
  // Never closed: effects made by it may live as long as the program.
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const std::string error = dlerror();
    if (isMissing(error, library)) return nullptr;
    throw std::invalid_argument("its plug-in cannot be loaded: " + error);
  }
  using Offer = const EffectPlugin* (*)();
  const auto offer = reinterpret_cast<Offer>(dlsym(handle, kSymbol));
  if (!offer)
    throw std::invalid_argument(library + " does not end with RIGID_BODY_SIM_EFFECT(...)");
  const EffectPlugin* plugin = offer();
  if (plugin->version != kEffectPluginVersion)
    throw std::invalid_argument(library + " was built for version " +
                                std::to_string(plugin->version) + " of the interface, this is " +
                                std::to_string(kEffectPluginVersion) + "; build it again");
  if (plugin->row.name != name)
    throw std::invalid_argument(library + " offers '" + plugin->row.name + "' instead");
  return &plugin->row;
}

}  // namespace rigid_body_sim
