// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <string>

#include <fmt/format.h>

#include "sim/render/color.hpp"
#include "sim/render/osmesa_context.hpp"
#include "sim/render/osmesa_scene.hpp"
#include "sim/render/osmesa_shaders.hpp"
#include "sim/render/renderer.hpp"
#include "slam/io/error.hpp"

namespace mh {

#ifdef MH_HAS_OSMESA
namespace {

using Eigen::Vector3f;

// Surfaces nearer than this are clipped; a ray tracer would see them.
constexpr float kNearM = 1e-3F;

class OsmesaRenderer final : public Renderer {
 public:
  OsmesaRenderer(const Scene& scene, const RenderConfig& config)
      : gl_(context_.gl()), exposure_(scene.light.empty() ? 0.0F : config.exposure) {
    const OffscreenContext::Current current(context_);
    has_panes_ = std::ranges::any_of(scene.materials, &Material::is_pane);
    make_program(
        std::ranges::any_of(scene.materials, [](const Material& m) { return !m.opacity.empty(); }));
    batches_ = load_scene(gl_, scene, config.exposure);
    Vector3f sky = Vector3f::Zero();
    for (const Light& light : scene.lights)
      if (light.kind == Light::Kind::kSky) sky += light.color * config.exposure;
    for (int k = 0; k < 3; ++k) sky_[static_cast<std::size_t>(k)] = std::min(sky[k], white());
    check("load the scene");
  }

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    check_projection(camera);
    const std::lock_guard lock(mutex_);
    const OffscreenContext::Current current(context_);
    prepare_targets(camera.width_px, camera.height_px);
    set_view(camera, world_from_camera);
    constexpr std::array<GLuint, 4> kNoLabel = {};
    constexpr std::array<float, 4> kNoDepth = {};
    gl_.ClearBufferfv(GL_COLOR, 0, sky_.data());
    gl_.ClearBufferuiv(GL_COLOR, 1, kNoLabel.data());
    gl_.ClearBufferfv(GL_COLOR, 2, kNoDepth.data());
    gl_.ClearBufferfv(GL_DEPTH, 0, kNoDepth.data());
    for (const Batch& batch : batches_)
      if (!batch.pane) draw(batch);
    if (has_panes_) draw_panes();
    RenderedFrame frame = read_back(camera.width_px, camera.height_px);
    frame.exposure = exposure_;
    check("draw");
    return frame;
  }

 private:
  /// Where light is cut off: not at white if the scene has panes, which may dim brighter light to
  /// below white.
  float white() const { return has_panes_ ? std::numeric_limits<float>::max() : 1.0F; }

  void check(const char* what) const {
    const GLenum error = gl_.GetError();
    if (error != GL_NO_ERROR)
      throw MachineError(fmt::format("OSMesa failed to {} (error {:#x})", what, error));
  }

  GLint place(const char* uniform) const { return gl_.GetUniformLocation(program_, uniform); }

  void make_program(bool with_holes) {
    program_ = gl_.CreateProgram();
    const auto add = [&](GLenum kind, const char* source) {
      const GLuint shader = gl_.CreateShader(kind);
      const std::array<const char*, 2> parts = {with_holes ? kVersionWithHoles : kVersion, source};
      gl_.ShaderSource(shader, 2, parts.data(), nullptr);
      gl_.CompileShader(shader);
      gl_.AttachShader(program_, shader);
    };
    add(GL_VERTEX_SHADER, kVertexShader);
    add(GL_FRAGMENT_SHADER, kFragmentShader);
    gl_.LinkProgram(program_);
    GLint linked = 0;
    gl_.GetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == 0) {
      std::array<char, 512> log{};
      gl_.GetProgramInfoLog(program_, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
      throw MachineError(fmt::format("OSMesa rejects the shaders: {}", log.data()));
    }
    gl_.UseProgram(program_);
    gl_.Uniform1i(place("picture"), 0);
    gl_.Uniform1i(place("normals"), 1);
    gl_.Uniform1i(place("labels"), 2);
    gl_.Uniform1i(place("opacity"), 3);
    gl_.Uniform1f(place("white"), white());
    gl_.Uniform1f(place("least_opacity"), (static_cast<float>(kOpaqueFrom) - 0.5F) / 255.0F);
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_GREATER);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  }

  /// Renderbuffers of the image's size: linear color, labels, depth, depth test.
  void prepare_targets(int width, int height) const {
    if (targets_.empty()) {
      targets_.resize(4);
      gl_.GenRenderbuffers(4, targets_.data());
      gl_.GenFramebuffers(1, &framebuffer_);
    }
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.Viewport(0, 0, width, height);
    if (width == width_ && height == height_) return;
    width_ = width, height_ = height;
    const GLenum color = has_panes_ ? GL_RGBA32F : GL_RGBA16;
    const std::array<GLenum, 4> formats = {color, GL_RG16UI, GL_R32F, GL_DEPTH_COMPONENT32F};
    constexpr std::array<GLenum, 4> kPlaces = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                               GL_COLOR_ATTACHMENT2, GL_DEPTH_ATTACHMENT};
    for (std::size_t i = 0; i < 4; ++i) {
      gl_.BindRenderbuffer(GL_RENDERBUFFER, targets_[i]);
      gl_.RenderbufferStorage(GL_RENDERBUFFER, formats[i], width, height);
      gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, targets_[i]);
    }
    gl_.DrawBuffers(3, kPlaces.data());
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw MachineError(fmt::format("OSMesa cannot draw {} x {} pixels", width, height));
  }

  void set_view(const Camera& camera, const SE3& world_from_camera) const {
    const double w = camera.width_px, h = camera.height_px;
    Eigen::Matrix4f clip_from_camera = Eigen::Matrix4f::Zero();
    clip_from_camera(0, 0) = static_cast<float>(2.0 * camera.fx_px / w);
    clip_from_camera(1, 1) = static_cast<float>(2.0 * camera.fy_px / h);
    // OpenGL's pixel centers are at half-integers, ours at integers.
    clip_from_camera(0, 2) = static_cast<float>(2.0 * (camera.cx_px + 0.5) / w - 1.0);
    clip_from_camera(1, 2) = static_cast<float>(2.0 * (camera.cy_px + 0.5) / h - 1.0);
    clip_from_camera(2, 3) = kNearM;
    clip_from_camera(3, 2) = 1.0F;
    const Eigen::Matrix3f camera_from_world =
        world_from_camera.rotation().transpose().cast<float>();
    const Vector3f origin = world_from_camera.translation().cast<float>();
    gl_.UniformMatrix4fv(place("clip_from_camera"), 1, GL_FALSE, clip_from_camera.data());
    gl_.UniformMatrix3fv(place("camera_from_world"), 1, GL_FALSE, camera_from_world.data());
    gl_.Uniform3fv(place("origin"), 1, origin.data());
    gl_.Uniform1f(place("pixel_area"), static_cast<float>(1.0 / (camera.fx_px * camera.fy_px)));
  }

  void draw(const Batch& batch) const {
    gl_.Uniform1i(place("first_face"), batch.first);
    gl_.Uniform1i(place("textured"), batch.texture != 0);
    gl_.Uniform3fv(place("base"), 1, batch.base.data());
    gl_.Uniform3fv(place("emission"), 1, batch.emission.data());
    gl_.Uniform1i(place("has_holes"), batch.opacity != 0);
    if (batch.opacity != 0) {
      gl_.ActiveTexture(GL_TEXTURE3);
      gl_.BindTexture(GL_TEXTURE_2D, batch.opacity);
      gl_.ActiveTexture(GL_TEXTURE0);
    }
    gl_.BindTexture(GL_TEXTURE_2D, batch.texture);
    const std::size_t bytes = static_cast<std::size_t>(batch.first) * 3 * sizeof(std::uint32_t);
    gl_.DrawElements(GL_TRIANGLES, 3 * batch.count, GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(bytes));
  }

  /// Panes dim the light behind them, in any order; nothing else changes.
  void draw_panes() const {
    gl_.Enablei(GL_BLEND, 0);
    gl_.BlendFunc(GL_ZERO, GL_SRC_COLOR);
    gl_.DepthMask(GL_FALSE);
    for (const GLuint target : {1U, 2U})
      gl_.ColorMaski(target, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (const Batch& batch : batches_)
      if (batch.pane) draw(batch);
    for (const GLuint target : {1U, 2U}) gl_.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_TRUE);
    gl_.Disablei(GL_BLEND, 0);
  }

  RenderedFrame read_back(int width, int height) const {
    RenderedFrame frame;
    frame.color = Grid2d<Rgb8>(width, height);
    frame.depth_m = Grid2d<float>(width, height);
    frame.classes = Grid2d<ClassId>(width, height);
    frame.instances = Grid2d<InstanceId>(width, height);
    std::vector<std::array<float, 4>> color(frame.color.size());
    std::vector<std::array<std::uint16_t, 2>> label(color.size());
    const auto read = [&](GLenum from, GLenum format, GLenum type, void* to) {
      gl_.ReadBuffer(from);
      gl_.ReadPixels(0, 0, width, height, format, type, to);
    };
    read(GL_COLOR_ATTACHMENT0, GL_RGBA, GL_FLOAT, color.data());
    read(GL_COLOR_ATTACHMENT1, GL_RG_INTEGER, GL_UNSIGNED_SHORT, label.data());
    read(GL_COLOR_ATTACHMENT2, GL_RED, GL_FLOAT, frame.depth_m.data());
    for (std::size_t i = 0; i < color.size(); ++i) {
      frame.color.data()[i] = {linear_to_srgb(color[i][0]), linear_to_srgb(color[i][1]),
                               linear_to_srgb(color[i][2])};
      frame.classes.data()[i] = static_cast<ClassId>(label[i][0]);
      frame.instances.data()[i] = label[i][1];
    }
    return frame;
  }

  OffscreenContext context_;
  const Gl& gl_;
  float exposure_;  // exposure of images, see RenderedFrame
  GLuint program_ = 0;
  std::vector<Batch> batches_;
  bool has_panes_ = false;
  std::array<float, 4> sky_{};  // linear x exposure
  mutable std::mutex mutex_;    // guards the context and what follows
  mutable std::vector<GLuint> targets_;
  mutable GLuint framebuffer_ = 0;
  mutable int width_ = 0, height_ = 0;
};

}  // namespace
#endif

std::unique_ptr<Renderer> make_osmesa_renderer([[maybe_unused]] const Scene& scene,
                                               [[maybe_unused]] const RenderConfig& config) {
#ifdef MH_HAS_OSMESA
  validate(scene);
  return std::make_unique<OsmesaRenderer>(scene, config);
#else
  throw MachineError(
      "this build has no OSMesa: install libosmesa6-dev and build again, or render with embree");
#endif
}

}  // namespace mh
