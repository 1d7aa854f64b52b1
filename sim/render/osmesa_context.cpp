// SPDX-License-Identifier: Apache-2.0
#include "sim/render/osmesa_context.hpp"

#ifdef MH_HAS_OSMESA

#include <dlfcn.h>

#include <array>
#include <cstdint>

#include <fmt/format.h>

// osmesa.h needs <GL/gl.h>, which redeclares what is in <GL/glcorearb.h>; declare its few types
// here.
extern "C" {
using OSMesaContext = struct osmesa_context*;
}

#include "slam/io/error.hpp"

namespace mh {
namespace {

// Constants of <GL/osmesa.h>.
constexpr int kRgba = 0x1908, kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33,
              kCoreProfile = 0x34, kMajorVersion = 0x36, kMinorVersion = 0x37;
constexpr int kSize = 16;  // pixels of the context's own image, which is never shown

}  // namespace

struct OffscreenContext::Library {
  OSMesaContext (*create)(const int*, OSMesaContext) = nullptr;
  void (*destroy)(OSMesaContext) = nullptr;
  unsigned char (*make_current)(OSMesaContext, void*, unsigned, int, int) = nullptr;
  void (*(*get_function)(const char*))() = nullptr;
  void* handle = nullptr;
  OSMesaContext context = nullptr;
  std::array<std::uint32_t, kSize * kSize> image{};

  Library() {
    handle = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
      throw MachineError(fmt::format(
          "OSMesa is not installed on this machine ({}): install libosmesa6, or render with embree",
          dlerror()));
    const auto find = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
      if (function == nullptr) throw MachineError(fmt::format("OSMesa lacks {}", name));
    };
    find(create, "OSMesaCreateContextAttribs");
    find(destroy, "OSMesaDestroyContext");
    find(make_current, "OSMesaMakeCurrent");
    find(get_function, "OSMesaGetProcAddress");
    const std::array<int, 11> wanted = {
        kFormat,       kRgba, kDepthBits,    24, kProfile, kCoreProfile,
        kMajorVersion, 4,     kMinorVersion, 5,  0};
    context = create(wanted.data(), nullptr);
    if (context == nullptr) throw MachineError("OSMesa does not support OpenGL 4.5");
  }
  // The library itself stays loaded: its compiler threads outlive their contexts.
  ~Library() { destroy(context); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

OffscreenContext::OffscreenContext() : library_(std::make_unique<Library>()) {
  const Current current(*this);
#define MH_LOAD(name, type) \
  gl_.name = reinterpret_cast<PFNGL##type##PROC>(library_->get_function("gl" #name));
  MH_GL_FUNCTIONS(MH_LOAD)
#undef MH_LOAD
}

OffscreenContext::~OffscreenContext() = default;

OffscreenContext::Current::Current(const OffscreenContext& context) : context_(context) {
  Library& library = *context_.library_;
  constexpr unsigned kUnsignedByte = 0x1401;
  if (library.make_current(library.context, library.image.data(), kUnsignedByte, kSize, kSize) == 0)
    throw MachineError("OSMesa cannot make its context current");
}

OffscreenContext::Current::~Current() {
  context_.library_->make_current(nullptr, nullptr, 0, 0, 0);
}

}  // namespace mh
#endif
