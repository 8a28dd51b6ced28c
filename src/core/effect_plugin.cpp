#include "rigid_body_sim/effect_plugin.hpp"

#include <dlfcn.h>
#include <locale.h>

#include <algorithm>
#include <stdexcept>

#include "core/effect_plugin.hpp"

namespace rigid_body_sim {
namespace {

/// A name that cannot lead anywhere: no slash, no dot.
bool isPlainName(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_plain);
}

/// While it lives, this thread gets the C library's messages as they are, in no other language.
class Untranslated {
 public:
  Untranslated() : plain_(newlocale(LC_ALL_MASK, "C", nullptr)), before_(uselocale(plain_)) {}
  ~Untranslated() {
    uselocale(before_);
    freelocale(plain_);
  }
  Untranslated(const Untranslated&) = delete;
  Untranslated& operator=(const Untranslated&) = delete;

 private:
  locale_t plain_, before_;
};

/// Whether the linker found no such library, rather than one that it could not load, or one that
/// lacks another. Only its message tells; the words are glibc's, read in version 2.36.
bool isMissing(const std::string& error, const std::string& library) {
  return error.rfind(library + ": cannot open shared object file: No such file", 0) == 0;
}

/// Null if it is missing. It is never closed: effects made by it may live as long as the program.
void* loaded(const std::string& library) {
  const Untranslated messages;
  if (void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  const std::string error = dlerror();
  if (isMissing(error, library)) return nullptr;
  throw std::invalid_argument("its plug-in cannot be loaded: " + error);
}

void checkFit(const EffectPlugin& plugin, const std::string& library, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("its plug-in " + library + " " + what);
  };
  // Behind these two numbers nothing may be read unless they are right.
  if (plugin.version != kEffectPluginVersion)
    refuse("was built for version " + std::to_string(plugin.version) +
           " of the interface, and this is " + std::to_string(kEffectPluginVersion) +
           "; build it again");
  if (plugin.alignment != EIGEN_MAX_STATIC_ALIGN_BYTES)
    refuse("was built with matrices aligned to " + std::to_string(plugin.alignment) +
           " bytes, and rigid_body_sim with " + std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES) +
           "; build both with the same -m flags");
  if (plugin.row.name != name) refuse("offers '" + plugin.row.name + "' instead");
}

}  // namespace

std::string effectPluginLibrary(const std::string& name) {
  return isPlainName(name) ? "librigid_body_sim_effect_" + name + ".so" : "";
}

const EffectRow* effectPlugin(const std::string& name) {
  const std::string library = effectPluginLibrary(name);
  if (library.empty()) return nullptr;
  void* handle = loaded(library);
  if (!handle) return nullptr;
  const auto offer =
      reinterpret_cast<decltype(&rigidBodySimEffect)>(dlsym(handle, "rigidBodySimEffect"));
  if (!offer)
    throw std::invalid_argument("its plug-in " + library +
                                " offers no effect; its source must end with "
                                "RIGID_BODY_SIM_EFFECT(...)");
  const EffectPlugin& plugin = *offer();
  checkFit(plugin, library, name);
  return &plugin.row;
}

}  // namespace rigid_body_sim
