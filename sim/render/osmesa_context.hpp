// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#if __has_include(<GL/glcorearb.h>)
#define MH_HAS_OSMESA 1
#include <GL/glcorearb.h>

namespace mh {

// The OpenGL functions used, as (name, its type's name). They and OSMesa are loaded at run time, so
// that a machine without OSMesa runs everything else.
#define MH_GL_FUNCTIONS(F)                            \
  F(ActiveTexture, ACTIVETEXTURE)                     \
  F(AttachShader, ATTACHSHADER)                       \
  F(BindBuffer, BINDBUFFER)                           \
  F(BindFramebuffer, BINDFRAMEBUFFER)                 \
  F(BindRenderbuffer, BINDRENDERBUFFER)               \
  F(BindTexture, BINDTEXTURE)                         \
  F(BindVertexArray, BINDVERTEXARRAY)                 \
  F(BlendFunc, BLENDFUNC)                             \
  F(BufferData, BUFFERDATA)                           \
  F(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)   \
  F(ClearBufferfv, CLEARBUFFERFV)                     \
  F(ClearBufferuiv, CLEARBUFFERUIV)                   \
  F(ClipControl, CLIPCONTROL)                         \
  F(ColorMaski, COLORMASKI)                           \
  F(CompileShader, COMPILESHADER)                     \
  F(CreateProgram, CREATEPROGRAM)                     \
  F(CreateShader, CREATESHADER)                       \
  F(DepthFunc, DEPTHFUNC)                             \
  F(DepthMask, DEPTHMASK)                             \
  F(Disablei, DISABLEI)                               \
  F(DrawBuffers, DRAWBUFFERS)                         \
  F(DrawElements, DRAWELEMENTS)                       \
  F(Enable, ENABLE)                                   \
  F(Enablei, ENABLEI)                                 \
  F(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
  F(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER) \
  F(GenBuffers, GENBUFFERS)                           \
  F(GenFramebuffers, GENFRAMEBUFFERS)                 \
  F(GenRenderbuffers, GENRENDERBUFFERS)               \
  F(GenTextures, GENTEXTURES)                         \
  F(GenVertexArrays, GENVERTEXARRAYS)                 \
  F(GetError, GETERROR)                               \
  F(GetProgramInfoLog, GETPROGRAMINFOLOG)             \
  F(GetProgramiv, GETPROGRAMIV)                       \
  F(GetUniformLocation, GETUNIFORMLOCATION)           \
  F(LinkProgram, LINKPROGRAM)                         \
  F(PixelStorei, PIXELSTOREI)                         \
  F(ReadBuffer, READBUFFER)                           \
  F(ReadPixels, READPIXELS)                           \
  F(RenderbufferStorage, RENDERBUFFERSTORAGE)         \
  F(ShaderSource, SHADERSOURCE)                       \
  F(TexBuffer, TEXBUFFER)                             \
  F(TexImage2D, TEXIMAGE2D)                           \
  F(TexParameteri, TEXPARAMETERI)                     \
  F(Uniform1f, UNIFORM1F)                             \
  F(Uniform1i, UNIFORM1I)                             \
  F(Uniform3fv, UNIFORM3FV)                           \
  F(UniformMatrix3fv, UNIFORMMATRIX3FV)               \
  F(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
  F(UseProgram, USEPROGRAM)                           \
  F(VertexAttribPointer, VERTEXATTRIBPOINTER)         \
  F(Viewport, VIEWPORT)

struct Gl {
#define MH_DECLARE(name, type) PFNGL##type##PROC name = nullptr;
  MH_GL_FUNCTIONS(MH_DECLARE)
#undef MH_DECLARE
};

/// An OpenGL 4.5 context without a window. Everything that depends on its provider is in
/// osmesa_context.cpp: OSMesa was removed from Mesa 25.1; EGL could replace it there.
class OffscreenContext {
 public:
  /// @throws MachineError if there is no OSMesa, or it lacks a required feature.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  const Gl& gl() const { return gl_; }

  /// Makes the context current on the calling thread during its own lifetime; at most one may exist
  /// at a time.
  class Current {
   public:
    explicit Current(const OffscreenContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    const OffscreenContext& context_;
  };

 private:
  struct Library;
  std::unique_ptr<Library> library_;
  Gl gl_;
};

}  // namespace mh
#endif
